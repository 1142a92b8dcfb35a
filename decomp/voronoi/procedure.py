"""The general procedure of the paper's section 3.1, solved numerically at a point.

Eight equations in ten variables: a point p = (x, y, z), its feet u on f and v on g, a distance d:

    f(u) = 0,  |p - u|^2 = d^2,  (p - u) . t1 = 0,  (p - u) . t2 = 0,   and the same for g and v,

with tangents t1, t2 of f at u. It needs nothing but the polynomials of f and g and cannot tell even
from odd. It has extraneous solutions: feet that are not the nearest ones, and singular points of
f or g, where the tangents vanish and the equations say nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from decomp.errors import GeometryError, InputError
from decomp.parity import Parity
from decomp.vectors import Array, frame
from decomp.voronoi.polynomial import Polynomial
from decomp.voronoi.sites import CarrierSite
from decomp.voronoi.stationary import stationary_feet

SYSTEM_STEPS = 15
RESTARTS = 8
EQUAL_LENGTHS = 1e-9
"""Lengths below this part of the size are equal."""
LEFT_OUT = 1e-13
"""Singular values below this part of the largest are left out of a Newton step."""
STEPS_SETTLED = 1e-14
"""Steps below which Newton's method has come to rest, relative to what it has come to."""
GRADIENTS_ALIKE = 1e-9
"""Length of the difference of two gradients below which they are one."""


class Status(Enum):
    """What a solution of the eight equations is."""

    TRUE = "true"
    """Both feet are nearest points: p is on Vor(f, g)."""
    NOT_NEAREST = "not nearest"
    """A foot is stationary only: there are nearer points."""


@dataclass(frozen=True, eq=False)
class VoronoiPoint:
    """A solution of the eight equations, and the Voronoi surface's shape there.

    Args:
        point: p (3,).
        feet: u and v (2, 3).
        distance: d >= 0.
        sides: +1 or -1 for f and g: whether p lies outside or inside at the foot.
        parity: even if the sides agree.
        normal: unit normal of the surface, from f's side to g's (3,).
        curvatures: principal curvatures (2,), positive where the surface bends towards -normal.
        directions: principal directions (2, 3).
        residual: of the equations, in units of length.
        status: whether it is a true solution.
    """

    point: Array
    feet: Array
    distance: float
    sides: tuple[int, int]
    parity: Parity
    normal: Array
    curvatures: Array
    directions: Array
    residual: float
    status: Status


@dataclass(frozen=True, eq=False)
class _Side:
    """One surface of the pair at a foot u: value, gradient and Hessian of its polynomial."""

    polynomial: Polynomial
    tangents: tuple[Array, Array]

    def rows(self, p: Array, u: Array, d: float) -> tuple[Array, Array, Array, Array]:
        """Four equations: their values (4,), derivatives by p (4, 3), by u (4, 3), by d (4,)."""
        value = float(self.polynomial(u))
        gradient = self.polynomial.gradient(u)
        hessian = self.polynomial.hessian(u)
        away = p - u
        values, by_p = [value, away @ away - d**2], [np.zeros(3), 2 * away]
        by_u = [gradient, -2 * away]
        for a in self.tangents:
            # t = a x gradient
            t = np.cross(a, gradient)
            values.append(away @ t)
            by_p.append(t)
            by_u.append(-t + hessian @ np.cross(away, a))
        return np.array(values), np.array(by_p), np.array(by_u), np.array([0, -2 * d, 0, 0])


def solve(f: Polynomial, g: Polynomial, p: Array, u: Array, v: Array) -> tuple[Array, float]:
    """Solve the eight equations near given values by Newton's steps of least length.

    Args:
        f, g: polynomials of two surfaces.
        p: near the Voronoi surface (3,).
        u, v: near its feet (3,), where the gradients of f and g are not zero.

    Returns:
        The ten variables (p, u, v, d), and the largest residual.

    Raises:
        GeometryError: the iteration does not converge, or a foot is a singular point.
    """
    sides = []
    for polynomial, foot in ((f, u), (g, v)):
        gradient = polynomial.gradient(foot)
        size = float(np.linalg.norm(gradient))
        if size == 0.0:
            raise GeometryError("a foot is a singular point of its surface: no tangents there")
        sides.append(_Side(polynomial, frame(gradient / size)))
    d = (np.linalg.norm(p - u) + np.linalg.norm(p - v)) / 2
    w = np.concatenate([p, u, v, [d]])
    for _ in range(SYSTEM_STEPS):
        values, jacobian = _system(sides, w)
        scale = np.linalg.norm(jacobian, axis=1)
        scale = np.where(scale > 0, scale, 1.0)
        step = np.linalg.lstsq(jacobian / scale[:, None], values / scale, rcond=LEFT_OUT)[0]
        w = w - step
        if np.abs(step).max() <= STEPS_SETTLED * (1 + np.abs(w).max()):
            break
    values, jacobian = _system(sides, w)
    scale = np.linalg.norm(jacobian, axis=1)
    residual = float(np.abs(values / np.where(scale > 0, scale, 1.0)).max())
    if not residual <= EQUAL_LENGTHS * (1 + np.abs(w).max()):
        raise GeometryError("the eight equations have no solution near the given values")
    return w, residual


def _system(sides: list[_Side], w: Array) -> tuple[Array, Array]:
    """Values (8,) and Jacobian (8, 10)."""
    p, d = w[:3], float(w[9])
    values, jacobian = np.zeros(8), np.zeros((8, 10))
    for k, side in enumerate(sides):
        rows, columns = slice(4 * k, 4 * k + 4), slice(3 + 3 * k, 6 + 3 * k)
        values[rows], jacobian[rows, :3], jacobian[rows, columns], jacobian[rows, 9] = side.rows(
            p, w[columns], d
        )
    return values, jacobian


