"""How level surfaces bend: second derivatives of distances, principal curvatures.

Where the foot q of a point p on a surface has the shape operator W, the Hessian of the distance d
is W (I + d W)^-1: along each principal direction the reciprocal of the distance from the centre of
curvature. Written out for every carrier that leaves the closed forms below.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.carriers.axial import axial_split
from decomp.errors import GeometryError
from decomp.vectors import Array, cross, dot, frame, norm

NO_DIRECTION = 1e-9
"""Gradients (of differences of distances) that are shorter have no direction."""


@dataclass(frozen=True, eq=False)
class Curvatures:
    """The shape of a surface at points of it.

    Args:
        normal: unit normals (..., 3), towards growing values.
        values: principal curvatures (..., 2) in increasing order, positive where the surface
            bends towards -normal.
        directions: principal directions (..., 2, 3).
    """

    normal: Array
    values: Array
    directions: Array


def level_curvatures(gradient: Array, hessian: Array, p: Array) -> Curvatures:
    """Of the level surfaces of a function with gradients (..., 3) and Hessians (..., 3, 3).

    Raises:
        GeometryError: a gradient vanishes: there is no tangent plane.
    """
    steep = norm(gradient)
    if (steep <= NO_DIRECTION).any():
        where = np.asarray(p)[steep <= NO_DIRECTION].reshape(-1, 3)[0]
        raise GeometryError("the two distances change alike at {at}: no tangent plane", at=where)
    normal = gradient / steep[..., None]
    flat = normal.reshape(-1, 3)
    across = np.array([np.stack(frame(n)) for n in flat]).reshape(*normal.shape[:-1], 2, 3)
    form = across @ (hessian / steep[..., None, None]) @ np.swapaxes(across, -1, -2)
    values, turned = np.linalg.eigh(form)
    return Curvatures(normal, values, np.swapaxes(turned, -1, -2) @ across)


def distance_hessian(carrier: Carrier, p: Array) -> Array:
    """Second derivatives (..., 3, 3) of a carrier's signed distance, off its reflexive locus."""
    if isinstance(carrier, Plane):
        return np.zeros((*p.shape, 3))
    if isinstance(carrier, Sphere):
        return about_point(p - carrier.centre)
    if isinstance(carrier, Cylinder):
        _, rho, out = axial_split(p, carrier.point, carrier.axis)
        return _square(cross(np.broadcast_to(carrier.axis, out.shape), out), 1 / rho)
    if isinstance(carrier, Cone):
        z, rho, out = axial_split(p, carrier.apex, carrier.axis)
        sine, cosine = np.sin(carrier.angle), np.cos(carrier.angle)
        around = cross(np.broadcast_to(carrier.axis, out.shape), out)
        beyond = z * cosine + rho * sine <= 0
        at_apex = about_point(p - carrier.apex)
        return np.where(beyond[..., None, None], at_apex, _square(around, cosine / rho))
    if isinstance(carrier, Torus):
        z, rho, out = axial_split(p, carrier.centre, carrier.axis)
        away, tube = rho - carrier.major, np.hypot(rho - carrier.major, z)
        around = cross(np.broadcast_to(carrier.axis, out.shape), out)
        along = (z / tube)[..., None] * out - (away / tube)[..., None] * carrier.axis
        return _square(along, 1 / tube) + _square(around, away / (tube * rho))
    raise GeometryError(f"no second derivatives are known for a {carrier.kind}")


def about_point(away: Array) -> Array:
    """Of the distance from a point, at points `away` from it."""
    far = norm(away)
    return np.asarray(np.eye(3) / far[..., None, None] - _square(away / far[..., None], 1 / far))


def about_curve(away: Array, tangent: Array, bend: Array) -> Array:
    """Of the distance from a curve: from the foot (..., 3), unit tangent, curvature vector."""
    far = norm(away)
    n = away / far[..., None]
    towards = dot(bend, n)
    return about_point(away) + _square(tangent, -towards / (1 - far * towards) - 1 / far)


def _square(way: Array, size: Array) -> Array:
    """size way way^T."""
    return np.asarray(size[..., None, None] * way[..., :, None] * way[..., None, :])
