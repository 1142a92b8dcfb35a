"""A complex of triangles whose vertices lie exactly on known surfaces and curves.

All patches share one array of points. Where patches meet, along lines, they share vertices, so the
complex conforms by construction.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np

from decomp.shown import Shown
from decomp.vectors import Array, Bools, Ints

SIDES: Ints = np.array([[0, 1], [1, 2], [2, 0]])
"""The sides of a triangle by its corners, in order around it."""
OPPOSITE_SIDES: Ints = np.array([[1, 2], [2, 0], [0, 1]])
"""The side opposite to each corner of a triangle."""


class CurveElement(Protocol):
    """A curve that vertices lie on."""

    def place(self, points: Array) -> Array:
        """Move points (k, 3) close to the curve onto it, to rounding, by about the shortest way."""
        ...


class SurfaceElement(Protocol):
    """A surface that vertices lie on."""

    def place(self, points: Array) -> Array:
        """Move points (k, 3) close to the surface onto it, to rounding, the shortest way."""
        ...

    def normal(self, points: Array) -> Array:
        """Unit normals (k, 3) at points on the surface, all to one side of it."""
        ...


class SurfaceFamily(Protocol):
    """Surfaces that are asked for points of all of them at once.

    A surface can have a `family`, the same object for all of one family, and a static method
    `of_family`, which makes one of these of some members.
    """

    def place(self, which: Ints, points: Array) -> tuple[Array, Bools]:
        """Points (k, 3), each moved onto a given member (k,), and whether that succeeded (k,)."""
        ...

    def normal(self, which: Ints, points: Array) -> tuple[Array, Bools]:
        """Unit normals (k, 3) at points on given members (k,), and whether they are good (k,).

        Where one is not, its member has to be asked by itself.
        """
        ...


class PatchKind(Enum):
    """What a patch is: boundary of one region, interface of two, sheet, or trim surface."""

    FACE = "face"
    INTERFACE = "interface"
    SHEET = "sheet"
    TRIM = "trim"


class LineKind(Enum):
    """What a line is.

    An edge of the boundary, a seam (three or more sheets), a trim (two sheets that continue each
    other), a rim (the free end of a sheet) or a reflexive curve.
    """

    EDGE = "edge"
    SEAM = "seam"
    TRIM = "trim"
    RIM = "rim"
    REFLEXIVE = "reflexive"


@dataclass(frozen=True, eq=False)
class Patch(Shown):
    """Triangles on one surface.

    Args:
        kind: what it is.
        surface: that its vertices lie on.
        triangles: (m, 3) indices of points, counterclockwise seen against `surface.normal`
            (so that a triangle's own normal agrees with the surface's).
    """

    kind: PatchKind
    surface: SurfaceElement
    triangles: Ints


@dataclass(frozen=True, eq=False)
class Line(Shown):
    """A polyline on one curve.

    Args:
        kind: what it is.
        curve: that its vertices lie on.
        vertices: (n,) indices of points in order; a closed line repeats its first at its end.
    """

    kind: LineKind
    curve: CurveElement
    vertices: Ints


@dataclass(frozen=True, eq=False)
class Complex(Shown):
    """Patches and lines over shared points (n, 3)."""

    points: Array
    patches: tuple[Patch, ...]
    lines: tuple[Line, ...]
