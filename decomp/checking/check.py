"""Whether a mesh is a mesh of its model: what falls short, one line for each.

1. By itself: elements the right way round, faces, tags (`check_structure`).
2. Its names are the model's (`check_names`), and groups hold what they are named for.
3. Regions have their volumes, but for what straight edges leave out.
4. Nodes of triangles are on the surfaces that their groups are named for.
5. No tetrahedron reaches out of its region or cell.

Whatever groups a mesh has, 2 to 5 look at the finest parts that it tells of (`finest`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from decomp.arguments import called, whole
from decomp.checking.cells import KnownCells, cells_named
from decomp.checking.groups import group_shortcomings
from decomp.checking.names import Names, name_shortcomings, resolved, sides
from decomp.checking.off_surfaces import known_sheets, off_surfaces
from decomp.checking.structure import counted, structural_shortcomings
from decomp.checking.volumes import VolumeError, volume_errors
from decomp.complex.many_elements import Elements
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.geometry import Geometry
from decomp.meshes.about import about
from decomp.meshes.files import read_file
from decomp.meshes.files.finest import finest
from decomp.meshes.files.msh_reader import ReadMesh
from decomp.meshes.incidence import faces_of, row_keys
from decomp.meshes.model import TetMesh
from decomp.meshing.surface.surface import SurfaceMaker, Surfaces
from decomp.paths import path_of
from decomp.places import place
from decomp.shown import Shown
from decomp.tolerance import OFF_VOLUMES, OUT_OF_CELLS, TOLERANCE
from decomp.vectors import Array, Ints, positive

FINENESS = 0.5
"""Sheets are drawn to this part of epsilon."""
INTO_OTHERS = 2.0
"""Tetrahedra may reach so many epsilons into a cell that is not theirs."""


@dataclass(frozen=True)
class Checked(Shown):
    """What was found.

    Args:
        shortcomings: one line each; none if the mesh is right.
        tets: how many it has.
        nodes: how many it has.
        groups: how many it has.
        volume_error: the largest of a region, relative.
        chord_error: the largest part of it that straight edges of their length explain.
        unexplained_error: the largest that is left without that.
        off_surface: largest distance of a node from a surface that it should be on, in model units.
        stray: nodes that are off their surfaces (faces, interfaces and sheets).
    """

    shortcomings: tuple[str, ...]
    tets: int
    nodes: int
    groups: int
    volume_error: float
    chord_error: float
    unexplained_error: float
    off_surface: float
    stray: int


def check(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    mesh: TetMesh | ReadMesh | str | Path,
    *,
    epsilon: float = OUT_OF_CELLS,
    volume_error: float = OFF_VOLUMES,
    unprojected: int = 0,
    surfaces: Surfaces = SurfaceMaker,
    progress: Callable[[str, float], None] | None = None,
) -> Checked:
    """Compare a mesh with its model.

    Args:
        source: a geometry, or what one can be made of.
        mesh: a mesh, or the path of a .msh file.
        epsilon: the mesh may be off the exact cells by so much, relative to a region's diagonal.
        volume_error: of a region, relative, at most, besides what straight edges of their length
            leave out at curved faces.
        unprojected: so many nodes of faces, interfaces and sheets may be off them (the report
            of `decomp.mesh` counts them).
        surfaces: makes the skeleton that the mesh's cells are held against; by default it is
            traced.
        progress: told what is being done, and which part of the whole (0 to 1) is behind.

    Raises:
        InputError: an option is of a wrong kind or out of its range.
        FileError: a file cannot be read.
        GeometryError: the model's geometry or skeleton cannot be computed.
    """
    epsilon, volume_error = positive(epsilon, "epsilon"), positive(volume_error, "volume_error")
    unprojected = whole(unprojected, "unprojected", 0)
    called(progress, "progress")
    tell = progress or (lambda what, done: None)
    tell("reading the mesh", 0.0)
    read = _as_read(mesh)
    tell("computing the boundary", 0.05)
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    with geometry.frame():
        local = replace(read, points=read.points - geometry.offset)
        limits = Limits(epsilon, volume_error, unprojected, _rounding(read.points))
        return _checked(geometry.local, local, limits, surfaces, tell)


@dataclass(frozen=True)
class Limits:
    """Of what a mesh may fall short by.

    Args:
        epsilon, volume_error, unprojected: see `check`.
        rounding: how far off the digits of its coordinates put nodes.
    """

    epsilon: float
    volume_error: float
    unprojected: int
    rounding: float


def _rounding(points: Array) -> float:
    return float(np.sqrt(3) * np.spacing(np.abs(points).max(initial=0.0)))


def _checked(
    geometry: Geometry,
    read: ReadMesh,
    limits: Limits,
    surfaces: Surfaces,
    tell: Callable[[str, float], None],
) -> Checked:
    epsilon, count = limits.epsilon, len(read.names)
    tell("looking at elements and faces", 0.1)
    lines = list(structural_shortcomings(read))
    fine = finest(read)
    lines += group_shortcomings(read, fine)
    read, names = fine, resolved(fine.names, geometry)
    cells = sheets = None
    if names.cells or names.sheets:
        given = {*names.cells.values(), *(n for s in names.sheets.values() for n in sides(s))}
        tolerance = FINENESS * epsilon * min(region.diagonal for region in geometry.regions)
        cells = cells_named(
            geometry, given, tolerance, surfaces, lambda what, done: tell(what, 0.2 + 0.6 * done)
        )
        elements = Elements(cells.surface.complex)
        sheets = known_sheets(cells.surface, elements, cells.name_of_site)
    tell("comparing with the model", 0.8)
    lines += name_shortcomings(names, geometry, cells.names if cells else [])
    lines += _bare_interfaces(read, names, geometry)
    errors = volume_errors(read, _regions(read.tet_tags, names, geometry), names, geometry)
    lines += _wrong_volumes(geometry, errors, limits.volume_error)
    off = off_surfaces(geometry, read.points, read.triangles, read.triangle_tags, names, sheets)
    stray = int((off > TOLERANCE * geometry.diagonal + limits.rounding).sum())
    lines += _strayed(read, off, stray, limits.unprojected)
    tell("looking across interfaces", 0.9)
    lines += _reaching(read, names, geometry, cells, epsilon)
    return Checked(
        tuple(lines),
        len(read.tets),
        len(read.points),
        count,
        max(abs(error.whole) for error in errors),
        max(abs(error.chords) for error in errors),
        max(abs(error.unexplained) for error in errors),
        float(off.max(initial=0.0)),
        stray,
    )


def _as_read(mesh: TetMesh | ReadMesh | str | Path) -> ReadMesh:
    if isinstance(mesh, ReadMesh):
        return mesh
    if not isinstance(mesh, TetMesh):
        return read_file(path_of(mesh, "the mesh's file"))
    names = {(group.dimension, group.tag): group.name for group in mesh.groups}
    return ReadMesh(
        mesh.points,
        mesh.tets,
        mesh.tet_tags,
        mesh.triangles,
        mesh.triangle_tags,
        names,
        mesh.all_parts.of_tets,
        mesh.triangle_parts,
        mesh.lines,
        mesh.line_tags,
        mesh.nodes,
        mesh.node_tags,
        mesh.point_data,
        {"cell": mesh.all_parts.of_tets.astype(np.float64)} if mesh.all_parts.cells else {},
        about(mesh),
    )


def _regions(tags: Ints, names: Names, geometry: Geometry) -> Ints:
    """The region (m,) that each tetrahedron is tagged with, -1 for none."""
    number = {region.name: k for k, region in enumerate(geometry.regions)}
    table = dict(names.regions)
    table |= {tag: number.get(name.split("/")[0], -1) for tag, name in names.cells.items()}
    return _looked_up(table, tags)


def _bare_interfaces(mesh: ReadMesh, names: Names, geometry: Geometry) -> Iterator[str]:
    """Faces between tetrahedra of two regions that no triangle tags."""
    faces = faces_of(mesh.tets)
    keys = row_keys(np.concatenate([faces, mesh.triangles[:, :3]]))
    own, tagged = keys[: len(faces)], keys[len(faces) :]
    region = np.repeat(_regions(mesh.tet_tags, names, geometry), 4)
    order = np.argsort(own, kind="stable")
    same = own[order[1:]] == own[order[:-1]]
    split = same & (region[order[1:]] != region[order[:-1]])
    rows = order[1:][split]
    bare = rows[~np.isin(own[rows], tagged)]
    places = mesh.points[faces].mean(axis=1)
    yield from counted(bare, places, "faces between regions without a physical group")


def _wrong_volumes(geometry: Geometry, errors: Sequence[VolumeError], most: float) -> Iterator[str]:
    for region, error in zip(geometry.regions, errors, strict=True):
        if abs(error.unexplained) > most:
            content = (1 + error.whole) * region.volume
            besides = ""
            if abs(error.chords) > TOLERANCE:
                besides = f" besides the {error.chords:+.2g} of straight edges"
            yield (
                f"region {region.name} has volume {content:.9g} in place of {region.volume:.9g}: "
                f"off by {abs(error.unexplained):.2g}{besides}, more than {most:g}"
            )


def _strayed(mesh: ReadMesh, off: Array, stray: int, allowed: int) -> Iterator[str]:
    if stray > allowed:
        worst = int(np.argmax(off))
        yield (
            f"{stray} nodes are off their exact surfaces, by up to {off[worst]:.2g} "
            f"at {place(mesh.points[worst])}" + (f" ({allowed} may be)" if allowed else "")
        )


def _reaching(
    mesh: ReadMesh,
    names: Names,
    geometry: Geometry,
    cells: KnownCells | None,
    epsilon: float,
) -> Iterator[str]:
    """Tetrahedra with a node or middle deeper than `INTO_OTHERS` epsilons in a foreign cell."""
    middles = mesh.points[mesh.tets[:, :4]].mean(axis=1)
    points = np.concatenate([mesh.points, middles])
    asked = np.column_stack([mesh.tets, len(mesh.points) + np.arange(len(mesh.tets))])
    own_region = _regions(mesh.tet_tags, names, geometry)
    nearest = geometry.index.nearest(points)
    limit = INTO_OTHERS * epsilon * np.array([region.diagonal for region in geometry.regions])
    at = nearest.region[asked]
    wrong = (at != own_region[:, None]) & (own_region[:, None] >= 0)
    deep = wrong & (nearest.distance[asked] > limit[own_region][:, None])
    yield from _told(mesh, np.flatnonzero(deep.any(axis=1)), "region")
    if cells is None:
        return
    number = {name: k for k, name in enumerate(cells.names)}
    own = _looked_up({t: number.get(name, -1) for t, name in names.cells.items()}, mesh.tet_tags)
    cell = np.where(nearest.region < 0, -1, cells.of_site[nearest.site])
    wrong = (cell[asked] != own[:, None]) & (at == own_region[:, None]) & (own[:, None] >= 0)
    which = np.unique(asked[wrong])
    depth = np.zeros(len(points))
    depth[which] = cells.depth(points[which], nearest.region[which])
    deep = wrong & (depth[asked] > limit[own_region][:, None])
    yield from _told(mesh, np.flatnonzero(deep.any(axis=1)), "cell")


def _looked_up(table: Mapping[int, int], tags: Ints) -> Ints:
    """The entry (m,) of each tag, -1 for none."""
    found, which = np.unique(tags, return_inverse=True)
    return np.array([table.get(int(tag), -1) for tag in found])[which.reshape(-1)]


def _told(mesh: ReadMesh, rows: Ints, what: str) -> Iterator[str]:
    if len(rows):
        middle = mesh.points[mesh.tets[rows[0], :4]].mean(axis=0)
        yield (
            f"{len(rows)} tetrahedra reach more than {INTO_OTHERS:g} epsilon into a {what} that is "
            f"not theirs, the first near {place(middle)}"
        )
