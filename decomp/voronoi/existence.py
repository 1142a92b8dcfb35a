"""Whether two sites have a Voronoi surface at all: it is empty, or a line where they only touch.

With h = s_f - e s_g, h is -e s_g on f and s_f on g. If h takes both signs there, it vanishes
between. If it does not, and f and g have no common point, h keeps its sign everywhere: were s_f =
e s_g = d at a point p, the ball about p of radius |d| would touch f and g, and lie on those sides
of them on which g and f are not. If they only touch, it vanishes on the common normal alone.
"""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier, Cone, Sphere, Torus
from decomp.curves import Circle, Curve, Line, crossings, intersect
from decomp.errors import ContactError
from decomp.vectors import Array, frame, norm
from decomp.voronoi.curve_site import CurveSite
from decomp.voronoi.exact import floats
from decomp.voronoi.kinds import Kind
from decomp.voronoi.shape import Shape, shape
from decomp.voronoi.sites import CarrierSite, CylinderSite, SphereSite, TorusSite, VoronoiSite

PAIR_SAMPLES = 96
SAMPLES_AT = (1.5, 30.0, 1e4)
"""Distances of samples from the middle, in units of the size."""
COMMON_WINDOW = 1e3
"""Where sites are searched for common points, in units of the size."""


def degenerate(
    f: VoronoiSite, g: VoronoiSite, e: int, tolerance: float, size: float
) -> Shape | None:
    """The shape EMPTY or LINE of the surface s_f = e s_g, None if it is none of these.

    Args:
        e: +1 for the even surface, -1 for the odd one.
        tolerance: lengths below it count as zero.
        size: of the sites and of the distance between them.
    """
    middle = (floats(f.reference) + floats(g.reference)) / 2
    on_f, on_g = _on(f, g, middle, size), _on(g, f, middle, size)
    values = np.concatenate([-e * g.signed_distance(on_f), f.signed_distance(on_g)])
    if values.min() < -tolerance and values.max() > tolerance:
        return None
    met = _common(f, g, middle, COMMON_WINDOW * size, tolerance)
    if met is None:
        return None
    if not len(met):
        return shape(Kind.EMPTY, middle, np.array([0.0, 0.0, 1.0]))
    lines = tuple(_normal_line(f, g, p, tolerance) for p in met)
    if len(lines) == 1:
        return lines[0]
    return Shape(Kind.LINE, lines[0].origin, lines[0].axes, {}, lines)


def _on(site: VoronoiSite, other: VoronoiSite, middle: Array, size: float) -> Array:
    """Points (k, 3) of a site, near and far, and those nearest to the other's."""
    ways = np.random.default_rng(0).normal(size=(PAIR_SAMPLES, 3))
    ways /= norm(ways)[:, None]
    around = [middle + far * size * ways for far in SAMPLES_AT]
    return np.asarray(site.foot(np.concatenate([*around, other.foot(around[0])])))


def _common(
    f: VoronoiSite, g: VoronoiSite, middle: Array, reach: float, tolerance: float
) -> Array | None:
    """The points (k, 3) where two sites touch, None where they meet otherwise or it is unknown."""
    one, two = _geometry(f, middle, reach), _geometry(g, middle, reach)
    if isinstance(one, Carrier) and isinstance(two, Carrier):
        if any(isinstance(each, (Sphere, Torus)) for each in (one, two)):
            reach = reach / 100
        try:
            found = intersect(one, two, middle, reach, tolerance)
        except ContactError:
            return None
        return None if found.curves or len(found.nodes) else found.contacts
    carrier, other = (one, two) if isinstance(one, Carrier) else (two, one)
    assert isinstance(carrier, Carrier) and not isinstance(other, Carrier)
    if isinstance(other, Curve):
        met = crossings(other, carrier, tolerance)
        whole = met.contained or not met.tangential.all()
        return None if whole else np.asarray(other.point(met.parameters))
    off = abs(float(carrier.signed_distance(other)))
    return other[None] if off <= tolerance else np.empty((0, 3))


def _geometry(site: VoronoiSite, middle: Array, reach: float) -> Carrier | Curve | Array:
    """A carrier, a curve (of a line the part within reach), or a point (3,)."""
    if isinstance(site, CurveSite):
        return site.curve
    assert isinstance(site, CarrierSite)
    if site.two_sided:
        return site.carrier
    if isinstance(site, SphereSite):
        return site.carrier.centre
    if isinstance(site, CylinderSite):
        line = site.carrier
        start = line.point + float((middle - line.point) @ line.axis) * line.axis
        return Line(start, line.axis, domain=(-reach, reach))
    assert isinstance(site, TorusSite)
    ring = site.carrier
    return Circle(ring.centre, *frame(ring.axis), ring.major)


def _normal_line(f: VoronoiSite, g: VoronoiSite, p: Array, tolerance: float) -> Shape:
    """The common normal at a point of contact; a point where there is none."""
    for site in (f, g):
        if not site.two_sided or not isinstance(site, CarrierSite):
            continue
        carrier = site.carrier
        if isinstance(carrier, Cone) and float(norm(p - carrier.apex)) <= tolerance:
            continue
        return shape(Kind.LINE, p, carrier.normal(p))
    return shape(Kind.POINT, p, np.array([0.0, 0.0, 1.0]))
