"""What tetrahedra follow."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.complex.many_elements import Elements
from decomp.geometry import Geometry
from decomp.meshing.surface.cells import CellMap
from decomp.meshing.surface.layout import Layout
from decomp.meshing.surface.surface import MeshSurface

ASKED_OFF = 0.5
"""What a triangle belongs to is asked so many tolerances off it, on either side."""


@dataclass(frozen=True, eq=False)
class Followed:
    """What the tetrahedra of one run follow, and how closely.

    Args:
        geometry, surface: of the model.
        cells: that tetrahedra are classified by.
        plan: the complex laid out for them.
        elements: what the complex's patches and lines lie on.
        tolerance: how far the mesh may be off the complex at first; a length.
    """

    geometry: Geometry
    surface: MeshSurface
    cells: CellMap
    plan: Layout
    elements: Elements
    tolerance: float
