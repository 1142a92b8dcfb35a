"""Tetrahedra that follow the complex within the tolerance are made to follow the exact one.

Triangles between cells are told their patches, and nodes are moved onto what these lie on. Where a
node has no room there a cut-off edge is put back, the node is merged with a neighbour, or the
sheet is taken off the face that it is on, and all is done again. Then tetrahedra with small angles
are exchanged for better ones, and nodes that have moved past the end of a sheet or line are put on
the next one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.meshes.faces import faces_of, is_complex
from decomp.meshing.exact.project import Projector
from decomp.meshing.exact.targets import Finder, placed, renewed
from decomp.meshing.naming.tagging import Tagged, Tagger
from decomp.meshing.repairs.clearing import cleared
from decomp.meshing.repairs.collapsing import collapsed
from decomp.meshing.repairs.filling import filled
from decomp.meshing.repairs.flipping import flipped
from decomp.meshing.repairs.separating import separated
from decomp.meshing.repairs.shortening import LONGEST_EDGE, Lengths
from decomp.meshing.surface.layout import Layout
from decomp.vectors import Array, Bools, Ints

CONFORMING_ROUNDS = 8
FLIPS = 3
"""How often tetrahedra with small angles are exchanged and nodes smoothed again."""
SLIPS = 3
"""How often nodes that slipped past a sheet's or line's end are put where it goes on."""


@dataclass(frozen=True, eq=False)
class Conformed:
    """A mesh whose nodes are where they belong.

    Args:
        points: (n, 3), all used.
        tets: (m, 4).
        part: (m,) of each.
        tagged: its triangles on patches.
    """

    points: Array
    tets: Ints
    part: Ints
    tagged: Tagged


def conformed(
    points: Array,
    tets: Ints,
    part: Ints,
    tagger: Tagger,
    finder: Finder,
    plan: Layout,
    elements: Elements,
    asked: Lengths,
    mends: bool,
) -> Conformed:
    """Tag and move.

    Args:
        points: (n, 3), all used.
        tets: (m, 4), positively oriented, of the cells only.
        part: (m,) the part of a cell that each is in.
        tagger, finder: of patches and of places.
        plan: the complex.
        elements: of it.
        asked: lengths; smoothing leaves no edge longer than these allow, but those that are.
        mends: whether tetrahedra are changed at nodes that have no room where they belong.
    """
    for last in range(CONFORMING_ROUNDS - 1, -1, -1):
        faces = faces_of(tets)
        tagged = tagger.tagged(points, part, faces)
        targets = finder.targets(points, tagged)
        projector = Projector(points, tets, targets, elements, plan.complex.points)
        left = projector.settle()
        mended = None
        if mends and len(left) and last:
            at = projector.points
            if tagger.still_right(tagged, at, part, faces, left):
                rows = np.searchsorted(targets.nodes, left)
                on = targets.dimension[rows], targets.element[rows]
                goals, _ = placed(elements, plan.complex.points, *on, at[left])
                mended = _mended(at, tets, part, left, goals, tagger, tagged, finder)
            else:
                mended = at, tets, part
        if mended is None:
            break
        points, tets, part = mended
    projector.smooth(LONGEST_EDGE * asked.edges(projector.points, tets, part, tagged).asked)
    for _ in range(FLIPS):
        better = flipped(projector.points, tets, part, tagged.triangles)
        if better is None:
            break
        tets, part = better
        projector = Projector(projector.points, tets, targets, elements, plan.complex.points)
        projector.settle()
        projector.smooth(LONGEST_EDGE * asked.edges(projector.points, tets, part, tagged).asked)
    for turn in range(SLIPS + 1):
        targets, slipped = renewed(targets, finder.targets(projector.points, tagged))
        if not len(slipped) or turn == SLIPS:
            break
        projector = Projector(projector.points, tets, targets, elements, plan.complex.points)
        projector.settle()
    return Conformed(projector.points, tets, part, tagged)


def _mended(
    points: Array,
    tets: Ints,
    part: Ints,
    left: Ints,
    goals: Array,
    tagger: Tagger,
    tagged: Tagged,
    finder: Finder,
) -> tuple[Array, Ints, Ints] | None:
    """Change tetrahedra at nodes that have no room where they belong; None if none could be.

    Where a mesher has left a dent, a change can lead across it onto tetrahedra that are there: it
    is not made.
    """
    near = _around(tets, left)
    around = points, tets[near], part[near], left
    tagged = tagged.at(tets[near])

    def put_back() -> tuple[Array, Ints, Ints] | None:
        found = filled(*around, tagger.parts_at)
        return None if found is None else (points, *found)

    def merged() -> tuple[Array, Ints, Ints] | None:
        found = collapsed(*around, finder.kinds(tagged))
        return None if found is None else (points, *found)

    def lifted() -> tuple[Array, Ints, Ints] | None:
        return separated(*around, tagger.owner(tagged, left), tagger.parts_at)

    def taken_in() -> tuple[Array, Ints, Ints] | None:
        return cleared(*around, goals, finder.kinds(tagged))

    for change in (put_back, merged, lifted, taken_in):
        found = change()
        if found is None:
            continue
        whole = np.concatenate([tets[~near], found[1]])
        if is_complex(whole):
            used = np.unique(whole)
            parts = np.concatenate([part[~near], found[2]])
            return found[0][used], np.searchsorted(used, whole), parts
    return None


def _around(tets: Ints, nodes: Ints) -> Bools:
    """The tetrahedra (m,) at nodes, and those that touch them.

    What changes is at the nodes, and it depends on nothing but these.
    """
    for _ in range(2):
        some = np.isin(tets, nodes).any(axis=1)
        nodes = np.unique(tets[some])
    return np.asarray(some)
