"""Two surfaces of revolution with a common axis: circles.

In the half-plane (rho, z), rho >= 0, each of them is a line (plane, cylinder, cone) or a circle
(sphere, torus). Common points of the two profiles turn into circles about the axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin, sqrt

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.curves.circle import Circle
from decomp.curves.intersect.result import Intersection, PairCurve, Window, points
from decomp.tolerance import PARALLEL
from decomp.vectors import Array, dot, frame, norm


@dataclass(frozen=True)
class Profile:
    """A line through `at` along `along` (a ray if `half`), or a circle about `at`."""

    at: tuple[float, float]
    along: tuple[float, float] | None = None
    radius: float = 0.0
    half: bool = False


def common_axis(a: Carrier, b: Carrier, window: Window) -> tuple[Array, Array, float] | None:
    """Point and direction of the common axis and how far it is from being one.

    None if the carriers are further from coaxial than the tolerance.
    """
    (pa, ka), (pb, kb) = _axis(a), _axis(b)
    reach = window.radius
    if ka is None and kb is None:
        assert pa is not None
        assert pb is not None
        gap = pb - pa
        size = float(norm(gap))
        return pa, gap / size if size > 0 else np.array([0.0, 0.0, 1.0]), 0.0
    k = ka if ka is not None else kb
    assert k is not None
    off = 0.0
    if ka is not None and kb is not None:
        off = float(norm(np.cross(ka, kb))) * reach
    origin = pa if pa is not None else pb
    assert origin is not None
    if pa is not None and pb is not None:
        away = pb - pa
        off += float(norm(away - dot(away, k) * k))
    return (origin, k, off) if off <= window.tolerance else None


def coaxial(a: Carrier, b: Carrier, origin: Array, axis: Array, window: Window) -> Intersection:
    """Circles about the common axis."""
    one, two = (_profile(c, origin, axis) for c in (a, b))
    x, y = frame(axis)
    curves, contacts = [], []
    for rho, z, tangent in _meet(one, two, window.tolerance):
        centre = origin + z * axis
        if rho <= window.tolerance:
            contacts.append(centre)
        elif float(norm(centre - window.centre)) <= window.radius + rho:
            curves.append(PairCurve(Circle(centre, x, y, rho), tangent))
    return Intersection(tuple(curves), contacts=_distinct(contacts, window.tolerance))


def _distinct(rows: list[Array], tolerance: float) -> Array:
    kept: list[Array] = []
    for p in rows:
        if all(float(norm(p - q)) > tolerance for q in kept):
            kept.append(p)
    return points(kept)


def _axis(c: Carrier) -> tuple[Array | None, Array | None]:
    """A point of the axis (None if any parallel axis will do) and its direction (or None)."""
    if isinstance(c, Plane):
        return None, c.normal_vector
    if isinstance(c, Sphere):
        return c.centre, None
    if isinstance(c, Cylinder):
        return c.point, c.axis
    if isinstance(c, Cone):
        return c.apex, c.axis
    assert isinstance(c, Torus)
    return c.centre, c.axis


def _profile(c: Carrier, origin: Array, axis: Array) -> Profile:
    if isinstance(c, Plane):
        return Profile((0.0, float(dot(c.point - origin, axis))), (1.0, 0.0))
    if isinstance(c, Sphere):
        return Profile((0.0, float(dot(c.centre - origin, axis))), None, c.radius)
    if isinstance(c, Cylinder):
        return Profile((c.radius, 0.0), (0.0, 1.0))
    if isinstance(c, Cone):
        up = 1.0 if float(dot(c.axis, axis)) > 0 else -1.0
        along = (sin(c.angle), up * cos(c.angle))
        return Profile((0.0, float(dot(c.apex - origin, axis))), along, half=True)
    assert isinstance(c, Torus)
    return Profile((c.major, float(dot(c.centre - origin, axis))), None, c.minor)


def _meet(one: Profile, two: Profile, tolerance: float) -> list[tuple[float, float, bool]]:
    """Common points (rho, z) with rho >= 0, and whether the profiles touch there."""
    if one.along is None and two.along is None:
        found = _circles(one, two, tolerance)
    elif one.along is not None and two.along is not None:
        found = _lines(one, two)
    else:
        line, circle = (one, two) if one.along is not None else (two, one)
        found = _line_circle(line, circle, tolerance)
    kept: list[tuple[float, float, bool]] = []
    for rho, z, tangent in found:
        if rho < -tolerance:
            continue
        on = all(
            (rho - p.at[0]) * p.along[0] + (z - p.at[1]) * p.along[1] >= -tolerance
            for p in (one, two)
            if p.half and p.along is not None
        )
        if on and all(hypot(rho - r, z - h) > tolerance for r, h, _ in kept):
            kept.append((max(rho, 0.0), z, tangent))
    return kept


def _lines(one: Profile, two: Profile) -> list[tuple[float, float, bool]]:
    assert one.along is not None
    assert two.along is not None
    (ux, uz), (vx, vz) = one.along, two.along
    det = ux * vz - uz * vx
    if abs(det) < PARALLEL:
        return []
    dx, dz = two.at[0] - one.at[0], two.at[1] - one.at[1]
    s = (dx * vz - dz * vx) / det
    return [(one.at[0] + s * ux, one.at[1] + s * uz, False)]


def _line_circle(
    line: Profile, circle: Profile, tolerance: float
) -> list[tuple[float, float, bool]]:
    assert line.along is not None
    ux, uz = line.along
    dx, dz = circle.at[0] - line.at[0], circle.at[1] - line.at[1]
    s, off = dx * ux + dz * uz, dx * uz - dz * ux
    gap = abs(off) - circle.radius
    foot = (line.at[0] + s * ux, line.at[1] + s * uz)
    if abs(gap) <= tolerance:
        return [(*foot, True)]
    if gap > 0:
        return []
    h = sqrt((circle.radius - off) * (circle.radius + off))
    return [(foot[0] + e * h * ux, foot[1] + e * h * uz, False) for e in (1, -1)]


def _circles(one: Profile, two: Profile, tolerance: float) -> list[tuple[float, float, bool]]:
    dx, dz = two.at[0] - one.at[0], two.at[1] - one.at[1]
    d, r, s = hypot(dx, dz), one.radius, two.radius
    if d <= tolerance:
        return []
    ux, uz = dx / d, dz / d
    if abs(d - r - s) <= tolerance or abs(d - abs(r - s)) <= tolerance:
        e = -1.0 if d < abs(r - s) + tolerance and r < s else 1.0
        return [(one.at[0] + e * r * ux, one.at[1] + e * r * uz, True)]
    if d > r + s or d < abs(r - s):
        return []
    t = ((d - s) * (d + s) + r * r) / (2 * d)
    h = sqrt((r - t) * (r + t))
    x, z = one.at[0] + t * ux, one.at[1] + t * uz
    return [(x - e * h * uz, z + e * h * ux, False) for e in (1, -1)]
