"""A skeleton in other coordinates."""

from __future__ import annotations

from dataclasses import replace

from decomp.boundary.moved import moved_boundary
from decomp.complex.moved import moved_complex
from decomp.skeletons.model import Skeleton
from decomp.vectors import Array


def moved_skeleton(skeleton: Skeleton, offset: Array) -> Skeleton:
    """A skeleton moved by `offset` (3,); `Skeleton.local` is the one that was given."""
    if not offset.any():
        return skeleton
    regions = tuple(
        replace(region, boundary=moved_boundary(region.boundary, offset))
        for region in skeleton.regions
    )
    return replace(
        skeleton,
        complex=moved_complex(skeleton.complex, offset),
        regions=regions,
        offset=offset,
        unmoved=skeleton,
    )
