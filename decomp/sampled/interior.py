"""Tetrahedra that fill all regions and conform to their exact boundaries.

The mesher fills the boundary alone, coarsely; its nodes are then moved onto the exact faces, edges
and vertices as those of any mesh are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from decomp.complex.boundary.boundary import BoundaryMesh, boundary_mesh
from decomp.complex.many_elements import Elements
from decomp.complex.refining.refine import refined
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.meshing.backends.base import Task, TimeLimit
from decomp.meshing.backends.table import mesher
from decomp.meshing.exact.strayed import strayed
from decomp.meshing.preparation import Prepared
from decomp.meshing.repairs.shortening import lengths_asked
from decomp.meshing.sizing.chords import chords
from decomp.meshing.sizing.features import usual_tolerance
from decomp.meshing.sizing.sizes import Wanted
from decomp.meshing.sizing.wishes import UNKNOWN, joined
from decomp.meshing.surface.beside import parting
from decomp.meshing.surface.cells import cell_map
from decomp.meshing.surface.layout import Layout, layout
from decomp.meshing.surface.surface import MeshSurface, RegionSurface
from decomp.meshing.tetrahedra import filled
from decomp.skeletons.cells.surface import volume
from decomp.skeletons.model import Cell
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Ints

CHORD = 0.4
"""How far the triangles to be filled may be off the boundary, in parts of its tolerance."""


@dataclass(frozen=True, eq=False)
class Interior:
    """Tetrahedra of all regions.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        region: (m,) the region of each.
        triangles: (k, 3) of boundaries and interfaces, counterclockwise seen against the normals
            of the patches that they are on.
        patches: (k,) these patches, of `surface`.
        surface: the boundaries that the mesh conforms to.
        plan: which patches meet along their lines.
        elements: of the plan's complex.
    """

    points: Array
    tets: Ints
    region: Ints
    triangles: Ints
    patches: Ints
    surface: BoundaryMesh
    plan: Layout
    elements: Elements


def interior(
    geometry: Geometry, size: float, tolerance: float, limit: TimeLimit, tell: Callable[[str], None]
) -> Interior:
    """Fill a model.

    Args:
        geometry: of the model.
        size: the longest edges wanted, in model units.
        tolerance: how far the mesher may leave the boundary, in model units; less where edges are
        short
            or sharp.
        limit: of the mesher.
        tell: is told what is being done.

    Raises:
        GeometryError: nodes cannot be moved onto the boundary.
        MeshingError: the mesher fails.
    """
    tolerance = min(tolerance, usual_tolerance(geometry, size))
    surface = boundary_mesh(geometry, CHORD * tolerance)
    mesh, _ = refined(surface.complex, CHORD * tolerance)
    regions = []
    for number, boundary in enumerate(geometry.regions):
        sides = surface.face_sides(number, len(boundary.faces))
        every = tuple(side for own in sides for side in own)
        faces = tuple(face.name for face in boundary.faces)
        content = volume(mesh, every, boundary.bounds.mean(axis=0))
        whole = Cell(f"{boundary.name}/all", faces, every, content)
        regions.append(RegionSurface(boundary.name, boundary, sides, {}, (whole,)))
    given = MeshSurface(geometry.sites, mesh, CHORD * tolerance, tuple(regions))
    known = cell_map(given)
    plan = layout(given, known)
    elements = Elements(plan.complex)
    wish = joined([(mesh.points, np.full(len(mesh.points), size), UNKNOWN)])
    sizes = np.full(len(geometry.regions), size)
    prepared = Prepared(
        geometry,
        given,
        known,
        plan,
        elements,
        Task(*parting(plan, known), size, wish.at, None, tolerance),
        0.0,
        sizes,
        lengths_asked(geometry, known, plan, sizes, Wanted()),
        wish,
        chords(given, sizes, CHORD * tolerance),
    )
    fit = filled(prepared, mesher(), limit, lambda what, done: tell(what)).fit
    left = strayed(fit.points, fit.tagged, plan, elements, TOLERANCE * geometry.diagonal)
    if len(left):
        raise GeometryError(
            "tetrahedra do not conform to the boundary near {at}", at=fit.points[left[0]]
        )
    return Interior(
        fit.points,
        fit.tets,
        known.region[known.cell[fit.part]],
        fit.tagged.triangles,
        fit.tagged.patches,
        surface,
        plan,
        elements,
    )
