"""Laws of distance, foot, normal, curvature, boxes and moves that every carrier obeys."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
import pytest
from numba import njit

from decomp import similarity
from decomp.carriers import Carrier, CarrierTable, Plane
from decomp.carriers.compiled_carriers import CarrierTable as Compiled
from decomp.carriers.compiled_carriers import (
    carrier_table,
    foot,
    foot_spread,
    normal_curvature,
    signed_distance,
)
from decomp.carriers.kinds import KINDS
from decomp.carriers.on_carriers import normals_at, projected
from decomp.similarity import Similarity
from decomp.vectors import Array, norm
from tests.carriers.kinds import (
    AXIS,
    CARRIERS,
    PLACE,
    ROUNDING,
    every_carrier,
    on_carrier,
    room,
    tangents,
)


@pytest.fixture
def somewhere() -> Array:
    """Points (k, 3) near and far, on axes too."""
    rng = np.random.default_rng(5)
    scattered = PLACE + rng.normal(size=(300, 3)) * rng.choice([0.3, 1.0, 5.0], size=(300, 1))
    line = np.linspace(-2, 2, 21)[:, None]
    return np.concatenate([scattered, PLACE + line * AXIS, line * [0, 0, 1], line * [1, 0, 0]])


def test_all_kinds_are_in_the_table() -> None:
    assert {type(carrier) for carrier in CARRIERS.values()} == set(KINDS.values())


@every_carrier
def test_feet_are_on_the_carrier_as_far_away_as_it_is(carrier: Carrier, somewhere: Array) -> None:
    feet, distance = carrier.foot(somewhere), carrier.signed_distance(somewhere)
    assert np.abs(carrier.signed_distance(feet)).max() < ROUNDING
    assert np.abs(carrier.implicit(feet)).max() < 10 * ROUNDING
    assert norm(somewhere - feet) == pytest.approx(np.abs(distance), abs=10 * ROUNDING)


@every_carrier
def test_no_point_of_the_carrier_is_nearer_than_the_foot(
    carrier: Carrier, somewhere: Array
) -> None:
    known = on_carrier(carrier, 2000)
    nearest = np.array([norm(known - p).min() for p in somewhere])
    assert (np.abs(carrier.signed_distance(somewhere)) <= nearest + ROUNDING).all()


@every_carrier
def test_along_a_normal_feet_stay_and_distances_grow(carrier: Carrier) -> None:
    q = on_carrier(carrier)
    for step in room(carrier) * np.array([-1.0, -0.3, 1e-6, 0.5, 1.0]):
        p = q + step * carrier.normal(q)
        assert norm(carrier.foot(p) - q).max() < 30 * ROUNDING
        assert carrier.signed_distance(p) == pytest.approx(step, abs=ROUNDING)
        assert norm(carrier.normal(p) - carrier.normal(q)).max() < 50 * ROUNDING


@every_carrier
def test_normals_are_gradients_of_distance_and_polynomial(carrier: Carrier) -> None:
    q, step = on_carrier(carrier), 1e-5
    for function in (carrier.signed_distance, carrier.implicit):
        ways = [function(q + step * unit) - function(q - step * unit) for unit in np.eye(3)]
        slope = np.stack(ways, axis=-1) / (2 * step)
        if function == carrier.implicit:
            slope = slope / norm(slope)[:, None]
        assert slope == pytest.approx(np.array(carrier.normal(q)), abs=1e-8)


@every_carrier
def test_curvature_is_the_second_derivative_of_the_distance(carrier: Carrier) -> None:
    q = on_carrier(carrier)
    way, step = tangents(carrier, q), 1e-3 * min(carrier.least_radius, 1.0)
    both = carrier.signed_distance(q + step * way) + carrier.signed_distance(q - step * way)
    bend = carrier.normal_curvature(q, way)
    assert both / step**2 == pytest.approx(bend, rel=1e-5, abs=1e-5)
    assert (np.abs(bend) <= (1 + 1e-9) / carrier.least_radius).all() or np.isinf(
        carrier.least_radius
    )


@njit  # type: ignore[untyped-decorator]
def _bends(table: Compiled, points: Array, ways: Array) -> Array:
    result = np.empty(len(points))
    for i in range(len(points)):
        x, y, z = points[i]
        dx, dy, dz = ways[i]
        result[i] = normal_curvature(table, 0, x, y, z, dx, dy, dz)
    return result


@every_carrier
def test_the_kernels_curvature_is_the_same(carrier: Carrier) -> None:
    q = on_carrier(carrier)
    way = tangents(carrier, q)
    found = _bends(carrier_table([carrier]), q, way)
    assert found == pytest.approx(carrier.normal_curvature(q, way), rel=1e-12, abs=1e-14)


@every_carrier
def test_boxes_hold_what_they_are_of(carrier: Carrier, somewhere: Array) -> None:
    def held(box: Array, points: Array) -> bool:
        return bool(((points >= box[0] - ROUNDING) & (points <= box[1] + ROUNDING)).all())

    inner, outer = carrier.half_space_boxes()
    inside = carrier.signed_distance(somewhere) < 0
    assert held(carrier.box(), on_carrier(carrier, 2000))
    assert held(inner, somewhere[inside])
    assert held(outer, somewhere[~inside])
    if carrier.closed:
        assert np.isfinite(carrier.box()).all()


@every_carrier
def test_tables_and_kernels_agree_to_rounding(carrier: Carrier, somewhere: Array) -> None:
    # among others, so that rows and kinds matter
    table = [*CARRIERS.values(), carrier]
    rows = np.full(len(somewhere), len(table) - 1)
    distance = carrier.signed_distance(somewhere)
    together = CarrierTable(table).distances(somewhere, rows[:1])[0]
    assert together == pytest.approx(distance, abs=ROUNDING)
    compiled = carrier_table(table)
    found = _found(compiled, rows[0], somewhere)
    assert found[:, 0] == pytest.approx(distance, abs=ROUNDING)
    assert norm(somewhere - found[:, 1:]) == pytest.approx(np.abs(distance), abs=10 * ROUNDING)
    q = on_carrier(carrier, len(somewhere))
    p = q + room(carrier) * carrier.normal(q)
    assert norm(projected(compiled, rows, p) - q).max() < 30 * ROUNDING
    assert norm(normals_at(compiled, rows, q) - carrier.normal(q)).max() < 30 * ROUNDING


@njit  # type: ignore[untyped-decorator]
def _found(table: Compiled, row: int, points: Array) -> Array:
    result = np.empty((len(points), 4))
    for i in range(len(points)):
        x, y, z = points[i]
        result[i, 0] = signed_distance(table, row, x, y, z)
        result[i, 1], result[i, 2], result[i, 3] = foot(table, row, x, y, z)
    return result


@njit  # type: ignore[untyped-decorator]
def _spread(table: Compiled, points: Array, radius: float) -> Array:
    result = np.empty(len(points))
    for i in range(len(points)):
        x, y, z = points[i]
        result[i] = foot_spread(table, 0, x, y, z, radius)
    return result


@every_carrier
def test_feet_of_a_ball_spread_no_farther_than_said(carrier: Carrier, somewhere: Array) -> None:
    rng, radius = np.random.default_rng(2), 0.2
    most = _spread(carrier_table([carrier]), somewhere, radius)
    feet = carrier.foot(somewhere)
    for _ in range(20):
        way = rng.normal(size=somewhere.shape)
        moved = carrier.foot(somewhere + radius * way / norm(way)[:, None])
        assert (norm(moved - feet) <= most * (1 + 1e-12)).all()


@every_carrier
@pytest.mark.parametrize(
    "by",
    [
        similarity.rotation((1, 2, 3), 40, (0.5, 0, 0)),
        similarity.translation((3, -2, 1)),
        similarity.reflection((1, 1, 0)),
        similarity.scaling(2.5).after(similarity.rotation((0, 1, 1), 70)),
    ],
    ids=["rotation", "translation", "mirror", "scale"],
)
def test_distances_follow_a_similarity(carrier: Carrier, by: Similarity, somewhere: Array) -> None:
    moved = carrier.transformed(by)
    there = moved.signed_distance(by.points(somewhere))
    assert there == pytest.approx(by.scale * carrier.signed_distance(somewhere), abs=1e-13)
    assert moved.kind == carrier.kind


@every_carrier
def test_a_carrier_coincides_with_itself_alone(carrier: Carrier) -> None:
    off = carrier.transformed(similarity.translation((1e-3, 2e-3, 3e-3)))
    assert carrier.coincides(carrier, 1e-12, 10.0) == 1
    # one turn, in parts, comes back but for rounding
    turn = similarity.rotation((1, 2, 3), 120)
    again = carrier.transformed(turn).transformed(turn).transformed(turn)
    assert carrier.coincides(again, 1e-12, 10.0) == 1
    assert carrier.features(10.0) == pytest.approx(again.features(10.0), abs=1e-12)
    assert carrier.coincides(off, 1e-6, 10.0) == 0
    for other in CARRIERS.values():
        if other.kind != carrier.kind:
            assert carrier.coincides(other, 1e-6, 10.0) == 0


@every_carrier
def test_lines_meet_it_at_the_roots(carrier: Carrier) -> None:
    rng, rows = np.random.default_rng(3), carrier.packed()[None]
    if carrier.degree > 2:
        with pytest.raises(TypeError):
            carrier.along_line(rows, PLACE, AXIS)
        return
    roots = 0
    for _ in range(50):
        origin, way = PLACE + rng.normal(size=3), rng.normal(size=3)
        way /= norm(way)
        q, h, c = (float(x[0]) for x in carrier.along_line(rows, origin, way))
        found = np.roots([q, 2 * h, c] if q else [2 * h, c])
        real = found[np.abs(found.imag) == 0].real
        roots += len(real)
        points = origin + real[:, None] * way
        assert np.abs(carrier.implicit(points)).max(initial=0.0) < 1e-12 * (
            1 + (real**2).max(initial=0.0)
        )
        sign = carrier.signed_distance(origin + np.linspace(-20, 20, 4001)[:, None] * way) < 0
        assert np.count_nonzero(sign[1:] != sign[:-1]) <= len(real)
    assert roots > 20


def test_unknown_kinds_are_refused_by_every_table() -> None:
    class Saddle(Plane):
        kind: ClassVar[str] = "saddle"
        code: ClassVar[int] = 77

    class Lookalike(Plane):
        pass

    for made in (Saddle, Lookalike):
        odd = made(PLACE, AXIS)
        for table in (CarrierTable, carrier_table):
            with pytest.raises(TypeError, match=f"{made.__name__} is no known kind of carrier"):
                table([CARRIERS["sphere"], odd])
