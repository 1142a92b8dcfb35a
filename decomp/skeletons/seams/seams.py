"""Tracing one seam from a point to where it ends.

A seam is followed as long as its sites stay the same, see `following`. Where a foot leaves its site
the neighbouring site takes over: a trim, where the seam goes on smoothly, unless it splits there,
see `halting`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

import numpy as np

from decomp.errors import GeometryError
from decomp.skeletons.balls.probing import JOINED
from decomp.skeletons.seams.ending.seam_stops import SeamStops
from decomp.skeletons.seams.halting import Halt, Onwards, Transitions
from decomp.skeletons.seams.steps.course import Course
from decomp.skeletons.seams.steps.following import follow
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import Run, State, Traced
from decomp.skeletons.seams.steps.stretch import Stretch
from decomp.vectors import Array

ROOM = 1024
"""Points of a stretch."""
MOST_RUNS = 1000
"""A seam with more runs goes round for ever."""
LATE = 3e-6
"""An intruder that is as near for longer than this part of the size has joined the seam before."""


class SeamTracer:
    """Follows seams of one region.

    Args:
        points: of its seams.
        longest: step, as a part of its size.
    """

    def __init__(self, points: SeamPoints, longest: float) -> None:
        self._points, self._stops = points, SeamStops(points)
        self._transitions = Transitions(points, self._stops)
        self._longest = longest * points.size

    def trace(self, start: State, stops: Callable[[Array], bool] | None = None) -> Traced:
        """Follow a seam from `start` in the sense of its tangent.

        Args:
            start: its first point.
            stops: whether there is a node at a point (3,) where the sites change.

        Raises:
            GeometryError: the seam cannot be followed; says where.
        """
        here, steps = start, 0
        runs: list[Run] = []
        for _ in range(MOST_RUNS):
            halt = self._halt(start, here, steps, stops or _nowhere)
            steps += halt.count - 1
            outcome = self._transitions.after(halt)
            runs.append(outcome.run)
            if not isinstance(outcome, Onwards):
                ended = outcome
                return Traced(tuple(runs), ended.last, ended.end, ended.intruder, ended.foot)
            here = outcome.here
        names = self._points.names(start.sites)
        raise GeometryError("the seam from {at} does not end", names, start.point)

    def _halt(
        self, start: State, here: State, steps: int, node_at: Callable[[Array], bool]
    ) -> Halt:
        """Follow a seam that began at `start` and has made some steps to where its sites change."""
        points, size = self._points, self._points.size
        stretch = Stretch(here.sites, ROOM, size)
        stretch.put(0, here)
        course = Course(
            points.table,
            points.queries.probe,
            stretch.track,
            longest=self._longest,
            home=np.concatenate([start.point, start.tangent]),
            closable=int(here.sites == start.sites),
            made=steps,
            latest=LATE * size,
        )
        count, why, contact = follow(course)
        joined = self._stops.joining(stretch, count) if why == JOINED else None
        if why == JOINED and joined is None:
            # nothing tells where it joined: the place from which it is nearer is the one
            count, why, contact = follow(replace(course, latest=inf))
            joined = self._stops.joining(stretch, count) if why == JOINED else None
        last = stretch.state(count - 1)
        return Halt(here, stretch, count, why, contact, last, joined, node_at)


def _nowhere(point: Array) -> bool:
    """No point is a node."""
    return False
