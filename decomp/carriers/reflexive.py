"""Reflexive loci of carriers: the points that are as far from many of a carrier's points."""

from __future__ import annotations

import numpy as np

from decomp.carriers.base import Carrier
from decomp.carriers.cone import Cone
from decomp.carriers.cylinder import Cylinder
from decomp.carriers.sphere import Sphere
from decomp.carriers.torus import Torus
from decomp.errors import GeometryError
from decomp.vectors import Array, norm


def reflexive_gap(carrier: Carrier, outward: int, points: Array) -> Array:
    """Distance (k,) of points (k, 3) from the reflexive locus on a face's inner side.

    Infinite where there is none.
    """
    away = np.full(len(points), np.inf)
    if isinstance(carrier, Sphere) and outward > 0:
        return norm(points - carrier.centre)
    if isinstance(carrier, Cylinder) and outward > 0:
        return _off_axis(points - carrier.point, carrier.axis)
    if isinstance(carrier, Cone) and outward > 0:
        return _off_axis(points - carrier.apex, carrier.axis)
    if isinstance(carrier, Torus):
        if outward < 0:
            return _off_axis(points - carrier.centre, carrier.axis)
        return np.asarray(carrier.signed_distance(points) + carrier.minor)
    return away


def inner_radius(carrier: Carrier, outward: int, points: Array) -> Array:
    """Distance (k,) from points (k, 3) of a carrier along its normals to its reflexive locus."""
    if isinstance(carrier, (Sphere, Cylinder)):
        return np.full(len(points), carrier.radius)
    if isinstance(carrier, Cone):
        # the normal from the point at slant length l meets the axis at distance l tan(angle)
        return np.asarray(norm(points - carrier.apex) * np.tan(carrier.angle))
    if isinstance(carrier, Torus):
        if outward > 0:
            return np.full(len(points), carrier.minor)
        off = _off_axis(points - carrier.centre, carrier.axis)
        # from the tube's inner side: beyond the tube the normal goes on to the axis
        with np.errstate(divide="ignore"):  # at the tube's top normals are parallel to the axis
            return np.asarray(off * carrier.minor / (carrier.major - off))
    raise GeometryError(f"a {carrier.kind} has no reflexive locus")


def _off_axis(v: Array, axis: Array) -> Array:
    return norm(v - (v @ axis)[:, None] * axis)
