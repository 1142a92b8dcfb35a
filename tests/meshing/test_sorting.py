"""Triangles in an order that suits a tree of boxes."""

import numpy as np

from decomp.meshing.backends.tetwild.sorting import sorted_in_space


def boxes(points, triangles):
    """The summed diagonals of the boxes of a tree over halves of the list."""
    if len(triangles) == 0:
        return 0.0
    size = float(np.linalg.norm(np.ptp(points[triangles].reshape(-1, 3), axis=0)))
    if len(triangles) == 1:
        return size
    half = len(triangles) // 2
    return size + boxes(points, triangles[:half]) + boxes(points, triangles[half:])


def test_same_triangles_with_smaller_boxes():
    n = 24
    i, j = np.divmod(np.arange(n * n), n)
    points = np.stack([i, j, np.zeros(n * n)], axis=1).astype(float)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate(
        [
            np.stack([corner, corner + n, corner + 1], axis=1),
            np.stack([corner + 1, corner + n, corner + n + 1], axis=1),
        ]
    )
    triangles = np.random.default_rng(0).permutation(triangles)
    found = sorted_in_space(points, triangles)
    assert sorted(map(tuple, found.tolist())) == sorted(map(tuple, triangles.tolist()))
    assert boxes(points, found) < 0.25 * boxes(points, triangles)


def test_equal_places_end():
    points = np.zeros((3, 3))
    triangles = np.tile([[0, 1, 2]], (50, 1))
    assert len(sorted_in_space(points, triangles)) == 50
