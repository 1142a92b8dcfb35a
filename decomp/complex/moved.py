"""A complex in other coordinates: its points are moved, its surfaces and curves stay exact."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from decomp.complex.model import Complex, CurveElement, SurfaceElement
from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class MovedCurveElement:
    """`element` moved by `offset` (3,)."""

    element: CurveElement
    offset: Array

    def place(self, points: Array) -> Array:
        return np.asarray(self.element.place(points - self.offset) + self.offset)


@dataclass(frozen=True, eq=False)
class MovedSurfaceElement:
    """`element` moved by `offset` (3,)."""

    element: SurfaceElement
    offset: Array

    def place(self, points: Array) -> Array:
        return np.asarray(self.element.place(points - self.offset) + self.offset)

    def normal(self, points: Array) -> Array:
        return self.element.normal(points - self.offset)


def moved_complex(mesh: Complex, offset: Array) -> Complex:
    """A complex moved by `offset` (3,); each point is rounded once."""
    return Complex(
        mesh.points + offset,
        tuple(replace(p, surface=MovedSurfaceElement(p.surface, offset)) for p in mesh.patches),
        tuple(replace(line, curve=MovedCurveElement(line.curve, offset)) for line in mesh.lines),
    )
