"""Ring torus: distance from the spine circle equals the minor radius."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import ClassVar

import numpy as np

from decomp.carriers.axial import axial_rows, axial_split, off_axis, round_reach
from decomp.carriers.base import Border, Carrier, pack
from decomp.carriers.charts import Chart, TorusChart
from decomp.similarity import Similarity
from decomp.vectors import Array, cross, dot, frame, norm


@dataclass(frozen=True, eq=False)
class Torus(Carrier):
    """The torus whose spine has radius `major` about `centre` in the plane across `axis`.

    The reflexive locus is the spine (inside) and the axis (outside).
    """

    centre: Array
    axis: Array
    major: float
    minor: float

    kind: ClassVar[str] = "torus"
    code: ClassVar[int] = 4
    degree: ClassVar[int] = 4
    locus: ClassVar[int | None] = 1
    closed: ClassVar[bool] = True

    def signed_distance(self, p: Array) -> Array:
        z, rho, _ = axial_split(p, self.centre, self.axis)
        return np.asarray(np.hypot(rho - self.major, z) - self.minor)

    @classmethod
    def distances_of(cls, rows: Array, p: Array) -> Array:
        z, rho = axial_rows(rows, p)
        return np.asarray(np.hypot(rho - rows[:, None, 6], z) - rows[:, None, 7])

    @classmethod
    def along_line(cls, rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        raise TypeError("a line meets a torus in up to four points")

    def foot(self, p: Array) -> Array:
        spine, outward = self._spine(p)
        return np.asarray(spine + self.minor * outward)

    def normal(self, q: Array) -> Array:
        return self._spine(q)[1]

    def implicit(self, p: Array) -> Array:
        away = p - self.centre
        square = dot(away, away)
        rho2 = square - dot(away, self.axis) ** 2
        left = square + self.major**2 - self.minor**2
        scale = 8 * self.major**2 * self.minor
        return np.asarray((left**2 - 4 * self.major**2 * rho2) / scale)

    def normal_curvature(self, q: Array, direction: Array) -> Array:
        _, rho, radial = axial_split(q, self.centre, self.axis)
        _, outward = self._spine(q)
        around = cross(self.axis, radial)
        across = cross(around, outward)
        parallel = dot(outward, radial) / rho
        return np.asarray(
            dot(around, direction) ** 2 * parallel + dot(across, direction) ** 2 / self.minor
        )

    def transformed(self, by: Similarity) -> Torus:
        return Torus(
            by.points(self.centre),
            by.directions(self.axis),
            by.scale * self.major,
            by.scale * self.minor,
        )

    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        if not isinstance(other, Torus):
            return 0
        sign = 1.0 if float(dot(self.axis, other.axis)) > 0 else -1.0
        gap = float(norm(self.centre - other.centre))
        tilt = float(norm(self.axis - sign * other.axis)) * (self.major + self.minor)
        size = abs(self.major - other.major) + abs(self.minor - other.minor)
        return 1 if gap + tilt + size <= tolerance else 0

    def features(self, reach: float) -> Array:
        lengths = np.append(self.centre, [self.major, self.minor])
        return np.concatenate([lengths / reach, np.abs(self.axis)])

    @property
    def least_radius(self) -> float:
        return self.minor

    @property
    def width(self) -> float:
        return self.major + self.minor

    @property
    def remoteness(self) -> float:
        return float(norm(self.centre)) + self.major

    def box(self) -> Array:
        reach = round_reach(self.axis, self.major) + self.minor
        return np.array([self.centre - reach, self.centre + reach])

    def extreme_points(self) -> Array:
        units = np.concatenate([np.eye(3), -np.eye(3)])
        across = units - (units @ self.axis)[:, None] * self.axis
        length = norm(across)
        flat = length > 1e-12
        spine = self.centre + self.major * across[flat] / length[flat, None]
        both = [spine + s * self.minor * units[flat] for s in (1, -1)]
        if flat.all():
            return np.concatenate(both)
        # the axis is one of them: circles, of which some points stand for all
        x, y = frame(self.axis)
        angles = np.linspace(0, 2 * np.pi, 64, endpoint=False)[:, None]
        top = self.centre + self.major * (np.cos(angles) * x + np.sin(angles) * y)
        return np.concatenate([*both, *(top + s * self.minor * self.axis for s in (1, -1))])

    def border_terms(
        self, border: Border, origin: Array, pole: Array | None
    ) -> tuple[float, float]:
        raise TypeError("on a torus a border has to be unwrapped")

    def second_term(self, border: Border, origin: Array, pole: Array | None, field: Array) -> float:
        raise TypeError("on a torus a border has to be unwrapped")

    def in_frames(self, points: Array, tangents: Array, pole: Array | None) -> tuple[Array, Array]:
        z, rho, radial = axial_split(points, self.centre, self.axis)
        out = (rho - self.major) / self.minor
        tube = (out[..., None] * self.axis) - (z / self.minor)[..., None] * radial
        return dot(tangents, cross(self.axis, radial)), dot(tangents, tube)

    def chart(self, tip: bool = False, reach: float = 1.0, pole: Array | None = None) -> Chart:
        return TorusChart(self.centre, self.axis, self.major, self.minor)

    def grid(self, finer: int, pole: Array | None = None) -> tuple[Array, float]:
        tube = 8 * finer
        around = tube * max(1, ceil(self.major / (3 * self.minor)))
        u, v = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in (around, tube)))
        grid = self.point(u.ravel(), v.ravel(), *frame(self.axis))
        return grid, 2 * np.pi * self.minor / (8 * finer)

    def reflexive_gap(self, outward: int, points: Array) -> Array:
        if outward < 0:
            return off_axis(points, self.centre, self.axis)
        return np.asarray(self.signed_distance(points) + self.minor)

    def inner_radius(self, outward: int, points: Array) -> Array:
        if outward > 0:
            return np.full(len(points), self.minor)
        off = off_axis(points, self.centre, self.axis)
        # from the tube's inner side: beyond the tube the normal goes on to the axis
        with np.errstate(divide="ignore"):  # at the tube's top normals are parallel to the axis
            return np.asarray(off * self.minor / (self.major - off))

    def packed(self) -> Array:
        return pack(self.centre, self.axis, self.major, self.minor)

    def point(self, around: Array, tube: Array, x: Array, y: Array) -> Array:
        """Points at angle `around` the axis (from x towards y) and angle `tube` in the tube."""
        radial = np.cos(around)[..., None] * x + np.sin(around)[..., None] * y
        rho = self.major + self.minor * np.cos(tube)
        height = self.minor * np.sin(tube)
        return np.asarray(self.centre + rho[..., None] * radial + height[..., None] * self.axis)

    def _spine(self, p: Array) -> tuple[Array, Array]:
        """Nearest spine point, and the unit direction from it to p."""
        z, rho, radial = axial_split(p, self.centre, self.axis)
        spine = self.centre + self.major * radial
        out = (rho - self.major)[..., None] * radial + z[..., None] * self.axis
        length = np.hypot(rho - self.major, z)
        clear = length > 1e-300
        outward = np.where(clear[..., None], out / np.where(clear, length, 1.0)[..., None], radial)
        return spine, outward