def voronoi_points(f: CarrierSite, g: CarrierSite, p: Array, reach: float) -> list[VoronoiPoint]:
    """The solutions of the eight equations for two surfaces close to a point.

    Newton's method starts from every pair of feet of the point, and where that does not converge
    from points around it, with the feet that they have on the same side.

    Args:
        f, g: surfaces; points, lines and circles have no normals of their own.
        p: the point (3,).
        reach: solutions farther from it are left out.

    Raises:
        InputError: a site is no surface.
        GeometryError: the distances of a pair of feet are equal somewhere near, but there is no
            regular solution: a foot is an apex, or there is no tangent plane.
    """
    for site in (f, g):
        if site.name in ("point", "line", "circle"):
            raise InputError(f"the eight equations are for surfaces, not for a {site.name}")
    one, two = (Polynomial.of(site.offset(0), site.reference) for site in (f, g))
    found: list[VoronoiPoint] = []
    for u in stationary_feet(f, p):
        for v in stationary_feet(g, p):
            # within reach of p the two distances come no nearer to each other than this
            if abs(np.linalg.norm(p - u) - np.linalg.norm(p - v)) > 2 * reach:
                continue
            solution = _near(f, g, one, two, (p, u, v), reach)
            if solution is None:
                continue
            new = all(
                np.linalg.norm(solution.feet - other.feet) > EQUAL_LENGTHS * (1 + reach)
                for other in found
            )
            if new and np.linalg.norm(solution.point - p) <= reach:
                found.append(solution)
    return found


def _near(
    f: CarrierSite,
    g: CarrierSite,
    one: Polynomial,
    two: Polynomial,
    start: tuple[Array, Array, Array],
    reach: float,
) -> VoronoiPoint | None:
    """The solution that belongs to one pair of feet, None if there is none within reach.

    Raises:
        GeometryError: the difference of the feet's distances vanishes, but not regularly.
    """
    p, u, v = start
    rng = np.random.default_rng(0)
    gaps, reason = [], GeometryError("no solution is near")
    for k in range(RESTARTS):
        q = p if k == 0 else p + reach * rng.uniform(-1, 1, size=3) / 2
        feet = [
            near[int(np.argmin(np.linalg.norm(near - old, axis=1)))]
            for near, old in ((stationary_feet(f, q), u), (stationary_feet(g, q), v))
        ]
        gaps.append(np.linalg.norm(q - feet[0]) - np.linalg.norm(q - feet[1]))
        try:
            w, residual = solve(one, two, q, *feet)
        except GeometryError as error:
            reason = error
            continue
        far = float(np.linalg.norm(w[:3] - p)) > reach
        return None if far else _described(f, g, one, two, w, residual)
    # a difference that has one sign at all these points is taken to have no zero near
    if min(gaps) > EQUAL_LENGTHS * reach or max(gaps) < -EQUAL_LENGTHS * reach:
        return None
    raise reason


def _described(
    f: CarrierSite, g: CarrierSite, one: Polynomial, two: Polynomial, w: Array, residual: float
) -> VoronoiPoint:
    p, u, v, d = w[:3], w[3:6], w[6:9], abs(float(w[9]))
    ways, bends, sides = [], [], []
    for site, polynomial, foot in ((f, one, u), (g, two, v)):
        # the site's own polynomial grows outwards
        outward = 1 if site.offset(0).leading_coefficient() > 0 else -1
        way, bend, side = _distance_form(polynomial, outward, p, foot, d)
        ways.append(way)
        bends.append(bend)
        sides.append(side)
    slope = ways[0] - ways[1]
    steep = float(np.linalg.norm(slope))
    if steep <= GRADIENTS_ALIKE:
        raise GeometryError("the two distances change alike: there is no tangent plane")
    normal = slope / steep
    x, y = frame(normal)
    across = np.stack([x, y])
    curvatures, turned = np.linalg.eigh(across @ (bends[0] - bends[1]) @ across.T / steep)
    size = 1 + float(np.abs(w).max())
    status = Status.TRUE
    for site, side in zip((f, g), sides, strict=True):
        if abs(float(site.signed_distance(p)) - side * d) > EQUAL_LENGTHS * size:
            status = Status.NOT_NEAREST
    return VoronoiPoint(
        p,
        np.stack([u, v]),
        d,
        (sides[0], sides[1]),
        Parity.EVEN if sides[0] == sides[1] else Parity.ODD,
        normal,
        curvatures,
        turned.T @ across,
        residual,
        status,
    )


def _distance_form(
    polynomial: Polynomial, outward: int, p: Array, foot: Array, d: float
) -> tuple[Array, Array, int]:
    """Gradient and Hessian of the distance from the foot's part of the surface, and the side.

    With the shape operator W at the foot the Hessian is W (I + d W)^-1.
    """
    gradient = outward * polynomial.gradient(foot)
    size = float(np.linalg.norm(gradient))
    if size <= EQUAL_LENGTHS:
        raise GeometryError("a foot is a singular point of its surface")
    normal = gradient / size
    side = 1 if float((p - foot) @ normal) >= 0 else -1
    flat = np.eye(3) - np.outer(normal, normal)
    shape = side * outward * flat @ polynomial.hessian(foot) @ flat / size
    return side * normal, shape @ np.linalg.inv(np.eye(3) + d * shape), side
