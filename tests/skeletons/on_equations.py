"""How far the vertices of sheets are from the canonical equations of their sheets."""

from __future__ import annotations

import numpy as np

from decomp.skeletons.model import Skeleton
from decomp.skeletons.sheet_kinds import sheet_kinds


def off_equations(skeleton: Skeleton) -> float:
    """The largest distance, relative to the diagonal, over all sheets of a kind but "general"."""
    largest = 0.0
    for region in skeleton.regions:
        for sheet, kind in zip(region.sheets, sheet_kinds(skeleton, region), strict=True):
            used = np.unique(skeleton.complex.patches[sheet.patch].triangles)
            p = skeleton.complex.points[used]
            shapes = [piece.shape for piece in (kind, *kind.also)]
            if None not in shapes:
                gaps = [piece.deviation(p) for piece in shapes if piece is not None]
                largest = max(largest, float(np.min(gaps, axis=0).max()))
    return largest / skeleton.diagonal
