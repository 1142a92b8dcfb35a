"""Circles and tubes about them in special positions to lines and to each other.

With D the distance from a torus's spine, s = D - minor. A cylinder of the same radius whose axis
lies in the spine's plane has D_g^2 = l^2 + z^2, with l the distance from the axis in that plane,
so that (rho - R)^2 = l^2: each of rho = R + l and rho = R - l has its focus on the torus's axis.
"""

from __future__ import annotations

from fractions import Fraction
from math import pi

import numpy as np

from decomp.vectors import norm
from decomp.voronoi.exact import cross, floats, inner, length, minus, moved, unit
from decomp.voronoi.focal import FocalForm, focal_surface
from decomp.voronoi.found import Found, both_of
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial, height
from decomp.voronoi.position import Axis, aligned
from decomp.voronoi.shape import plane_pair, shape
from decomp.voronoi.sites import CylinderSite, TorusSite


def ring_and_level_tube(
    ring: TorusSite, tube: CylinderSite, tolerance: float, angle: float
) -> Found | None:
    """Torus and cylinder (circle and line) of equal radius, the axis in the spine's plane.

    Two parabolic cylinders about the torus's axis, one where the line passes outside the circle; a
    half-plane and one where it touches. None in other positions.
    """
    axis = Axis(ring.centre, ring.axis)
    if abs(float(unit(ring.axis) @ unit(tube.axis))) > angle:
        return None
    if abs(float(axis.height(tube.point))) > tolerance:
        return None
    normal = cross(ring.axis, tube.axis)
    size = length(normal)
    forms = []
    for side in (Fraction(1), Fraction(-1)):
        gradient = moved((Fraction(0),) * 3, side / size, normal)
        forms.append(FocalForm(axis, gradient, ring.major - inner(gradient, tube.point)))
    found = [focal_surface(form, tolerance, angle) for form in forms]
    return both_of(found, ring.centre)


def threaded_rings(
    f: TorusSite, g: TorusSite, e: int, tolerance: float, angle: float
) -> Found | None:
    """Tori that touch along a meridian of one and an equator of the other.

    The tube of f fills the hole of g (e = -1), or holds g (e = +1). Then all normals along the
    circle lie in the plane of g's spine. Two such planes if each fills the other's hole. None in
    other positions, and where the tori cross elsewhere, so that there are other points.
    """
    planes = [two for one, two in ((f, g), (g, f)) if _is_threaded(one, two, e, tolerance, angle)]
    if not planes:
        return None
    raws = [height(site.centre, site.axis) for site in planes]
    origin = floats(planes[0].centre)
    normals = [unit(site.axis) for site in planes]
    if len(planes) == 1:
        return shape(Kind.PLANE, origin, normals[0]), Polynomial.of(raws[0], planes[0].centre)
    z, x = np.cross(normals[0], normals[1]), normals[0] + normals[1]
    pair = plane_pair(origin, z / norm(z), x / norm(x), pi / 4)
    return pair, Polynomial.of(raws[0] * raws[1], planes[0].centre)


def _is_threaded(f: TorusSite, g: TorusSite, e: int, tolerance: float, angle: float) -> bool:
    """Whether g's spine is a circle about a point of f's spine, across it, that f's tube reaches.

    On g's spine D_f is R_g then, and D_f - e D_g = R_g in its plane, inside it for e = -1 and
    outside it for e = +1.
    """
    axis, out = Axis(f.centre, f.axis), minus(g.centre, f.centre)
    if abs(float(f.minor - e * g.minor - g.major)) > tolerance or f.major - g.major < -tolerance:
        return False
    if abs(float(axis.height(g.centre))) > tolerance:
        return False
    if abs(axis.gap(g.centre) - float(f.major)) > tolerance:
        return False
    return bool(aligned(cross(f.axis, out), g.axis, angle))
