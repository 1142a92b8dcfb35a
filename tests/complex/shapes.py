"""Coarse complexes with exact vertices, to be refined."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.complex.model import Complex, Line, LineKind, Patch, PatchKind
from decomp.vectors import Array, norm

X, Y, Z = np.eye(3)
O3 = np.zeros(3)


@dataclass(frozen=True, eq=False)
class OnCarrier:
    """A carrier as a surface element."""

    carrier: Carrier
    side: float = 1.0

    def place(self, points: Array) -> Array:
        return self.carrier.project(points)

    def normal(self, points: Array) -> Array:
        return self.side * self.carrier.normal(points)


@dataclass(frozen=True, eq=False)
class Saddle:
    """The surface z = bend x y."""

    bend: float = 1.0

    def place(self, points: Array) -> Array:
        q = points.copy()
        for _ in range(60):
            gap = q[:, 2] - self.bend * q[:, 0] * q[:, 1]
            up = self._up(q)
            q = points + up * ((q - points) * up).sum(1, keepdims=True) / (up**2).sum(
                1, keepdims=True
            )
            gap = q[:, 2] - self.bend * q[:, 0] * q[:, 1]
            up = self._up(q)
            q = q - (gap / (up**2).sum(1))[:, None] * up
        return q

    def normal(self, points: Array) -> Array:
        up = self._up(points)
        return up / norm(up)[:, None]

    def _up(self, q: Array) -> Array:
        return np.stack([-self.bend * q[:, 1], -self.bend * q[:, 0], np.ones(len(q))], axis=1)


@dataclass(frozen=True, eq=False)
class Round:
    """A circle about an axis."""

    centre: Array
    axis: Array
    radius: float

    def place(self, points: Array) -> Array:
        away = points - self.centre
        away = away - (away @ self.axis)[:, None] * self.axis
        away = away / norm(away)[:, None]
        away = away - (away @ self.axis)[:, None] * self.axis
        return self.centre + self.radius * away / norm(away)[:, None]


@dataclass(frozen=True, eq=False)
class Straight:
    """The line through two points."""

    a: Array
    b: Array

    def place(self, points: Array) -> Array:
        along = (self.b - self.a) / norm(self.b - self.a)
        return self.a + ((points - self.a) @ along)[:, None] * along


def face(carrier: Carrier, triangles: object, side: float = 1.0) -> Patch:
    return Patch(PatchKind.FACE, OnCarrier(carrier, side), np.array(triangles, dtype=np.int64))


def edge(curve: object, vertices: object) -> Line:
    return Line(LineKind.EDGE, curve, np.array(vertices, dtype=np.int64))  # type: ignore[arg-type]


def ring(k: int, radius: float, z: float) -> Array:
    t = 2 * np.pi * np.arange(k) / k
    return np.stack([radius * np.cos(t), radius * np.sin(t), np.full(k, z)], axis=1)


def circle_line(first: int, k: int, radius: float, z: float) -> Line:
    loop = [*range(first, first + k), first]
    return edge(Round(np.array([0.0, 0.0, z]), Z, radius), loop)


def disc(first: int, k: int, z: float, side: float) -> Patch:
    """A plane polygon, fan of its first vertex; side +1 looks up."""
    fan = [[first, first + i, first + i + 1] for i in range(1, k - 1)]
    if side < 0:
        fan = [[a, c, b] for a, b, c in fan]
    return face(Plane(np.array([0.0, 0.0, z]), Z), fan, side)


def block(a: float = 4.0, b: float = 3.0, c: float = 2.0) -> Complex:
    points = np.array([[x, y, z] for x in (0, a) for y in (0, b) for z in (0, c)], dtype=float)
    faces = [
        ((0, 1, 3, 2), -X),
        ((4, 6, 7, 5), X),
        ((0, 4, 5, 1), -Y),
        ((2, 3, 7, 6), Y),
        ((0, 2, 6, 4), -Z),
        ((1, 5, 7, 3), Z),
    ]
    patches = [
        face(Plane(points[q[0]], n), [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]) for q, n in faces
    ]
    pairs = {tuple(sorted((q[i], q[i - 1]))) for q, _ in faces for i in range(4)}
    lines = [edge(Straight(points[i], points[j]), [i, j]) for i, j in sorted(pairs)]
    return Complex(points, tuple(patches), tuple(lines))


def sphere() -> Complex:
    """An octahedron in the unit sphere."""
    points = np.array([X, Y, -X, -Y, Z, -Z])
    top = [[i, (i + 1) % 4, 4] for i in range(4)]
    low = [[(i + 1) % 4, i, 5] for i in range(4)]
    return Complex(points, (face(Sphere(O3, 1.0), top + low),), ())


def cylinder(k: int = 4, height: float = 3.0) -> Complex:
    points = np.concatenate([ring(k, 1.0, 0.0), ring(k, 1.0, height)])
    side = []
    for i in range(k):
        j = (i + 1) % k
        side += [[i, j, k + j], [i, k + j, k + i]]
    patches = (disc(0, k, 0.0, -1.0), disc(k, k, height, 1.0), face(Cylinder(O3, Z, 1.0), side))
    return Complex(points, patches, (circle_line(0, k, 1.0, 0.0), circle_line(k, k, 1.0, height)))


def cone(k: int = 4, height: float = 2.0) -> Complex:
    """Apex at the origin, opening upwards to radius 1."""
    points = np.concatenate([ring(k, 1.0, height), [O3]])
    side = [[(i + 1) % k, i, k] for i in range(k)]
    carrier = Cone(O3, Z, float(np.arctan2(1.0, height)))
    patches = (disc(0, k, height, 1.0), face(carrier, side))
    return Complex(points, patches, (circle_line(0, k, 1.0, height),))


def torus(n: int = 6, m: int = 4, major: float = 2.0, minor: float = 0.7) -> Complex:
    u, v = 2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m
    rho = major + minor * np.cos(v)
    points = np.stack(
        [
            np.outer(np.cos(u), rho),
            np.outer(np.sin(u), rho),
            np.outer(np.ones(n), minor * np.sin(v)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    triangles = []
    for i in range(n):
        for j in range(m):
            a, b = i * m + j, (i + 1) % n * m + j
            c, d = (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m
            triangles += [[a, b, c], [a, c, d]]
    return Complex(points, (face(Torus(O3, Z, major, minor), triangles),), ())


def saddle(bend: float = 1.0) -> Complex:
    """z = bend x y over the square from -1 to 1 with two straight rulings as borders each way."""
    flat = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    points = np.column_stack([flat, bend * flat[:, 0] * flat[:, 1]])
    patch = Patch(PatchKind.SHEET, Saddle(bend), np.array([[0, 1, 2], [0, 2, 3]]))
    lines = [edge(Straight(points[i], points[(i + 1) % 4]), [i, (i + 1) % 4]) for i in range(4)]
    return Complex(points, (patch,), tuple(lines))


def half_discs(count: int = 3) -> Complex:
    """Half-discs of radius 1 that meet along the diameter on the z axis."""
    points, patches = [-Z, Z], []
    lines = [edge(Straight(-Z, Z), [0, 1])]
    for i in range(count):
        t = 2 * np.pi * i / count
        out, normal = np.cos(t) * X + np.sin(t) * Y, -np.sin(t) * X + np.cos(t) * Y
        tip = len(points)
        points.append(out)
        patches.append(face(Plane(O3, normal), [[0, 1, tip]]))
        lines.append(edge(Round(O3, normal, 1.0), [0, tip, 1]))
    return Complex(np.array(points), tuple(patches), tuple(lines))


def lens() -> Complex:
    """Two caps of spheres and a disc between them on one circle, all three with one diagonal."""
    points = ring(4, 1.0, 0.0)
    down, up = np.array([0, 0, -1.0]), np.array([0, 0, 1.0])
    two = [[0, 1, 2], [0, 2, 3]]
    patches = (
        face(Sphere(down, np.sqrt(2.0)), two),
        face(Plane(O3, Z), two),
        face(Sphere(up, np.sqrt(2.0)), two, -1.0),
    )
    return Complex(points, patches, (circle_line(0, 4, 1.0, 0.0),))
