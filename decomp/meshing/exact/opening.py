"""Layers that TetWild has pressed flat are opened again.

A region between two faces that touch gets thinner than epsilon towards the contact. There TetWild
may leave it out, so that its two neighbours meet and their nodes belong to both faces. There

1. edges that lead from the layer across the curve of contact get a node on it: an end is moved
   there, or they are cut;
2. what is left of the layer beyond the curve goes to a neighbour;
3. nodes that are in the layer and on both its sides are split in two, one for each face, with
   tetrahedra of the layer between them.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.polylines import polyline_distance
from decomp.meshes.faces import EDGES, OPPOSITE, edges_of, faces_of, least_dihedral
from decomp.meshing.exact.exact_model import ExactModel
from decomp.meshing.exact.layers import Across, Layer, across, layers
from decomp.meshing.exact.targets import LINE, placed
from decomp.meshing.surface.cells import OUTSIDE, locate
from decomp.vectors import Array, Bools, Ints

REACH = 2.5
"""Nodes that belong on a face are within so many epsilons of it."""
CLOSE = 0.35
"""An edge's end is moved onto the curve if it is nearer than this part of the edge, else the edge
is cut."""
SOUND = 2.0
"""Degrees. Tetrahedra have no lesser dihedral angle afterwards, unless they had one before."""
PASSES = 4
"""How often nodes are tried to be split."""
SAME = 1e-10
"""Walls are in contact where they are less than this part of the diagonal apart."""
IN, ON, BEYOND = 1, 0, -1
"""Where nodes are: in a layer, in contact (or not concerned), beyond the contact."""


class Opener:
    """Opens the layers of one model's meshes.

    Args:
        model: that they follow.
    """

    def __init__(self, model: ExactModel) -> None:
        self._geometry, self._cells, self._plan = model.geometry, model.cells, model.plan
        self._elements, self._epsilon = model.elements, model.epsilon
        self._layers = layers(model.surface, model.plan)

    def opened(self, points: Array, tets: Ints, part: Ints) -> tuple[Array, Ints, Ints]:
        """Open all layers.

        Args:
            points: (n, 3), all used.
            tets: (m, 4), positively oriented.
            part: (m,) the part of a cell that each is in.
        """
        for layer in self._layers:
            points, tets, part = self._opened(layer, points, tets, part)
        return points, tets, part

    def _opened(
        self, layer: Layer, points: Array, tets: Ints, part: Ints
    ) -> tuple[Array, Ints, Ints]:
        faces = faces_of(tets)
        region = self._cells.region_of(np.append(part, OUTSIDE)[faces.tets])
        region.sort(axis=1)
        known = np.isin(region, [layer.region, layer.one, layer.two]).all(axis=1)
        nodes = np.unique(faces.triangles[known & (region[:, 0] != region[:, 1])])
        direct = np.unique(faces.triangles[(region == [layer.two, layer.one]).all(axis=1)])
        side = np.full(len(points), ON)
        if not len(direct) or not (self._sides(layer, points[direct]) == IN).any():
            return points, tets, part
        side[nodes] = self._sides(layer, points[nodes])
        near = (side[tets] != ON).any(axis=1)
        patch = _Patch(points, tets[near], part[near], side)
        self._contact(layer, patch)
        self._beyond(layer, patch)
        self._split(layer, patch)
        kept = patch.part != OUTSIDE
        tets = np.concatenate([tets[~near], patch.tets[kept]])
        used = np.unique(tets)
        part = np.concatenate([part[~near], patch.part[kept]])
        return patch.points[used], np.searchsorted(used, tets), part

    def _sides(self, layer: Layer, nodes: Array) -> Ints:
        """Where nodes (k,) at some points (k, 3) are.

        Those in a layer are close to both its walls; beyond the contact edges may be longer.
        """
        found = self._across(layer, nodes)
        same, reach = SAME * self._geometry.diagonal, REACH * self._epsilon
        side = np.full(len(found.thickness), ON)
        within, beyond = found.gaps.max(axis=0) < reach, found.gaps.min(axis=0) < reach
        side[(found.thickness > same) & within & found.facing] = IN
        side[(found.thickness < -same) & beyond & found.facing] = BEYOND
        rows = np.flatnonzero(side == IN)
        # faces end: a carrier goes on where no layer is
        middles = found.feet[:, rows].mean(axis=0)
        held = self._cells.region_of(locate(self._geometry, self._cells, middles).part)
        side[rows[held != layer.region]] = ON
        return side

    def _contact(self, layer: Layer, patch: _Patch) -> None:
        """Put nodes on the curve of contact where edges cross it."""
        ends, _ = edges_of(patch.tets, EDGES)
        ends = ends[patch.side[ends].prod(axis=1) == IN * BEYOND]
        if not len(ends) or not layer.lines:
            return
        found = [self._across(layer, patch.points[own]).thickness for own in ends.T]
        share = found[0] / (found[0] - found[1])
        gap = np.minimum(share, 1 - share)
        for row in np.argsort(gap).tolist():
            one, two = ends[row].tolist()
            if patch.side[one] * patch.side[two] != IN * BEYOND:
                continue
            place = patch.points[one] + share[row] * (patch.points[two] - patch.points[one])
            end = one if share[row] < 0.5 else two
            if gap[row] < CLOSE and patch.move(end, self._on_line(layer, patch.points[end])):
                continue
            patch.cut(one, two, self._on_line(layer, place), place)

    def _on_line(self, layer: Layer, place: Array) -> Array:
        """The place (3,) on the nearest of a layer's lines; the same one if that is not found."""
        mesh = self._plan.complex
        gaps = [
            polyline_distance(mesh.points[mesh.lines[k].vertices], place[None])[0]
            for k in layer.lines
        ]
        line = self._elements.of_line[layer.lines[int(np.argmin(gaps))]]
        on, _ = placed(self._elements, mesh.points, np.array([LINE]), np.array([line]), place[None])
        return np.asarray(on[0])

    def _beyond(self, layer: Layer, patch: _Patch) -> None:
        """Give what is left of the layer beyond the contact to one of its neighbours."""
        side = patch.side[patch.tets]
        wrong = np.flatnonzero(
            (self._cells.region_of(patch.part) == layer.region)
            & (side == BEYOND).any(axis=1)
            & (side != IN).all(axis=1)
            & np.isin(patch.tets, patch.concerned).all(axis=1)
        )
        middles = patch.points[patch.tets[wrong]].mean(axis=1)
        there = locate(self._geometry, self._cells, middles).part
        first = self._part(layer.one)
        patch.part[wrong] = np.where(self._cells.region_of(there) == layer.two, there, first)

    def _split(self, layer: Layer, patch: _Patch) -> None:
        """Split nodes that the layer has on both its sides, the thickest places first.

        Where there is no room for that there can be some when neighbours are split.
        """
        own = OUTSIDE if layer.region == OUTSIDE else self._part(layer.region)
        nodes = np.unique(patch.tets)
        nodes = nodes[patch.side[nodes] == IN]
        found = self._across(layer, patch.points[nodes])
        order = np.argsort(-found.thickness)
        for _ in range(PASSES):
            split = False
            for row in order[patch.side[nodes[order]] == IN].tolist():
                star = np.flatnonzero((patch.tets == nodes[row]).any(axis=1))
                region = self._cells.region_of(patch.part[star])
                if (region == layer.one).any():
                    above = region == layer.two
                    split |= patch.split(
                        int(nodes[row]), star, above, layer.two, own, found.feet[:, row]
                    )
            if not split:
                break

    def _across(self, layer: Layer, points: Array) -> Across:
        return across(layer, self._elements, self._plan.complex.points, points)

    def _part(self, region: int) -> int:
        """A part of a region's cells."""
        return int(np.flatnonzero(self._cells.region[self._cells.cell] == region)[0])


