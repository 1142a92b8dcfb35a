"""A Voronoi surface's kind with its canonical parameters in a frame of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import cos, sin, sqrt, tan

import numpy as np

from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, dot, frame, norm
from decomp.voronoi.kinds import Kind

Quadratic = tuple[Array, Array, float]
"""Q (n, n), l (n,), k of w.Q.w + 2 l.w + k."""


@dataclass(frozen=True, eq=False)
class Shape:
    """Where a surface of one of the kinds is.

    Args:
        kind: see there for the canonical equations.
        origin: of the frame (3,): a centre, vertex, apex or point of the axis.
        axes: x, y, z as rows (3, 3), orthonormal and right-handed.
        parameters: lengths, and angles in radians, by the names in the canonical equation. For a
            surface of revolution of a conic also where its profile lies, in the half-plane of
            rho and z: `centre_rho` and `centre_z` (of a parabola the vertex) and `tilt`, the angle
            from the rho axis to u.
        parts: the shapes that it is the union of: the two planes of a pair.
    """

    kind: Kind
    origin: Array
    axes: Array
    parameters: Mapping[str, float] = field(default_factory=dict)
    parts: tuple[Shape, ...] = ()

    def local(self, p: Array) -> Array:
        """Coordinates (..., 3) in the frame."""
        return np.asarray((p - self.origin) @ self.axes.T)

    def deviation(self, p: Array) -> Array:
        """Distances (...) of points (..., 3) from it to first order, infinite if it is empty."""
        if self.parts:
            return np.asarray(np.min([part.deviation(p) for part in self.parts], axis=0))
        w = self.local(np.asarray(p, dtype=np.float64))
        if self.kind is Kind.EMPTY:
            return np.full(w.shape[:-1], np.inf)
        if self.kind is Kind.LINE:
            return norm(w[..., :2])
        if self.kind is Kind.POINT:
            return norm(w)
        if self.kind in REVOLVED:
            w = np.stack([np.hypot(w[..., 0], w[..., 1]), w[..., 2]], axis=-1)
        q, linear, constant = QUADRATICS[self.kind](self.parameters)
        value = dot(w @ q, w) + 2 * w @ linear + constant
        slope = 2 * norm(w @ q + linear)
        return np.abs(value) / np.where(slope > 0, slope, 1.0)

    @property
    def tips(self) -> Array:
        """Where a surface of revolution of a conic meets its axis: points (k, 3) in order of z."""
        if self.kind not in REVOLVED:
            return np.empty((0, 3))
        q, linear, constant = QUADRATICS[self.kind](self.parameters)
        # the equation for rho = 0, in units of the conic's size
        largest = float(np.abs(q).max())
        unit = float(norm(linear)) / largest + sqrt(abs(constant) / largest)
        a, b, c = float(q[1, 1]) * unit**2, float(linear[1]) * unit, constant
        small = TOLERANCE * float(max(abs(a), abs(b), abs(c)))
        if abs(a) <= small:
            z = np.array([-c / (2 * b)]) if abs(b) > small else np.empty(0)
        elif b**2 - a * c <= small**2:
            z = np.empty(0)
        else:
            z = np.sort((-b + sqrt(b**2 - a * c) * np.array([1.0, -1.0])) / a)
        z = z * unit
        if self.kind is Kind.REVOLVED_HYPERBOLA:
            way, p = self._recession, self.parameters
            z = z[-p["centre_rho"] * way[0] + (z - p["centre_z"]) * way[1] > 0]
        return np.asarray(self.origin + z[:, None] * self.axes[2])

    @property
    def spindle(self) -> bool:
        """Whether a bounded part of it is closed at two tips on the axis (the paper's figure 14).

        A parabolic torus, about a line parallel to the parabola's axis, has one tip and none.
        """
        return len(self.tips) == 2 and float(self._recession[0]) <= 0

    @property
    def _recession(self) -> Array:
        """In rho and z the direction in which parabola or branch goes to infinity; else zero."""
        turn = self.parameters.get("tilt", 0.0)
        if self.kind is Kind.REVOLVED_PARABOLA:
            return np.array([-sin(turn), cos(turn)])
        if self.kind is Kind.REVOLVED_HYPERBOLA:
            return np.array([cos(turn), sin(turn)])
        return np.zeros(2)


def shape(kind: Kind, origin: Array, z: Array, x: Array | None = None, /, **values: float) -> Shape:
    """Make one from its z axis and, where it matters, its x axis (unit vectors)."""
    if x is None:
        x, _ = frame(z)
    return Shape(kind, np.asarray(origin), np.stack([x, np.cross(z, x), z]), values)


def plane_pair(origin: Array, z: Array, x: Array, half_angle: float) -> Shape:
    """Two planes through the line along z, each at an angle from x."""
    y, s, c = np.cross(z, x), sin(half_angle), cos(half_angle)
    planes = tuple(shape(Kind.PLANE, origin, c * y - side * s * x, z) for side in (1, -1))
    axes = np.stack([x, y, z])
    return Shape(Kind.PLANE_PAIR, np.asarray(origin), axes, {"half_angle": half_angle}, planes)


def _diagonal(x: float, y: float, z: float, constant: float) -> Quadratic:
    return np.diag([x, y, z]), np.zeros(3), constant


def _profile(
    a: float, b: float, constant: float, slope: float, p: Mapping[str, float]
) -> Quadratic:
    """a u^2 + b v^2 + 2 slope v + constant in rho and z."""
    c, s = cos(p["tilt"]), sin(p["tilt"])
    turn = np.array([[c, s], [-s, c]])
    centre = np.array([p["centre_rho"], p["centre_z"]])
    q = turn.T @ np.diag([a, b]) @ turn
    along = turn.T @ np.array([0.0, slope])
    return q, along - q @ centre, float(centre @ q @ centre - 2 * centre @ along + constant)


def _parabolic_cylinder(p: Mapping[str, float]) -> Quadratic:
    return np.diag([0.0, 1.0, 0.0]), np.array([-2 * p["focal_length"], 0.0, 0.0]), 0.0


def _paraboloid(p: Mapping[str, float]) -> Quadratic:
    return np.diag([1.0, 1.0, 0.0]), np.array([0.0, 0.0, -2 * p["focal_length"]]), 0.0


def _saddle(p: Mapping[str, float]) -> Quadratic:
    x, y = 1 / (4 * p["focal_length_x"]), 1 / (4 * p["focal_length_y"])
    return np.diag([x, -y, 0.0]), np.array([0.0, 0.0, -0.5]), 0.0


def _plane_pair(p: Mapping[str, float]) -> Quadratic:
    s, c = sin(p["half_angle"]), cos(p["half_angle"])
    return _diagonal(-(s**2), c**2, 0.0, 0.0)


def _torus(p: Mapping[str, float]) -> Quadratic:
    major, minor = p["major"], p["minor"]
    return np.eye(2), np.array([-major, 0.0]), major**2 - minor**2


QUADRATICS: dict[Kind, Callable[[Mapping[str, float]], Quadratic]] = {
    Kind.PLANE: lambda p: (np.zeros((3, 3)), np.array([0.0, 0.0, 0.5]), 0.0),
    Kind.PLANE_PAIR: _plane_pair,
    Kind.SPHERE: lambda p: _diagonal(1, 1, 1, -(p["radius"] ** 2)),
    Kind.TORUS: _torus,
    Kind.CIRCULAR_CONE: lambda p: _diagonal(1, 1, -(tan(p["half_angle"]) ** 2), 0),
    Kind.ELLIPTIC_CONE: lambda p: _diagonal(
        1 / tan(p["half_angle_x"]) ** 2, 1 / tan(p["half_angle_y"]) ** 2, -1, 0
    ),
    Kind.CIRCULAR_CYLINDER: lambda p: _diagonal(1, 1, 0, -(p["radius"] ** 2)),
    Kind.ELLIPTIC_CYLINDER: lambda p: _diagonal(1 / p["a"] ** 2, 1 / p["b"] ** 2, 0, -1),
    Kind.PARABOLIC_CYLINDER: _parabolic_cylinder,
    Kind.HYPERBOLIC_CYLINDER: lambda p: _diagonal(1 / p["a"] ** 2, -1 / p["b"] ** 2, 0, -1),
    Kind.PARABOLOID: _paraboloid,
    Kind.PROLATE_SPHEROID: lambda p: _diagonal(
        1 / p["b"] ** 2, 1 / p["b"] ** 2, 1 / p["a"] ** 2, -1
    ),
    Kind.ONE_SHEETED_HYPERBOLOID: lambda p: _diagonal(
        1 / p["a"] ** 2, 1 / p["a"] ** 2, -1 / p["b"] ** 2, -1
    ),
    Kind.TWO_SHEETED_HYPERBOLOID: lambda p: _diagonal(
        -1 / p["b"] ** 2, -1 / p["b"] ** 2, 1 / p["a"] ** 2, -1
    ),
    Kind.HYPERBOLIC_PARABOLOID: _saddle,
    Kind.REVOLVED_PARABOLA: lambda p: _profile(1, 0, 0, -2 * p["focal_length"], p),
    Kind.REVOLVED_ELLIPSE: lambda p: _profile(1 / p["a"] ** 2, 1 / p["b"] ** 2, -1, 0, p),
    Kind.REVOLVED_HYPERBOLA: lambda p: _profile(1 / p["a"] ** 2, -1 / p["b"] ** 2, -1, 0, p),
}
"""The canonical equations as quadratic forms of x, y, z, or of rho and z."""

REVOLVED = (Kind.TORUS, Kind.REVOLVED_PARABOLA, Kind.REVOLVED_ELLIPSE, Kind.REVOLVED_HYPERBOLA)
"""Kinds whose canonical equation is one of rho and z."""
