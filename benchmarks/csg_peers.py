"""CSG solids as other programs build them: manifold3d, Gmsh's OpenCASCADE kernel, Netgen.

Half-spaces and infinite cylinders become boxes and cylinders that reach far beyond the solid.
Cones are not translated: none of the benchmark's models has one.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import acos, ceil, pi
from typing import Any

import numpy as np

from decomp.csg import primitives, solid
from decomp.csg.solid import Solid
from decomp.similarity import Similarity
from decomp.vectors import Array, frame

FAR = 4.0
"""Infinite primitives reach so many diagonals."""


class Builder(ABC):
    """Builds a solid bottom up.

    Args:
        bounds: (2, 3) of the solid.
        chord: largest distance of facets from their curved surfaces, where there are facets.
    """

    def __init__(self, bounds: Array, chord: float) -> None:
        self.centre, self.chord = bounds.mean(axis=0), chord
        self.reach = FAR * float(np.linalg.norm(bounds[1] - bounds[0]))

    def build(self, node: Solid) -> Any:
        """The solid of a node of the tree."""
        match node:
            case solid.Union():
                return self.union([self.build(part) for part in node.parts])
            case solid.Intersection():
                return self.intersection([self.build(part) for part in node.parts])
            case solid.Difference():
                return self.difference(self.build(node.base), self.build(node.tool))
            case solid.Complement():
                everything = self.box(self.centre - self.reach, np.full(3, 2 * self.reach))
                return self.difference(everything, self.build(node.part))
            case solid.Labelled():
                return self.build(node.part)
            case solid.Transformed():
                return self.moved(self.build(node.part), node.by)
            case solid.Copies():
                return self.union([self.moved(self.build(node.part), by) for by in node.by])
            case primitives.Block():
                return self.box(node.corner, node.size)
            case primitives.Sphere():
                return self.sphere(node.centre, node.radius)
            case primitives.Cylinder():
                return self.cylinder(node.base, node.top, node.radius)
            case primitives.InfiniteCylinder():
                foot = node.point + node.axis * float(node.axis @ (self.centre - node.point))
                reach = self.reach * node.axis
                return self.cylinder(foot - reach, foot + reach, node.radius)
            case primitives.Torus():
                return self.torus(node.centre, node.axis, node.major, node.minor)
            case primitives.HalfSpace():
                return self.half_space(node.point, node.normal)
        raise ValueError(f"{type(node).__name__} is not translated")

    def segments(self, radius: float) -> int:
        """Sides of a regular polygon within the chord error of its circle."""
        return max(8, ceil(pi / acos(1 - self.chord / radius)))

    def half_space(self, point: Array, normal: Array) -> Any:
        """A box behind a plane, about the foot of the solid's centre."""
        foot = self.centre - normal * float(normal @ (self.centre - point))
        x, y = frame(normal)
        turned = np.stack([x, y, normal], axis=1)
        size = 2 * self.reach
        corner = np.array([-self.reach, -self.reach, -size])
        return self.moved(self.box(corner, np.full(3, size)), Similarity(turned, 1.0, foot))

    @abstractmethod
    def union(self, parts: list[Any]) -> Any: ...
    @abstractmethod
    def intersection(self, parts: list[Any]) -> Any: ...
    @abstractmethod
    def difference(self, base: Any, tool: Any) -> Any: ...
    @abstractmethod
    def moved(self, part: Any, by: Similarity) -> Any: ...
    @abstractmethod
    def box(self, corner: Array, size: Array) -> Any: ...
    @abstractmethod
    def sphere(self, centre: Array, radius: float) -> Any: ...
    @abstractmethod
    def cylinder(self, base: Array, top: Array, radius: float) -> Any: ...
    @abstractmethod
    def torus(self, centre: Array, axis: Array, major: float, minor: float) -> Any: ...


def upright(axis: Array, origin: Array) -> Similarity:
    """Turns the z axis to a direction and moves the origin to a point."""
    x, y = frame(axis)
    return Similarity(np.stack([x, y, axis], axis=1), 1.0, origin)


