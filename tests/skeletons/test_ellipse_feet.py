"""Feet on ellipses, beside the nearest of many points."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from decomp.boundary.topology import Convexity
from decomp.csg.model import model
from decomp.csg.primitives import Block, Cylinder, HalfSpace
from decomp.curves.ellipse import Ellipse
from decomp.geometry import Geometry
from decomp.skeletons.balls.fields import edge_foot
from decomp.vectors import dot, norm


@pytest.mark.parametrize("slope", [0.02, 0.2, 1.0])
@pytest.mark.parametrize("far", [0.5, 5.0, 500.0])
def test_nearest_point(slope: float, far: float) -> None:
    """From known feet less than a quarter turn away, and however sharp the ellipse's tips are."""
    rod = Cylinder((0, 0, -400), (0, 0, 400), 2) & HalfSpace((0, 0, 0), (1, 0, slope))
    geometry = Geometry(model(Block((-900, -900, -900), (1800, 1800, 1800)) - rod))
    boundary = geometry.regions[0]
    edge = next(e for e in boundary.edges if isinstance(e.curve, Ellipse))
    assert edge.convexity is Convexity.REENTRANT
    curve = edge.curve
    rng = np.random.default_rng(3)
    t = rng.uniform(0, 2 * pi, 40)
    points = curve.point(t) + far * rng.normal(size=(40, 3))
    dense = curve.point(np.linspace(0, 2 * pi, 20001))
    gaps = norm(points[:, None] - dense[None])
    nearest = dense[np.argmin(gaps, axis=1)]
    turned = curve.parameter(nearest) + rng.uniform(-0.3, 0.3, 40)
    feet = edge_foot(boundary, edge, points, curve.point(turned))
    s = curve.parameter(feet)
    assert norm(feet - curve.point(s)) == pytest.approx(0.0, abs=1e-12 * boundary.diagonal)
    away, along = points - feet, curve.derivative(s)
    assert np.abs(dot(away, along)) == pytest.approx(
        0.0, abs=1e-12 * boundary.diagonal * float(norm(along).max())
    )
    two_minima = norm(away) > gaps.min(axis=1) + 1e-4
    assert two_minima.mean() < 0.1


@pytest.mark.parametrize("lost", [np.nan, np.inf])
def test_points_that_are_none_have_no_foot(lost: float) -> None:
    """Newton's method elsewhere may ask for them: the answer is none, and it comes."""
    rod = Cylinder((0, 0, -4), (0, 0, 4), 2) & HalfSpace((0, 0, 0), (1, 0, 1))
    geometry = Geometry(model(Block((-9, -9, -9), (18, 18, 18)) - rod))
    boundary = geometry.regions[0]
    edge = next(e for e in boundary.edges if isinstance(e.curve, Ellipse))
    known = edge.curve.point(np.array([0.3]))
    assert np.isnan(edge_foot(boundary, edge, np.array([[lost, 0, 0]]), known)).any()