class _Patch:
    """Tetrahedra with all that share some nodes, to be changed there.

    Args:
        points: (n, 3).
        tets: (m, 4), positively oriented.
        part: (m,) of each.
        side: (n,) of nodes.
    """

    def __init__(self, points: Array, tets: Ints, part: Ints, side: Ints) -> None:
        self.points, self.tets, self.part, self.side = points.copy(), tets, part, side
        self.concerned: Ints = np.flatnonzero(side != ON)

    def move(self, node: int, place: Array) -> bool:
        """Move a node into contact, if that spoils nothing."""
        star = self.tets[(self.tets == node).any(axis=1)]
        moved = self.points.copy()
        moved[node] = place
        if not _sound(moved, star, self.points, star):
            return False
        self.points, self.side[node] = moved, ON
        return True

    def cut(self, one: int, two: int, *places: Array) -> None:
        """Cut an edge at the first place that spoils nothing, and call that in contact."""
        around = (self.tets == one).any(axis=1) & (self.tets == two).any(axis=1)
        old, new = self.tets[around], len(self.points)
        halves = np.concatenate([np.where(old == end, new, old) for end in (two, one)])
        for place in places:
            points = np.concatenate([self.points, place[None]])
            if not _sound(points, halves, self.points, old):
                continue
            self.points, self.side = points, np.append(self.side, ON)
            self.concerned = np.append(self.concerned, new)
            self.tets = np.concatenate([self.tets[~around], halves])
            self.part = np.concatenate([self.part[~around], *[self.part[around]] * 2])
            return

    def split(self, node: int, star: Ints, above: Bools, two: int, own: int, feet: Array) -> bool:
        """Split a node, if that spoils nothing; whether it was.

        Args:
            node: stays with all but the tetrahedra above.
            star: the tetrahedra at it.
            above: which of them get the other node; none if that is outside.
            two: what is above.
            own: the part of what comes in between, OUTSIDE for nothing.
            feet: (2, 3) where both nodes belong.
        """
        sheet = _sheet(self.tets[star], node, above, two == OUTSIDE)
        if sheet is None:
            return False
        new = len(self.points)
        tets = self.tets.copy()
        tets[star[above]] = np.where(tets[star[above]] == node, new, tets[star[above]])
        between = np.column_stack([sheet, np.full(len(sheet), new)])
        if own == OUTSIDE:
            between = between[:0]
        here = self.points[node]
        for low, high in ((feet[0], feet[1]), (feet[0], here), (here, feet[1])):
            points = np.concatenate([self.points, high[None]])
            points[node] = low
            if _sound(points, np.concatenate([tets[star], between]), self.points, self.tets[star]):
                self.points, self.side = points, np.append(self.side, ON)
                self.tets = np.concatenate([tets, between])
                self.part = np.append(self.part, np.full(len(between), own))
                return True
        return False


