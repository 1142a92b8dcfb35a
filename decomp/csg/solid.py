"""The CSG tree: immutable nodes that can be inspected; operators build nodes, nothing more.

Nodes form a directed acyclic graph, as one solid may be used several times. Every walk over it
is a loop, never a recursion, so that trees may be nested as deep as memory allows.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from decomp import similarity
from decomp.csg.options import OF_FACES, Options, checked
from decomp.errors import InputError
from decomp.similarity import Similarity
from decomp.vectors import direction, number, vector


@dataclass(frozen=True, eq=False, repr=False)
class Solid:
    """A set of points given by primitives, Boolean operations and similarities.

    Solids do not change: methods give new ones. `a | b`, `a & b`, `a - b` and `~a` are union,
    intersection, difference and complement.
    """

    def __or__(self, other: Solid) -> Union:
        return Union((self, _solid(other)))

    def __and__(self, other: Solid) -> Intersection:
        return Intersection((self, _solid(other)))

    def __sub__(self, other: Solid) -> Difference:
        return Difference(self, _solid(other))

    def __invert__(self) -> Complement:
        return Complement(self)

    def named(self, name: str, **options: Any) -> Labelled:
        """Put `name` before the names of all faces inside; options go to faces without their own.

        Args:
            name: as in `name.hole.side`.
            options: `maxh`, the largest edge length wanted, in model units; `bc`, the number of a
                boundary condition; `bcname`, its name.

        Raises:
            InputError: the name is empty or holds a character that face names use; there is no
                such option, or its value is none that it may have.
        """
        return Labelled(self, checked_name(name), options)

    def translate(self, offset: ArrayLike) -> Transformed:
        """Move by `offset`, (3,).

        Raises:
            InputError: it is not three finite numbers.
        """
        return Transformed(self, similarity.translation(offset))

    def rotate(self, axis: ArrayLike, degrees: float, centre: ArrayLike = (0, 0, 0)) -> Transformed:
        """Turn by `degrees` about the axis through `centre` (right-hand rule).

        Raises:
            InputError: the axis is zero, or numbers are not finite.
        """
        return Transformed(self, similarity.rotation(axis, degrees, centre))

    def mirror(self, normal: ArrayLike, point: ArrayLike = (0, 0, 0)) -> Transformed:
        """Reflect in the plane through `point` with the given normal, of any length.

        Raises:
            InputError: the normal is zero, or numbers are not finite.
        """
        return Transformed(self, similarity.reflection(normal, point))

    def scale(self, factor: float, centre: ArrayLike = (0, 0, 0)) -> Transformed:
        """Scale uniformly by `factor` above zero, keeping `centre` in place.

        Raises:
            InputError: the factor is not above zero, or numbers are not finite.
        """
        return Transformed(self, similarity.scaling(factor, centre))

    def transform(self, matrix: ArrayLike) -> Transformed:
        """Apply a homogeneous matrix (4, 4) or its first rows (3, 4), which must be a similarity.

        Raises:
            InputError: it is another kind of matrix, such as an uneven scale or a shear.
        """
        return Transformed(self, similarity.from_matrix(matrix))

    def linear_copies(self, offset: ArrayLike, count: int) -> Copies:
        """The union of `count` copies (this one included), each moved on by `offset`.

        Face names get the copy's number, from 1 for the one in its own place: `hole#2.side`.

        Raises:
            InputError: the count is no whole number above zero, or the offset not finite.
        """
        step = vector(offset, "copy offset")
        moves = [similarity.translation(k * step) for k in range(checked_count(count))]
        return Copies(self, tuple(moves))

    def polar_copies(
        self, axis: ArrayLike, count: int, degrees: float = 360.0, centre: ArrayLike = (0, 0, 0)
    ) -> Copies:
        """The union of `count` copies (this one included) spread evenly over `degrees`.

        A full turn (360 or -360) is shared out among `count` steps; any other angle has a copy at
        both ends. Turns follow the right-hand rule about the axis through `centre`; face names get
        the copy's number as in `linear_copies`.

        Raises:
            InputError: the count is no whole number above zero, or the axis is zero.
        """
        n = checked_count(count)
        total = number(degrees, "copy angle")
        direction(axis, "rotation axis")
        steps = n if abs(total) == 360.0 else max(n - 1, 1)
        turns = [similarity.rotation(axis, total * k / steps, centre) for k in range(n)]
        return Copies(self, tuple(turns))

    def children(self) -> tuple[Solid, ...]:
        """The solids that this node is made of."""
        return ()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied as a flat list, as trees may be deep."""
        from decomp.csg.packing import packed, unpacked_one

        return unpacked_one, (packed((self,)),)

    def __copy__(self) -> Solid:
        result = object.__new__(type(self))
        vars(result).update(vars(self))
        return result

    def __repr__(self) -> str:
        inside = len(self.children())
        return f"<{type(self).__name__} of {inside}>" if inside else f"<{type(self).__name__}>"


