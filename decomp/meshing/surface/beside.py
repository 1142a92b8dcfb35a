"""A complex as meshers take it, and which cells its triangles part."""

from __future__ import annotations

import numpy as np

from decomp.meshing.surface.cells import OUTSIDE, CellMap
from decomp.meshing.surface.layout import Layout
from decomp.vectors import Array, Ints


def parting(plan: Layout, cells: CellMap) -> tuple[Array, Ints, Ints]:
    """All triangles that the mesh conforms to, without points that none uses.

    Returns:
        points (n, 3), triangles (m, 3), and the cells (m, 2) that each one's normal points into
        and out of, OUTSIDE for none.
    """
    patches = plan.complex.patches
    beside = np.full((len(patches), 2), OUTSIDE, dtype=np.int64)
    for number, cell in enumerate(cells.cells):
        for patch, sign in cell.sides:
            beside[patch, 0 if sign < 0 else 1] = number
    used, triangles = np.unique(plan.triangles, return_inverse=True)
    rows = np.repeat(beside, [len(patch.triangles) for patch in patches], axis=0)
    return plan.complex.points[used], triangles.reshape(-1, 3), rows
