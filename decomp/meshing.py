"""From a model to a tetrahedral mesh with a name on every cell, face, interface and sheet.

1. The exact skeleton, as one complex of triangles; without cells the exact boundary.
2. fTetWild fills the box around it with tetrahedra that conform to it.
3. Each tetrahedron is told its cell, each triangle between cells its patch, by exact queries.
4. Nodes are moved onto the exact surfaces, curves and points that they belong to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from decomp.arguments import called, one_of, switch
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.located import located
from decomp.surfaces import surfaces_by
from decomp.tetra.cells import OUTSIDE
from decomp.tetra.check_names import resolved
from decomp.tetra.child import TimeLimit
from decomp.tetra.fields import checked_fields, with_fields
from decomp.tetra.groups import cell_groups, region_groups, surface_groups
from decomp.tetra.mesh import FoundBy, Group, TetMesh
from decomp.tetra.moved import moved_mesh
from decomp.tetra.nearer import Nearer, brought_near
from decomp.tetra.off_surfaces import known_sheets, off_surfaces
from decomp.tetra.preparation import Cells, Prepared, Progress, prepared
from decomp.tetra.quadratic import quadratic
from decomp.tetra.sizes import Wanted
from decomp.tetra.sweeping import far_groups, swept
from decomp.tetra.tetrahedra import Filled, filled
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Ints, positive
from decomp.ways import Method, checked_method

LIMIT, LIMIT_PER_TET = 600.0, 5e-3
"""Seconds that TetWild may compute, in all and for each expected tetrahedron."""
PREPARED, FILLED = 0.35, 0.95
"""Which part of the whole is behind when TetWild begins, and when its mesh is in place."""


def mesh(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    *,
    size: float | None = None,
    layers: int | None = None,
    elements_per_circle: float | None = None,
    order: int = 1,
    cells: Cells = "skeleton",
    volumes: Literal["cells", "regions"] = "cells",
    sheets: bool = True,
    fields: Sequence[str] = (),
    timeout: float | None = None,
    progress: Progress | None = None,
    method: Method = "traced",
) -> TetMesh:
    """Mesh a model.

    Args:
        source: a geometry, or what one can be made of.
        size: edge length wanted, in model units: the mean comes out a little below it, and no edge
            is longer than 1.5 times as much.
        layers: at least so many elements across thin parts.
        elements_per_circle: at least so many edges around a full circle of a curved face.
        order: 1 for straight elements, 2 for quadratic ones.
        cells: `skeleton`, `face` for one cell for each boundary face, or `none`: then no skeleton
            is computed, and the mesh has faces, interfaces and regions alone.
        volumes: `cells`, or `regions` for one physical volume for each region, which is all there
            is without cells.
        sheets: whether triangles between the cells of a region are tagged.
        fields: values wanted on the mesh: `distance`, `thickness`, `nearest`, `cell`, `region`
            (`decomp.tetra.fields`).
        timeout: seconds that TetWild may take; by default ten minutes of computing, or 5 ms for
            each expected tetrahedron where that is more, and four times as long by the clock.
        progress: told what is being done, and which part of the whole (0 to 1) is behind.
        method: how the skeleton is found, as of `decomp.skeleton`.

    Raises:
        InputError: an option is of a wrong kind or out of its range, or the mesh would not fit
            into memory.
        FileError: the file cannot be read.
        GeometryError: the solid or its skeleton cannot be computed.
        MeshingError: TetWild fails.
    """
    order = one_of(order, (1, 2), "order")
    cells = one_of(cells, ("skeleton", "face", "none"), "cells")
    volumes = one_of(volumes, ("cells", "regions"), "volumes")
    sheets = switch(sheets, "sheets")
    called(progress, "progress")
    method = checked_method(method)
    seconds = None if timeout is None else positive(timeout, "timeout")
    asked = checked_fields(fields, with_cells=cells != "none")
    wanted = Wanted(size, layers, elements_per_circle)
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    with geometry.frame(), located(geometry):
        options = _Options(order, cells, volumes, sheets, seconds, method)
        tell = progress or (lambda what, done: None)
        near = brought_near(geometry.local, wanted) if order == 1 and cells == "none" else None
        if near is None:
            made = _meshed(geometry.local, wanted, options, asked, tell)
        else:
            made = _meshed_near(geometry.local, near, options, asked, tell)
    return moved_mesh(made, geometry.offset)


@dataclass(frozen=True)
class _Options:
    """What `mesh` is asked for beside lengths and fields; all have been checked."""

    order: int
    cells: Cells
    volumes: Literal["cells", "regions"]
    sheets: bool
    seconds: float | None
    method: Method


def _meshed(
    geometry: Geometry, wanted: Wanted, options: _Options, asked: Sequence[str], tell: Progress
) -> TetMesh:
    given = _prepared(geometry, wanted, options, _between(tell, 0.0, PREPARED))
    work = max(LIMIT, LIMIT_PER_TET * given.expected)
    seconds = options.seconds
    limit = TimeLimit(seconds) if seconds is not None else TimeLimit.of_work(work)
    made = filled(given, limit, _between(tell, PREPARED, FILLED))
    if options.order == 2:
        tell("curving", FILLED)
    points, tets, triangles = _elements(given, made, options.order)
    tagged, part = made.fit.tagged, made.fit.part
    groups, tags = surface_groups(
        geometry, given.surface, given.known, given.plan, tagged, options.sheets, given.sizes
    )
    triangles, tags = triangles[tags > 0], tags[tags > 0]
    cell = given.known.cell_of(part) + 1
    if options.volumes == "cells" and options.cells != "none":
        solid, tet_tags = cell_groups(geometry, given.known, given.sizes), cell
    else:
        solid = region_groups(geometry, given.sizes)
        tet_tags = given.known.region_of(part) + 1
    result = TetMesh(
        geometry.model.name,
        points,
        tets,
        tet_tags,
        triangles,
        tags,
        (*solid, *groups),
        _unprojected(given, points, triangles, tags, groups),
        lengths=np.minimum(given.wish.at(points), given.chords.at(points)),
        source=geometry.model.source,
        found_by=() if options.cells == "none" else _found_by(given),
    )
    return with_fields(geometry, result, asked, cell) if asked else result


def _meshed_near(
    geometry: Geometry, near: Nearer, options: _Options, asked: Sequence[str], tell: Progress
) -> TetMesh:
    """Mesh a model with its end brought near, and put back what is before it."""
    made = _meshed(near.geometry.local, near.wanted, options, (), tell)
    made = moved_mesh(made, near.geometry.offset)
    groups = far_groups(made.groups, [region.volume for region in geometry.regions], near)
    result = swept(made, near, groups)
    return with_fields(geometry, result, asked, result.tet_tags) if asked else result


def _prepared(geometry: Geometry, wanted: Wanted, options: _Options, tell: Progress) -> Prepared:
    """What TetWild is given; where there is no skeleton for it, how to do without is said."""
    try:
        return prepared(geometry, wanted, options.cells, surfaces_by(options.method), tell)
    except GeometryError as error:
        if options.cells == "none":
            raise
        raise error.advised("'--cells none' makes a mesh without cells") from error


def _found_by(given: Prepared) -> tuple[FoundBy, ...]:
    regions = given.surface.regions
    return tuple(FoundBy(each.name, each.method.value, each.cause) for each in regions)


def _elements(given: Prepared, made: Filled, order: int) -> tuple[Array, Ints, Ints]:
    """Points, tetrahedra and triangles."""
    fit = made.fit
    if order == 1:
        return fit.points, fit.tets, fit.tagged.triangles
    corners = given.plan.complex.points
    return quadratic(fit.points, fit.tets, fit.tagged, made.finder, given.elements, corners)


def _unprojected(
    given: Prepared, points: Array, triangles: Ints, tags: Ints, groups: Sequence[Group]
) -> Ints:
    """The nodes of groups of triangles that are off their exact surfaces, ascending."""
    known = given.known
    cells = known.cell_of(known.part)
    names = [known.cells[k].name if k != OUTSIDE else "" for k in cells.tolist()]
    off = off_surfaces(
        given.geometry,
        points,
        triangles,
        tags,
        resolved({(group.dimension, group.tag): group.name for group in groups}, given.geometry),
        known_sheets(given.surface, given.elements, names),
    )
    return np.flatnonzero(off > TOLERANCE * given.geometry.diagonal)


def _between(tell: Progress, start: float, end: float) -> Progress:
    """Tells of a stage as of a part of the whole."""
    return lambda what, done: tell(what, start + (end - start) * done)
