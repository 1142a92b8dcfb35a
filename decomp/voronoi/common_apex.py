"""Pairs whose equidistant points form quadratic cones about one point c.

Of two sites with axes u1, u2 through c let z_i be the height and rho_i the distance from axis i,
both as seen from c. Where equal distance means

    a1 rho1 + h1 z1 = a2 rho2 + h2 z2 = m   with   a1^2 + h1^2 = a2^2 + h2^2 = s,

the first form gives s |p|^2 - m^2 = (s z1 - h1 m)^2 / a1^2, the second the same, so that

    (s z1 - h1 m) / a1 = +- (s z2 - h2 m) / a2:

for either sign m is linear in p, and the surface a quadratic cone, or a plane if m drops out. That
is so for cones and cylinders about one sphere (a = cos, h = -sin of the half-angle, and the radii
of the spheres agree) and for circles and equal tubes on one sphere (a = R, h = the spine's height
above c).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import atan, sqrt

import numpy as np

from decomp.vectors import Array, norm
from decomp.voronoi.elimination import squarefree
from decomp.voronoi.exact import Vector, exact_vector, floats, inner, length, minus, moved
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial, height, linear, rational, squared_distance
from decomp.voronoi.position import Axis, aligned, axis_of
from decomp.voronoi.shape import Shape, plane_pair, shape
from decomp.voronoi.sites import CarrierSite, ConeSite, CylinderSite, TorusSite

RULINGS = 24
"""Rulings of a part on which equality is tried: it holds on whole arcs of them, or on none."""
BEYOND_APEX = 1e-9
"""A point lies beyond a cone's apex if it does by more than this part of its distance from it."""
EQUAL_ALONG = 1e-7
"""Distances from two sites are equal along a ray if they differ by less than this part."""


@dataclass(frozen=True, eq=False)
class _Form:
    """across rho + along z about an axis through c.

    `sine` is that of a cone's half-angle where its apex is not behind c: rulings that leave c into
    the region whose nearest point is the apex hold no true point then.
    """

    axis: Axis
    across: Fraction
    along: Fraction
    sine: float = 0.0

    def __call__(self, p: Array) -> Array:
        """Values (k,) at points (k, 3) relative to c, NaN beyond a cone's apex."""
        z = p @ self.axis.unit
        rho = norm(p - z[:, None] * self.axis.unit)
        value = float(self.across) * rho + float(self.along) * z
        cosine = sqrt(max(1 - self.sine**2, 0.0))
        beyond = (self.sine > 0) & (rho * self.sine + z * cosine < -BEYOND_APEX * norm(p))
        return np.where(beyond, np.nan, value)


def about_one_sphere(
    f: CarrierSite, g: CarrierSite, e: int, tolerance: float, angle: float
) -> tuple[Shape, Polynomial] | None:
    """The surface s_f = e s_g of cones, cylinders or tori about one sphere, else None.

    Args:
        tolerance: lengths below it count as zero.
        angle: angles (radians) below it count as zero.
    """
    first, second = axis_of(f), axis_of(g)
    if first is None or second is None or aligned(first.direction, second.direction, angle):
        return None
    c = _meeting(first, second, tolerance)
    if c is None:
        return None
    pair = _forms(f, g, e, c, tolerance)
    if pair is None:
        return None
    one, two = pair
    found = [_part(one, two, sign, c, angle) for sign in (1, -1)]
    kept = [part for part in found if part is not None]
    if not kept:
        return None
    raw = kept[0][1].raw if len(kept) == 1 else kept[0][1].raw * kept[1][1].raw
    return _union([part for part, _ in kept]), Polynomial.of(raw, c)


def _meeting(first: Axis, second: Axis, tolerance: float) -> Vector | None:
    """The point where two axes meet, exactly if their parameters do."""
    u, v, between = first.direction, second.direction, minus(second.point, first.point)
    uu, uv, vv = inner(u, u), inner(u, v), inner(v, v)
    s = (inner(between, u) * vv - inner(between, v) * uv) / (uu * vv - uv**2)
    c = moved(first.point, s, u)
    return c if second.gap(c) <= tolerance else None


def _forms(
    f: CarrierSite, g: CarrierSite, e: int, c: Vector, tolerance: float
) -> tuple[_Form, _Form] | None:
    """Both sides of the equation, if the sites lie about one sphere with centre c."""
    if isinstance(f, TorusSite) and isinstance(g, TorusSite):
        forms = [_of_ring(site, c) for site in (f, g)]
        spheres = [sqrt(form.across**2 + form.along**2) for form in forms]
        tubes = abs(float(f.minor - e * g.minor)) <= tolerance
        same = tubes and abs(spheres[0] - spheres[1]) <= tolerance
        return (forms[0], forms[1]) if same else None
    if not (isinstance(f, (ConeSite, CylinderSite)) and isinstance(g, (ConeSite, CylinderSite))):
        return None
    radii = _radius(f, c), _radius(g, c)
    one, two = _of_cone(f, 1, radii[0] > tolerance), _of_cone(g, e, radii[1] > tolerance)
    same = abs(float(radii[0] - e * radii[1])) <= tolerance
    return (one, two) if same else None


def _of_ring(ring: TorusSite, c: Vector) -> _Form:
    axis = Axis(c, ring.axis)
    return _Form(axis, ring.major, axis.height(ring.centre))


def _of_cone(cone: ConeSite | CylinderSite, e: int, behind: bool) -> _Form:
    """The signed distance but for a constant, times e."""
    axis, sense = Axis(cone.reference, cone.axis), Fraction(e)
    if isinstance(cone, CylinderSite):
        return _Form(axis, sense, Fraction(0))
    return _Form(axis, sense * cone.cosine, -sense * cone.sine, 0.0 if behind else float(cone.sine))


