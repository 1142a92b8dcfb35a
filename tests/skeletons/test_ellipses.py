"""Edges that are ellipses, and sheets in the planes of two that cross."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.boundary.topology import Convexity
from decomp.curves import Ellipse
from decomp.skeletons.balls.fields import support_fields
from decomp.skeletons.balls.supports import ELLIPSE, support_table
from decomp.skeletons.sheets.flat_parts import flat_parts
from decomp.vectors import norm
from tests.skeletons.coincidences import equal_tee


def test_feet_stay_on_their_ellipse() -> None:
    """Also close to where another edge of the same two cylinders crosses it."""
    geometry = decomp.Geometry(equal_tee())
    boundary = geometry.regions[0]
    table = support_table(boundary, geometry.sites)
    seen = 0
    for number, edge in enumerate(boundary.edges):
        if edge.convexity is not Convexity.REENTRANT:
            continue
        curve = edge.curve
        assert isinstance(curve, Ellipse)
        row = table.first_edge + number
        assert table.kinds[row] == ELLIPSE
        t = np.linspace(edge.start, edge.end, 41)
        q, along = curve.point(t), curve.derivative(t)
        along /= norm(along)[:, None]
        # across the curve, and less far than to its centre of curvature
        across = np.cross(along, np.array([0.3, -0.5, 0.8]))
        found = support_fields(table, np.full(41, row), q + 0.4 * across, q + 0.05 * along)
        assert norm(found.foot - q).max() <= 1e-12
        assert found.distance == pytest.approx(0.4 * norm(across), abs=1e-12)
        seen += 1
    assert seen == 2


def test_lines_are_parted_by_their_planes() -> None:
    """The shared line is in both; a line in space is in none."""
    t = np.linspace(0, np.pi, 9)
    up = np.stack([np.sin(t), np.cos(t), np.sin(t)], axis=1)
    down = up * [-1, 1, 1]
    shared = np.array([[0, 1, 0], [0, 1.5, 0]])
    space = np.stack([np.cos(t), np.sin(t), t], axis=1)
    points = np.concatenate([up, down, shared, space])
    one, other, both, bent = np.split(np.arange(29), [9, 18, 20])
    parts = flat_parts(points, [one, other, both], 1e-12)
    assert parts is not None
    assert [[line[0] for line in part] for part in parts] == [[0, 18], [9, 18]]
    assert flat_parts(points, [one, both], 1e-12) is None
    assert flat_parts(points, [one, other, both, bent], 1e-12) is None
