"""One table of carriers of every kind, plain and in odd places, for the laws that all must pass."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.carriers import (
    Carrier,
    Cone,
    Cylinder,
    EllipticCylinder,
    Plane,
    Sphere,
    Torus,
)
from decomp.vectors import Array, dot, norm, perpendicular

ROUNDING = 1e-14
"""Of lengths of about 1."""
PLACE = np.array([0.3, -0.7, 0.4])
AXIS = np.array([2.0, -3.0, 6.0]) / 7
SIDE = perpendicular(AXIS)
Z = np.array([0.0, 0.0, 1.0])
X = np.array([1.0, 0.0, 0.0])
ORIGIN = np.zeros(3)

CARRIERS: dict[str, Carrier] = {
    "plane": Plane(ORIGIN, Z),
    "plane, tilted": Plane(PLACE, AXIS),
    "sphere": Sphere(PLACE, 1.3),
    "cylinder": Cylinder(ORIGIN, Z, 0.8),
    "cylinder, tilted": Cylinder(PLACE, AXIS, 1.1),
    "cone": Cone(ORIGIN, Z, 0.5),
    "cone, tilted": Cone(PLACE, AXIS, 1.0),
    "torus": Torus(ORIGIN, Z, 1.5, 0.4),
    "torus, tilted": Torus(PLACE, AXIS, 1.1, 0.6),
    "elliptic cylinder": EllipticCylinder(ORIGIN, Z, X, 1.2, 0.7),
    "elliptic cylinder, tilted": EllipticCylinder(PLACE, AXIS, SIDE, 1.4, 0.9),
    "elliptic cylinder, nearly round": EllipticCylinder(PLACE, AXIS, SIDE, 1.0 + 1e-9, 1.0),
    "elliptic cylinder, flat": EllipticCylinder(PLACE, AXIS, SIDE, 1.5, 0.3),
}

every_carrier = pytest.mark.parametrize("carrier", CARRIERS.values(), ids=CARRIERS)


def on_carrier(carrier: Carrier, count: int = 200, seed: int = 0) -> Array:
    """Points (count, 3) scattered on a carrier, away from its tip."""
    rng = np.random.default_rng(seed)
    points = np.empty((0, 3))
    while len(points) < count:
        found = carrier.project(PLACE + 1.5 * rng.normal(size=(4 * count, 3)))
        if carrier.tip is not None:
            found = found[norm(found - carrier.tip) > 0.5]
        points = np.concatenate([points, found])
    return points[:count]


def room(carrier: Carrier) -> float:
    """A distance from the points of `on_carrier` within which feet are unique."""
    bend = min(carrier.least_radius, 1.0)
    return 0.4 * (bend if carrier.tip is None else bend * 0.25)


def tangents(carrier: Carrier, q: Array, seed: int = 1) -> Array:
    """Unit tangents (n, 3), in odd directions, at points (n, 3) of a carrier."""
    normal = carrier.normal(q)
    way = np.random.default_rng(seed).normal(size=q.shape)
    way = way - dot(way, normal)[:, None] * normal
    return np.asarray(way / norm(way)[:, None])
