"""How other programs number the nodes of an element."""

from __future__ import annotations

from decomp.vectors import Ints

VTK_ORDER = (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)
"""Mid-edge nodes on edges 01, 12, 20, 03, 13, 23; VTK, meshio, Abaqus and scikit-fem use it."""


def in_vtk_order(tets: Ints) -> Ints:
    """Tetrahedra (m, 4) or (m, 10) in VTK's order; triangles are the same in both."""
    return tets[:, VTK_ORDER[: tets.shape[1]]]
