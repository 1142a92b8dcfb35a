"""The walls of all regions that are sampled, with tetrahedra refined where they need it.

Around walls whose vertices cannot be placed tetrahedra are made finer; where an edge leads through
a third site's zone a node is put there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]
from scipy.spatial.distance import pdist  # type: ignore[import-untyped]

from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.sampled.bisecting import TET_EDGES, Bisected
from decomp.sampled.extracted import Extracted
from decomp.sampled.extraction import Extractor
from decomp.sampled.interior import Interior
from decomp.sampled.labels import Labeller
from decomp.sampled.refinement import Refiner
from decomp.sampled.whole import RegionTools
from decomp.skeletons.balls.queries import region_queries
from decomp.vectors import Array, Ints, norm

REFINED_AGAIN, WITHOUT_PROGRESS = 8, 3
"""So often tetrahedra are refined around walls that cannot be placed, and so often though there are
no fewer then,"""
FINEST_FLOOR = 0.002
"""to this part of the floor at the most."""
MOST_TETRAHEDRA = 40_000
"""Tetrahedra at most: more would take longer than they are worth."""
SHORTER = 0.6
"""Their edges become no longer than this part of what they were,"""
OF_APART = 0.5
"""and than this part of how far what meets there is apart,"""
LEAST_APART = 1e-3
"""unless that is less than this part of them;"""
LEAST_AT_ONCE = 0.15
"""nor less than this part of what they were at once;"""
REFINED_REACH = 0.3
"""those around them are refined if they are nearer than this part of their own edges,"""
WALL_HALVINGS = 40
"""and all are halved so often at the most."""


def region_walls(
    geometry: Geometry,
    given: Interior,
    mesh: Bisected,
    tools: Sequence[RegionTools],
    floor: float,
    chord: float,
) -> list[Extracted]:
    """The walls of all regions; tetrahedra around those that cannot be placed are refined.

    Args:
        geometry: of the model.
        given: what the tetrahedra conform to.
        mesh: the tetrahedra; they are refined.
        tools: of the regions; those that are not sampled have no walls.
        floor: a length.
        chord: how far chords may be off the edges of the boundary.

    Raises:
        GeometryError: there would be too many tetrahedra.
    """
    labellers, known = [], []
    for number, tool in enumerate(tools):
        if not tool.sampled:
            continue
        queries = region_queries(geometry.index, number)
        face_of_patch = np.full(len(given.plan.complex.patches), -1, dtype=np.int64)
        sides = given.surface.face_sides(number, len(geometry.regions[number].faces))
        for face, own in enumerate(sides):
            face_of_patch[[patch for patch, _ in own]] = face
        labeller = Labeller(queries, tool.incidence, face_of_patch)
        refiner = Refiner(queries, labeller, tool.placer, number)
        labellers.append((number, labeller, refiner))
        known.append(labeller.labels(mesh, None))
    found = [Extracted.none()] * len(tools)
    fewest, since = len(mesh.points), 0
    for left in reversed(range(REFINED_AGAIN)):
        for k, (_, labeller, refiner) in enumerate(labellers):
            known[k] = refiner.refined(mesh, labeller.labels(mesh, known[k]), floor, chord)
        if len(mesh.tets) > MOST_TETRAHEDRA:
            lost = [walls.points[walls.lost] for walls in found]
            at = next((places[0] for places in lost if len(places)), mesh.points[0])
            raise GeometryError(
                f"more than {MOST_TETRAHEDRA} tetrahedra would be needed to tell sites apart "
                "near {at}",
                at=at,
            )
        for k, (number, labeller, _) in enumerate(labellers):
            known[k] = labeller.labels(mesh, known[k])
            tool = tools[number]
            extractor = Extractor(
                region_queries(geometry.index, number),
                tool.placer,
                tool.owner,
                geometry.regions[number].diagonal,
            )
            found[number] = extractor.extracted(mesh, known[k], number)
        many = sum(int(walls.lost.sum()) for walls in found)
        since = 0 if many < fewest else since + 1
        fewest = min(many, fewest)
        if (
            not left
            or since == WITHOUT_PROGRESS
            or not _refined_where_lost(mesh, found, tools, floor)
        ):
            break
    return found


def _refined_where_lost(
    mesh: Bisected, found: Sequence[Extracted], tools: Sequence[RegionTools], floor: float
) -> bool:
    """Refine the tetrahedra in which walls could not be placed; whether there were any.

    They are made as fine as the points at which some of a vertex's sites truly meet are apart.
    """
    places, lengths = [np.empty((0, 3))], [np.empty(0)]
    least = FINEST_FLOOR * floor
    for number, walls in enumerate(found):
        rows = np.flatnonzero(mesh.region == number)
        cut = {tuple(place) for place in walls.passing.tolist()}
        for vertex in np.flatnonzero(walls.lost).tolist():
            if tuple(walls.points[vertex].tolist()) in cut:
                continue
            own = np.unique(rows[walls.tet[(walls.triangles == vertex).any(axis=1)]])
            longest = float(_longest(mesh, own).max(initial=0.0))
            if longest <= least:
                continue
            point = walls.points[vertex]
            near = tools[number].placer.meetings(walls.sites[vertex], point, longest)
            apart = pdist(near)
            wide = float(apart.min(initial=np.inf, where=apart > LEAST_APART * longest))
            least_now = max(least, LEAST_AT_ONCE * longest)
            asked = float(np.clip(OF_APART * wide, least_now, SHORTER * longest))
            places += [point[None], near]
            lengths.append(np.full(1 + len(near), asked))
    at, length = np.concatenate(places), np.concatenate(lengths)
    if len(at):
        tree = cKDTree(at)
        for _ in range(WALL_HALVINGS):
            away, nearest = tree.query(mesh.points[mesh.tets].mean(axis=1))
            every = _longest(mesh, np.arange(len(mesh.tets)))
            wanted = (away <= REFINED_REACH * every) & (every > length[nearest])
            if not wanted.any():
                break
            mesh.shorten(wanted)
    return bool(len(at)) | _cut_through(mesh, found)


def _longest(mesh: Bisected, tets: Ints) -> Array:
    """The longest edge (k,) of some tetrahedra."""
    corners = mesh.points[mesh.tets[tets]]
    return np.asarray(norm(corners[:, TET_EDGES[:, 0]] - corners[:, TET_EDGES[:, 1]]).max(axis=1))


def _cut_through(mesh: Bisected, found: Sequence[Extracted]) -> bool:
    """Put nodes into zones that edges lead through; whether there were any."""
    edges, which = mesh.edges()
    number = {(a, b): k for k, (a, b) in enumerate(edges.tolist())}
    chosen = np.zeros(len(edges), dtype=np.bool_)
    at: Array = mesh.points[edges].mean(axis=1)
    for walls in found:
        for pair, point in zip(np.sort(walls.passed, axis=1).tolist(), walls.passing, strict=True):
            k = number.get((pair[0], pair[1]))
            if k is not None:
                chosen[k], at[k] = True, point
    chosen &= ~mesh.boundary_edges(edges)
    if chosen.any():
        mesh.halve(edges, which, chosen, at)
    return bool(chosen.any())
