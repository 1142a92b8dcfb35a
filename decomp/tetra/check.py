"""Whether a mesh is a mesh of its model: what falls short, one line for each.

1. By itself: elements the right way round, faces, tags (`check_structure`).
2. Its names are the model's (`check_names`).
3. Regions have their volumes.
4. Nodes of boundary triangles are on their surfaces.
5. No tetrahedron reaches out of its region or cell.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from decomp.arguments import called, whole
from decomp.compute import skeleton
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.geometry import Geometry
from decomp.paths import path_of
from decomp.tetra.check_cells import KnownCells, known_cells
from decomp.tetra.check_names import Names, name_shortcomings, resolved, sides
from decomp.tetra.check_structure import counted, structural_shortcomings
from decomp.tetra.incidence import faces_of, row_keys
from decomp.tetra.mesh import TetMesh
from decomp.tetra.msh_reader import ReadMesh, read_msh
from decomp.tetra.quality import volumes
from decomp.tolerance import TOLERANCE
from decomp.vectors import Ints, place, positive

EPSILON = 2e-3
"""Default of what meshes may leave their cells by, relative to the region's diagonal."""
VOLUME_ERROR = 5e-3
REACH = 2.0
"""Tetrahedra may reach so many epsilons into a cell that is not theirs."""


@dataclass(frozen=True)
class Checked:
    """What was found.

    Args:
        shortcomings: one line each; none if the mesh is right.
        tets, nodes, groups: how many it has.
        volume_error: the largest of a region, relative.
        off_surface: largest distance of a boundary node from its surface, in model units.
        stray: boundary nodes that are off their surface.
    """

    shortcomings: tuple[str, ...]
    tets: int
    nodes: int
    groups: int
    volume_error: float
    off_surface: float
    stray: int


def check(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    mesh: TetMesh | ReadMesh | str | Path,
    *,
    epsilon: float = EPSILON,
    volume_error: float = VOLUME_ERROR,
    unprojected: int = 0,
    progress: Callable[[str, float], None] | None = None,
) -> Checked:
    """Compare a mesh with its model.

    Args:
        source: a geometry, or what one can be made of.
        mesh: a mesh, or the path of a .msh file.
        epsilon: the mesh may be off the exact cells by so much, relative to a region's diagonal.
        volume_error: of a region, relative, at most.
        unprojected: so many nodes of the boundary may be off their surfaces (the report of
            `decomp.mesh` counts them).
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
    names = resolved(read.names, geometry)
    tell("looking at elements and faces", 0.1)
    lines = list(structural_shortcomings(read))
    cells = None
    if names.cells or names.sheets:
        found = skeleton(geometry, progress=lambda what, done: tell(what, 0.2 + 0.6 * done))
        given = {*names.cells.values(), *(n for s in names.sheets.values() for n in sides(s))}
        cells = known_cells(found, given)
    tell("comparing with the model", 0.8)
    lines += name_shortcomings(names, geometry, cells.names if cells else [])
    lines += _bare_interfaces(read, names, geometry)
    worst, more = _volumes(read, names, geometry, volume_error)
    lines += more
    off, stray, more = _surfaces(read, names, geometry, unprojected)
    lines += more
    tell("looking across interfaces", 0.9)
    lines += _reaching(read, names, geometry, cells, epsilon)
    return Checked(
        tuple(lines), len(read.tets), len(read.points), len(read.names), worst, off, stray
    )


def _as_read(mesh: TetMesh | ReadMesh | str | Path) -> ReadMesh:
    if isinstance(mesh, ReadMesh):
        return mesh
    if not isinstance(mesh, TetMesh):
        return read_msh(path_of(mesh, "the mesh's file"))
    names = {(group.dimension, group.tag): group.name for group in mesh.groups}
    return ReadMesh(
        mesh.points, mesh.tets, mesh.tet_tags, mesh.triangles, mesh.triangle_tags, names
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


def _volumes(
    mesh: ReadMesh, names: Names, geometry: Geometry, most: float
) -> tuple[float, list[str]]:
    regions = _regions(mesh.tet_tags, names, geometry)
    contents = volumes(mesh.points, mesh.tets)
    worst, lines = 0.0, []
    for number, region in enumerate(geometry.regions):
        content = float(contents[regions == number].sum())
        error = abs(content / region.volume - 1)
        worst = max(worst, error)
        if error > most:
            lines.append(
                f"region {region.name} has volume {content:.9g} in place of {region.volume:.9g}: "
                f"off by {error:.2g}, more than {most:g}"
            )
    return worst, lines


def _surfaces(
    mesh: ReadMesh, names: Names, geometry: Geometry, allowed: int
) -> tuple[float, int, list[str]]:
    """Largest distance of boundary nodes from their surfaces, how many are off, shortcomings."""
    off = np.zeros(len(mesh.points))
    for tag, owners in names.faces.items():
        nodes = np.unique(mesh.triangles[mesh.triangle_tags == tag])
        for region, face in owners:
            boundary = geometry.regions[region]
            carrier = boundary.carriers[boundary.faces[face].carrier]
            far = np.abs(carrier.signed_distance(mesh.points[nodes]))
            off[nodes] = np.maximum(off[nodes], far)
    stray = int((off > TOLERANCE * geometry.diagonal).sum())
    worst = int(np.argmax(off))
    lines = []
    if stray > allowed:
        lines.append(
            f"{stray} boundary nodes are off their surface, by up to {off[worst]:.2g} "
            f"at {place(mesh.points[worst])}" + (f" ({allowed} may be)" if allowed else "")
        )
    return float(off[worst]), stray, lines


def _reaching(
    mesh: ReadMesh,
    names: Names,
    geometry: Geometry,
    cells: KnownCells | None,
    epsilon: float,
) -> Iterator[str]:
    """Tetrahedra with a node or their middle deeper than `REACH` epsilons in a foreign cell."""
    middles = mesh.points[mesh.tets[:, :4]].mean(axis=1)
    points = np.concatenate([mesh.points, middles])
    asked = np.column_stack([mesh.tets, len(mesh.points) + np.arange(len(mesh.tets))])
    own_region = _regions(mesh.tet_tags, names, geometry)
    nearest = geometry.index.nearest(points)
    limit = REACH * epsilon * np.array([region.diagonal for region in geometry.regions])
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
            f"{len(rows)} tetrahedra reach more than {REACH:g} epsilon into a {what} that is not "
            f"theirs, the first near {place(middle)}"
        )
