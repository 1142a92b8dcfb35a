"""What becomes of a seam where it halts."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.errors import GeometryError
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.seams import SeamTracer
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import SeamEnd, State
from decomp.vectors import norm
from tests.solids import SOLIDS

CORNER = np.array([1.0, 1.0, 1.0]) / np.sqrt(3.0)


def points_of(solid: decomp.Solid) -> SeamPoints:
    """Seam points of a model with one region."""
    geometry = decomp.Geometry(solid)
    return SeamPoints(RegionContext(geometry.index, 0))


def in_corner(points: SeamPoints, depth: float) -> State:
    """The point so far from the faces of a block's lowest corner, travelling away from it."""
    at = np.full(3, depth)
    feet = at - depth * np.eye(3)
    state = points.settled(at, feet, CORNER)
    assert state is not None
    return state


def test_a_seam_ends_on_the_boundary_or_at_a_junction() -> None:
    points = points_of(decomp.Block((0, 0, 0), (4, 5, 6), name="block"))
    tracer, start = SeamTracer(points, 0.05), in_corner(points, 1.0)
    inwards, outwards = tracer.trace(start), tracer.trace(start.turned())
    assert inwards.end is SeamEnd.JUNCTION
    assert points.names([inwards.intruder]) == ["block.xmax"]
    assert norm(inwards.last.point - 2.0) <= 1e-9
    assert norm(inwards.foot - [4.0, 2.0, 2.0]) <= 1e-9
    assert outwards.end is SeamEnd.BOUNDARY
    assert norm(outwards.last.point) <= 1e-5
    assert outwards.intruder == -1


def test_a_seam_goes_on_where_its_room_is_used_up(monkeypatch: pytest.MonkeyPatch) -> None:
    points = points_of(decomp.Block((0, 0, 0), (4, 5, 6), name="block"))
    tracer, start = SeamTracer(points, 0.01), in_corner(points, 0.5)
    whole = tracer.trace(start)
    monkeypatch.setattr("decomp.skeletons.seams.seams.ROOM", 8)
    parts = tracer.trace(start)
    assert len(whole.runs) == 1
    assert len(parts.runs) > 3
    assert {run.sites for run in parts.runs} == {start.sites}
    assert parts.end is whole.end
    assert norm(parts.last.point - whole.last.point) <= 1e-12
    for one, following in zip(parts.runs, parts.runs[1:], strict=False):
        assert (one.points[-1] == following.points[0]).all()


def test_a_seam_that_goes_on_for_ever_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    points = points_of(decomp.Block((0, 0, 0), (4, 5, 6), name="block"))
    tracer, start = SeamTracer(points, 0.01), in_corner(points, 0.5)
    monkeypatch.setattr("decomp.skeletons.seams.seams.ROOM", 8)
    monkeypatch.setattr("decomp.skeletons.seams.seams.MOST_RUNS", 2)
    with pytest.raises(GeometryError, match="does not end"):
        tracer.trace(start)


def test_a_foot_passes_from_a_face_to_its_reentrant_edge() -> None:
    """The seam goes on with the edge instead of the face, from the point where it passes."""
    points = points_of(SOLIDS["bracket"].make())
    at = np.array([2.0, 0.5, 0.5])
    feet = np.array([[2.0, 0.0, 0.5], [2.0, 1.0, 0.5], [2.0, 0.5, 0.0]])
    start = points.settled(at, feet, np.array([-1.0, 0.0, 0.0]))
    assert start is not None
    tracer = SeamTracer(points, 0.05)
    first, second = tracer.trace(start).runs[:2]
    assert norm(first.points[-1] - [1.0, 0.5, 0.5]) <= 1e-12
    assert (second.points[0] == first.points[-1]).all()
    assert second.sites[::2] == first.sites[::2]
    assert points.names(second.sites) != points.names(first.sites)
    # a node there ends it
    stopped = tracer.trace(start, lambda point: bool(norm(point - first.points[-1]) <= 1e-9))
    assert stopped.end is SeamEnd.SPLIT
    assert (stopped.last.point == first.points[-1]).all()
