"""Circles and tubes in special positions to lines and to each other."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.voronoi import CylinderSite, Kind, Parity, TorusSite, VoronoiSurface, surface
from decomp.voronoi.elimination import eliminate
from decomp.voronoi.exact import Vector, cross, floats, unit
from tests.voronoi.independent import check
from tests.voronoi.instances import FEW, WAYS, across, at, numbers, points, radii, ways


def in_plane(f: TorusSite, g: TorusSite, normal: Vector, count: int = 40) -> np.ndarray:
    """Random points of the plane of g's spine around its centre."""
    u, v = unit(cross(normal, f.axis)), unit(f.axis)
    spread = np.random.default_rng(1).uniform(-1, 1, size=(count, 2)) * 2 * float(g.major)
    return floats(g.centre) + spread[:, :1] * u + spread[:, 1:] * v


@FEW
@given(points, st.sampled_from(WAYS), radii, numbers, st.sampled_from([0, "1/8"]))
def test_line_in_the_plane_of_a_circle(
    p: Vector, way: Vector, r: Fraction, h: Fraction, tube: str
) -> None:
    """Parabolic cylinders rho = r + l and rho = r - l, equal tubes alike: a half-plane on contact.

    The plane is one of the two where the line touches the circle, and outside only one is left.
    """
    x, y = across(way)
    f = TorusSite(p, way, r, tube)
    g = CylinderSite(at(p, x, h), y, tube)
    for found in (surface(f, g, "even"), surface(g, f, "even")):
        kinds = sorted(part.kind.value for part in found.shape.parts or (found.shape,))
        if abs(h) < r:
            assert kinds == [Kind.PARABOLIC_CYLINDER.value] * 2
            assert found.degree == 4
        elif abs(h) == r:
            assert kinds == [Kind.PARABOLIC_CYLINDER.value, Kind.PLANE.value]
            assert found.degree == 3
        else:
            assert kinds == [Kind.PARABOLIC_CYLINDER.value]
            assert found.degree == 2
        check(found, count=40)
        assert found.polynomial.divides(eliminate(f, g, 1))
    # the odd surface of tubes stays in one piece
    if f.two_sided:
        assert surface(f, g, "odd").kind in (Kind.GENERAL, Kind.EMPTY, Kind.LINE)


@FEW
@given(points, ways, radii, radii)
def test_line_beside_the_plane_of_a_circle(
    p: Vector, way: Vector, r: Fraction, h: Fraction
) -> None:
    """Off the plane, or not along it, it is of degree 4 and in one piece."""
    x, y = across(way)
    level = TorusSite(p, way, r, 0)
    off = surface(level, CylinderSite(at(at(p, x, r / 2), way, h), y, 0))
    oblique = surface(level, CylinderSite(at(p, x, r / 2), at(y, way, Fraction(1)), 0))
    for found in (off, oblique):
        assert (found.kind, found.degree) == (Kind.GENERAL, 4)
        assert found.polynomial is not None
        assert len(found.polynomial.raw.factor()[1]) == 1


@FEW
@given(points, st.sampled_from(WAYS), radii, radii, st.sampled_from(["0", "1/4", "1/2", "3/4"]))
def test_tube_in_the_hole_of_a_ring(
    p: Vector, way: Vector, r: Fraction, s: Fraction, share: str
) -> None:
    """They touch along a circle: its disc (odd). A ring in a tube: what is outside it (even)."""
    x, _ = across(way)
    k = Fraction(share) * r
    f = TorusSite(p, way, 2 * r + s, r)
    c = at(p, x, f.major)
    around = cross(way, x)
    g = TorusSite(c, around, r + k, k)
    odd = surface(f, g, "odd")
    assert (odd.kind, odd.degree) == (Kind.PLANE, 1)
    lies_on_plane(odd, f, g, around, inside=True)
    small = TorusSite(c, around, r - k / 2, k / 2)
    even = surface(f, small, "even")
    assert (even.kind, even.degree) == (Kind.PLANE, 1)
    lies_on_plane(even, f, small, around, inside=False)


def lies_on_plane(
    found: VoronoiSurface, f: TorusSite, g: TorusSite, normal: Vector, inside: bool
) -> None:
    """All points of the plane within g's spine (or beyond it) are equidistant, none beside it."""
    q = in_plane(f, g, normal)
    far = np.linalg.norm(q - floats(g.centre), axis=1)
    out = unit(cross(normal, f.axis))
    near_axis = np.abs((q - floats(g.centre)) @ out) >= float(f.major)
    held = found.contains(q)
    within = (far <= float(g.major)) if inside else (far >= float(g.major))
    assert held[within & ~near_axis].all()
    assert not held[~within & ~near_axis].any()
    assert found.shape is not None and found.shape.deviation(q).max() <= 1e-12 * found.size
    beside = q + 0.05 * float(g.major) * unit(normal)
    assert not found.contains(beside).any()
    assert found.polynomial is not None
    assert found.polynomial.divides(eliminate(f, g, found.parity.sign))


def test_rings_that_fill_each_other() -> None:
    """Two discs across each other; a wider ring crosses the tube and adds a surface."""
    f = TorusSite((0, 0, 0), (0, 0, 1), 2, 1)
    odd = surface(f, TorusSite((2, 0, 0), (0, 1, 0), 2, 1), Parity.ODD)
    assert (odd.kind, odd.degree) == (Kind.PLANE_PAIR, 2)
    assert odd.shape is not None
    assert odd.shape.parameters["half_angle"] == pytest.approx(np.pi / 4)
    discs = np.array([[1.5, 0, 0.5], [2.5, 0, -0.5], [1.5, 0.5, 0], [0.5, -0.5, 0]])
    assert odd.contains(discs).all()
    assert odd.shape.deviation(discs).max() <= 1e-15
    wide = surface(f, TorusSite((2, 0, 0), (0, 1, 0), "5/2", "3/2"), "odd")
    assert (wide.kind, wide.degree) == (Kind.GENERAL, 5)
    check(wide)
    assert wide.contains(np.array([[2.5, 0, 1.0], [1.5, 0, -0.5]])).all()