class Facets(Builder):
    """Meshes of triangles by manifold3d."""

    def __init__(self, bounds: Array, chord: float) -> None:
        import manifold3d

        super().__init__(bounds, chord)
        self._library = manifold3d

    def union(self, parts: list[Any]) -> Any:
        return self._library.Manifold.batch_boolean(parts, self._library.OpType.Add)

    def intersection(self, parts: list[Any]) -> Any:
        return self._library.Manifold.batch_boolean(parts, self._library.OpType.Intersect)

    def difference(self, base: Any, tool: Any) -> Any:
        return base - tool

    def moved(self, part: Any, by: Similarity) -> Any:
        return part.transform(by.matrix()[:3])

    def box(self, corner: Array, size: Array) -> Any:
        return self._library.Manifold.cube(size.tolist()).translate(corner.tolist())

    def sphere(self, centre: Array, radius: float) -> Any:
        made = self._library.Manifold.sphere(radius, self.segments(radius))
        return made.translate(centre.tolist())

    def cylinder(self, base: Array, top: Array, radius: float) -> Any:
        length = float(np.linalg.norm(top - base))
        made = self._library.Manifold.cylinder(length, radius, radius, self.segments(radius))
        return self.moved(made, upright((top - base) / length, base))

    def torus(self, centre: Array, axis: Array, major: float, minor: float) -> Any:
        ring = self._library.CrossSection.circle(minor, self.segments(minor))
        made = ring.translate([major, 0.0]).revolve(self.segments(major + minor))
        return self.moved(made, upright(axis, centre))


class Kernel(Builder):
    """Shapes of OpenCASCADE by Gmsh, as lists of (dimension, tag)."""

    def __init__(self, bounds: Array, chord: float) -> None:
        import gmsh

        super().__init__(bounds, chord)
        self._occ = gmsh.model.occ

    def union(self, parts: list[Any]) -> Any:
        others = [entity for part in parts[1:] for entity in part]
        return self._occ.fuse(parts[0], others)[0] if others else parts[0]

    def intersection(self, parts: list[Any]) -> Any:
        result = parts[0]
        for part in parts[1:]:
            result = self._occ.intersect(result, part)[0]
        return result

    def difference(self, base: Any, tool: Any) -> Any:
        return self._occ.cut(base, tool)[0]

    def moved(self, part: Any, by: Similarity) -> Any:
        copy = self._occ.copy(part)
        self._occ.affineTransform(copy, by.matrix().reshape(-1).tolist())
        return copy

    def box(self, corner: Array, size: Array) -> Any:
        return [(3, self._occ.addBox(*corner.tolist(), *size.tolist()))]

    def sphere(self, centre: Array, radius: float) -> Any:
        return [(3, self._occ.addSphere(*centre.tolist(), radius))]

    def cylinder(self, base: Array, top: Array, radius: float) -> Any:
        return [(3, self._occ.addCylinder(*base.tolist(), *(top - base).tolist(), radius))]

    def torus(self, centre: Array, axis: Array, major: float, minor: float) -> Any:
        return [(3, self._occ.addTorus(*centre.tolist(), major, minor, zAxis=axis.tolist()))]


class Netgen(Builder):
    """Netgen's own CSG; models with copies or moves are given to it as files instead."""

    def __init__(self, bounds: Array, chord: float) -> None:
        from netgen import csg

        super().__init__(bounds, chord)
        self._csg = csg

    def union(self, parts: list[Any]) -> Any:
        result = parts[0]
        for part in parts[1:]:
            result = result + part
        return result

    def intersection(self, parts: list[Any]) -> Any:
        result = parts[0]
        for part in parts[1:]:
            result = result * part
        return result

    def difference(self, base: Any, tool: Any) -> Any:
        return base - tool

    def moved(self, part: Any, by: Similarity) -> Any:
        raise ValueError("moves are not translated")

    def half_space(self, point: Array, normal: Array) -> Any:
        return self._csg.Plane(self._point(point), self._csg.Vec(*normal.tolist()))

    def box(self, corner: Array, size: Array) -> Any:
        return self._csg.OrthoBrick(self._point(corner), self._point(corner + size))

    def sphere(self, centre: Array, radius: float) -> Any:
        return self._csg.Sphere(self._point(centre), radius)

    def cylinder(self, base: Array, top: Array, radius: float) -> Any:
        side = self._csg.Cylinder(self._point(base), self._point(top), radius)
        ends = [self.half_space(base, base - top), self.half_space(top, top - base)]
        return self.intersection([side, *ends])

    def torus(self, centre: Array, axis: Array, major: float, minor: float) -> Any:
        return self._csg.Torus(self._point(centre), self._csg.Vec(*axis.tolist()), major, minor)

    def _point(self, place: Array) -> Any:
        return self._csg.Pnt(*place.tolist())
