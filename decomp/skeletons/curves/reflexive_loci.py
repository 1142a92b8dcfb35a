"""The curves from whose points a carrier is as near all around: its reflexive locus.

A cylinder's and a cone's is the axis, a torus's the spine and, outside its tube, the axis; a circle
that is an edge has its axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Torus
from decomp.curves.circle import Circle
from decomp.vectors import Array, cross, frame, norm

DIFFERENCE = 1e-6
"""Step of differences along a locus, as a part of the size."""
ASIDE = 1e-7
"""Radius of the circle around a locus, as a part of the size."""


@dataclass(frozen=True, eq=False)
class Locus:
    """The reflexive locus of a carrier as a curve.

    Args:
        point: points (k, 3) at parameters (k,), arc length.
        span: first and last parameter to look at.
        closed: whether these are the same point.
        radius: distance (k,) to the carrier.
        parameter: of points (k, 3) near the locus.
        touched: directions (count, 3) from the point at one parameter to the points of the
            carrier that are nearest to it, evenly around their circle.
    """

    point: Callable[[Array], Array]
    span: tuple[float, float]
    closed: bool
    radius: Callable[[Array], Array]
    parameter: Callable[[Array], Array]
    touched: Callable[[float, int], Array]


def locus_of(carrier: Carrier, outward: int, bounds: Array) -> Locus | None:
    """The locus of a carrier on its inner side, None if it has none; a sphere's is a point.

    Args:
        carrier: of a face.
        outward: +1 if its normal points out of the region, else -1.
        bounds: (2, 3) of the region.
    """
    if isinstance(carrier, Cylinder) and outward > 0:
        radius = carrier.radius
        return _line(
            carrier.point, carrier.axis, bounds, lambda u: np.full(np.shape(u), radius), carrier
        )
    if isinstance(carrier, Cone) and outward > 0:
        apex, axis, sine = carrier.apex, carrier.axis, np.sin(carrier.angle)
        line = _line(apex, axis, bounds, lambda u: np.asarray(np.maximum(u, 0.0) * sine), carrier)
        low, high = line.span
        span = (max(low, 0.0), max(high, 0.0))
        return replace(line, span=span)
    if isinstance(carrier, Torus):
        major, minor, centre = carrier.major, carrier.minor, carrier.centre
        if outward < 0:
            return _line(
                centre,
                carrier.axis,
                bounds,
                lambda u: np.asarray(np.hypot(major, u) - minor),
                carrier,
            )
        x, y = frame(carrier.axis)

        def spine(u: Array) -> Array:
            angle = np.asarray(u)[..., None] / major
            return np.asarray(centre + major * (np.cos(angle) * x + np.sin(angle) * y))

        def along(p: Array) -> Array:
            v = p - centre
            return np.asarray(major * np.mod(np.arctan2(v @ y, v @ x), 2 * np.pi))

        return Locus(
            spine,
            (0.0, 2 * np.pi * major),
            True,
            lambda u: np.full(np.shape(u), minor),
            along,
            _touched_circle(spine, carrier.foot, minor),
        )
    return None


def _line(
    point: Array,
    axis: Array,
    bounds: Array,
    radius: Callable[[Array], Array],
    carrier: Carrier,
) -> Locus:
    corners = np.array(np.meshgrid(*bounds.T)).reshape(3, -1).T
    heights = (corners - point) @ axis

    def at(u: Array) -> Array:
        return np.asarray(point + np.asarray(u)[..., None] * axis)

    size = float(norm(bounds[1] - bounds[0]))
    return Locus(
        at,
        (float(heights.min()), float(heights.max())),
        False,
        radius,
        lambda p: np.asarray((p - point) @ axis),
        _touched_circle(at, carrier.foot, size),
    )


def _touched_circle(
    point: Callable[[Array], Array], foot: Callable[[Array], Array], size: float
) -> Callable[[float, int], Array]:
    """Directions to the feet of points on a small circle around the locus."""

    def touched(u: float, count: int) -> Array:
        h = DIFFERENCE * size
        behind, here, ahead = point(np.array([u - h, u, u + h]))
        x, y = frame((ahead - behind) / float(norm(ahead - behind)))
        angle = np.linspace(0, 2 * np.pi, count, endpoint=False)[:, None]
        ways = foot(here + ASIDE * size * (np.cos(angle) * x + np.sin(angle) * y)) - here
        return np.asarray(ways / norm(ways)[:, None])

    return touched


def circle_axis(circle: Circle, bounds: Array) -> Locus:
    """The axis of a circle that is an edge: its points are equally far from the whole circle."""
    axis = cross(circle.x, circle.y)
    corners = np.array(np.meshgrid(*bounds.T)).reshape(3, -1).T
    heights = (corners - circle.centre) @ axis

    def touched(u: float, count: int) -> Array:
        angle = np.linspace(0, circle.period, count, endpoint=False)
        ways = circle.point(circle.domain[0] + angle) - circle.centre - u * axis
        return np.asarray(ways / norm(ways)[:, None])

    return Locus(
        lambda u: np.asarray(circle.centre + np.asarray(u)[..., None] * axis),
        (float(heights.min()), float(heights.max())),
        False,
        lambda u: np.hypot(circle.radius, u),
        lambda p: np.asarray((p - circle.centre) @ axis),
        touched,
    )
