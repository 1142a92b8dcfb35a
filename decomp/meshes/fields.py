"""Values on a mesh that come from the exact geometry, for FEM: distance, thickness, nearest face.

- `distance` (nodes): to the boundary of the region that the node is in; 0 on the boundary.
- `thickness` (nodes): the diameter of the largest ball inside the region that touches the
  boundary where it is nearest to the node. It is twice the distance on the skeleton, the wall's
  width between parallel walls, and goes to 0 towards sharp edges. It jumps where the nearest point
  does.
- `nearest` (tetrahedra): the tag of the surface group of the face that is nearest to the centroid;
  a reentrant edge counts as the face that owns it.
- `cell` (tetrahedra): number of the cell, from 1; every mesh with cells has it.
- `region` (tetrahedra): number of the region, from 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.errors import InputError
from decomp.geometry import Geometry
from decomp.meshes.model import GroupKind, TetMesh
from decomp.meshes.parts import Parts
from decomp.near import near
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.balls import inscribed_balls
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.cells.owners import site_owners
from decomp.vectors import Array, Ints, norm

AT_NODES, AT_TETS = ("distance", "thickness"), ("nearest", "cell", "region")
FIELDS = (*AT_NODES, *AT_TETS)
ASKED_INSIDE = 1e-5
"""Nodes nearer to the boundary than this part of the diagonal are asked from this far inside."""


def checked_fields(names: Sequence[str], with_cells: bool = True) -> tuple[str, ...]:
    """Names of fields, each once.

    Raises:
        InputError: they are no list, one is unknown, or tells of cells where there are none.
    """
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise InputError(f"fields must be a list of names, such as ['distance'], got {names!r}")
    names = tuple(names)
    for name in names:
        if name not in FIELDS:
            hint = near(str(name), FIELDS)
            raise InputError(f"{name!r} is no field; there are {', '.join(FIELDS)}{hint}")
        if name == "cell" and not with_cells:
            raise InputError(
                "the field 'cell' tells of cells, and a mesh with --cells none has none: leave it "
                "out, or choose --cells skeleton or face"
            )
    return tuple(dict.fromkeys(names))


def with_fields(
    geometry: Geometry, mesh: TetMesh, parts: Parts, names: Sequence[str]
) -> tuple[TetMesh, Parts]:
    """A mesh with values on it, and its parts with what groups' tags are made of.

    Args:
        geometry: that it is a mesh of.
        mesh: to give fields to.
        parts: of it.
        names: of `FIELDS`.

    Raises:
        InputError: a name is unknown.
        GeometryError: the ball at a point cannot be found; says where.
    """
    at_nodes: dict[str, Array] = {}
    at_tets: dict[str, Ints] = {"cell": parts.of_tets} if parts.cells else {}
    for name in checked_fields(names):
        if name == "distance":
            at_nodes[name] = geometry.index.nearest(mesh.points).distance
        elif name == "thickness":
            at_nodes[name] = thickness(geometry, mesh, parts.region_of_tets - 1)
        elif name == "nearest":
            parts = replace(parts, nearest=nearest_surfaces(geometry, mesh, parts))
        elif name == "region":
            at_tets[name] = parts.region_of_tets - 1
    return replace(mesh, point_data=at_nodes, cell_data=at_tets), parts


def thickness(geometry: Geometry, mesh: TetMesh, of_tet: Ints) -> Array:
    """The local thickness (n,) at the nodes, see above; the tetrahedra's regions (m,) are known.

    At nodes on the boundary it is that of a point close to it, inside the tetrahedron at the node
    whose centroid is deepest in its region.
    """
    index = geometry.index
    points = np.array(mesh.points)
    centre = mesh.points[mesh.tets[:, :4]].mean(axis=1)
    order = np.argsort(index.nearest(centre).distance, kind="stable")
    owner = np.empty(len(points), dtype=np.int64)
    owner[mesh.tets[order]] = order[:, None]  # the deepest is written last
    region = of_tet[owner]
    inside = ASKED_INSIDE * geometry.diagonal
    found = index.nearest(points)
    shallow = np.flatnonzero((found.distance < inside) | (found.region != region))
    way = centre[owner[shallow]] - points[shallow]
    points[shallow] += 2 * inside * way / norm(way)[:, None]
    found = index.nearest(points)
    result, sites = np.zeros(len(points)), found.site.astype(np.int64)
    for number, boundary in enumerate(geometry.regions):
        rows = np.flatnonzero((found.region == number) & (found.distance > 0))
        inward = _inward(geometry, boundary, points[rows], found.foot[rows], sites[rows])
        balls = inscribed_balls(RegionContext(index, number), found.foot[rows], inward)
        result[rows] = 2 * np.maximum(balls.radius, found.distance[rows])
    return result


def _inward(
    geometry: Geometry, boundary: RegionBoundary, points: Array, feet: Array, sites: Ints
) -> Array:
    """Unit vectors (k, 3) from feet towards points; the exact normals on faces."""
    way = points - feet
    result = np.asarray(way / norm(way)[:, None])
    for number in np.unique(sites).tolist():
        site = geometry.sites[number]
        if site.kind is SiteKind.FACE:
            rows = sites == number
            face = boundary.faces[site.index]
            result[rows] = -face.outward * boundary.carriers[face.carrier].normal(feet[rows])
    return result


def nearest_surfaces(geometry: Geometry, mesh: TetMesh, parts: Parts) -> Ints:
    """The tag (m,) of the face or interface that is nearest to each tetrahedron's centroid."""
    outer = [s for s in parts.surfaces if s.kind is not GroupKind.SHEET]
    tags = {side: surface.tag for surface in outer for side in surface.sides}
    owner = site_owners(geometry.sites, geometry.regions)
    table = np.full(len(geometry.sites), -1, dtype=np.int64)
    for number, site in enumerate(geometry.sites):
        if site.region >= 0:
            boundary = geometry.regions[site.region]
            table[number] = tags[boundary.name, boundary.faces[owner[number]].name]
    centre = mesh.points[mesh.tets[:, :4]].mean(axis=1)
    return table[geometry.index.nearest(centre).site]