def _sound(points: Array, tets: Ints, before: Array, old: Ints) -> bool:
    """Whether tetrahedra may take the place of others."""
    least = min(SOUND, float(least_dihedral(before, old).min()))
    return bool(least_dihedral(points, tets).min() >= least)


def _sheet(star: Ints, node: int, above: Bools, outside: bool) -> Ints | None:
    """The triangles (k, 3) at a node under what is above it, which they point to.

    Args:
        star: (m, 4) the tetrahedra at the node.
        node: which comes first.
        above: (m,) which of them are above.
        outside: whether what is outside of all is above.

    Returns:
        None if they are not a disc around the node.
    """
    triangles = star[~above][:, OPPOSITE].reshape(-1, 3)
    triangles = triangles[(triangles == node).any(axis=1)]
    other = star[above][:, OPPOSITE].reshape(-1, 3)
    first = np.argmax(triangles == node, axis=1)[:, None]
    triangles = np.take_along_axis(triangles, (first + np.arange(3)) % 3, axis=1)
    count: dict[tuple[int, ...], int] = {}
    for row in np.sort(triangles, axis=1).tolist():
        count[tuple(row)] = count.get(tuple(row), 0) + 1
    under = {tuple(row) for row in np.sort(other, axis=1).tolist()}
    after: dict[int, int] = {}
    found = []
    for row in triangles.tolist():
        key = tuple(sorted(row))
        if count[key] == 1 and (outside or key in under):
            if row[1] in after:
                return None
            after[row[1]] = row[2]
            found.append(row)
    if not found:
        return None
    at, steps = found[0][1], 0
    while at in after and steps <= len(after):
        at, steps = after[at], steps + 1
        if at == found[0][1]:
            break
    return np.array(found, dtype=np.int64) if steps == len(after) == len(found) else None
