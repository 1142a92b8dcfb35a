"""All points of a carrier whose normals go through a given point, nearest or not."""

from __future__ import annotations

import numpy as np

from decomp.carriers import Cone, Cylinder, Plane, Sphere, Torus
from decomp.carriers.axial import axial_split
from decomp.vectors import Array
from decomp.voronoi.sites import CarrierSite


def stationary_feet(site: CarrierSite, p: Array) -> Array:
    """Feet (k, 3) of one point (3,): 1 on a plane, 2 on a quadric, 4 on a torus.

    A cone is taken with both nappes. On a reflexive locus, where infinitely many normals meet,
    one pair is given. Points and lines have one foot, circles two.
    """
    carrier = site.carrier
    if isinstance(carrier, Plane):
        return carrier.foot(p)[None]
    if isinstance(carrier, Sphere):
        ways = carrier.normal(p) * np.array([[1.0], [-1.0]])
        return _distinct(carrier.centre + carrier.radius * ways)
    if isinstance(carrier, Cylinder):
        z, _, out = axial_split(p, carrier.point, carrier.axis)
        radial = carrier.radius * np.array([[1.0], [-1.0]]) * out
        return _distinct(carrier.point + z * carrier.axis + radial)
    if isinstance(carrier, Cone):
        return _on_rulings(carrier, p)
    assert isinstance(carrier, Torus)
    return _on_tube(carrier, p)


def _on_rulings(cone: Cone, p: Array) -> Array:
    z, rho, out = axial_split(p, cone.apex, cone.axis)
    sine, cosine = np.sin(cone.angle), np.cos(cone.angle)
    feet = []
    for side in (1.0, -1.0):
        ruling = side * sine * out + cosine * cone.axis
        feet.append(cone.apex + (side * sine * rho + cosine * z) * ruling)
    return _distinct(np.array(feet))


def _on_tube(torus: Torus, p: Array) -> Array:
    _, _, out = axial_split(p, torus.centre, torus.axis)
    feet = []
    for side in (1.0, -1.0):
        spine = torus.centre + side * torus.major * out
        away = p - spine
        length = float(np.linalg.norm(away))
        way = away / length if length > 0 else side * out
        feet += [spine + torus.minor * way, spine - torus.minor * way]
    return _distinct(np.array(feet))


def _distinct(feet: Array) -> Array:
    """Without repetitions, as for radius zero."""
    kept: list[Array] = []
    for foot in feet:
        if not any(np.array_equal(foot, other) for other in kept):
            kept.append(foot)
    return np.array(kept)
