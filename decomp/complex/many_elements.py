"""The surfaces and curves of a complex, asked for many points at once.

Elements are numbered: first the distinct surfaces, then the distinct curves. Patches that share a
surface object share its number, so that one call serves them all. Surfaces of one family are asked
in one call too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from decomp.complex.model import Complex, CurveElement, SurfaceElement, SurfaceFamily
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, Ints, norm

Together = Callable[[Ints, Array], tuple[Array, Bools]]


class Elements:
    """Distinct surfaces and curves of a complex.

    Attributes:
        of_patch: the number of each patch's surface.
        of_line: the number of each line's curve.
        names: what each element is called in messages.
    """

    def __init__(self, given: Complex) -> None:
        surfaces: dict[int, int] = {}
        curves: dict[int, int] = {}
        self.names: list[str] = []
        self._surfaces: list[SurfaceElement] = []
        self._curves: list[CurveElement] = []
        of_patch, of_line = [], []
        for patch in given.patches:
            if id(patch.surface) not in surfaces:
                surfaces[id(patch.surface)] = len(self._surfaces)
                self._surfaces.append(patch.surface)
                self.names.append(f"{patch.kind.value} surface")
            of_patch.append(surfaces[id(patch.surface)])
        for line in given.lines:
            if id(line.curve) not in curves:
                curves[id(line.curve)] = len(self._surfaces) + len(self._curves)
                self._curves.append(line.curve)
                self.names.append(f"{line.kind.value} curve")
            of_line.append(curves[id(line.curve)])
        self._families, self._family, self._member = _families(self._surfaces)
        self.of_patch: Ints = np.array(of_patch, dtype=np.int64)
        self.of_line: Ints = np.array(of_line, dtype=np.int64)

    def place(self, numbers: Ints, points: Array) -> Array:
        """Points (k, 3) moved onto the elements of given numbers (k,).

        Raises:
            GeometryError: an element gives no finite point; the message says where.
        """
        moved = self._each(numbers, points, self._place_on, [f.place for f in self._families])
        self._finite(numbers, points, moved)
        return moved

    def normal(self, numbers: Ints, points: Array) -> Array:
        """Unit normals (k, 3) of the surfaces of given numbers at points (k, 3) on them.

        Raises:
            GeometryError: a surface gives no finite normal; the message says where.
        """
        found = self._each(numbers, points, self._normal_of, [f.normal for f in self._families])
        self._finite(numbers, points, found)
        return found

    def gap(self, numbers: Ints, points: Array) -> Array:
        """How far (k,) each point is from where its element places it."""
        return norm(self.place(numbers, points) - points)

    @property
    def first_curve(self) -> int:
        """Numbers from here on are curves'."""
        return len(self._surfaces)

    def _place_on(self, number: int, points: Array) -> Array:
        if number < len(self._surfaces):
            return self._surfaces[number].place(points)
        return self._curves[number - len(self._surfaces)].place(points)

    def _normal_of(self, number: int, points: Array) -> Array:
        return self._surfaces[number].normal(points)

    def _each(
        self,
        numbers: Ints,
        points: Array,
        ask: Callable[[int, Array], Array],
        ask_families: Sequence[Together],
    ) -> Array:
        """Ask each family, or else each element, once for all its points."""
        if len(numbers) == 0:
            return np.empty((0, 3))
        if (numbers == numbers[0]).all():
            return ask(int(numbers[0]), points)
        result = np.empty((len(points), 3))
        family = np.full(len(numbers), -1, dtype=np.int64)
        on = np.flatnonzero(numbers < len(self._surfaces))
        family[on] = self._family[numbers[on]]
        left = [np.flatnonzero(family < 0)]
        for k, ask_family in enumerate(ask_families):
            rows = np.flatnonzero(family == k)
            if len(rows):
                result[rows], good = ask_family(self._member[numbers[rows]], points[rows])
                left.append(rows[~good])
        alone = np.concatenate(left)
        order = alone[np.argsort(numbers[alone], kind="stable")]
        for some in np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1):
            if len(some):
                result[some] = ask(int(numbers[some[0]]), points[some])
        return result

    def _finite(self, numbers: Ints, points: Array, values: Array) -> None:
        if np.isfinite(values).all():
            return
        first = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
        raise GeometryError(
            f"{self.names[int(numbers[first])]} cannot be followed at {{at}}", at=points[first]
        )


def _families(surfaces: Sequence[SurfaceElement]) -> tuple[list[SurfaceFamily], Ints, Ints]:
    """The families, the family of each surface, -1 for none, and its number in it."""
    found: dict[int, list[Any]] = {}
    of_surface, member = np.full((2, len(surfaces)), -1, dtype=np.int64)
    for number, surface in enumerate(surfaces):
        family = getattr(surface, "family", None)
        if family is not None:
            own = found.setdefault(id(family), [])
            of_surface[number], member[number] = list(found).index(id(family)), len(own)
            own.append(surface)
    return [own[0].of_family(own) for own in found.values()], of_surface, member
