"""The walls of all regions that are sampled, with tetrahedra refined where they need it.

Around walls whose vertices cannot be placed tetrahedra are made finer; where an edge leads through
a third site's zone a node is put there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.geometry import Geometry
from decomp.sampled.bisecting import Bisected
from decomp.sampled.extracted import Extracted
from decomp.sampled.extraction import Extractor
from decomp.sampled.interior import Interior
from decomp.sampled.labels import Labeller
from decomp.sampled.refinement import Refiner
from decomp.sampled.whole import RegionTools
from decomp.tracing.queries import region_queries
from decomp.vectors import Array, norm

AGAIN = 7
"""So often tetrahedra are refined around walls that cannot be placed,"""
FINEST = 0.01
"""to this part of the floor at the most."""


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
    for left in reversed(range(AGAIN)):
        for k, (_, labeller, refiner) in enumerate(labellers):
            known[k] = refiner.refined(mesh, labeller.labels(mesh, known[k]), floor, chord)
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
        if not left or not _refined_where_lost(mesh, found, floor):
            break
    return found


def _refined_where_lost(mesh: Bisected, found: list[Extracted], floor: float) -> bool:
    """Refine the tetrahedra in which walls could not be placed; whether there were any."""
    wanted = np.zeros(len(mesh.tets), dtype=np.bool_)
    for number, walls in enumerate(found):
        rows = np.flatnonzero(mesh.region == number)
        if not len(walls.passed):
            wanted[rows[walls.tet[walls.lost[walls.triangles].any(axis=1)]]] = True
    corners = mesh.points[mesh.tets]
    wanted &= norm(corners - corners[:, [1, 2, 3, 0]]).max(axis=1) > FINEST * floor
    mesh.shorten(wanted)
    return bool(wanted.any()) | _cut_through(mesh, found)


def _cut_through(mesh: Bisected, found: list[Extracted]) -> bool:
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
