"""Shape and size of tetrahedra: dihedral angles, radius ratios, volumes, Jacobians."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from decomp.vectors import Array, Bools, Ints, cross, dot, norm

TETS_AT_ONCE = 1 << 16
_ORBITS = (
    (0.31088591926330060980, 0.11268792571801585080),
    (0.092735250310891226402, 0.073493043116361949544),
)
_EDGE_ORBIT = (0.045503704125649649492, 0.042546020777081466438)


def _rule() -> tuple[Array, Array]:
    """Barycentric points (14, 4) and weights (14,) of a rule that is exact to degree 5.

    Source: N. J. Walkington, Quadrature on simplices of arbitrary dimension, 2000, n = 3.
    """
    points, weights = [], []
    for a, weight in _ORBITS:
        for k in range(4):
            point = np.full(4, a)
            point[k] = 1 - 3 * a
            points.append(point)
            weights.append(weight)
    a, weight = _EDGE_ORBIT
    for pair in combinations(range(4), 2):
        point = np.full(4, a)
        point[list(pair)] = 0.5 - a
        points.append(point)
        weights.append(weight)
    return np.array(points), np.array(weights)


POINTS, WEIGHTS = _rule()
_NEAR = (5 - np.sqrt(5)) / 20
FOUR: Array = np.full((4, 4), _NEAR) + np.eye(4) * (1 - 4 * _NEAR)
"""Barycentric points of the rule of degree 2 that 10-node elements are integrated with."""


def dihedral_angles(points: Array, tets: Ints) -> Array:
    """The six angles (m, 6) between the faces of each tetrahedron, by its corners, in degrees."""
    result = np.empty((len(tets), 6))
    for start in range(0, len(tets), TETS_AT_ONCE):
        corner = points[tets[start : start + TETS_AT_ONCE, :4]]
        for column, (i, j) in enumerate(combinations(range(4), 2)):
            k, other = (n for n in range(4) if n not in (i, j))
            axis = corner[:, j] - corner[:, i]
            one = cross(axis, corner[:, k] - corner[:, i])
            two = cross(axis, corner[:, other] - corner[:, i])
            angle = np.arctan2(norm(cross(one, two)), dot(one, two))
            result[start : start + TETS_AT_ONCE, column] = np.degrees(angle)
    return result


def radius_ratios(points: Array, tets: Ints) -> Array:
    """Three times the radius of the inscribed ball over that of the circumscribed one: (m,).

    It is 1 for regular tetrahedra and 0 for flat ones; corners alone count.
    """
    corner = points[tets[:, :4]]
    a, b, c = (corner[:, k] - corner[:, 0] for k in (1, 2, 3))
    ab, bc, ca = cross(a, b), cross(b, c), cross(c, a)
    six = np.abs(dot(a, bc))
    area = norm(ab) + norm(bc) + norm(ca) + norm(cross(b - a, c - a))
    # r = 6 V / (2 A) and R = |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (12 V)
    squares = [dot(v, v)[:, None] for v in (a, b, c)]
    reach = norm(squares[0] * bc + squares[1] * ca + squares[2] * ab)
    bottom = area * reach
    return np.divide(6.0 * six**2, bottom, out=np.zeros(len(tets)), where=bottom > 0)


def volumes(points: Array, tets: Ints) -> Array:
    """The volume (m,) of each element, negative where it is turned over."""
    if tets.shape[1] == 4:
        return jacobians(points, tets)[:, 0] / 6.0
    return np.asarray(jacobians(points, tets, POINTS) @ WEIGHTS / 6.0)


def inverted(points: Array, tets: Ints) -> Bools:
    """Which elements (m,) have a Jacobian of zero or less at a point that they are integrated at.

    For 10-node elements these are the points of the rules of degree 2 and 5.
    """
    at = FOUR if tets.shape[1] == 4 else np.concatenate([FOUR, POINTS])
    return np.asarray((jacobians(points, tets, at) <= 0.0).any(axis=1))


def jacobians(points: Array, tets: Ints, at: Array = FOUR[:1]) -> Array:
    """Determinants (m, q) of the map from the unit tetrahedron.

    Args:
        points: (n, 3).
        tets: (m, 4) or (m, 10) in Gmsh's order.
        at: barycentric coordinates (q, 4).
    """
    if tets.shape[1] == 4:
        corner = points[tets]
        a, b, c = (corner[:, k] - corner[:, 0] for k in (1, 2, 3))
        return np.repeat(dot(a, cross(b, c))[:, None], len(at), axis=1)
    result = np.empty((len(tets), len(at)))
    for column, where in enumerate(at):
        gradient = _gradients(where)
        for start in range(0, len(tets), TETS_AT_ONCE):
            rows = tets[start : start + TETS_AT_ONCE]
            matrix = np.einsum("nk,mnd->mkd", gradient, points[rows])
            result[start : start + TETS_AT_ONCE, column] = dot(
                matrix[:, 0], cross(matrix[:, 1], matrix[:, 2])
            )
    return result


def _gradients(where: Array) -> Array:
    """Derivatives (10, 3) of the quadratic shape functions at a barycentric point.

    With barycentric coordinates l the functions are l_i (2 l_i - 1) at corners and 4 l_i l_j on
    edges; coordinate k of the unit tetrahedron is l_{k+1}, and l_0 = 1 - the others.
    """
    by_l = np.zeros((10, 4))
    for k in range(4):
        by_l[k, k] = 4 * where[k] - 1
    for row, (i, j) in enumerate(((0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1)), 4):
        by_l[row, i], by_l[row, j] = 4 * where[j], 4 * where[i]
    return by_l[:, 1:] - by_l[:, :1]
