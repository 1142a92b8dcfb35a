"""Moving nodes onto the exact surfaces, curves and points that they belong to, all together.

1. All nodes are moved at once. Nodes of tetrahedra that come out worse than allowed go back.
2. Those are tried again, a few that do not touch at a time, after the nodes around them have been
   moved to better places along what they are on.
3. What is left of nodes on lines and corners is put on one surface at least.
4. Nodes inside, and on surfaces along them, are smoothed.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.many_elements import Elements
from decomp.meshes.faces import least_dihedral
from decomp.meshing.exact.targets import SURFACE, Targets, placed
from decomp.meshing.repairs.lifting import lifted
from decomp.meshing.repairs.smoothing import smoothed
from decomp.vectors import Array, Bools, Ints, norm

KEPT = 0.5
"""A tetrahedron's least dihedral angle may fall to this part of what it was."""
UNSPOILT = 9.0
"""A tetrahedron with this least dihedral angle (degrees) is not spoilt."""
LAST_ANGLE = 2.0
"""The least that a node's exact place may cost in the end."""
SETTLING_ROUNDS = 6
ANGLE_FLOORS = (1.0, 1.0, 0.6, 0.6, 0.3)
"""What the angles asked for are multiplied by, try after try."""
WORST = 15.0
"""Nodes of tetrahedra below this angle are moved to better places."""
MOVING_STEPS = (0.25, 0.1, 0.04)
"""How far they are moved, in parts of the shortest edge at them."""
BETTER = 1e-9
"""Least angles (degrees) have grown only if they have by so much."""


