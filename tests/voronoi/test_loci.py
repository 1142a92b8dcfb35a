"""Reflexive loci (section 2.1) and trim surfaces (section 2.5, figure 5)."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.line import Line
from decomp.curves.parabola import Parabola
from decomp.errors import GeometryError
from decomp.vectors import Array, norm
from decomp.voronoi import Kind
from decomp.voronoi.reflexive import LocusKind, Side, reflexive_loci
from decomp.voronoi.trimming import trim_surface

C = np.array([1.0, -2.0, 0.5])
Z = np.array([2.0, 3.0, 6.0]) / 7
X = np.array([6.0, 2.0, -3.0]) / 7
Y = np.cross(Z, X)


def spread(carrier: Carrier, p: Array) -> float:
    """Largest distance between points of a carrier at the least distance from p, by sampling."""
    rng = np.random.default_rng(0)
    near = carrier.foot(p + 1e-5 * rng.normal(size=(200, 3)))
    gap = norm(near - p)
    assert np.ptp(gap) <= 1e-4
    return float(norm(near - near[0]).max())


@pytest.mark.parametrize(
    ("carrier", "kinds"),
    [
        (Plane(C, Z), []),
        (Sphere(C, 1.5), [(LocusKind.POINT, Side.INSIDE)]),
        (Cylinder(C, Z, 1.5), [(LocusKind.LINE, Side.INSIDE)]),
        (Cone(C, Z, 0.6), [(LocusKind.HALF_LINE, Side.INSIDE)]),
        (Torus(C, Z, 2.0, 0.7), [(LocusKind.CIRCLE, Side.INSIDE), (LocusKind.LINE, Side.OUTSIDE)]),
    ],
)
def test_loci_of_carriers(carrier: Carrier, kinds: list[tuple[LocusKind, Side]]) -> None:
    """On the locus many points are nearest, off it one is."""
    loci = reflexive_loci(carrier)
    assert [(locus.kind, locus.side) for locus in loci] == kinds
    for locus in loci:
        assert locus.dimension == (0 if locus.kind is LocusKind.POINT else 1)
        for p in locus.points(5, 3.0, seed=1):
            assert bool(locus.contains(p, 1e-12))
            assert spread(carrier, p) > 0.1 * abs(float(carrier.signed_distance(p)))
            inside = float(carrier.signed_distance(p)) < 0
            assert inside == (locus.side is Side.INSIDE)
    for p in C + np.random.default_rng(2).uniform(-3, 3, size=(20, 3)):
        if not any(bool(locus.contains(p, 1e-2)) for locus in loci):
            assert spread(carrier, p) < 0.1


@pytest.mark.parametrize(
    "curve",
    [
        Circle(C, X, Y, 1.3),
        Ellipse(C, X, Y, 2.0, 1.0),
        Ellipse(C, X, Y, 1.0, 2.0),
        Parabola(C, X, Y, 0.4, domain=(-9.0, 9.0)),
        Hyperbola(C, X, Y, 1.0, 0.8, domain=(-3.0, 3.0)),
    ],
)
def test_loci_of_edges(curve: Curve) -> None:
    """Two or more points of the curve are nearest on the locus, one elsewhere."""
    (locus,) = reflexive_loci(curve)
    t = np.linspace(*curve.domain, 20001)
    samples = curve.point(t)

    def count(p: Array) -> int:
        """Local minima of the distance that are nearly least."""
        gap = norm(samples - p)
        turning = (gap <= np.roll(gap, 1)) & (gap <= np.roll(gap, -1))
        if not curve.closed:
            turning[[0, -1]] = False
        feet = samples[turning & (gap <= gap.min() + 1e-5)]
        return len(feet) if len(feet) < 2 else 1 + int(norm(feet - feet[0]).max() > 1e-2)

    for p in locus.points(12, 2.0, seed=3):
        assert bool(locus.contains(p, 1e-12))
        if locus.kind is LocusKind.STRIP and locus.contains(p + 0.1 * locus.axes[0], 1e-9).all():
            assert count(p) == 2 or locus.kind is LocusKind.LINE
    for p in C + np.random.default_rng(2).uniform(-2, 2, size=(30, 3)):
        if not bool(locus.contains(p, 0.05)):
            assert count(p) == 1


def test_sheet_of_an_ellipse_ends_at_the_centres_of_curvature() -> None:
    (locus,) = reflexive_loci(Ellipse(C, X, Y, 2.0, 1.0))
    assert (locus.low, locus.high) == (-1.5, 1.5)
    assert locus.dimension == 2


R, H = 1.5, 0.6
TUBE = Cylinder(C, Z, R)
CONE = Cone(C, Z, 0.6)
RING = Torus(C, Z, 2.0, 0.7)


def round_at(height: float, radius: float) -> Circle:
    return Circle(C + height * Z, X, Y, radius)


CASES = [
    (Line(C, X), Plane(C, Z), Kind.PLANE),
    (round_at(0, 1), Plane(C, Z), Kind.CIRCULAR_CYLINDER),
    (Ellipse(C, X, Y, 2.0, 1.0), Plane(C, Z), Kind.ELLIPTIC_CYLINDER),
    (Parabola(C, X, Y, 0.4), Plane(C, Z), Kind.PARABOLIC_CYLINDER),
    (Hyperbola(C, X, Y, 1.0, 0.8), Plane(C, Z), Kind.HYPERBOLIC_CYLINDER),
    (round_at(H, np.sqrt(R**2 - H**2)), Sphere(C, R), Kind.CIRCULAR_CONE),
    (round_at(-H, np.sqrt(R**2 - H**2)), Sphere(C, R), Kind.CIRCULAR_CONE),
    (round_at(0, R), Sphere(C, R), Kind.PLANE),
    (Line(C + R * X, Z), TUBE, Kind.PLANE),
    (round_at(H, R), TUBE, Kind.PLANE),
    (round_at(1.0, np.tan(0.6)), CONE, Kind.CIRCULAR_CONE),
    (Line(C, np.sin(0.6) * X + np.cos(0.6) * Z, domain=(0.1, 2.0)), CONE, Kind.PLANE),
    (round_at(0, 2.7), RING, Kind.PLANE),
    (round_at(0.7, 2.0), RING, Kind.CIRCULAR_CYLINDER),
    (round_at(0.7 * np.sin(1.0), 2 + 0.7 * np.cos(1.0)), RING, Kind.CIRCULAR_CONE),
    (round_at(0.7 * np.sin(2.0), 2 + 0.7 * np.cos(2.0)), RING, Kind.CIRCULAR_CONE),
    (Circle(C + 2 * X, X, Z, 0.7), RING, Kind.PLANE),
    (Ellipse(C, np.cos(0.7) * X + np.sin(0.7) * Z, Y, R / np.cos(0.7), R), TUBE, Kind.GENERAL),
]


@pytest.mark.parametrize(("curve", "carrier", "kind"), CASES)
def test_trim_surfaces(curve: Curve, carrier: Carrier, kind: Kind) -> None:
    """The ruled surface lies on its canonical equation, or its polynomial (figure 5)."""
    trim = trim_surface(curve, carrier)
    assert trim.kind is kind
    rng = np.random.default_rng(4)
    t, s = rng.uniform(*curve.domain, 60), rng.uniform(-2, 2, 60)
    p = trim.point(t, s)
    if trim.shape is not None:
        assert trim.shape.deviation(p).max() <= 1e-12
    assert trim.polynomial is not None
    assert trim.polynomial.degree == {Kind.PLANE: 1, Kind.GENERAL: 4}.get(kind, 2)
    slope = norm(trim.polynomial.gradient(p))
    assert (np.abs(trim.polynomial(p)) / slope).max() <= 1e-9


def test_edge_off_its_carrier() -> None:
    with pytest.raises(GeometryError, match="does not lie on"):
        trim_surface(Circle(C, X, Y, 1.0), TUBE)


def test_villarceau_circle_has_no_special_trim_surface() -> None:
    """A circle on a torus that is neither a parallel nor a meridian."""
    lean = np.arcsin(0.7 / 2.0)
    way = np.cos(lean) * X + np.sin(lean) * Z
    circle = Circle(C + 0.7 * Y, way, Y, 2.0)
    assert trim_surface(circle, RING).kind is Kind.GENERAL
