"""Tetrahedra that follow the exact complex: a mesher's, told their cells and put in place."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from decomp.meshes.faces import faces_of
from decomp.meshing.backends.base import (
    Mesher,
    MeshingError,
    Repair,
    Task,
    Tetrahedra,
    TimeLimit,
)
from decomp.meshing.conforming import Conformed, conformed
from decomp.meshing.exact.opening import Opener
from decomp.meshing.exact.strayed import strayed
from decomp.meshing.exact.targets import Finder
from decomp.meshing.naming.classify import classified, parts_of_cells
from decomp.meshing.naming.tagging import Tagger
from decomp.meshing.preparation import Prepared, Progress
from decomp.meshing.repairs.shortening import LONGEST_EDGE, shortened, tightened
from decomp.meshing.repairs.splitting import freed
from decomp.meshing.surface.followed import Followed
from decomp.vectors import Array, Ints

OFF_FACES, SECOND_TOLERANCE = 3.0, 0.9
"""Nodes farther off their faces than so many tolerances tell that triangles were left out. A mesher
that does so by chance is tried once more, with this part of the tolerance."""

CUTTING_ROUNDS = 3
"""How often edges that are too long are cut: nodes put in place can draw them out again."""


@dataclass(frozen=True, eq=False)
class Filled:
    """A mesh whose nodes are where they belong.

    Args:
        fit: the mesh.
        finder: of its nodes' places.
        far: nodes that are far off their faces.
    """

    fit: Conformed
    finder: Finder
    far: Ints


def filled(given: Prepared, mesher: Mesher, limit: TimeLimit, tell: Progress) -> Filled:
    """Run a mesher, a second time if it leaves out triangles by chance, and keep the better mesh.

    Args:
        given: what it runs on.
        mesher: that runs.
        limit: of each run.
        tell: of the progress.

    Raises:
        MeshingError: the first run fails.
    """
    tell(mesher.title, 0.0)
    best = _run(given, mesher, given.task, limit, tell)
    if len(best.far) and Repair.CHANCE in mesher.repairs:
        tell(f"{mesher.title} again", 0.0)
        finer = replace(given.task, tolerance=SECOND_TOLERANCE * given.task.tolerance)
        with suppress(MeshingError):  # the first mesh is whole, and tells of its nodes
            again = _run(given, mesher, finer, limit, tell)
            best = min(best, again, key=lambda found: len(found.far))
    return best


def _run(given: Prepared, mesher: Mesher, task: Task, limit: TimeLimit, tell: Progress) -> Filled:
    """Run a mesher once."""
    geometry, known, plan = given.geometry, given.known, given.plan
    raw = mesher.run(task, limit, lambda note: tell(note, 0.2))
    tell("naming", 0.7)
    tolerance = raw.tolerance
    part = _parts(given, raw)
    points, tets = _used(raw.points, raw.tets[part >= 0])
    part = part[part >= 0]
    followed = Followed(geometry, given.surface, known, plan, given.elements, tolerance)
    if Repair.LAYERS in mesher.repairs:
        points, tets, part = Opener(followed).opened(points, tets, part)
    points, tets, part = freed(points, tets, part, known.region[known.cell])
    tell("projecting", 0.8)
    tagger, finder = Tagger(followed), Finder(followed)
    tagged = tagger.tagged(points, part, faces_of(tets))
    mends = Repair.DENTS in mesher.repairs
    aimed = given.asked
    for _ in range(CUTTING_ROUNDS):
        points, tets, part = shortened(points, tets, part, tagged, aimed)
        fit = conformed(
            points, tets, part, tagger, finder, plan, given.elements, given.asked, mends
        )
        points, tets, part, tagged = fit.points, fit.tets, fit.part, fit.tagged
        longest = given.asked.edges(points, tets, part, tagged).excess(points).max()
        tighter = tightened(points, tets, part, tagged, given.asked, aimed)
        if longest <= LONGEST_EDGE and tighter is None:
            break
        aimed = tighter or aimed
    far = strayed(fit.points, fit.tagged, plan, given.elements, OFF_FACES * tolerance)
    return Filled(fit, finder, far)


def _parts(given: Prepared, made: Tetrahedra) -> Ints:
    """The part (m,) of a cell that each tetrahedron is in, OUTSIDE for none."""
    if made.cells is not None:
        return parts_of_cells(given.geometry, given.known, made.points, made.tets, made.cells)
    return classified(given.geometry, given.known, made.points, made.tets, made.tolerance)


def _used(points: Array, cells: Ints) -> tuple[Array, Ints]:
    """The points that tetrahedra use, and these renumbered."""
    used = np.unique(cells)
    return points[used], np.searchsorted(used, cells)