class Projector:
    """Moves nodes of one mesh.

    Args:
        points: (n, 3) at first.
        tets: (m, 4) positively oriented.
        targets: of nodes.
        elements: of the complex.
        corners: (p, 3) the complex's points.
        seed: of the directions that are tried.
    """

    def __init__(
        self,
        points: Array,
        tets: Ints,
        targets: Targets,
        elements: Elements,
        corners: Array,
        seed: int = 0,
    ) -> None:
        self._points = np.array(points)
        self._tets, self._targets, self._elements = tets, targets, elements
        self._corners = corners
        self._random = np.random.default_rng(seed)
        self._row = np.full(len(points), -1, dtype=np.int64)
        self._row[targets.nodes] = np.arange(len(targets.nodes))
        order = np.argsort(tets.reshape(-1), kind="stable")
        self._around = order // 4
        self._first = np.searchsorted(tets.reshape(-1)[order], np.arange(len(points) + 1))
        self._quality = least_dihedral(self._points, tets)
        self._floor = np.minimum(KEPT * self._quality, UNSPOILT)
        self._dimension = np.array(targets.dimension)
        self._element = np.array(targets.element)
        self._done = np.zeros(len(targets.nodes), dtype=np.bool_)

    @property
    def points(self) -> Array:
        """The nodes (n, 3) as they are."""
        return self._points

    def settle(self) -> Ints:
        """Move all nodes; those that are not on all that they belong to, ascending."""
        complete = np.array(self._targets.complete)
        self._move_together(np.arange(len(self._targets.nodes)))
        for factor in ANGLE_FLOORS:
            if self._done.all():
                break
            self._better(self._near_failed())
            self._move_one_by_one(np.flatnonzero(~self._done), factor)
        failed = np.flatnonzero(~self._done)
        complete[failed] = False
        self._dimension[failed] = SURFACE
        self._element[failed] = self._targets.surface[failed]
        self._move_one_by_one(failed, ANGLE_FLOORS[-1])
        return np.sort(self._targets.nodes[~complete])

    def smooth(self, longest: Array) -> None:
        """Better angles, at the worst and all over; nodes on lines and corners stay.

        Args:
            longest: (e,) what edges, in the order of `edges_of`, are not drawn out beyond.
        """
        for _ in range(SETTLING_ROUNDS):
            bad = np.flatnonzero(self._quality < WORST)
            if not len(bad) or not self._better(np.unique(self._tets[bad])):
                break
        free = np.bincount(self._tets.reshape(-1), minlength=len(self._points)) > 0
        free[self._targets.nodes] = False
        held = np.zeros(len(free), dtype=np.bool_)
        held[self._targets.nodes] = self._done & (self._dimension == SURFACE)

        def place(nodes: Ints, wanted: Array) -> tuple[Array, Bools]:
            rows = self._row[nodes]
            on = self._dimension[rows], self._element[rows]
            return placed(self._elements, self._corners, *on, wanted)

        self._points = smoothed(self._points, self._tets, free, held, place, longest)
        # nodes on surfaces stay: a try may lead beyond the face that they are on
        self._points = lifted(self._points, self._tets, free)

    def _goals(self, rows: Ints) -> tuple[Array, Bools]:
        return placed(
            self._elements,
            self._corners,
            self._dimension[rows],
            self._element[rows],
            self._points[self._targets.nodes[rows]],
        )

    def _move_together(self, rows: Ints) -> None:
        """Move nodes at once; take back those of tetrahedra that it spoils, until none is."""
        goals, good = self._goals(rows)
        rows, goals = rows[good], goals[good]
        nodes = self._targets.nodes[rows]
        before = np.array(self._points)
        moved = np.zeros(len(self._points), dtype=np.bool_)
        moved[nodes] = True
        self._points[nodes] = goals
        self._quality = least_dihedral(self._points, self._tets)
        while True:
            bad = self._tets[self._quality < self._floor]
            back = np.unique(bad[moved[bad]])
            if not len(back):
                break
            moved[back] = False
            self._points[back] = before[back]
            self._quality = least_dihedral(self._points, self._tets)
        self._done[rows[moved[nodes]]] = True

    def _move_one_by_one(self, rows: Ints, factor: float) -> None:
        """Move nodes each for itself, as far as that spoils nothing."""
        goals, good = self._goals(rows)
        for row, goal in zip(rows[good], goals[good], strict=True):
            node = int(self._targets.nodes[row])
            around = self._at(node)
            old = np.array(self._points[node])
            self._points[node] = goal
            quality = least_dihedral(self._points, self._tets[around])
            wanted = np.minimum(
                np.maximum(factor * self._floor[around], LAST_ANGLE), self._quality[around] + BETTER
            )
            if (quality >= wanted).all() and (quality > 0).all():
                self._quality[around] = quality
                self._done[row] = True
            else:
                self._points[node] = old

    def _near_failed(self) -> Ints:
        """Nodes of tetrahedra at nodes that are not yet in their places."""
        failed = self._targets.nodes[~self._done]
        some = [self._tets[self._at(int(node))].reshape(-1) for node in failed]
        return np.unique(np.concatenate(some))

    def _at(self, node: int) -> Ints:
        return self._around[self._first[node] : self._first[node + 1]]

    def _better(self, nodes: Ints) -> int:
        """Move nodes where the worst tetrahedron at each gets better; how many were."""
        rows = self._row[nodes]
        movable = (rows < 0) | (self._dimension[rows] > 0) & self._done[rows]
        count = 0
        nodes_left = nodes[movable]
        if not len(nodes_left):
            return 0
        for step in MOVING_STEPS:
            ways = self._random.normal(size=(len(nodes_left), 3))
            ways /= norm(ways)[:, None]
            wanted = self._points[nodes_left] + self._reach(nodes_left)[:, None] * step * ways
            on = self._row[nodes_left]
            held = np.flatnonzero(on >= 0)
            goals, good = placed(
                self._elements,
                self._corners,
                self._dimension[on[held]],
                self._element[on[held]],
                wanted[held],
            )
            wanted[held] = np.where(good[:, None], goals, self._points[nodes_left[held]])
            count += sum(
                self._improve(int(node), goal)
                for node, goal in zip(nodes_left, wanted, strict=True)
            )
        return count

    def _improve(self, node: int, goal: Array) -> bool:
        around = self._at(node)
        old = np.array(self._points[node])
        self._points[node] = goal
        quality = least_dihedral(self._points, self._tets[around])
        if quality.min() > self._quality[around].min():
            self._quality[around] = quality
            return True
        self._points[node] = old
        return False

    def _reach(self, nodes: Ints) -> Array:
        """The shortest edge (k,) at each node."""
        counts = self._first[nodes + 1] - self._first[nodes]
        starts = np.cumsum(counts) - counts
        rows = np.arange(counts.sum()) + np.repeat(self._first[nodes] - starts, counts)
        owner, around = np.repeat(nodes, counts), self._tets[self._around[rows]]
        gaps = norm(self._points[around] - self._points[owner][:, None])
        gaps[around == owner[:, None]] = np.inf
        return np.asarray(np.minimum.reduceat(gaps.min(axis=1), starts))
