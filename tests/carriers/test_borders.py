"""Laws of what boundaries ask of a carrier: frames, rulings, far and extreme points, integrals."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.carriers import Carrier, Plane
from decomp.carriers.base import Border
from decomp.errors import GeometryError
from decomp.vectors import Array, cross, dot, norm
from tests.carriers.kinds import PLACE, ROUNDING, every_carrier, on_carrier, tangents


@every_carrier
def test_frames_are_right_handed_about_the_normal(carrier: Carrier) -> None:
    q = on_carrier(carrier)
    way, pole = tangents(carrier, q), np.array([0.6, 0.0, 0.8])
    one = np.stack(carrier.in_frames(q, way, pole), axis=-1)
    two = np.stack(carrier.in_frames(q, cross(carrier.normal(q), way), pole), axis=-1)
    turned = np.stack([-one[:, 1], one[:, 0]], axis=-1)
    assert two / norm(one)[:, None] == pytest.approx(turned / norm(one)[:, None], abs=1e-9)


@every_carrier
def test_rulings_lie_on_it_and_lead_up(carrier: Carrier) -> None:
    for q in on_carrier(carrier, 20):
        way = carrier.ruling(q)
        if way is None:
            assert carrier.closed
            continue
        line = q + np.linspace(0, 2, 9)[:, None] * way
        assert np.abs(carrier.signed_distance(line)).max() < ROUNDING
        assert (np.diff(carrier.rise(line)) > 0).all()


@every_carrier
def test_levels_lie_on_it_across_its_rulings(carrier: Carrier) -> None:
    for q in on_carrier(carrier, 20):
        found, way = carrier.level(q), carrier.ruling(q)
        if found is None:
            assert carrier.closed or carrier.flat
            continue
        t = np.linspace(0, 2 * np.pi, 721)[:, None]
        curve = found.centre + found.a * np.cos(t) * found.x + found.b * np.sin(t) * found.y
        assert np.abs(carrier.signed_distance(curve)).max() < 10 * ROUNDING
        assert norm(curve - q).min() < 0.02
        assert way is not None
        assert np.ptp(carrier.rise(curve)) < 10 * ROUNDING


@every_carrier
@pytest.mark.parametrize("tip", [False, True])
def test_charts_are_one_to_one_and_keep_their_sense(carrier: Carrier, tip: bool) -> None:
    pole = np.array([0.6, 0.0, 0.8]) if carrier.needs_pole else None
    chart = carrier.chart(tip, 1.3, pole)
    q = on_carrier(carrier)
    plane = chart.to_plane(q)
    assert norm(chart.to_space(plane) - q).max() < 1e-12
    for k, period in enumerate(chart.period):
        if period is not None:
            moved = plane + period * np.eye(2)[k]
            assert norm(chart.to_space(moved) - q).max() < 1e-12
            assert np.ptp(plane[:, k]) <= period
    # steps along (u, v) turn about the normal as these do
    step = 1e-5
    along, across = (
        chart.to_space(plane + step * unit) - chart.to_space(plane - step * unit)
        for unit in np.eye(2)
    )
    sense = dot(cross(along, across), carrier.normal(q))
    assert (sense > 0.3 * norm(along) * norm(across)).all()


@every_carrier
def test_points_around_a_tip_are_on_it(carrier: Carrier) -> None:
    ring = carrier.around_tip(0.1)
    assert (carrier.tip is None) == (carrier.tip_axis is None) == (not len(ring))
    if carrier.tip is not None and carrier.tip_axis is not None:
        assert np.abs(carrier.signed_distance(ring)).max() < ROUNDING
        assert norm(ring - carrier.tip) == pytest.approx(0.1)
        assert float(carrier.signed_distance(carrier.tip + carrier.tip_axis)) < 0


@every_carrier
@pytest.mark.parametrize("outward", [1, -1])
def test_normals_lead_to_the_reflexive_locus(carrier: Carrier, outward: int) -> None:
    q = on_carrier(carrier)
    gap = carrier.reflexive_gap(outward, q)
    assert (carrier.locus is None) <= bool(np.isinf(gap).all())
    if carrier.locus is None:
        with pytest.raises(GeometryError, match=carrier.kind):
            carrier.inner_radius(outward, q)
        return
    if np.isinf(gap).all():
        assert outward < 0
        return
    radius = carrier.inner_radius(outward, q)
    if not carrier.closed or outward > 0:
        assert (radius > 0).all()
    # outside a torus only the inner part of the tube faces the axis
    q, radius = q[radius > 0], radius[radius > 0]
    ends = q - outward * radius[:, None] * carrier.normal(q)
    assert carrier.reflexive_gap(outward, ends).max() < 1e-10 * (1 + radius.max())


@every_carrier
def test_far_points_are_far_out_on_it(carrier: Carrier) -> None:
    far = carrier.far_points(PLACE, 10.0)
    assert bool(far) != carrier.closed
    for point in far:
        assert abs(float(carrier.signed_distance(point))) < 1e-12
        assert float(norm(point - PLACE)) > 30


@every_carrier
def test_extreme_points_have_normals_along_coordinates(carrier: Carrier) -> None:
    points = carrier.extreme_points()
    assert bool(len(points)) == carrier.closed
    if len(points):
        assert np.abs(carrier.normal(points)).max(axis=1) == pytest.approx(1.0)
        assert np.abs(carrier.signed_distance(points)).max() < ROUNDING
        box = np.array([points.min(axis=0), points.max(axis=0)])
        assert box == pytest.approx(carrier.box(), abs=1e-13)


@every_carrier
def test_borders_tell_the_integrals_inside(carrier: Carrier) -> None:
    if carrier.degree > 2:
        pytest.skip("borders on a torus have to be unwrapped")
    middle = on_carrier(carrier, 1, seed=8)[0]
    normal = np.asarray(carrier.normal(middle[None])[0])
    x = tangents(carrier, middle[None])[0]
    y, size = cross(normal, x), 0.3 * min(carrier.least_radius, 0.5)

    def at(rho: Array, angle: Array) -> Array:
        flat = np.cos(angle)[..., None] * x + np.sin(angle)[..., None] * y
        return carrier.project(middle + rho[..., None] * flat)

    angle, step = 2 * np.pi * np.arange(128) / 128, 1e-4
    nodes, weights = np.polynomial.legendre.leggauss(16)
    rho, turn = np.meshgrid(size / 2 * (nodes + 1), angle, indexing="ij")
    out = (at(rho + step, turn) - at(rho - step, turn)) / (2 * step)
    around = (at(rho, turn + step) - at(rho, turn - step)) / (2 * step)
    patch = (size / 2 * weights[:, None] * (2 * np.pi / 128) * norm(cross(out, around))).ravel()
    points, origin, field = at(rho, turn).reshape(-1, 3), PLACE + 0.1, np.array([0.48, 0.6, 0.64])
    normals = carrier.normal(points)
    lift = dot(points - carrier.packed()[:3], normals)
    other = ((points - origin) @ field) * (normals @ field)

    rim = np.full(128, size)
    steps = (at(rim, angle + step) - at(rim, angle - step)) / (2 * step) * (2 * np.pi / 128)
    border = Border(at(rim, angle), steps)
    area, support = carrier.border_terms(border, origin, -normal)
    second = carrier.second_term(border, origin, -normal, field)
    assert area == pytest.approx(float(patch.sum()), rel=1e-6)
    flat = isinstance(carrier, Plane) or carrier.tip is not None
    assert support == pytest.approx(0.0 if flat else float(patch @ lift), rel=1e-6)
    assert second == pytest.approx(float(patch @ other), rel=1e-5, abs=1e-9)
