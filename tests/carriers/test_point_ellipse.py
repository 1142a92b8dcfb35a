"""The nearest point of an ellipse: the nearest of all, wherever the point is."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.carriers.ellipse_arc import arc_angle, arc_length, perimeter
from decomp.carriers.point_ellipse import nearest_on_ellipse
from decomp.vectors import Array

AXES = [(3.0, 2.0), (1.0, 1.0), (1.0 + 1e-12, 1.0), (5.0, 0.05), (1e6, 1.0), (2e-40, 1e-40)]


def _places(a: float, b: float) -> Array:
    """Points (k, 2) anywhere, on both axes, and beside the evolute, its cusps above all."""
    rng = np.random.default_rng(4)
    line, near = np.linspace(-2, 2, 33), 10.0 ** -np.arange(18.0)
    t = rng.uniform(0, 2 * np.pi, 200)
    evolute = (a - b) * (a + b) * np.stack([np.cos(t) ** 3 / a, -(np.sin(t) ** 3) / b], axis=1)
    cusp = (a - b) * (a + b) / a
    return np.concatenate(
        [
            rng.normal(size=(300, 2)) * [2 * a, 2 * b],
            np.stack([a * line, 0 * line], axis=1),
            np.stack([0 * line, b * line], axis=1),
            np.stack([cusp * (1 - near), b * near[::-1]], axis=1),
            np.stack([cusp * (1 + near), b * near], axis=1),
            evolute,
        ]
    )


@pytest.mark.parametrize(("a", "b"), AXES)
def test_no_point_of_the_ellipse_is_nearer(a: float, b: float) -> None:
    p = _places(a, b)
    c, s = nearest_on_ellipse(p[:, 0], p[:, 1], np.array(a), np.array(b))
    assert np.hypot(c, s) == pytest.approx(1.0, abs=1e-15)
    away = np.hypot(p[:, 0] - a * c, p[:, 1] - b * s)
    # all around, and closely beside what was found
    fine = np.arctan2(s, c)[:, None] + np.concatenate([[0], 10.0 ** -np.arange(1, 9)])
    for t in (np.linspace(0, 2 * np.pi, 4001)[None], fine, 2 * np.arctan2(s, c)[:, None] - fine):
        others = np.hypot(p[:, :1] - a * np.cos(t), p[:, 1:] - b * np.sin(t)).min(axis=1)
        assert (away <= others + 2e-15 * (a + np.abs(p).max(axis=1))).all()


@pytest.mark.parametrize(("a", "b"), AXES)
def test_it_keeps_to_the_quadrant(a: float, b: float) -> None:
    p = _places(a, b)
    c, s = nearest_on_ellipse(p[:, 0], p[:, 1], np.array(a), np.array(b))
    assert (c * p[:, 0] >= 0).all()
    assert (s * p[:, 1] >= 0).all()
    # on the major axis, between the cusps of the evolute, there are two: the upper one is told
    assert (s >= 0)[p[:, 1] == 0].all()


@pytest.mark.parametrize(("a", "b"), AXES)
def test_angles_are_found_from_lengths(a: float, b: float) -> None:
    angle = np.concatenate([np.linspace(-7, 7, 301), np.pi / 2 * np.arange(-4, 5)])
    length = arc_length(angle, a, b)
    assert arc_length(np.array([2 * np.pi]), a, b)[0] == pytest.approx(perimeter(a, b), rel=1e-14)
    assert arc_length(arc_angle(length, a, b), a, b) == pytest.approx(length, abs=1e-14 * 7 * a)
    # by sums over short chords, whose error falls with the square of their length
    t = np.linspace(0.3, 1.9, 20001)
    chords = np.hypot(a * np.diff(np.cos(t)), b * np.diff(np.sin(t))).sum()
    ends = arc_length(t[[0, -1]], a, b)
    assert ends[1] - ends[0] == pytest.approx(chords, rel=1e-8)
