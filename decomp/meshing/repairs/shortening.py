"""Edges longer than asked are cut in two.

A mesher such as TetWild aims at the lengths asked, and leaves some edges almost twice as long; on
small faces even the mean can be above what is asked. They are cut before nodes are put in place, so
that new ones on faces, sheets and edges go there with all others.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from decomp.geometry import Geometry
from decomp.meshes.cutting import apart, halved
from decomp.meshes.faces import EDGES, TRIANGLE_EDGES, edges_of
from decomp.meshing.naming.tagging import Tagged
from decomp.meshing.sizing.size_places import Place
from decomp.meshing.sizing.sizes import Wanted
from decomp.meshing.surface.cells import CellMap
from decomp.meshing.surface.layout import Layout
from decomp.vectors import Array, Ints, norm

LONGEST_EDGE = 1.5
"""No edge is longer than so many of the length asked in its region, or on its face."""
CUT = 1.45
"""Edges are cut that are longer than so many: nodes still move afterwards."""
MEAN, TIGHTER = 1.05, 0.85
"""Where the mean is above the first of what is asked, edges are cut to the second of it."""
SHORTENING_ROUNDS = 12
"""The most passes; each cuts the longest edges, one for each tetrahedron."""


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of tetrahedra, and what is asked of them.

    Args:
        ends: (e, 2), in the order of `edges_of`.
        of_tet: (m, 6) their numbers.
        of_triangle: (k, 3) their numbers.
        asked: (e,) the length, in model units.
    """

    ends: Ints
    of_tet: Ints
    of_triangle: Ints
    asked: Array

    def excess(self, points: Array) -> Array:
        """How long each edge (e,) is, in parts of the length asked."""
        return norm(points[self.ends[:, 1]] - points[self.ends[:, 0]]) / self.asked


@dataclass(frozen=True, eq=False)
class Lengths:
    """What is asked, in model units.

    Args:
        of_part: (p,) in each part of a cell, its region's.
        of_patch: (q,) on each patch of the complex; infinite where its faces ask for nothing.
        region: (p,) of each part.
        places: in which edges are to be shorter.
        offset: (3,) what points are counted from, for places.
    """

    of_part: Array
    of_patch: Array
    region: Ints
    places: tuple[Place, ...] = ()
    offset: Array = field(default_factory=lambda: np.zeros(3))

    def of_tets(self, points: Array, tets: Ints, part: Ints) -> Array:
        """The length (m,) asked in tetrahedra (m, 4) of parts (m,)."""
        found = self.of_part[part]
        middles = points[tets].mean(axis=1)
        for place in self.places:
            inside = place.away(middles, self.offset) == 0
            found = np.where(inside, np.minimum(found, place.length), found)
        return found

    def edges(self, points: Array, tets: Ints, part: Ints, tagged: Tagged) -> Edges:
        """The edges of tetrahedra (m, 4) of parts (m,), with tagged triangles."""
        own = self.of_patch[tagged.patches]
        return edges_asked(tets, self.of_tets(points, tets, part), tagged.triangles, own)


def lengths_asked(
    geometry: Geometry, cells: CellMap, plan: Layout, sizes: Array, wanted: Wanted
) -> Lengths:
    """The lengths asked of a model's cells and patches.

    Args:
        geometry, cells, plan: of the model.
        sizes: (r,) the largest length in each region.
        wanted: by the user.

    Raises:
        InputError: the `maxh` of a face is no number above 0.
    """
    found = np.full(len(plan.sides), np.inf)
    for patch, sides in enumerate(plan.sides):
        for region, face in sides:
            length = geometry.regions[region].faces[face].options.get("maxh")
            if length is not None:
                found[patch] = min(found[patch], length, sizes[region])
    of_part = cells.region[cells.cell]
    return Lengths(sizes[of_part], found, of_part, wanted.places, wanted.offset)


def edges_asked(tets: Ints, limit: Array, triangles: Ints, own: Array) -> Edges:
    """All edges; one of several tetrahedra and triangles has the least of their lengths.

    Args:
        tets: (m, 4).
        limit: (m,) the length asked in each.
        triangles: (k, 3) of them.
        own: (k,) the length asked on each.
    """
    ends, of_tet = edges_of(tets, EDGES)
    width = int(tets.max(initial=0)) + 1
    sides = np.sort(triangles[:, TRIANGLE_EDGES], axis=2)
    of_triangle = np.searchsorted(
        ends[:, 0] * width + ends[:, 1], sides[:, :, 0] * width + sides[:, :, 1]
    )
    least = np.full(len(ends), np.inf)
    np.minimum.at(least, of_tet, limit[:, None])
    np.minimum.at(least, of_triangle, own[:, None])
    return Edges(ends, of_tet, of_triangle, least)


def shortened(
    points: Array, tets: Ints, part: Ints, tagged: Tagged, asked: Lengths
) -> tuple[Array, Ints, Ints]:
    """Cut edges in two until none is longer than `CUT` allows.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        part: (m,) of each; both halves keep it.
        tagged: triangles with their patches.
        asked: lengths.

    Returns:
        points, tetrahedra and parts.
    """
    limit = asked.of_tets(points, tets, part)
    triangles, own = tagged.triangles, asked.of_patch[tagged.patches]
    for _ in range(SHORTENING_ROUNDS):
        edges = edges_asked(tets, limit, triangles, own)
        excess = edges.excess(points)
        long = np.flatnonzero(excess > CUT)
        if not len(long):
            break
        chosen, _ = apart(long, edges.of_tet, excess)
        new = np.full(len(edges.ends), -1, dtype=np.int64)
        new[chosen] = len(points) + np.arange(len(chosen))
        points = np.concatenate([points, points[edges.ends[chosen]].mean(axis=1)])
        tets, rows = halved(tets, EDGES, new[edges.of_tet])
        part, limit = part[rows], limit[rows]
        triangles, rows = halved(triangles, TRIANGLE_EDGES, new[edges.of_triangle])
        own = own[rows]
    return points, tets, part


def tightened(
    points: Array, tets: Ints, part: Ints, tagged: Tagged, asked: Lengths, aimed: Lengths
) -> Lengths | None:
    """Shorter lengths to cut to, for regions and faces in which the mean is more than is asked.

    Args:
        points, tets, part, tagged, asked: see `shortened`.
        aimed: what edges were cut to.

    Returns:
        the lengths; None if no mean is too long.
    """
    of_part, of_patch = aimed.of_part.copy(), aimed.of_patch.copy()
    for region in np.unique(asked.region).tolist():
        own = asked.region == region
        if _mean(points, tets[own[part]], EDGES) > MEAN * asked.of_part[own].max():
            of_part[own] *= TIGHTER
    for patch in np.unique(tagged.patches).tolist():
        own = tagged.triangles[tagged.patches == patch]
        if _mean(points, own, TRIANGLE_EDGES) > MEAN * asked.of_patch[patch]:
            of_patch[patch] *= TIGHTER
    if (of_part == aimed.of_part).all() and (of_patch == aimed.of_patch).all():
        return None
    return replace(aimed, of_part=of_part, of_patch=of_patch)


def _mean(points: Array, cells: Ints, pairs: Ints) -> float:
    """The mean length of the edges of simplices, 0 if there are none."""
    ends, _ = edges_of(cells, pairs)
    return float(norm(points[ends[:, 1]] - points[ends[:, 0]]).mean()) if len(ends) else 0.0
