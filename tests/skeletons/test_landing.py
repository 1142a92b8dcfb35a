"""Seams that come down to a reflexive locus, and what leaves points of a reflexive axis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import decomp
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.ending.landing import landing
from decomp.skeletons.seams.leaving.arcs import Arcs
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import State
from decomp.vectors import Array
from tests.skeletons.computed import region_of
from tests.skeletons.shapes import SHAPES

END = 0.3
"""Of a seam x = t, z = (t - END)^2 / 2, whose locus is the x axis."""


def state(t: float) -> State:
    w = t - END
    point, tangent = np.array([t, 0.0, w * w / 2]), np.array([1.0, 0.0, w])
    feet = point + np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
    return State(point, 1.0, (0, 1, 2), feet, tangent / np.linalg.norm(tangent), 0.0)


def off(point: Array) -> float:
    return float(np.hypot(point[1], point[2]))


def test_the_end_of_a_parabola_is_read_off() -> None:
    found = landing(
        lambda length: state(0.25 + length), lambda near: state(near.point[0]), off, state(0.25)
    )
    assert found is not None
    between, end = found
    assert end.point == pytest.approx([END, 0, 0], abs=1e-12)
    assert end.feet[0] == pytest.approx([END, 1, 0], abs=1e-12)
    along = [s.point[0] for s in between]
    assert along == sorted(along)
    assert along[0] > 0.25
    assert along[-1] < END


def test_a_seam_that_crosses_a_locus_does_not_end_there() -> None:
    def crossing(t: float) -> State:
        return replace(state(END), point=np.array([t, 0.0, 0.5 * (END - t)]))

    assert (
        landing(
            lambda length: crossing(0.25 + length),
            lambda near: crossing(near.point[0]),
            off,
            crossing(0.25),
        )
        is None
    )


def test_what_leaves_the_end_of_an_axis() -> None:
    """On the ridge's axis, where its end is as far as its side: one seam, between both edges."""
    geometry = decomp.Geometry(SHAPES["ridge"]())
    points = SeamPoints(RegionContext(geometry.index, 0))
    place = np.array([2.2, 2.2, 2.4])
    touching = points.contacts.at(place, points.tolerances.same)
    arcs = Arcs(points.context)
    _, (ray,) = arcs.leaving(touching, place)
    names = {geometry.index.sites[touching.sites[k][0]].name for k in ray.contacts}
    assert names == {"base.zmax@2|boss.side", "base.zmax|boss.side", "boss.top"}
    assert ray.direction[2] < 0


def test_the_sheet_between_the_edges_of_a_ridge_ends_on_its_axis() -> None:
    ridge = region_of("ridge")
    edges = "base.zmax@2|boss.side", "base.zmax|boss.side"
    on = ridge.on_sheets(*edges)
    assert on[:, 0] == pytest.approx(2.2, abs=1e-12)
    assert on[:, 2].max() == pytest.approx(2.4, abs=1e-12)
    top = on[on[:, 2] > 2.4 - 1e-9]
    assert top[:, 1].min() == pytest.approx(0.5, abs=1e-9)
    assert top[:, 1].max() == pytest.approx(2.2, abs=1e-9)


@pytest.mark.parametrize(
    ("name", "centre", "edges"),
    [
        ("ball on a corner", (3.8, 2.7, 2), {"base.xmax", "base.ymax", "base.zmax"}),
        ("ball on an edge", (2, 2.7, 2), set()),
    ],
)
def test_what_leaves_the_centre_of_a_ball(
    name: str, centre: tuple[float, float, float], edges: set[str]
) -> None:
    """On a corner one seam, between the three edges; on an edge none, only their sheet."""
    geometry = decomp.Geometry(SHAPES[name]())
    points = SeamPoints(RegionContext(geometry.index, 0))
    touching = points.contacts.at(np.array(centre), points.tolerances.same)
    arcs = Arcs(points.context)
    found, rays = arcs.leaving(touching, np.array(centre))
    names = {geometry.index.sites[found.sites[k][0]].name for ray in rays for k in ray.contacts}
    assert names == {f"ball.surface|{face}" for face in edges}
    assert len(rays) == (1 if edges else 0)
    for ray in rays:
        assert (ray.direction < 0).all()
