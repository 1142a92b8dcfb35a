"""From a model to a tetrahedral mesh with a name on every cell, face, interface and sheet.

1. The exact skeleton, as one complex of triangles; without cells the exact boundary.
2. A mesher fills it with tetrahedra that conform to it.
3. Each tetrahedron is told its cell, each triangle between cells its patch, by exact queries.
4. Nodes are moved onto the exact surfaces, curves and points that they belong to.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from decomp.arguments import called, one_of
from decomp.checking.names import resolved
from decomp.checking.off_surfaces import known_sheets, off_surfaces
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.located import located
from decomp.meshes.fields import checked_fields, with_fields
from decomp.meshes.group import Group, GroupKind
from decomp.meshes.grouping import Chosen, Volumes
from decomp.meshes.model import FoundBy, TetMesh, regrouped
from decomp.meshes.moved import moved_mesh
from decomp.meshes.parts import Parts
from decomp.meshing.backends.base import TimeLimit
from decomp.meshing.backends.table import mesher
from decomp.meshing.exact.quadratic import quadratic
from decomp.meshing.far.nearer import Nearer, brought_near
from decomp.meshing.far.sweeping import far_groups, swept
from decomp.meshing.naming.chosen_of_model import check_chosen
from decomp.meshing.naming.groups import cell_parts, region_parts, surface_parts
from decomp.meshing.preparation import Cells, Prepared, Progress, prepared
from decomp.meshing.sizing.named_sizes import checked_sizes, sized
from decomp.meshing.sizing.size_places import field_of, places_of
from decomp.meshing.sizing.sizes import Wanted
from decomp.meshing.sizing.wishes import shorter
from decomp.meshing.surface.cells import OUTSIDE
from decomp.meshing.tetrahedra import Filled, filled
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Ints, positive
from decomp.ways.options import MeshOptions
from decomp.ways.skeleton import Method, checked_method
from decomp.ways.surfaces import surfaces_by

LIMIT, LIMIT_PER_TET = 600.0, 5e-3
"""Seconds that a mesher may compute, in all and for each expected tetrahedron."""
PREPARED, FILLED = 0.35, 0.95
"""Which part of the whole is behind when the mesher begins, and when its mesh is in place."""


def mesh(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    *,
    size: float | None = None,
    sizes: Mapping[str, float] | None = None,
    size_at: Sequence[tuple[Any, ...]] | None = None,
    size_field: Callable[[Array], Array] | tuple[ArrayLike, ArrayLike] | None = None,
    layers: int | None = None,
    elements_per_circle: float | None = None,
    order: int = 1,
    cells: Cells = "skeleton",
    volumes: Volumes = "regions",
    sheets: bool = False,
    groups: Mapping[str, str | Sequence[str]] | None = None,
    split_faces: bool = False,
    edges: bool = False,
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
        sizes: lengths by pattern (`TetMesh.select`): of regions, in place of `size`, the file's
            `maxh` and the default; on faces, at most. The last that stands for something counts.
        size_at: lengths in places, at most: (point, length), (centre, radius, length) of a ball,
            (corner, corner, length) of a box.
        size_field: a function of points (n, 3) that gives lengths (n,), at most; or points and the
            lengths there, which are linear in between.
        layers: at least so many elements across thin parts.
        elements_per_circle: at least so many edges around a full circle of a curved face.
        order: 1 for straight elements, 2 for quadratic ones.
        cells: `skeleton`, `face` for one cell for each boundary face, or `none`: then no skeleton
            is computed, and the mesh has faces, interfaces and regions alone.
        volumes: `regions` for one group of tetrahedra for each region, `cells` for one for each
            cell, `materials` for one for all regions of one material and each without one.
        sheets: whether there are groups of the triangles between the cells of a region.
        groups: by name one pattern or several: the faces, regions or edges that they stand for
            are one group of that name (`TetMesh.select`).
        split_faces: whether the pieces of a face (`base.zmax`, `base.zmax@2`) are groups of their
            own; else they are one.
        edges: whether edges and vertices of the model are groups of edges of triangles and of
            nodes, named by the faces that meet there: `part/base.zmax&hole.side`.
        fields: values wanted on the mesh: `distance`, `thickness`, `nearest`, `cell`, `region`
            (`decomp.meshes.fields`).
        timeout: seconds that the mesher may take; by default ten minutes of computing, or 5 ms for
            each expected tetrahedron where that is more, and four times as long by the clock.
        progress: told what is being done, and which part of the whole (0 to 1) is behind.
        method: how the skeleton is found, as of `decomp.skeleton`.

    Raises:
        InputError: an option is of a wrong kind or out of its range, or the mesh would not fit
            into memory.
        FileError: the file cannot be read.
        GeometryError: the solid or its skeleton cannot be computed.
        MeshingError: the mesher, TetWild, fails.
    """
    options = MeshOptions(
        size=size,
        sizes=sizes,
        size_at=size_at,
        size_field=size_field,
        layers=layers,
        elements_per_circle=elements_per_circle,
        order=order,
        cells=cells,
        volumes=volumes,
        sheets=sheets,
        groups=groups,
        split_faces=split_faces,
        edges=edges,
        fields=fields,
        timeout=timeout,
        method=method,
    )
    return meshed(source, options, progress)