def _radius(cone: ConeSite | CylinderSite, c: Vector) -> Fraction:
    """Of the inscribed sphere about c, negative beyond the apex."""
    if isinstance(cone, CylinderSite):
        return cone.radius
    return cone.sine * Axis(cone.apex, cone.axis).height(c)


def _part(
    one: _Form, two: _Form, sign: int, c: Vector, angle: float
) -> tuple[Shape, Polynomial] | None:
    """The plane or cone for one of the two signs, None if nothing of it is equidistant."""
    s = one.across**2 + one.along**2
    # s (z1 / a1 - sign z2 / a2) = m k
    k = one.along / one.across - sign * two.along / two.across
    scaled = moved(
        (Fraction(0),) * 3, s / (one.across * length(one.axis.direction)), one.axis.direction
    )
    flat = moved(scaled, -sign * s / (two.across * length(two.axis.direction)), two.axis.direction)
    if abs(float(k)) <= angle * float(abs(one.along / one.across) + 1):
        normal = floats(flat)
        raw = linear(flat, -inner(flat, c))
        found = shape(Kind.PLANE, floats(c), normal / norm(normal))
    else:
        slope = moved((Fraction(0),) * 3, 1 / k, flat)
        m = height(c, slope)
        z1 = height(c, one.axis.direction) / rational(length(one.axis.direction))
        raw = rational(one.across) ** 2 * (rational(s) * squared_distance(c) - m**2)
        raw -= (rational(s) * z1 - rational(one.along) * m) ** 2
        across2, w = float(one.across) ** 2, floats(slope)
        side = float(s) * one.axis.unit - float(one.along) * w
        form = across2 * (float(s) * np.eye(3) - np.outer(w, w)) - np.outer(side, side)
        made = _cone(floats(c), form / np.abs(form).max(), one, two, angle)
        if made is None:
            return None
        found = made
    if not _true(found, one, two).any():
        return None
    if found.kind is Kind.PLANE and raw.total_degree() == 2:
        # a double plane
        way = exact_vector(found.axes[2], "a normal")
        single = squarefree(raw)
        raw = single if single.total_degree() == 1 else linear(way, -inner(way, c))
    return found, Polynomial.of(raw, c)


def _cone(c: Array, form: Array, one: _Form, two: _Form, angle: float) -> Shape | None:
    """The canonical shape of the cone p . form p = 0 about c."""
    values, ways = np.linalg.eigh(form)
    zero = np.abs(values) <= angle * np.abs(values).max()
    if zero.any():
        return _planes(c, values, ways, zero)
    if (values < 0).all() or (values > 0).all():
        return None
    alone = 0 if values[1] > 0 else 2
    i, j = (1, 2) if alone == 0 else (0, 1)
    tx, ty = (sqrt(-values[alone] / values[n]) for n in (i, j))
    z = ways[:, alone]
    if abs(atan(tx) - atan(ty)) <= angle:
        found = [shape(Kind.CIRCULAR_CONE, c, w, half_angle=atan(tx)) for w in (z, -z)]
    else:
        halves = {"half_angle_x": atan(tx), "half_angle_y": atan(ty)}
        found = [shape(Kind.ELLIPTIC_CONE, c, w, ways[:, i], **halves) for w in (z, -z)]
    # the axis points into the nappe with more of the true points
    return max(found, key=lambda each: int(_true(each, one, two)[: RULINGS // 2].sum()))


def _planes(c: Array, values: Array, ways: Array, zero: Array) -> Shape | None:
    """A double plane, or two planes; None for a line or a point."""
    if int(zero.sum()) == 2:
        return shape(Kind.PLANE, c, ways[:, int(np.argmin(zero))])
    low, high = (n for n in range(3) if not zero[n])
    if values[low] > 0 or values[high] < 0:
        return None
    # values[low] x^2 + values[high] y^2 = 0
    z, half = ways[:, int(np.argmax(zero))], atan(sqrt(-values[low] / values[high]))
    return plane_pair(c, z, ways[:, low], half)


def _true(found: Shape, one: _Form, two: _Form) -> Array:
    """Whether the forms agree on rulings of a shape about c: first those of the upper nappe."""
    turn = np.linspace(0, 2 * np.pi, RULINGS // 2, endpoint=False) + 0.1
    if found.parts:
        return np.concatenate([_true(part, one, two) for part in found.parts])
    x, y, z = found.axes
    values = found.parameters
    tx = np.tan(values.get("half_angle_x", values.get("half_angle", 0.0)))
    ty = np.tan(values.get("half_angle_y", values.get("half_angle", 0.0)))
    cone = found.kind is not Kind.PLANE
    a, b = (tx, ty) if cone else (1.0, 1.0)
    ring = a * np.cos(turn)[:, None] * x + b * np.sin(turn)[:, None] * y
    ways = np.concatenate([ring + z, ring - z]) if cone else np.concatenate([ring, 2 * ring])
    ways = ways / norm(ways)[:, None]
    scale = abs(float(one.across)) + abs(float(one.along))
    with np.errstate(invalid="ignore"):
        return np.asarray(np.abs(one(ways) - two(ways)) <= EQUAL_ALONG * scale)


def _union(parts: list[Shape]) -> Shape:
    """One surface of several parts that all go through one point."""
    if len(parts) == 1:
        return parts[0]
    if all(part.kind is Kind.PLANE for part in parts):
        n, m = (part.axes[2] for part in parts)
        z = np.cross(n, m)
        # x bisects the planes
        x = (n + m) / norm(n + m)
        return plane_pair(parts[0].origin, z / norm(z), x, atan(sqrt((1 + n @ m) / (1 - n @ m))))
    return Shape(Kind.TWO_SURFACES, parts[0].origin, parts[0].axes, {}, tuple(parts))
