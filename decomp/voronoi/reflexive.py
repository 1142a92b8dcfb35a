"""Reflexive loci: the points that are as far from several points of one site.

Of carriers (the paper's section 2.1) and of edge curves. They are points and curves; of conics that
are not circles they are strips of the plane of symmetry.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.line import Line
from decomp.curves.parabola import Parabola
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, cross, frame


class Side(Enum):
    """Where a locus lies; curves have no sides."""

    INSIDE = "inside"
    OUTSIDE = "outside"
    NEITHER = "neither"


class LocusKind(Enum):
    """The kinds of reflexive loci, in a frame (x, y, z) at an origin."""

    POINT = "point"
    """x = y = z = 0"""
    LINE = "line"
    """x = y = 0"""
    HALF_LINE = "half-line"
    """x = y = 0, z >= 0"""
    CIRCLE = "circle"
    """x^2 + y^2 = high^2, z = 0"""
    STRIP = "strip"
    """y = 0, low <= x <= high, any z: high is infinite for a half-plane"""


@dataclass(frozen=True, eq=False)
class ReflexiveLocus:
    """A part of a site's reflexive locus.

    Args:
        kind: see there for the equations.
        side: of the carrier.
        origin: (3,).
        axes: x, y, z as rows (3, 3).
        low, high: bounds or radius.
    """

    kind: LocusKind
    side: Side
    origin: Array
    axes: Array
    low: float = 0.0
    high: float = 0.0

    @property
    def dimension(self) -> int:
        """0, 1 or 2."""
        return {LocusKind.POINT: 0, LocusKind.STRIP: 2}.get(self.kind, 1)

    def contains(self, p: Array, tolerance: float) -> Bools:
        """Whether points (..., 3) are within a tolerance of the locus."""
        x, y, z = np.moveaxis((p - self.origin) @ self.axes.T, -1, 0)
        off = {
            LocusKind.POINT: lambda: np.sqrt(x**2 + y**2 + z**2),
            LocusKind.LINE: lambda: np.hypot(x, y),
            LocusKind.HALF_LINE: lambda: np.sqrt(x**2 + y**2 + np.minimum(z, 0) ** 2),
            LocusKind.CIRCLE: lambda: np.hypot(np.hypot(x, y) - self.high, z),
            LocusKind.STRIP: lambda: np.hypot(y, x - np.clip(x, self.low, self.high)),
        }[self.kind]()
        return np.asarray(off <= tolerance)

    def points(self, count: int, reach: float, seed: int = 0) -> Array:
        """Some points (count, 3) of the locus, where it is infinite within `reach`."""
        rng = np.random.default_rng(seed)
        zero, free = np.zeros(count), rng.uniform(-reach, reach, count)
        turn = rng.uniform(0, 2 * np.pi, count)
        low, high = max(self.low, -reach), min(self.high, self.low + reach)
        local = {
            LocusKind.POINT: (zero, zero, zero),
            LocusKind.LINE: (zero, zero, free),
            LocusKind.HALF_LINE: (zero, zero, np.abs(free)),
            LocusKind.CIRCLE: (self.high * np.cos(turn), self.high * np.sin(turn), zero),
            LocusKind.STRIP: (rng.uniform(low, high, count), zero, free),
        }[self.kind]
        return np.asarray(self.origin + np.stack(local, axis=-1) @ self.axes)


def reflexive_loci(site: Carrier | Curve) -> tuple[ReflexiveLocus, ...]:
    """The parts of the reflexive locus of a whole carrier or edge curve; none for plane and line.

    Raises:
        GeometryError: the locus has no closed form.
    """
    if isinstance(site, (Plane, Line)):
        return ()
    if isinstance(site, Sphere):
        return (ReflexiveLocus(LocusKind.POINT, Side.INSIDE, site.centre, np.eye(3)),)
    if isinstance(site, Cylinder):
        return (_about(LocusKind.LINE, Side.INSIDE, site.point, site.axis),)
    if isinstance(site, Cone):
        return (_about(LocusKind.HALF_LINE, Side.INSIDE, site.apex, site.axis),)
    if isinstance(site, Torus):
        spine = _about(LocusKind.CIRCLE, Side.INSIDE, site.centre, site.axis, site.major)
        return spine, _about(LocusKind.LINE, Side.OUTSIDE, site.centre, site.axis)
    if isinstance(site, Circle):
        axis = cross(site.x, site.y)
        return (_about(LocusKind.LINE, Side.NEITHER, site.centre, axis),)
    if isinstance(site, Curve):
        return (_of_conic(site),)
    raise GeometryError(f"the reflexive locus of a {site.kind} is not known")


def _about(
    kind: LocusKind, side: Side, origin: Array, axis: Array, radius: float = 0.0
) -> ReflexiveLocus:
    x, y = frame(axis)
    return ReflexiveLocus(kind, side, origin, np.stack([x, y, axis]), 0.0, radius)


def _of_conic(curve: Curve) -> ReflexiveLocus:
    """Between the centres of curvature of an ellipse's (a > b) vertices, beyond that of others.

    From (x, 0, z) the squared distance of a point of the ellipse is least at cos t = a x /
    (a^2 - b^2), wherever z is: two points, until they join at the vertex.
    """
    if isinstance(curve, Ellipse):
        x, y, a, b = curve.x, curve.y, curve.a, curve.b
        if b > a:
            x, y, a, b = y, -x, b, a
        half = (a**2 - b**2) / a
        return _strip(curve.centre, x, y, -half, half)
    if isinstance(curve, Hyperbola):
        start = (curve.a**2 + curve.b**2) / curve.a
        return _strip(curve.centre, curve.x, curve.y, start, np.inf)
    if isinstance(curve, Parabola):
        return _strip(curve.vertex, curve.x, curve.y, 2 * curve.focal, np.inf)
    raise GeometryError(f"the reflexive locus of a {curve.kind} edge has no closed form here")


def _strip(origin: Array, x: Array, y: Array, low: float, high: float) -> ReflexiveLocus:
    axes = np.stack([x, y, cross(x, y)])
    return ReflexiveLocus(LocusKind.STRIP, Side.NEITHER, origin, axes, low, high)
