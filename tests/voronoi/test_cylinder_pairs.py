"""Theorem 4.8: a cylinder and a cylinder, cone or torus."""

from __future__ import annotations

from fractions import Fraction
from math import pi, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from decomp.voronoi import ConeSite, CylinderSite, Kind, TorusSite, surface
from decomp.voronoi.exact import Vector
from tests.voronoi.independent import check
from tests.voronoi.instances import (
    FEW,
    WAYS,
    across,
    angles,
    at,
    cylinders,
    numbers,
    points,
    radii,
    ways,
)


@FEW
@given(points, points, st.permutations(WAYS), radii)
def test_equal_and_skew(p: Vector, q: Vector, some: list[Vector], r: Fraction) -> None:
    """(i) A hyperbolic paraboloid, for any angle between the axes."""
    f, g = CylinderSite(p, some[0], r), CylinderSite(q, some[1], r)
    a, b = f.carrier, g.carrier
    normal = np.cross(a.axis, b.axis)
    gap = abs(float((b.point - a.point) @ normal)) / np.linalg.norm(normal)
    assume(gap > 1e-9)
    even = surface(f, g, "even")
    assert even.kind is Kind.HYPERBOLIC_PARABOLOID
    assert even.degree == 2
    assert even.shape is not None
    focal = gap / (2 * np.linalg.norm(normal))
    assert even.shape.parameters["focal_length_x"] == pytest.approx(focal)
    check(even)


@FEW
@given(points, st.permutations(WAYS), radii, numbers, numbers)
def test_equal_and_meeting(
    p: Vector, some: list[Vector], r: Fraction, t: Fraction, u: Fraction
) -> None:
    """(i) The two planes that bisect the axes, at right angles to the plane of the axes."""
    f, g = CylinderSite(at(p, some[0], t), some[0], r), CylinderSite(at(p, some[1], u), some[1], r)
    even = surface(f, g, "even")
    assert even.kind is Kind.PLANE_PAIR
    assert even.degree == 2
    assert even.shape is not None
    assert even.shape.parameters["half_angle"] == pytest.approx(pi / 4)
    assert np.allclose(even.shape.origin, [float(c) for c in p], atol=1e-9)
    check(even)


@FEW
@given(points, ways, radii, radii, radii)
def test_parallel(p: Vector, way: Vector, r: Fraction, s: Fraction, gap: Fraction) -> None:
    """(i) Plane or hyperbolic cylinder (even), elliptic cylinder (odd); half-planes on contact."""
    x, _ = across(way)
    f, g = CylinderSite(p, way, r), CylinderSite(at(p, x, gap), way, s)
    even, odd = surface(f, g, "even"), surface(f, g, "odd")
    difference = abs(r - s)
    if difference == 0 or difference == gap:
        assert even.kind is Kind.PLANE
        assert even.degree == 1
    elif difference < gap:
        assert even.kind is Kind.HYPERBOLIC_CYLINDER
        assert even.degree == 2
        check(even)
    else:
        assert even.kind is Kind.EMPTY
    if r + s > gap:
        assert odd.kind is Kind.ELLIPTIC_CYLINDER
        assert odd.degree == 2
        check(odd)
    elif r + s == gap:
        assert odd.kind is Kind.PLANE
    else:
        assert odd.kind is Kind.EMPTY


@FEW
@given(points, ways, radii, radii)
def test_coaxial(p: Vector, way: Vector, r: Fraction, s: Fraction) -> None:
    """Not in the paper: the circular cylinder half-way, odd."""
    assume(r != s)
    f, g = CylinderSite(p, way, r), CylinderSite(p, way, s)
    odd = surface(f, g, "odd")
    assert odd.kind is Kind.CIRCULAR_CYLINDER
    assert odd.shape is not None
    assert odd.shape.parameters["radius"] == pytest.approx(float(r + s) / 2)
    check(odd)
    assert surface(f, g, "even").kind is Kind.EMPTY


@FEW
@given(cylinders, cylinders)
def test_general_degree(f: CylinderSite, g: CylinderSite) -> None:
    """Skew or meeting and of different radii: degree 4; so is every odd surface."""
    assume(np.linalg.norm(np.cross(f.carrier.axis, g.carrier.axis)) > 0 and f.radius != g.radius)
    for parity in ("even", "odd"):
        found = surface(f, g, parity)
        assert found.kind in (Kind.GENERAL, Kind.EMPTY, Kind.LINE)
        assert found.degree == 4