@dataclass(frozen=True, eq=False, repr=False)
class Union(Solid):
    """All points in at least one part; the empty set if there is none."""

    parts: tuple[Solid, ...]

    def children(self) -> tuple[Solid, ...]:
        return self.parts


@dataclass(frozen=True, eq=False, repr=False)
class Intersection(Solid):
    """All points in every part; all of space if there is none."""

    parts: tuple[Solid, ...]

    def children(self) -> tuple[Solid, ...]:
        return self.parts


@dataclass(frozen=True, eq=False, repr=False)
class Difference(Solid):
    """All points of `base` that are not in `tool`."""

    base: Solid
    tool: Solid

    def children(self) -> tuple[Solid, ...]:
        return (self.base, self.tool)


@dataclass(frozen=True, eq=False, repr=False)
class Complement(Solid):
    """All points that are not in `part`."""

    part: Solid

    def children(self) -> tuple[Solid, ...]:
        return (self.part,)


@dataclass(frozen=True, eq=False, repr=False)
class Transformed(Solid):
    """The image of `part` under a similarity."""

    part: Solid
    by: Similarity

    def children(self) -> tuple[Solid, ...]:
        return (self.part,)


@dataclass(frozen=True, eq=False, repr=False)
class Copies(Solid):
    """The union of the images of `part`, whose primitives are renamed `name#k`, k from 1."""

    part: Solid
    by: tuple[Similarity, ...]

    def children(self) -> tuple[Solid, ...]:
        return (self.part,)


@dataclass(frozen=True, eq=False, repr=False)
class Labelled(Solid):
    """The same points as `part`, with a name before its faces' names and options for them.

    Where labels are nested, an inner option wins over an outer one of the same key.

    Raises:
        InputError: an option is unknown, or its value wrong (`decomp.csg.options.OF_FACES`).
    """

    part: Solid
    name: str | None
    options: Mapping[str, Any] = field(default_factory=Options)

    def __post_init__(self) -> None:
        where = "a solid" if self.name is None else f"solid {self.name!r}"
        object.__setattr__(self, "options", checked(self.options, OF_FACES, where))

    def children(self) -> tuple[Solid, ...]:
        return (self.part,)


def union(parts: Sequence[Solid]) -> Union:
    """The union of a sequence of solids, of any length; the empty set if there is none.

    Raises:
        InputError: this is no sequence of solids.
    """
    return Union(_solids(parts, "union"))


def intersection(parts: Sequence[Solid]) -> Intersection:
    """The intersection of a sequence of solids, of any length; all of space if there is none.

    Raises:
        InputError: this is no sequence of solids.
    """
    return Intersection(_solids(parts, "intersection"))


def walk(roots: Sequence[Solid]) -> Iterator[Solid]:
    """Yield every node below `roots` once, children before parents."""
    seen: set[int] = set()
    stack: list[tuple[Solid, bool]] = [(root, False) for root in reversed(roots)]
    while stack:
        node, expanded = stack.pop()
        if expanded:
            yield node
        elif id(node) not in seen:
            seen.add(id(node))
            stack.append((node, True))
            stack.extend((child, False) for child in reversed(node.children()))


RESERVED = ".#/"
LONGEST_NAME = 1000
"""Characters of a name, and of all that stands before or after it in faces' names."""


def checked_name(name: str) -> str:
    """Return `name`, or raise InputError if it cannot be one.

    It is no text, empty, too long, holds `. # /`, quotes or blanks, or has no form in UTF-8.
    """
    if not isinstance(name, str):
        raise InputError(f"{name!r} cannot be a name: a name is a text")
    if len(name) > LONGEST_NAME:
        raise InputError(
            f"a name has {len(name):,} characters, but at most {LONGEST_NAME:,} are allowed: "
            f"{name[:40]!r}..."
        )
    checked_text(name, "a name")
    if not name or any(c in RESERVED or c.isspace() or c == '"' for c in name):
        raise InputError(
            f"{name!r} cannot be a name: use at least one character, no blanks, quotes or any of "
            + " ".join(RESERVED)
        )
    return name


def checked_text(text: str, what: str) -> str:
    """Return `text`, or raise InputError if it holds half a surrogate pair, which no file can."""
    if any("\ud800" <= c <= "\udfff" for c in text):
        raise InputError(
            f"{what} holds half of a surrogate pair, which has no form in UTF-8: {text[:40]!r}"
        )
    return text


def checked_count(count: int) -> int:
    """Return a number of copies, or raise InputError unless it is a whole number above zero."""
    if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 1:
        raise InputError(f"number of copies must be a whole number above zero, got {count!r}")
    return int(count)


def _solids(parts: Sequence[Solid], what: str) -> tuple[Solid, ...]:
    if isinstance(parts, Solid) or not isinstance(parts, Iterable):
        raise InputError(f"{what} takes a list of solids, got {parts!r}")
    return tuple(_solid(part) for part in parts)


def _solid(value: Solid) -> Solid:
    if not isinstance(value, Solid):
        raise InputError(f"a solid is combined with {value!r}, which is none")
    return value
