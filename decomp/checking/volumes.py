"""Whether regions have their volumes, but for what straight edges of such a length leave out.

A flat triangle with its corners on a curved surface cuts off what is between. Edges of length l on
a surface of curvature k rise l^2 k / 8 at their middles, and a triangle of area A with rises h
leaves out A (h1 + h2 + h3) / 3 (the integral of 4 h_ij b_i b_j in barycentric coordinates b).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier
from decomp.checking.names import Names, Sides
from decomp.geometry import Geometry
from decomp.meshes.faces import TRIANGLE_EDGES
from decomp.meshes.files.msh_reader import ReadMesh
from decomp.meshes.quality import volumes
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, cross, dot, norm


@dataclass(frozen=True)
class VolumeError:
    """Of a region, relative to its exact volume, with signs.

    Args:
        whole: of the tetrahedra.
        chords: what straight edges leave out (below 0) or put in between.
    """

    whole: float
    chords: float

    @property
    def unexplained(self) -> float:
        """What is left."""
        return self.whole - self.chords


def volume_errors(
    mesh: ReadMesh, regions: Ints, names: Names, geometry: Geometry
) -> list[VolumeError]:
    """The errors of all regions.

    Args:
        mesh: with its triangles.
        regions: (m,) the region of each tetrahedron.
        names: of its groups.
        geometry: of the model.
    """
    contents = volumes(mesh.points, mesh.tets)
    out = left_out(mesh, names, geometry)
    found = []
    for number, region in enumerate(geometry.regions):
        content = float(contents[regions == number].sum())
        found.append(VolumeError(content / region.volume - 1, -float(out[number]) / region.volume))
    return found


def left_out(mesh: ReadMesh, names: Names, geometry: Geometry) -> Array:
    """The volume (r,) of each region beyond its flat triangles, below 0 where they reach out of it.

    What corners are off their surfaces does not count. Triangles of 6 nodes are not flat.
    """
    found = np.zeros(len(geometry.regions))
    if mesh.triangles.shape[1] > 3:
        return found
    for tag, choices in names.faces.items():
        corners = mesh.points[mesh.triangles[mesh.triangle_tags == tag]]
        kinds = list(dict.fromkeys(_surfaces_of(geometry, sides) for sides in choices))
        which = _nearest(geometry, corners, kinds)
        for k, kind in enumerate(kinds):
            own = corners[which == k]
            for number, carrier, outward in kind:
                surface = geometry.regions[number].carriers[carrier]
                found[number] += _beyond(own, surface, outward)
    return found


Kind = tuple[tuple[int, int, int], ...]
"""Region, carrier and outward sign of a face, or of the two of an interface."""


def _surfaces_of(geometry: Geometry, sides: Sides) -> Kind:
    faces = [(region, geometry.regions[region].faces[face]) for region, face in sides]
    return tuple((region, face.carrier, face.outward) for region, face in faces)


def _nearest(geometry: Geometry, corners: Array, kinds: Sequence[Kind]) -> Ints:
    """Which of some faces or interfaces each triangle (k, 3, 3) is on: near, and turned alike."""
    if len(kinds) == 1:
        return np.zeros(len(corners), dtype=np.int64)
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.sqrt(np.maximum(norm(normal), TINY))
    cost = []
    for (number, carrier, outward), *_ in kinds:
        surface = geometry.regions[number].carriers[carrier]
        off = np.abs(surface.signed_distance(corners)).max(axis=1) / size
        way = outward * surface.normal(surface.foot(corners.mean(axis=1)))
        cost.append(off - dot(way, normal) / size**2)
    return np.asarray(np.argmin(cost, axis=0))


def _beyond(corners: Array, surface: Carrier, outward: int) -> float:
    """The volume between triangles (k, 3, 3) and a surface, above 0 where this is outside."""
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = norm(normal) / 2
    ends = corners[:, TRIANGLE_EDGES]
    rise = np.zeros(len(corners))
    for edge in range(3):
        middle = ends[:, edge].mean(axis=1)
        foot = surface.foot(middle)
        way = foot - middle
        for end in range(2):
            at = ends[:, edge, end]
            way = way - (surface.foot(at) - at) / 2
        rise += dot(way, outward * surface.normal(foot))
    return float((area * rise).sum()) / 3
