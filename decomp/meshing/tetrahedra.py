"""Tetrahedra that follow the exact complex: TetWild's, told their cells and put in place."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from decomp.meshes.faces import faces_of
from decomp.meshing.backends.tetwild.child import MeshingError, Settings, TimeLimit, tetrahedralized
from decomp.meshing.conforming import Conformed, conformed
from decomp.meshing.exact.exact_model import ExactModel
from decomp.meshing.exact.opening import Opener
from decomp.meshing.exact.strayed import strayed
from decomp.meshing.exact.targets import Finder
from decomp.meshing.naming.classify import classified
from decomp.meshing.naming.tagging import Tagger
from decomp.meshing.preparation import Prepared, Progress
from decomp.meshing.repairs.shortening import LONGEST, shortened, tightened
from decomp.meshing.repairs.splitting import freed
from decomp.vectors import Array, Ints

FAR, AGAIN = 3.0, 0.9
"""Nodes farther off their faces than so many epsilons tell that TetWild has failed to insert a
triangle. It does so by chance, and is tried once more, with this part of epsilon."""

CUTS = 3
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


def filled(given: Prepared, limit: TimeLimit, tell: Progress) -> Filled:
    """Run TetWild, a second time if it leaves out triangles, and keep the better mesh.

    Args:
        given: what it runs on.
        limit: of each run.
        tell: of the progress.

    Raises:
        MeshingError: the first run fails.
    """
    tell("TetWild", 0.0)
    best = _run(given, given.settings, limit, tell)
    if len(best.far):
        tell("TetWild again", 0.0)
        finer = replace(given.settings, epsilon=AGAIN * given.settings.epsilon)
        with suppress(MeshingError):  # the first mesh is whole, and tells of its nodes
            again = _run(given, finer, limit, tell)
            best = min(best, again, key=lambda found: len(found.far))
    return best


def _run(given: Prepared, settings: Settings, limit: TimeLimit, tell: Progress) -> Filled:
    """Run TetWild once."""
    geometry, known, plan = given.geometry, given.known, given.plan
    raw = tetrahedralized(
        *given.triangles, settings, given.field, limit, lambda note: tell(note, 0.2)
    )
    tell("naming", 0.7)
    epsilon = raw.settings.epsilon
    part = classified(geometry, known, raw.points, raw.tets, epsilon)
    points, tets = _used(raw.points, raw.tets[part >= 0])
    model = ExactModel(geometry, given.surface, known, plan, given.elements, epsilon)
    points, tets, part = Opener(model).opened(points, tets, part[part >= 0])
    points, tets, part = freed(points, tets, part, known.region[known.cell])
    tell("projecting", 0.8)
    tagger = Tagger(geometry, given.surface, known, plan, epsilon)
    finder = Finder(model)
    tagged = tagger.tagged(points, part, faces_of(tets))
    aimed = given.asked
    for _ in range(CUTS):
        points, tets, part = shortened(points, tets, part, tagged, aimed)
        fit = conformed(points, tets, part, tagger, finder, plan, given.elements, given.asked)
        points, tets, part, tagged = fit.points, fit.tets, fit.part, fit.tagged
        longest = given.asked.edges(points, tets, part, tagged).excess(points).max()
        tighter = tightened(points, tets, part, tagged, given.asked, aimed)
        if longest <= LONGEST and tighter is None:
            break
        aimed = tighter or aimed
    far = strayed(fit.points, fit.tagged, plan, given.elements, FAR * epsilon)
    return Filled(fit, finder, far)


def _used(points: Array, cells: Ints) -> tuple[Array, Ints]:
    """The points that tetrahedra use, and these renumbered."""
    used = np.unique(cells)
    return points[used], np.searchsorted(used, cells)
