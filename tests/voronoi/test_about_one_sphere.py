"""Cones, cylinders and rings about one sphere: what is equidistant splits into quadrics."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.voronoi import CarrierSite, ConeSite, CylinderSite, Kind, TorusSite, surface
from decomp.voronoi.elimination import eliminate
from decomp.voronoi.exact import Vector
from tests.voronoi.independent import check
from tests.voronoi.instances import FEW, WAYS, across, angles, at, points, radii

Angle = tuple[Fraction, Fraction]


def about(c: Vector, way: Vector, angle: Angle, r: Fraction) -> ConeSite:
    """The cone about the sphere of radius r about c, which is beyond its apex if r < 0."""
    return ConeSite(at(c, way, -r / angle[0]), way, *angle)


def checked(f: CarrierSite, g: CarrierSite, parity: str) -> None:
    """Parts and equation against elimination and against equidistant points."""
    found = surface(f, g, parity)
    assert found.kind is not Kind.GENERAL
    points = check(found, count=40, needed=False)
    assert found.kind is not Kind.EMPTY or not len(points)
    if found.kind.dimension == 2:
        assert found.polynomial is not None
        assert found.polynomial.divides(eliminate(f, g, found.parity.sign))
        assert found.degree is not None and found.degree <= 4


@FEW
@given(points, st.permutations(WAYS), angles, angles, radii)
def test_cones(c: Vector, some: list[Vector], a: Angle, b: Angle, r: Fraction) -> None:
    """Two quadratic cones with the sphere's centre as apex, a plane among them for equal angles."""
    f, g = about(c, some[0], a, r), about(c, some[1], b, r)
    checked(f, g, "even")
    if a == b:
        even = surface(f, g, "even")
        assert even.shape is not None
        kinds = [part.kind for part in even.shape.parts] or [even.kind]
        assert Kind.PLANE in kinds


@FEW
@given(points, st.permutations(WAYS), angles, radii)
def test_cone_and_cylinder(c: Vector, some: list[Vector], a: Angle, r: Fraction) -> None:
    checked(about(c, some[0], a, r), CylinderSite(c, some[1], r), "even")


def test_odd_where_the_sphere_is_behind_one_apex() -> None:
    way, other = WAYS[5], WAYS[6]
    f = about((Fraction(0),) * 3, way, (Fraction(3, 5), Fraction(4, 5)), Fraction(1))
    g = about((Fraction(0),) * 3, other, (Fraction(4, 5), Fraction(3, 5)), Fraction(-1))
    found = surface(f, g, "odd")
    assert found.kind is Kind.ELLIPTIC_CONE and found.degree == 2
    check(found)


@FEW
@given(points, st.permutations(WAYS), st.sampled_from([(3, 4), (4, 3), (5, 0)]),
       st.sampled_from([(3, 4), (3, -4), (4, 3)]), st.sampled_from([0, 1, 2]))  # fmt: skip
def test_rings(
    c: Vector, some: list[Vector], one: tuple[int, int], two: tuple[int, int], tube: int
) -> None:
    """Circles and tubes of equal radius whose spines lie on one sphere."""
    f, g = (
        TorusSite(at(c, way, Fraction(h)), way, r, tube)
        for way, (r, h) in zip(some[:2], (one, two), strict=True)
    )
    checked(f, g, "even")


@FEW
@given(points, st.permutations(WAYS), angles, radii, radii)
def test_spheres_of_two_radii(
    c: Vector, some: list[Vector], a: Angle, r: Fraction, s: Fraction
) -> None:
    """Otherwise it stays of degree 4 in one piece."""
    assume(r != s)
    found = surface(about(c, some[0], a, r), about(c, some[1], a, s), "even")
    assert found.kind in (Kind.GENERAL, Kind.EMPTY, Kind.LINE)
    assert found.degree == 4
    assert found.polynomial is not None
    assert len(found.polynomial.raw.factor()[1]) == pytest.approx(1)


@FEW
@given(points, st.sampled_from(WAYS), radii, radii, radii, st.sampled_from([0, "1/8"]))
def test_level_rings(
    c: Vector, way: Vector, r: Fraction, s: Fraction, gap: Fraction, tube: str
) -> None:
    """Spines in one plane: the even and the odd cylinder of the cylinders through them."""
    f = TorusSite(c, way, r, tube)
    g = TorusSite(at(c, across(way)[0], gap), way, s, tube)
    found = surface(f, g, "even")
    assert found.kind is not Kind.GENERAL
    if gap not in (r + s, abs(r - s)):
        assert (found.kind is Kind.TWO_SURFACES) == (abs(r - s) < gap < r + s)
        checked(f, g, "even")
