"""Constrained Delaunay triangulation of planes, strips and tori; crossings of segments."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from decomp.complex.plane.planar import (
    PLANE,
    Period,
    SparseError,
    Triangulation,
    crossings,
    triangulate,
)
from decomp.errors import GeometryError
from decomp.vectors import Array, Ints

NONE = np.empty((0, 2), dtype=np.int64)


def ring(first: int, count: int) -> Ints:
    """Segments of a closed polygon of `count` points from `first` on."""
    k = np.arange(count)
    return np.stack([k, np.roll(k, -1)], axis=1) + first


def areas(made: Triangulation, points: Array, period: Period = PLANE) -> Array:
    """Signed areas (m,), corners taken the shorter way round."""
    p, q, r = (points[made.triangles[:, k]] for k in range(3))
    base = np.array([b or 0.0 for b in period])

    def apart(a: Array, b: Array) -> Array:
        d = b - a
        return np.asarray(d - np.round(d / np.where(base > 0, base, 1.0)) * base)

    u, v = apart(p, q), apart(p, r)
    return np.asarray((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2)


def test_a_square_is_two_triangles() -> None:
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    made = triangulate(square, ring(0, 4))
    assert len(made.triangles) == 2
    assert made.component.tolist() == [0, 0]
    assert areas(made, square).sum() == pytest.approx(1)


def test_what_lies_outside_all_constraints_has_no_component() -> None:
    """A dart: its hull has one triangle more than itself."""
    dart = np.array([[0, 0], [2, -1], [0.5, 0], [2, 1.0]])
    made = triangulate(dart[[0, 1, 2, 3]], ring(0, 4))
    assert sorted(made.component.tolist()) == [-1, 0, 0]
    assert areas(made, dart)[made.component == 0].sum() == pytest.approx(0.5)


def test_constraints_cut_the_plane_into_parts() -> None:
    outer = np.array([[0, 0], [4, 0], [4, 4], [0, 4.0]])
    points = np.concatenate([outer, outer / 4 + 1.5, [[0.5, 0.5]]])
    made = triangulate(points, np.concatenate([ring(0, 4), ring(4, 4)]))
    assert made.components == 2
    area = areas(made, points)
    assert sorted(area[made.component == k].sum() for k in (0, 1)) == pytest.approx([1, 15])
    assert 8 in made.triangles


def test_points_on_a_segment_cut_it() -> None:
    points = np.array([[0, 0], [2, 0], [1, 0], [1, 1], [1, -1.0]])
    made = triangulate(points, np.array([[0, 1], [1, 3], [3, 0], [0, 4], [4, 1]]))
    assert made.components == 2
    assert len(made.triangles) == 4


@pytest.mark.parametrize(
    ("points", "segments"),
    [
        ([[0, 0], [1, 0], [0, 0]], []),
        ([[0, 0], [1, 1], [0, 1], [1, 0]], [[0, 1], [2, 3]]),
        ([[0, 0], [1, 0], [2, 0]], []),
        ([[0, 0], [1, 0]], []),
    ],
)
def test_what_cannot_be_triangulated_is_refused(
    points: list[list[float]], segments: list[list[int]]
) -> None:
    with pytest.raises(GeometryError):
        triangulate(np.array(points, dtype=float), np.array(segments, dtype=np.int64))


@pytest.mark.parametrize("height", [1e-3, 0.3, 1.0, 30.0])
@pytest.mark.parametrize("count", [3, 4, 7, 32])
@pytest.mark.parametrize("across", [0, 1])
def test_two_circles_on_a_cylinder_take_two_triangles_a_sample(
    height: float, count: int, across: int
) -> None:
    around = np.arange(count) / count * 2 - 5
    rows = [np.stack([around, np.full(count, z)], axis=1) for z in (0.0, height)]
    points = np.concatenate(rows)
    period: Period = (2.0, None)
    if across == 1:
        points, period = points[:, ::-1] * np.array([-1, 1]), (None, 2.0)
    made = triangulate(points, np.concatenate([ring(0, count), ring(count, count)]), period)
    assert len(made.triangles) == 2 * count
    assert made.components == 1
    assert (areas(made, points, period) > 0).all()
    assert areas(made, points, period).sum() == pytest.approx(2 * height)


def test_a_loop_across_the_period_encloses_its_inside() -> None:
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    points = np.stack([np.mod(0.3 * np.cos(angle), 2), 0.3 * np.sin(angle)], axis=1)
    made = triangulate(points, ring(0, 12), (2.0, None))
    assert made.components == 1
    assert len(made.triangles) == 10
    assert areas(made, points, (2.0, None)).sum() == pytest.approx(3 * 0.09)


def test_edges_between_the_same_points_that_go_both_ways_round_are_two() -> None:
    """A tall loop of half a period: inside and outside chords join the same corners."""
    left, right = np.linspace(-1.56, -1.38, 20), np.linspace(0.35, 0.23, 20)
    heights = np.linspace(-2.8, 0, 20)
    points = np.concatenate(
        [np.stack([left, heights], axis=1), np.stack([right, heights], axis=1)[::-1]]
    )
    made = triangulate(points, ring(0, 40), (4.232, None))
    width = (right[1:] + right[:-1] - left[1:] - left[:-1]) / 2
    assert made.components == 1
    assert areas(made, points, (4.232, None)).sum() == pytest.approx(width @ np.diff(heights))


def test_centroids_are_those_of_the_unwrapped_triangles() -> None:
    points = np.array([[0.9, 0.0], [0.1, 0.0], [0.0, 0.3]])
    made = triangulate(points, ring(0, 3), (1.0, None))
    assert made.centroids == pytest.approx(np.array([[0.0, 0.1]]), abs=1e-9) or (
        made.centroids == pytest.approx(np.array([[1.0, 0.1]]), abs=1e-9)
    )


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.integers(150, 400))
def test_points_on_a_torus_are_triangulated_all_round(seed: int, count: int) -> None:
    points = np.random.default_rng(seed).random((count, 2)) * [2, 1]
    made = triangulate(points, NONE, (2.0, 1.0))
    assert len(made.triangles) == 2 * count
    assert areas(made, points, (2.0, 1.0)).sum() == pytest.approx(2)


@pytest.mark.parametrize("count", [3, 4, 5, 8])
def test_a_regular_grid_on_a_torus_has_no_gap(count: int) -> None:
    """All squares have four corners on a circle: ties must break alike everywhere."""
    step = np.arange(count) / count
    points = np.stack(np.meshgrid(step * 2, step), axis=-1).reshape(-1, 2)
    made = triangulate(points, NONE, (2.0, 1.0))
    assert len(made.triangles) == 2 * count**2


def test_a_torus_with_too_few_points_is_refused() -> None:
    for count in (0, 1, 3, 5):
        with pytest.raises(SparseError):
            triangulate(np.random.default_rng(1).random((count, 2)), NONE, (1.0, 1.0))


def brute(points: Array, segments: Ints) -> set[tuple[int, int]]:
    """Proper crossings by the signs of areas."""

    def area(p: Array, q: Array, r: Array) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    found = set()
    for i, s in enumerate(segments):
        for j in range(i):
            t = segments[j]
            if set(s) & set(t):
                continue
            a, b, c, d = points[s[0]], points[s[1]], points[t[0]], points[t[1]]
            if area(a, b, c) * area(a, b, d) < 0 and area(c, d, a) * area(c, d, b) < 0:
                found.add((j, i))
    return found


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6))
def test_crossings_are_those_of_all_pairs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points, segments = rng.random((30, 2)), rng.integers(0, 30, (25, 2))
    segments = segments[segments[:, 0] != segments[:, 1]]
    assert {tuple(p) for p in crossings(points, segments).tolist()} == brute(points, segments)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.floats(-3, 3), st.floats(-3, 3))
def test_crossings_do_not_depend_on_where_a_period_begins(seed: int, dx: float, dy: float) -> None:
    rng = np.random.default_rng(seed)
    start = rng.random((20, 2))
    points = np.concatenate([start, start + 0.3 * rng.random((20, 2))])
    segments = np.stack([np.arange(20), np.arange(20) + 20], axis=1)
    moved = np.mod(points + np.array([dx, dy]), 1.0)
    here = crossings(points, segments, (1.0, 1.0))
    assert np.array_equal(here, crossings(moved, segments, (1.0, 1.0)))


def test_touching_counts_as_crossing_and_common_ends_do_not() -> None:
    points = np.array([[0, 0], [2, 0], [1, 0], [1, 1], [3, 0], [0, 1.0]])

    def met(*segments: tuple[int, int]) -> list[list[int]]:
        return crossings(points, np.array(segments)).tolist()

    assert met((0, 1), (2, 3)) == [[0, 1]]  # an end on the other segment
    assert met((0, 1), (2, 4)) == [[0, 1]]  # overlapping on one line
    assert met((0, 1), (0, 4)) == [[0, 1]]  # one runs along the other from a common end
    assert met((0, 1), (1, 4)) == []  # going straight on
    assert met((0, 1), (0, 5)) == []
    assert met((0, 1), (1, 0)) == []
