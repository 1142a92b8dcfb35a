"""What every primitive is: a named intersection of half-spaces; and what several are made with."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass
from math import atan2
from typing import ClassVar, Self

import numpy as np

from decomp import carriers
from decomp.carriers import Carrier
from decomp.csg.solid import Solid, checked_name
from decomp.errors import InputError
from decomp.exact import seen_about
from decomp.magnitude import check_length
from decomp.places import triple
from decomp.vectors import Array, direction, frozen, norm, number

HalfSpaces = Iterator[tuple[str, Carrier]]


@dataclass(frozen=True, eq=False, repr=False)
class Primitive(Solid):
    """A named intersection of half-spaces."""

    kind: ClassVar[str]
    places: ClassVar[tuple[str, ...]]
    """Which of its fields are points."""
    name: str | None

    @abstractmethod
    def half_spaces(self) -> HalfSpaces:
        """Yield (face name, carrier) pairs; the primitive is what is inside all of them.

        The face name is empty where the primitive has only one face and needs no other word.
        """

    def bounds(self) -> Array | None:
        """Return the corners (2, 3) of a box around the primitive, None if it is unbounded."""
        return None

    def about(self, origin: Array) -> Self:
        """The same primitive in coordinates about `origin` (3,), each rounded once."""
        moved = copy(self)
        for field in self.places:
            object.__setattr__(moved, field, frozen(seen_about(getattr(self, field), origin)))
        return moved

    def __repr__(self) -> str:
        shown = (str, float, np.ndarray)
        values = [f"{k}={_show(v)}" for k, v in vars(self).items() if isinstance(v, shown)]
        return f"{type(self).__name__}({', '.join(values)})"


def set_fields(primitive: Primitive, name: str | None, **fields: Array | float) -> None:
    """Give a primitive its name and its fields, once.

    Raises:
        InputError: the name cannot be one.
    """
    object.__setattr__(primitive, "name", None if name is None else checked_name(name))
    for key, value in fields.items():
        object.__setattr__(primitive, key, value)


def cone_through(a: Array, ra: float, b: Array, rb: float) -> carriers.Cone:
    """The nappe through circles of radius ra about a and rb about b, across the line a b."""
    if ra > rb:
        a, ra, b, rb = b, rb, a, ra
    axis = direction(b - a, "cone axis")
    length = float(norm(b - a))
    slope = (rb - ra) / length
    return carriers.Cone(frozen(a - ra / slope * axis), axis, atan2(rb - ra, length))


def radius_at_end(value: float, what: str) -> float:
    """A radius that may be zero.

    Raises:
        InputError: it is no finite number, or negative.
    """
    result = number(value, what)
    if result < 0:
        raise InputError(f"{what} must not be negative, got {result:g}")
    if result > 0:
        check_length(result, what)
    return result


def refuse_equal_radii(a: float, b: float) -> None:
    """Raise InputError if a cone's radii are equal."""
    if a == b:
        hint = "both are zero" if a == 0 else f"both are {a:g}; that is a cylinder"
        raise InputError(f"a cone needs two different radii, but {hint}")


def around(points: list[Array], reaches: list[Array]) -> Array:
    """The corners (2, 3) of a box that holds boxes about points, which reach so far each way."""
    low = np.min([p - r for p, r in zip(points, reaches, strict=True)], axis=0)
    high = np.max([p + r for p, r in zip(points, reaches, strict=True)], axis=0)
    return np.array([low, high])


def _show(value: object) -> str:
    if isinstance(value, np.ndarray):
        return triple(value)
    return f"{value:g}" if isinstance(value, float) else repr(value)