def test_odd_surface_ends_in_four_conical_points() -> None:
    """Plate II: cylinders with skew axes that meet. The polynomial goes on beyond its end."""
    f = CylinderSite((0, "1/4", 0), (0, 0, 1), 1)
    g = CylinderSite((0, "-1/4", 0), (1, 0, 0), 1)
    odd = surface(f, g, "odd")
    assert odd.degree == 4
    assert odd.polynomial is not None
    check(odd)
    # on one axis, at the distance of its radius from the other cylinder, inside both
    t = np.sqrt(4 - 0.25)
    tips = np.array([[0, 0.25, t], [0, 0.25, -t], [t, -0.25, 0], [-t, -0.25, 0]])
    assert np.abs(odd.polynomial(tips)).max() <= 1e-14
    assert np.abs(odd.polynomial.gradient(tips)).max() <= 1e-14
    assert odd.contains(tips).all()
    for tip, way in zip(tips, [[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0]], strict=True):
        # near a tip the Hessian has signature (2, 1): a cone
        values = np.linalg.eigvalsh(odd.polynomial.hessian(tip))
        assert sorted(np.sign(values)) in ([-1, -1, 1], [-1, 1, 1])
        beyond = tip + 0.3 * np.array(way)
        zeros = _zeros_across(odd, beyond)
        assert len(zeros)
        assert not odd.contains(zeros).any()


def _zeros_across(odd, centre):  # type: ignore[no-untyped-def]
    """Zeros of the polynomial on rays from a point, within 0.3."""
    rng = np.random.default_rng(3)
    found = []
    for way in rng.normal(size=(40, 3)):
        t = np.linspace(0, 0.3, 301)
        values = odd.polynomial(centre + t[:, None] * way / np.linalg.norm(way))
        for k in np.flatnonzero(values[1:] * values[:-1] < 0):
            s = t[k] + (t[k + 1] - t[k]) * values[k] / (values[k] - values[k + 1])
            found.append(centre + s * way / np.linalg.norm(way))
    return np.array(found)


@FEW
@given(points, ways, radii, angles, numbers)
def test_cone(
    p: Vector, way: Vector, r: Fraction, angle: tuple[Fraction, Fraction], h: Fraction
) -> None:
    """(ii) Cones of half-angle c / 2 (odd) and 90 - c / 2 (even), not c, as in the paper's proof.

    Both go through the circle where f and g meet.
    """
    f, g = CylinderSite(at(p, way, h), way, r), ConeSite(p, way, *angle)
    c = g.carrier.angle
    ring = g.carrier.apex + float(r) / np.tan(c) * g.carrier.axis
    x, y = (np.array([float(v) for v in w]) for w in across(way))
    t = np.linspace(0, 6, 7)[:, None]
    circle = ring + float(r) * (
        np.cos(t) * x / np.linalg.norm(x) + np.sin(t) * y / np.linalg.norm(y)
    )
    for parity, half in (("even", pi / 2 - c / 2), ("odd", c / 2)):
        found = surface(f, g, parity)
        assert found.kind is Kind.CIRCULAR_CONE
        assert found.degree == 2
        assert found.shape is not None
        assert found.shape.deviation(circle).max() <= 1e-9
        assert found.shape.parameters["half_angle"] == pytest.approx(half)
        check(found)


@FEW
@given(points, ways, radii, radii, radii, numbers)
def test_torus(
    p: Vector, way: Vector, r: Fraction, more: Fraction, s: Fraction, h: Fraction
) -> None:
    """(iii) A parabola turned about a line across its axis (no paraboloid of revolution).

    The odd surface has a spindle if the cylinder reaches the torus's inner equator.
    """
    f, g = CylinderSite(at(p, way, h), way, s), TorusSite(p, way, r + more, r)
    for parity, e in (("even", 1), ("odd", -1)):
        found = surface(f, g, parity)
        assert found.shape is not None
        depth = r + e * (r + more - s)
        if depth < 0:
            assert found.kind is Kind.EMPTY
        elif depth == 0:
            # they touch along the tube's inner or outer equator: a plane through the spine
            assert found.kind is Kind.PLANE
            assert found.degree == 1
        else:
            assert found.kind is Kind.REVOLVED_PARABOLA
            assert found.degree == 4
            values = found.shape.parameters
            assert abs(sin(values["tilt"])) == pytest.approx(1)
            assert values["focal_length"] == pytest.approx(float(depth) / 2)
            check(found)
            # on the axis the distances are hypot(major, z) - r and s
            inner = float(more)
            tip = np.sqrt(max((float(s) + float(r)) ** 2 - float(g.major) ** 2, 0.0))
            spindle = bool(found.contains(g.carrier.centre + tip * g.carrier.axis))
            assert spindle == (parity == "odd" and float(s) >= inner)
