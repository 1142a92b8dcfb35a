"""Feet on a traced curve that winds about an axis, from which all of it is nearly as far.

A cone is stuck through a rod at right angles, beside its axis: from a point of the axis the nearest
places of the curve in which they meet are those at its own height, and as far as the rod is wide.
"""

from __future__ import annotations

import numpy as np
import pytest

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.csg.model import model
from decomp.csg.primitives import Cone, Cylinder
from decomp.curves.traced import TracedCurve
from decomp.geometry import Geometry
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.legs import legs
from decomp.vectors import Array, norm

RADIUS = 0.85


@pytest.fixture(scope="module")
def geometry() -> Geometry:
    rod = Cylinder((0, 0, -2), (0, 0, 2), RADIUS)
    return Geometry(model(rod | Cone((0.67, -2.2, -0.25), 0.53, (0.67, 0.76, -0.25), 0.21)))


@pytest.fixture(scope="module")
def edge(geometry: Geometry) -> Edge:
    boundary = geometry.regions[0]
    return next(e for e in boundary.edges if isinstance(e.curve, TracedCurve))


def _places(edge: Edge, count: int) -> Array:
    t = np.linspace(edge.start, edge.end, count, endpoint=False)
    return edge.curve.point(edge.curve.wrapped(t))


def _axis(edge: Edge) -> Array:
    z = _places(edge, 20_000)[:, 2]
    at = np.linspace(z.min(), z.max(), 100)[1:-1]
    return np.stack([0 * at, 0 * at, at], axis=1)


def _boundary(geometry: Geometry) -> RegionBoundary:
    return geometry.boundaries.regions[0]


def test_the_nearest_leg_is_found(geometry: Geometry, edge: Edge) -> None:
    """Samples tell the wrong one of some points, and Newton's method leaves the place of others."""
    incidence = Incidence(RegionContext(geometry.index, 0))
    number = next(k for k, e in enumerate(_boundary(geometry).edges) if e.curve is edge.curve)
    points = _axis(edge)
    feet = incidence.feet([incidence.edge_site[number]], points)[:, 0]
    assert norm(feet - points) == pytest.approx(RADIUS, abs=1e-12)


def test_legs_that_can_be_nearest() -> None:
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    circle = np.stack([3 * np.cos(t), np.sin(t), 0 * t], axis=1)
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.5, 0.0]])
    rows, samples = legs(circle, True, points)
    assert rows.tolist() == [0, 0]
    assert circle[samples, 1].tolist() == pytest.approx([1.0, -1.0])
    # the ends of an open edge are no legs
    assert not len(legs(circle[10:31], False, points)[0])
