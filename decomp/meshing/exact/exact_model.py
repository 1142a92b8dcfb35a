"""The exact model that a mesh follows."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.complex.many_elements import Elements
from decomp.geometry import Geometry
from decomp.meshing.surface.cells import CellMap
from decomp.meshing.surface.layout import Layout
from decomp.meshing.surface.surface import MeshSurface


@dataclass(frozen=True, eq=False)
class ExactModel:
    """What nodes are put onto, and how far off it they are at first.

    Args:
        geometry: of the model.
        surface: boundary, and skeleton if there are cells.
        cells: which each place is in.
        plan: which patches part them.
        elements: of the plan's complex.
        epsilon: how far the mesh may be off the complex.
    """

    geometry: Geometry
    surface: MeshSurface
    cells: CellMap
    plan: Layout
    elements: Elements
    epsilon: float