def meshed(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    options: MeshOptions,
    progress: Progress | None = None,
) -> TetMesh:
    """Mesh a model with options as one value; all else is as of `mesh`."""
    options = _checked(options)
    groups = {} if options.groups is None else options.groups
    chosen = Chosen(options.volumes, options.sheets, groups, options.split_faces, options.edges)
    called(progress, "progress")
    asked = checked_fields(options.fields, with_cells=options.with_cells)
    named = checked_sizes(options.sizes)
    places, everywhere = places_of(options.size_at), field_of(options.size_field)
    wanted = Wanted(options.size, options.layers, options.elements_per_circle)
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    geometry, of_regions = sized(geometry, named)
    offset = geometry.offset
    wanted = replace(
        wanted, of_regions=of_regions, places=places, everywhere=everywhere, offset=offset
    )
    check_chosen(geometry, chosen, with_cells=options.with_cells)
    tell = progress or (lambda what, done: None)
    with geometry.frame(), located(geometry):
        local = geometry.local
        can_be_near = not (options.order == 2 or options.with_cells or places)
        near = brought_near(local, wanted) if can_be_near and everywhere is None else None
        if near is None:
            made, parts = _meshed(local, wanted, options, tell)
        else:
            made, parts = _meshed_near(local, near, options, tell)
        made, parts = with_fields(local, made, parts, asked)
    made = replace(made, parts=parts, part_rows=np.arange(len(parts.of_triangles)))
    return moved_mesh(regrouped(made, chosen), geometry.offset)


def _checked(options: MeshOptions) -> MeshOptions:
    """The options, choices and seconds among them checked."""
    seconds = options.timeout
    return replace(
        options,
        order=one_of(options.order, (1, 2), "order"),
        cells=one_of(options.cells, ("skeleton", "face", "none"), "cells"),
        method=checked_method(options.method),
        timeout=None if seconds is None else positive(seconds, "timeout"),
    )


def _meshed(
    geometry: Geometry, wanted: Wanted, options: MeshOptions, tell: Progress
) -> tuple[TetMesh, Parts]:
    """A mesh whose groups are its parts, and these."""
    given = _prepared(geometry, wanted, options, _between(tell, 0.0, PREPARED))
    work = max(LIMIT, LIMIT_PER_TET * given.expected)
    seconds = options.timeout
    limit = TimeLimit(seconds) if seconds is not None else TimeLimit.of_work(work)
    made = filled(given, mesher(), limit, _between(tell, PREPARED, FILLED))
    if options.order == 2:
        tell("curving", FILLED)
    points, tets, triangles = _elements(given, made, options.order)
    tagged, part = made.fit.tagged, made.fit.part
    surfaces, tags = surface_parts(
        geometry, given.surface, given.known, given.plan, tagged, given.sizes
    )
    triangles, tags = triangles[tags > 0], tags[tags > 0]
    cell, region = given.known.cell_of(part) + 1, given.known.region_of(part) + 1
    has_cells = options.with_cells
    parts = Parts(
        tuple(region_parts(geometry, given.sizes)),
        tuple(each.options.get("material") for each in geometry.model.regions),
        tuple(cell_parts(geometry, given.known, given.sizes)) if has_cells else (),
        cell if has_cells else region,
        tuple(surfaces),
        triangles,
        tags,
    )
    lengths, reason, reasons = shorter(given.wish, given.chords, points)
    result = TetMesh(
        geometry.model.name,
        points,
        tets,
        parts.of_tets,
        triangles,
        tags,
        (*parts.solids, *surfaces),
        _unprojected(given, points, triangles, tags, surfaces),
        lengths=lengths,
        reason=reason,
        reasons=reasons,
        source=geometry.model.source,
        found_by=_found_by(given) if has_cells else (),
    )
    return result, parts


def _meshed_near(
    geometry: Geometry, near: Nearer, options: MeshOptions, tell: Progress
) -> tuple[TetMesh, Parts]:
    """Mesh a model with its end brought near, and put back what is before it."""
    made, parts = _meshed(near.geometry.local, near.wanted, options, tell)
    made = moved_mesh(made, near.geometry.offset)
    groups = far_groups(made.groups, [region.volume for region in geometry.regions], near)
    result = swept(made, near, groups)
    return result, replace(
        parts,
        regions=tuple(group for group in groups if group.kind is GroupKind.REGION),
        of_tets=result.tet_tags,
        surfaces=tuple(group for group in groups if group.dimension == 2),
        triangles=result.triangles,
        of_triangles=result.triangle_tags,
    )


def _prepared(geometry: Geometry, wanted: Wanted, options: MeshOptions, tell: Progress) -> Prepared:
    """What a mesher is given; where there is no skeleton for it, how to do without is said."""
    try:
        return prepared(geometry, wanted, options.cells, surfaces_by(options.method), tell)
    except GeometryError as error:
        if not options.with_cells:
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
