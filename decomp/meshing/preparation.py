"""What a mesher is given: the complex, fine enough for a tolerance, and lengths of edges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

from decomp.complex.many_elements import Elements
from decomp.geometry import Geometry
from decomp.meshing.backends.base import Task
from decomp.meshing.repairs.shortening import Lengths, lengths_asked
from decomp.meshing.sizing.chords import chords
from decomp.meshing.sizing.expected import expected_tets, least_tets
from decomp.meshing.sizing.features import fitting_tolerance, usual_tolerance
from decomp.meshing.sizing.field import sizing
from decomp.meshing.sizing.memory import check_memory
from decomp.meshing.sizing.sizes import Wanted, region_sizes, wishes
from decomp.meshing.sizing.wishes import Wishes
from decomp.meshing.surface.beside import parting
from decomp.meshing.surface.boundary_surface import boundary_surface
from decomp.meshing.surface.cells import CellMap, cell_map
from decomp.meshing.surface.layout import Layout, layout
from decomp.meshing.surface.surface import MeshSurface, Surfaces
from decomp.vectors import Array

CHORD, COARSEST_CHORD = 0.4, 0.65
"""How far triangles are made to be off their surfaces, and may be, in parts of tolerance."""
CUSP_DEGREES = 2.0
"""Faces that meet at less than this angle (degrees) make a cusp, whose tip no tolerance fits into.
Only sheets, which end in it, need as small a one as there is."""
SHORTEST_EDGES = 7.0
"""The shortest edges are at least so many tolerances long."""

Cells = Literal["skeleton", "face", "none"]
"""Which cells a mesh has: the skeleton's, one for each face, or none."""
Progress = Callable[[str, float], None]
"""Told what is being done, and which part of the whole (0 to 1) is behind."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """All that is known before a mesher runs.

    Args:
        geometry: of the model.
        surface: boundary, and skeleton if there are cells.
        known: its cells.
        plan: which patches part them.
        elements: of the complex.
        task: for the mesher.
        expected: how many tetrahedra there will be, about.
        sizes: (r,) the largest length in each region.
        asked: the largest lengths in cells and on patches.
        wish: all lengths.
        chords: as long as edges on curved faces may be for the tolerance's sake.
    """

    geometry: Geometry
    surface: MeshSurface
    known: CellMap
    plan: Layout
    elements: Elements
    task: Task
    expected: float
    sizes: Array
    asked: Lengths
    wish: Wishes
    chords: Wishes


def prepared(
    geometry: Geometry, wanted: Wanted, cells: Cells, surfaces: Surfaces, tell: Progress
) -> Prepared:
    """Compute the skeleton, unless there are to be no cells, and choose sizes and the tolerance.

    Args:
        geometry: of the model.
        wanted: by the user.
        cells: which there are to be.
        surfaces: makes the skeletons.
        tell: of the progress.

    Raises:
        InputError: the mesh would not fit into memory.
        GeometryError: the boundary cannot be triangulated, or the skeleton not be computed.
    """
    sizes = region_sizes(geometry, wanted)
    check_memory(least_tets(geometry, sizes), float(sizes.max()))
    make = _maker(geometry, cells, sizes, surfaces, tell)
    longest = float(sizes.min())
    tolerance = usual_tolerance(geometry, longest, CUSP_DEGREES if cells == "none" else 0.0)
    surface = make(CHORD * tolerance)
    tolerance = fitting_tolerance(geometry, surface, tolerance, longest)
    surface = _fine_enough(surface, tolerance, make)
    tell("sizing", 1.0)
    wish = wishes(geometry, surface, wanted)
    tolerance = min(tolerance, float(wish.lengths.min()) / SHORTEST_EDGES)
    surface = _fine_enough(surface, tolerance, make)
    expected = expected_tets(geometry, wish, sizes)
    check_memory(expected)
    length, field = sizing(geometry, wish, sizes)
    known = cell_map(surface)
    plan = layout(surface, known)
    return Prepared(
        geometry,
        surface,
        known,
        plan,
        Elements(plan.complex),
        Task(*parting(plan, known), length, wish.at, field, tolerance),
        expected,
        sizes,
        lengths_asked(geometry, known, plan, sizes, wanted),
        wish,
        chords(surface, sizes, CHORD * tolerance),
    )


def _maker(
    geometry: Geometry, cells: Cells, sizes: Array, surfaces: Surfaces, tell: Progress
) -> Callable[[float], MeshSurface]:
    """What makes a complex for a chord tolerance, in model units."""
    if cells == "none":
        tell("triangulating the boundary", 0.0)
        return partial(boundary_surface, geometry, sizes)
    return partial(surfaces(geometry, tell).made, by_face=cells == "face")


def _fine_enough(
    surface: MeshSurface, tolerance: float, make: Callable[[float], MeshSurface]
) -> MeshSurface:
    """The surface, or a finer one if it is too coarse for a tolerance."""
    if surface.tolerance <= COARSEST_CHORD * tolerance:
        return surface
    return make(CHORD * tolerance)
