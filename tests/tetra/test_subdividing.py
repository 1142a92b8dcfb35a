"""Long triangles cut up."""

import numpy as np
import pytest

from decomp.tetra.faces import edges_of
from decomp.tetra.subdividing import SIDES, subdivided
from decomp.vectors import cross, norm

# two patches that meet along a long edge, one of three triangles at it
POINTS = np.array([[0, 0, 0], [5, 0, 0], [0, 1, 0], [5, 0, 1], [2, -1, 0.0]])
TRIANGLES = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])


def areas(points, triangles):
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return norm(cross(b - a, c - a)) / 2


@pytest.mark.parametrize("longest", [4.0, 1.0, 0.3])
def test_no_edge_is_longer_than_asked(longest):
    points, triangles = subdivided(POINTS, TRIANGLES, longest)
    edges, _ = edges_of(triangles, SIDES)
    assert norm(points[edges[:, 0]] - points[edges[:, 1]]).max() <= longest


@pytest.mark.parametrize("longest", [4.0, 1.0, 0.3])
def test_surface_stays_the_same_and_conforms(longest):
    points, triangles = subdivided(POINTS, TRIANGLES, longest)
    assert areas(points, triangles).sum() == pytest.approx(areas(POINTS, TRIANGLES).sum())
    edges, sides = edges_of(triangles, SIDES)
    count = np.bincount(sides.ravel())
    # edges of three triangles are the parts of the one in which three meet
    length = norm(points[edges[:, 0]] - points[edges[:, 1]])
    assert length[count == 3].sum() == pytest.approx(5.0)
    # and the free border is as long as it was
    border = [(0, 2), (1, 2), (0, 3), (1, 3), (0, 4), (1, 4)]
    whole = sum(float(norm(POINTS[a] - POINTS[b])) for a, b in border)
    assert length[count == 1].sum() == pytest.approx(whole)


def test_normals_stay():
    points, triangles = subdivided(POINTS, TRIANGLES, 0.3)
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    flat = np.abs(a[:, 2]) + np.abs(b[:, 2]) + np.abs(c[:, 2]) == 0
    up = cross(b - a, c - a)[flat][:, 2]
    side = points[triangles[flat]].mean(axis=1)[:, 1]
    assert (up[side > 0] > 0).all() and (up[side < 0] < 0).all()


def test_short_triangles_stay():
    points, triangles = subdivided(POINTS, TRIANGLES, 10.0)
    assert (points == POINTS).all() and (triangles == TRIANGLES).all()
