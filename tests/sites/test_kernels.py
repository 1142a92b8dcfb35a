"""Compiled carriers against `decomp.carriers`, and how kernels are compiled."""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numba import njit

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.carriers.compiled_carriers import (
    CarrierTable,
    carrier_table,
    foot,
    foot_spread,
    normal,
    signed_distance,
)
from decomp.carriers.on_carriers import normals_at, projected
from decomp.kernels import compiled
from decomp.kernels.records import Record
from decomp.vectors import Array, direction, frozen

POINT, AXIS = frozen([0.3, -0.2, 0.1]), direction([1, 2, 2], "axis")
CARRIERS = [
    Plane(POINT, AXIS),
    Sphere(POINT, 0.7),
    Cylinder(POINT, AXIS, 0.7),
    Cone(POINT, AXIS, 0.5),
    Torus(POINT, AXIS, 1.2, 0.4),
]
distance_from, foot_on = njit(signed_distance.py_func), njit(foot.py_func)
normal_at, spread_of = njit(normal.py_func), njit(foot_spread.py_func)
# all around, on the axis, and at the reference point
PLACES = np.concatenate(
    [np.random.default_rng(0).normal(size=(200, 3)), POINT + np.outer([-1, 0, 0.5, 2], AXIS)]
)


@pytest.mark.parametrize("carrier", CARRIERS, ids=lambda c: c.kind)
def test_kernels_equal_carriers(carrier: Carrier) -> None:
    table = carrier_table([CARRIERS[0], carrier])
    away = [distance_from(table, 1, *p) for p in PLACES]
    np.testing.assert_allclose(away, carrier.signed_distance(PLACES), atol=1e-14)
    feet = np.array([foot_on(table, 1, *p) for p in PLACES])
    gaps = np.linalg.norm(PLACES - feet, axis=1)
    np.testing.assert_allclose(gaps, np.abs(away), atol=1e-14)
    np.testing.assert_allclose(feet[:200], carrier.foot(PLACES[:200]), atol=1e-14)
    on = carrier.project(PLACES[:200])
    on = on[np.linalg.norm(on - POINT, axis=1) > 1e-9]  # a cone has no normal at its apex
    normals = [normal_at(table, 1, *q) for q in on]
    np.testing.assert_allclose(normals, carrier.normal(on), atol=1e-13)


def test_many_points_each_on_a_carrier_of_its_own() -> None:
    which = np.arange(len(PLACES[:200])) % len(CARRIERS)
    feet = projected(carrier_table(CARRIERS), which, PLACES[:200])
    normals = normals_at(carrier_table(CARRIERS), which, feet)
    for k, carrier in enumerate(CARRIERS):
        own = which == k
        np.testing.assert_allclose(feet[own], carrier.project(PLACES[:200][own]), atol=1e-14)
        smooth = own & (np.linalg.norm(feet - POINT, axis=1) > 1e-9)  # not at the cone's apex
        np.testing.assert_allclose(normals[smooth], carrier.normal(feet[smooth]), atol=1e-13)


@pytest.mark.parametrize("carrier", CARRIERS, ids=lambda c: c.kind)
def test_feet_stay_within_their_spread(carrier: Carrier) -> None:
    table, rng = carrier_table([carrier]), np.random.default_rng(1)
    for p in PLACES[:100]:
        near = rng.normal(size=(20, 3))
        near = p + 0.2 * near / np.linalg.norm(near, axis=1)[:, None]
        moved = np.linalg.norm(carrier.foot(near) - carrier.foot(p), axis=1)
        assert moved.max() <= spread_of(table, 0, *p, 0.2) * (1 + 1e-12)


@dataclass(frozen=True, eq=False)
class Row(Record):
    number: int
    table: CarrierTable
    part: float
    grid: Array


@compiled.scalar
def _total(row: Row) -> float:
    total = row.number + row.part
    for i in range(row.grid.shape[0]):
        for j in range(row.grid.shape[1]):
            total += row.grid[i, j] * row.table.codes[i]
    row.grid[0, 0] = total
    return total


def test_records_are_read_and_filled_in_place() -> None:
    row = Row(7, carrier_table(CARRIERS[1:4]), 0.25, np.arange(6.0).reshape(3, 2))
    codes = [c.code for c in CARRIERS[1:4]]
    total = 7.25 + float((row.grid.sum(axis=1) * codes).sum())
    assert _total(row) == row.grid[0, 0] == total
    other = pickle.loads(pickle.dumps(row))
    assert _total(other) == total + codes[0] * total
    assert row.grid[0, 0] == total


def test_records_refuse_what_kernels_would_misread() -> None:
    table = carrier_table(CARRIERS)
    for bad in (np.zeros((4, 4))[:, ::2], np.zeros(3).tolist()):
        with pytest.raises(TypeError):
            _total(Row(1, table, 0.5, bad))  # type: ignore[arg-type]


def test_inner_kernels_are_compiled_once_and_not_called_from_python() -> None:
    def twice(x: float) -> float:
        return 2 * x

    inner = compiled.inner(twice)

    @compiled.scalar
    def outer(i: int, short: np.int32) -> float:
        return inner(i) + inner(3) + inner(short)

    assert outer(1, np.int32(2)) == 12
    assert len(inner.overloads) == 1  # type: ignore[attr-defined]
    with pytest.raises(TypeError, match="only compiled kernels"):
        inner(1)


def test_kernels_compile_without_a_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    original = compiled.njit

    def uncached(**options: Any) -> Any:
        if options.get("cache"):
            raise RuntimeError("cannot cache function: no locator available")
        return original(**options)

    monkeypatch.setattr(compiled, "njit", uncached)

    def double(x: float) -> float:
        return 2 * x

    assert compiled.scalar(double)(1.5) == 3.0
