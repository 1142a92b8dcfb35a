"""Long triangles cut up."""

import numpy as np
import pytest

from decomp.complex.model import OPPOSITE_SIDES
from decomp.meshes.faces import edges_of
from decomp.meshing.backends.tetwild.subdividing import LADDER, subdivided
from decomp.vectors import cross, norm

# two patches that meet along a long edge, one of three triangles at it
POINTS = np.array([[0, 0, 0], [5, 0, 0], [0, 1, 0], [5, 0, 1], [2, -1, 0.0]])
TRIANGLES = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
FLAT = 1e-9


def evenly(length):
    return lambda middles: np.full(len(middles), length)


def areas(points, triangles):
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return norm(cross(b - a, c - a)) / 2


def strips(count, height):
    """The side of a cylinder as complexes have it: slender strips of two triangles each."""
    angle = 2 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    a = np.arange(count)
    b = (a + 1) % count
    low = np.stack([a, b, b + count], axis=1)
    high = np.stack([a, b + count, a + count], axis=1)
    return np.concatenate([ring, ring + np.array([0, 0, height])]), np.concatenate([low, high])


@pytest.mark.parametrize("longest", [4.0, 1.0, 0.3])
def test_no_edge_is_longer_than_asked(longest):
    points, triangles = subdivided(POINTS, TRIANGLES, evenly(longest), FLAT)
    edges, _ = edges_of(triangles, OPPOSITE_SIDES)
    assert norm(points[edges[:, 0]] - points[edges[:, 1]]).max() <= LADDER * longest


@pytest.mark.parametrize("longest", [4.0, 1.0, 0.3])
def test_surface_stays_the_same_and_conforms(longest):
    points, triangles = subdivided(POINTS, TRIANGLES, evenly(longest), FLAT)
    assert areas(points, triangles).sum() == pytest.approx(areas(POINTS, TRIANGLES).sum())
    edges, sides = edges_of(triangles, OPPOSITE_SIDES)
    count = np.bincount(sides.ravel())
    # edges of three triangles are the parts of the one in which three meet
    length = norm(points[edges[:, 0]] - points[edges[:, 1]])
    assert length[count == 3].sum() == pytest.approx(5.0)
    assert length[count == 3].max() <= longest
    # and the free border is as long as it was
    border = [(0, 2), (1, 2), (0, 3), (1, 3), (0, 4), (1, 4)]
    whole = sum(float(norm(POINTS[a] - POINTS[b])) for a, b in border)
    assert length[count == 1].sum() == pytest.approx(whole)


def test_normals_stay():
    points, triangles = subdivided(POINTS, TRIANGLES, evenly(0.3), FLAT)
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    flat = np.abs(a[:, 2]) + np.abs(b[:, 2]) + np.abs(c[:, 2]) == 0
    up = cross(b - a, c - a)[flat][:, 2]
    side = points[triangles[flat]].mean(axis=1)[:, 1]
    assert (up[side > 0] > 0).all() and (up[side < 0] < 0).all()


def test_short_triangles_stay():
    points, triangles = subdivided(POINTS, TRIANGLES, evenly(10.0), FLAT)
    assert (points == POINTS).all() and (triangles == TRIANGLES).all()


def test_slender_strips_become_ladders():
    given, triangles = strips(24, 16.0)
    width = float(norm(given[1] - given[0]))
    points, triangles = subdivided(given, triangles, evenly(1.0), FLAT)
    # 16 rungs or more to a strip, two triangles to a rung, and no vertex between its sides
    assert 24 * 16 * 2 <= len(triangles) <= 24 * 32 * 2
    assert np.allclose(np.hypot(points[:, 0], points[:, 1]), 1.0)
    edges, _ = edges_of(triangles, OPPOSITE_SIDES)
    assert norm(points[edges[:, 0]] - points[edges[:, 1]]).min() >= 0.99 * width


def test_parts_are_even():
    points, triangles = subdivided(POINTS, TRIANGLES, evenly(1.7), FLAT)
    edges, sides = edges_of(triangles, OPPOSITE_SIDES)
    count = np.bincount(sides.ravel())
    length = norm(points[edges[:, 0]] - points[edges[:, 1]])
    assert length[count == 3] == pytest.approx(np.full(3, 5 / 3), rel=0.01)  # not halves of halves


def test_lengths_follow_a_field():
    square = np.array([[0, 0, 0], [8, 0, 0], [8, 8, 0], [0, 8, 0.0]])
    halves = np.array([[0, 1, 2], [0, 2, 3]])

    def longest(middles):
        return 0.3 + 0.4 * middles[:, 0]

    points, triangles = subdivided(square, halves, longest, FLAT)
    edges, _ = edges_of(triangles, OPPOSITE_SIDES)
    ends = points[edges]
    assert (norm(ends[:, 1] - ends[:, 0]) <= LADDER * longest(ends.mean(axis=1))).all()
    fine = (points[:, 0] < 2).mean()
    assert fine > 0.6  # the quarter at the fine side has most of the vertices
