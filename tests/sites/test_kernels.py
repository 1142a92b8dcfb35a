"""Compiled carriers against `decomp.carriers`, and how kernels are compiled."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.sites import compiled
from decomp.sites.carrier_kernels import (
    carrier_table,
    foot,
    foot_spread,
    normal,
    signed_distance,
)
from decomp.vectors import direction, frozen

POINT, AXIS = frozen([0.3, -0.2, 0.1]), direction([1, 2, 2], "axis")
CARRIERS = [
    Plane(POINT, AXIS),
    Sphere(POINT, 0.7),
    Cylinder(POINT, AXIS, 0.7),
    Cone(POINT, AXIS, 0.5),
    Torus(POINT, AXIS, 1.2, 0.4),
]
# all around, on the axis, and at the reference point
PLACES = np.concatenate(
    [np.random.default_rng(0).normal(size=(200, 3)), POINT + np.outer([-1, 0, 0.5, 2], AXIS)]
)


@pytest.mark.parametrize("carrier", CARRIERS, ids=lambda c: c.kind)
def test_kernels_equal_carriers(carrier: Carrier) -> None:
    table = carrier_table([CARRIERS[0], carrier])
    away = [signed_distance(table, 1, *p) for p in PLACES]
    np.testing.assert_allclose(away, carrier.signed_distance(PLACES), atol=1e-14)
    feet = np.array([foot(table, 1, *p) for p in PLACES])
    gaps = np.linalg.norm(PLACES - feet, axis=1)
    np.testing.assert_allclose(gaps, np.abs(away), atol=1e-14)
    np.testing.assert_allclose(feet[:200], carrier.foot(PLACES[:200]), atol=1e-14)
    on = carrier.project(PLACES[:200])
    on = on[np.linalg.norm(on - POINT, axis=1) > 1e-9]  # a cone has no normal at its apex
    normals = [normal(table, 1, *q) for q in on]
    np.testing.assert_allclose(normals, carrier.normal(on), atol=1e-13)


@pytest.mark.parametrize("carrier", CARRIERS, ids=lambda c: c.kind)
def test_feet_stay_within_their_spread(carrier: Carrier) -> None:
    table, rng = carrier_table([carrier]), np.random.default_rng(1)
    for p in PLACES[:100]:
        near = rng.normal(size=(20, 3))
        near = p + 0.2 * near / np.linalg.norm(near, axis=1)[:, None]
        moved = np.linalg.norm(carrier.foot(near) - carrier.foot(p), axis=1)
        assert moved.max() <= foot_spread(table, 0, *p, 0.2) * (1 + 1e-12)


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
