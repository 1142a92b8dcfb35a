"""Angles, ratios, volumes and Jacobians of elements that are known."""

from __future__ import annotations

from math import acos, atan2, degrees, sqrt

import numpy as np
import pytest

from decomp.meshes.quality import (
    POINTS,
    WEIGHTS,
    dihedral_angles,
    inverted,
    jacobians,
    radius_ratios,
    volumes,
)
from tests.meshes.shapes import bar, quadratic

REGULAR = np.array([[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]], dtype=float)
CORNER = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
ONE = np.array([[0, 1, 2, 3]])


def test_regular() -> None:
    assert dihedral_angles(REGULAR, ONE) == pytest.approx(degrees(acos(1 / 3)), rel=1e-13)
    assert radius_ratios(REGULAR, ONE) == pytest.approx(1.0, rel=1e-13)
    assert abs(volumes(REGULAR, ONE)[0]) == pytest.approx(8 / 3, rel=1e-13)
    assert inverted(REGULAR, ONE).tolist() == [volumes(REGULAR, ONE)[0] < 0]


def test_corner_of_a_cube() -> None:
    angles = dihedral_angles(CORNER, ONE)[0]
    assert sorted(angles) == pytest.approx([degrees(atan2(sqrt(2), 1))] * 3 + [90.0] * 3)
    inner, outer = 1 / (3 + sqrt(3)), sqrt(3) / 2
    assert radius_ratios(CORNER, ONE) == pytest.approx(3 * inner / outer, rel=1e-13)
    assert volumes(CORNER, ONE) == pytest.approx(1 / 6, rel=1e-13)
    assert not inverted(CORNER, ONE).any()
    assert inverted(CORNER, ONE[:, [1, 0, 2, 3]]).all()


def test_a_flat_one() -> None:
    flat = CORNER * [1, 1, 0]
    assert radius_ratios(flat, ONE)[0] == 0
    assert inverted(flat, ONE).all()
    sliver = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], dtype=float)
    assert sorted(dihedral_angles(sliver, ONE)[0]) == pytest.approx([0, 0, 0, 0, 180, 180])


@pytest.mark.parametrize("powers", [(0, 0, 0), (1, 2, 2), (5, 0, 0), (3, 1, 1), (2, 2, 0)])
def test_the_rule_is_exact_to_degree_5(powers: tuple[int, int, int]) -> None:
    """The integral of x^a y^b z^c over the unit tetrahedron is a! b! c! / (a + b + c + 3)!."""
    from math import factorial, prod

    exact = prod(map(factorial, powers)) / factorial(sum(powers) + 3)
    values = np.prod(POINTS[:, 1:] ** np.array(powers), axis=1)
    assert values @ WEIGHTS / 6 == pytest.approx(exact, rel=1e-13)


def test_curved() -> None:
    """A shear y += b x^2 keeps all volumes; middle nodes astray turn an element over."""
    mesh = quadratic(bar(), bend=0.2)
    assert volumes(mesh.points, mesh.tets) == pytest.approx(1 / 384, rel=1e-12)
    assert jacobians(mesh.points, mesh.tets, POINTS) == pytest.approx(1 / 64, rel=1e-9)
    assert not inverted(mesh.points, mesh.tets).any()
    points = mesh.points.copy()
    points[mesh.tets[0, 4]] = points[mesh.tets[0, 2]]
    assert inverted(points, mesh.tets)[0]
    assert not inverted(points, mesh.tets).all()
