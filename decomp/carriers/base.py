"""What every carrier (untrimmed boundary surface) offers.

Notation: p is any point, q a point on the carrier, n the outward unit normal (gradient of the
signed distance). Points come as arrays of shape (..., 3), results have the leading shape.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from decomp.carriers.charts import Chart
from decomp.errors import GeometryError
from decomp.similarity import Similarity
from decomp.vectors import Array, frozen

ROW = 11
"""Numbers of a carrier in tables and kernels, see `Carrier.packed`."""
EVERYWHERE = frozen([[-np.inf] * 3, [np.inf] * 3])
NO_SIDE = frozen((0, 0, 0))


class Border(NamedTuple):
    """Quadrature along a face's border, or a part of it, with the face on the left.

    Left is told by the carrier's normal.

    Args:
        points: (n, 3).
        steps: (n, 3), derivatives times weights.
    """

    points: Array
    steps: Array


class Level(NamedTuple):
    """The ellipse centre + a cos t x + b sin t y, x and y orthonormal (3,); a circle if a = b."""

    centre: Array
    x: Array
    y: Array
    a: float
    b: float


@dataclass(frozen=True, eq=False)
class Carrier(ABC):
    """An untrimmed surface with an inside, where the signed distance is negative."""

    kind: ClassVar[str]
    code: ClassVar[int]
    degree: ClassVar[int]
    closed: ClassVar[bool] = False
    """Whether it is bounded, and may be a face without an edge."""
    revolved: ClassVar[bool] = True
    """Whether it is a surface of revolution."""
    needs_pole: ClassVar[bool] = False
    """Whether it has charts and frames only without one point of it, its pole."""
    locus: ClassVar[int | None] = None
    """Dimension of its reflexive locus, None without one, or with a sheet for one."""
    traceable: ClassVar[bool] = True
    """Whether its Voronoi surfaces with other sites are known (`decomp.voronoi`)."""

    @abstractmethod
    def signed_distance(self, p: Array) -> Array:
        """Euclidean distance to the carrier, negative inside."""

    @classmethod
    @abstractmethod
    def distances_of(cls, rows: Array, p: Array) -> Array:
        """Signed distances (m, n) of points p (n, 3) to m carriers of this kind.

        Args:
            rows: (m, ROW), what `packed` gives of each.
            p: the points.
        """

    @classmethod
    @abstractmethod
    def along_line(cls, rows: Array, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        """Coefficients q, h, c (m,) with q t^2 + 2 h t + c = 0 where a line meets m carriers.

        q is zero for lines along which there is one root at most.

        Args:
            rows: (m, ROW), what `packed` gives of each.
            origin: (3,) of the line, where t is 0.
            direction: (3,) of the line, of length 1.

        Raises:
            TypeError: the carrier is no plane or quadric.
        """

    @abstractmethod
    def foot(self, p: Array) -> Array:
        """The nearest point of the carrier (any one of them on its reflexive locus)."""

    @abstractmethod
    def normal(self, q: Array) -> Array:
        """Outward unit normal at points on (or near) the carrier."""

    @abstractmethod
    def implicit(self, p: Array) -> Array:
        """A polynomial of degree `degree` in p that vanishes on the carrier.

        It is scaled so that its gradient at the carrier has length about 1.
        """

    @abstractmethod
    def normal_curvature(self, q: Array, direction: Array) -> Array:
        """Curvature of the carrier at q along unit tangent `direction`.

        It is the second derivative of the signed distance: positive where the surface bends
        away from its outward normal, 1/r on a sphere.
        """

    @abstractmethod
    def transformed(self, by: Similarity) -> Carrier:
        """The image under a similarity, with the image of the inside as its inside."""

    @abstractmethod
    def coincides(self, other: Carrier, tolerance: float, reach: float) -> int:
        """Tell whether two carriers are one surface.

        Args:
            other: another carrier of any kind.
            tolerance: lengths below this count as zero.
            reach: how far from the carriers' reference points they matter; angles are
                compared by the deviation that they cause at this distance.

        Returns:
            +1 same surface and same inside, -1 same surface and opposite inside, 0 different.
        """

    @abstractmethod
    def features(self, reach: float) -> Array:
        """Return numbers (k,) by which to look up coinciding carriers: equal for equal surfaces.

        Lengths are given in units of `reach`.
        """

    @abstractmethod
    def packed(self) -> Array:
        """Return the parameters as ROW numbers for compiled kernels.

        point or centre or apex (3), axis or normal (3), two numbers by kind: sphere and
        cylinder (radius, 0), cone (sine, cosine of the half-angle), torus and elliptic cylinder
        (major, minor); of the last the direction of its major axis (3), of others 0.
        """

    @property
    def flat(self) -> bool:
        """Whether it is a plane."""
        return self.degree == 1

    @property
    def place(self) -> Array:
        """Its reference point (3,): a centre, an apex, or any one of a plane or an axis."""
        return self.packed()[:3]

    @property
    def tip(self) -> Array | None:
        """The one point (3,) without a normal, None where all have one."""
        return None

    @property
    def least_radius(self) -> float:
        """The least radius with which it is bent, infinite where there is none."""
        return np.inf

    @property
    def width(self) -> float:
        """How far it reaches across from its reference point or axis, 0 if without end."""
        return 0.0

    @property
    def remoteness(self) -> float:
        """The size of the coordinates that tell where a carrier with a `least_radius` is."""
        return 0.0

    def box(self) -> Array:
        """Corners (2, 3) of a box around the carrier, infinite where nothing bounds it."""
        return np.array(EVERYWHERE)

    def half_space_boxes(self) -> tuple[Array, Array]:
        """Boxes (2, 3) around the inside and around the outside."""
        return self.box(), np.array(EVERYWHERE)

    @property
    def tip_axis(self) -> Array | None:
        """The unit direction (3,) from the tip into the inside, None where there is no tip."""
        return None

    def reflexive_gap(self, outward: int, points: Array) -> Array:
        """Distance (k,) of points (k, 3) from the reflexive locus on a face's inner side.

        Infinite where there is none.

        Args:
            outward: +1 if that is the carrier's inside, else -1.
            points: anywhere.
        """
        return np.full(len(points), np.inf)

    def inner_radius(self, outward: int, points: Array) -> Array:
        """Distance (k,) from points (k, 3) of the carrier along normals to that locus.

        Raises:
            GeometryError: there is none on either side.
        """
        raise GeometryError(f"{self.kind}: this surface has no reflexive locus")

    def around_tip(self, step: float) -> Array:
        """Points (k, 3) all around its tip, a step down its rulings; none where there is none."""
        return np.empty((0, 3))

    @abstractmethod
    def chart(self, tip: bool = False, reach: float = 1.0, pole: Array | None = None) -> Chart:
        """The carrier laid out flat.

        Args:
            tip: whether its tip, if there is one, must have a place.
            reach: without its tip, the distance from it at which lengths are kept.
            pole: unit vector (3,) from the centre to the point that has no place, where one is
                needed.

        Raises:
            GeometryError: a pole is needed and not given.
        """

    def grid(self, finer: int, pole: Array | None = None) -> tuple[Array, float]:
        """Points (k, 3) without which it has no triangles, and a distance that they keep.

        Args:
            finer: how many times as many points along a circle there are than at least.
            pole: see `chart`.
        """
        return np.empty((0, 3)), 0.0

    def section_kind(self, normal: Array) -> str:
        """What the curve is called in which planes with unit `normal` (3,) cut it, in general."""
        return "curve"

    def box_around(self, parts: Array) -> Array | None:
        """Corners (2, 3) of a box around a face, None if nothing is known.

        Args:
            parts: (k, 6), lower and upper corners of boxes around the face's edges.
        """
        return self.box() if self.closed else None

    def far_points(self, centre: Array, radius: float) -> list[Array]:
        """A point (3,) on every infinite end, beyond a ball around `centre`."""
        return []

    def extreme_points(self) -> Array:
        """Points (k, 3) where the normal is parallel to a coordinate axis, if these are single."""
        return np.empty((0, 3))

    def ruling(self, point: Array) -> Array | None:
        """Unit direction (3,) of the straight line on the carrier through a point, if there is one.

        It leads up in the sense of `rise`. None at a tip too, where lines lead everywhere.
        """
        return None

    def level(self, point: Array) -> Level | None:
        """The ellipse across the rulings through a point, None if it is none."""
        return None

    def rise(self, points: Array) -> Array:
        """How far up (k,) points (k, 3) are along the rulings."""
        return np.zeros(len(points))

    @abstractmethod
    def border_terms(
        self, border: Border, origin: Array, pole: Array | None
    ) -> tuple[float, float]:
        """What a border adds to a face's integrals of 1 and of (p - c) . n, c the packed point.

        Args:
            border: of the face.
            origin: (3,), a point near the face.
            pole: on a sphere, a unit direction away from the border: if the face holds it, `whole`
                has to be added.

        Raises:
            TypeError: the carrier is a torus, whose borders have to be unwrapped.
        """

    @abstractmethod
    def second_term(self, border: Border, origin: Array, pole: Array | None, field: Array) -> float:
        """What a border adds to a face's integral of ((p - origin) . e)(n . e), e the field (3,).

        The other arguments are those of `border_terms`.
        """

    @property
    def whole(self) -> tuple[float, float]:
        """Both integrals of `border_terms` over the whole of a closed carrier."""
        raise TypeError(f"a {self.kind} has no end")

    @abstractmethod
    def in_frames(self, points: Array, tangents: Array, pole: Array | None) -> tuple[Array, Array]:
        """Coordinates (n,) of tangents (n, 3) in frames right-handed about the normal.

        Args:
            points: (n, 3) where they are, none of them a tip.
            tangents: along the carrier.
            pole: on a sphere, a unit direction away from the points.
        """

    def project(self, p: Array, steps: int = 2) -> Array:
        """Return the foot, corrected until it is on the carrier to rounding."""
        q = self.foot(p)
        for _ in range(steps):
            q = q - self.signed_distance(q)[..., None] * self.normal(q)
        return q


def pack(point: Array, axis: Array, a: float = 0.0, b: float = 0.0, side: Array = NO_SIDE) -> Array:
    """Lay out the parameters of a carrier for `Carrier.packed`."""
    return np.concatenate([point, axis, [a, b], side])
