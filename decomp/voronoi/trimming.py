"""Trim surfaces: ruled by a face's normals along an edge (the paper's section 2.5).

They are planes, cylinders over the edge, and right circular cones, but for conics on cylinders and
cones: figure 5's, of an ellipse on a cylinder, is a ruled surface of degree 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, pi

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.ellipse import Ellipse
from decomp.curves.hyperbola import Hyperbola
from decomp.curves.line import Line
from decomp.curves.parabola import Parabola
from decomp.errors import GeometryError
from decomp.tolerance import TINY, TOLERANCE
from decomp.vectors import Array, cross, dot, norm
from decomp.voronoi.canonical import equation_of
from decomp.voronoi.exact import Vector, exact_vector
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial, height, squared_distance_from_line
from decomp.voronoi.shape import Shape, shape


@dataclass(frozen=True, eq=False)
class TrimSurface:
    """The surface of the points curve(t) + s normal(t).

    Args:
        curve: the edge.
        carrier: the face's, whose normals they are.
        shape: its kind and place, None if it is of no special kind.
        conoid: the polynomial of the ruled surface of an ellipse on a cylinder, else None.
    """

    curve: Curve
    carrier: Carrier
    shape: Shape | None
    conoid: Polynomial | None

    @property
    def polynomial(self) -> Polynomial | None:
        """The implicit polynomial where it is a plane, cone or cylinder, or a conoid; else None."""
        return self.conoid if self.shape is None else equation_of(self.shape)

    @property
    def kind(self) -> Kind:
        """What it is."""
        return Kind.GENERAL if self.shape is None else self.shape.kind

    def point(self, t: Array, s: Array) -> Array:
        """Points (..., 3) at the edge's parameter t and signed distance s from it."""
        q = self.curve.point(t)
        return np.asarray(q + np.asarray(s)[..., None] * self.carrier.normal(q))


def trim_surface(curve: Curve, carrier: Carrier) -> TrimSurface:
    """The trim surface of an edge on one of its two faces.

    Raises:
        GeometryError: the curve does not lie on the carrier.
    """
    t = np.linspace(*curve.domain, 9)
    off = np.abs(carrier.signed_distance(curve.point(t)))
    reach = float(curve.bounding_ball()[1])
    if float(off.max()) > TOLERANCE * max(reach, TINY):
        raise GeometryError(f"the {curve.kind} does not lie on the {carrier.kind}")
    if isinstance(carrier, Plane):
        return TrimSurface(curve, carrier, _on_plane(curve, carrier), None)
    if isinstance(curve, Line):
        # a ruling: all normals along it are parallel (but a cone has none at its apex)
        q = curve.point(np.array(sum(curve.domain) / 2))
        normal = cross(curve.direction, carrier.normal(q))
        return TrimSurface(curve, carrier, shape(Kind.PLANE, q, normal), None)
    if isinstance(curve, Circle):
        return TrimSurface(curve, carrier, _of_circle(curve, carrier), None)
    if isinstance(curve, Ellipse) and isinstance(carrier, Cylinder):
        return TrimSurface(curve, carrier, None, _conoid(curve, carrier))
    return TrimSurface(curve, carrier, None, None)


def _on_plane(curve: Curve, plane: Plane) -> Shape | None:
    """The cylinder over the curve."""
    z = plane.normal_vector
    if isinstance(curve, Line):
        return shape(Kind.PLANE, curve.origin, cross(curve.direction, z), curve.direction)
    if isinstance(curve, Circle):
        return shape(Kind.CIRCULAR_CYLINDER, curve.centre, z, curve.x, radius=curve.radius)
    if isinstance(curve, Ellipse):
        return shape(Kind.ELLIPTIC_CYLINDER, curve.centre, z, curve.x, a=curve.a, b=curve.b)
    if isinstance(curve, Hyperbola):
        return shape(Kind.HYPERBOLIC_CYLINDER, curve.centre, z, curve.x, a=curve.a, b=curve.b)
    if isinstance(curve, Parabola):
        return shape(Kind.PARABOLIC_CYLINDER, curve.vertex, z, curve.x, focal_length=curve.focal)
    return None


def _of_circle(circle: Circle, carrier: Carrier) -> Shape | None:
    """The normals of a circle about a carrier's axis lie on a cone, a cylinder or a plane.

    Those of a torus's meridian, a circle round its tube, fill the meridian's plane.
    """
    z = cross(circle.x, circle.y)
    if isinstance(carrier, Sphere):
        return _fan(circle, z, circle.centre - carrier.centre)
    if isinstance(carrier, (Cylinder, Cone, Torus)):
        q = circle.point(np.linspace(0, circle.period, 4)[:3])
        n = carrier.normal(q)
        if float(np.abs(n @ z).max()) <= TOLERANCE:
            # across the axis, or a meridian
            return shape(Kind.PLANE, circle.centre, z, circle.x)
        if float(np.ptp(n @ z)) > TOLERANCE:
            return None
        if float(norm(n - (n @ z)[:, None] * z).max()) <= TOLERANCE:
            return shape(Kind.CIRCULAR_CYLINDER, circle.centre, z, circle.x, radius=circle.radius)
        radial = (q - circle.centre) / circle.radius
        # the normal meets the axis after -radius / (n . radial)
        step = -circle.radius / float(dot(n, radial)[0])
        apex = circle.centre + step * float((n @ z)[0]) * z
        return _fan(circle, z, circle.centre - apex)
    return None


def _fan(circle: Circle, z: Array, rise: Array) -> Shape:
    """The lines from a point to a circle above it, `rise` from the point to the centre."""
    climb = float(rise @ z)
    if abs(climb) <= TOLERANCE * circle.radius:
        return shape(Kind.PLANE, circle.centre, z, circle.x)
    opening = z if climb > 0 else -z
    angle = atan2(circle.radius, abs(climb))
    assert 0 < angle < pi / 2
    apex = circle.centre - climb * z
    return shape(Kind.CIRCULAR_CONE, apex, opening, circle.x, half_angle=angle)


def _conoid(ellipse: Ellipse, cylinder: Cylinder) -> Polynomial:
    """Figure 5: heights over an oblique section keep along normals, h rho = m r x.

    With the section at height m x of a cylinder of radius r, a point at distance rho from the
    axis in direction x / rho has the height m r x / rho: h^2 rho^2 = m^2 r^2 x^2.
    """
    axis = cylinder.axis
    # the centre of the section is on the axis
    normal = cross(ellipse.x, ellipse.y)
    # along the section's plane n.(p - c) = 0: h = -(n.(p - c) - h n.a) / n.a
    slope = (normal - float(normal @ axis) * axis) * (-cylinder.radius / float(normal @ axis))
    centre = _given(ellipse.centre)
    square = squared_distance_from_line(centre, _given(axis))
    raw = height(centre, _given(axis)) ** 2 * square - height(centre, _given(slope)) ** 2
    return Polynomial.of(raw, centre)


def _given(values: Array) -> Vector:
    return exact_vector(values, "a curve's parameter")
