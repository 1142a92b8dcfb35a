"""Options of faces and regions: which there are, and what they may hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from decomp.errors import InputError


class Options(Mapping[str, Any]):
    """Values by name, read-only. Unlike a `MappingProxyType` it can be pickled and copied."""

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        self._values = dict(values or {})

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"Options({self._values!r})"


@dataclass(frozen=True)
class Known:
    """An option that exists.

    Args:
        what: it must be.
        plain: makes a value of Python's own types of one; None if it is none.
    """

    what: str
    plain: Callable[[Any], Any]


def _number(value: Any) -> int | float | None:
    """A finite number, whole where it is given so."""
    if isinstance(value, (np.integer, np.floating)):
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        return value if isfinite(value) else None
    except OverflowError:
        return None


def _length(value: Any) -> int | float | None:
    found = _number(value)
    return found if found is not None and found > 0 else None


def _whole(value: Any) -> int | None:
    found = _number(value)
    return int(found) if found is not None and found == int(found) else None


def _text(value: Any) -> str | None:
    if not isinstance(value, str) or not value:
        return None
    try:
        value.encode()
    except UnicodeEncodeError:
        return None
    return value


def _colour(value: Any) -> tuple[int | float, ...] | None:
    if not isinstance(value, (tuple, list, np.ndarray)):
        return None
    found = [each for each in map(_number, value) if each is not None]
    return tuple(found) if len(found) == len(value) == 3 else None


def _flag(value: Any) -> bool | None:
    return bool(value) if isinstance(value, (bool, np.bool_)) else None


_MAXH = Known("a length above zero", _length)
_BC = Known("a whole number", _whole)
OF_FACES = {"maxh": _MAXH, "bc": _BC, "bcname": Known("a text", _text)}
OF_REGIONS = {
    "maxh": _MAXH,
    "bc": _BC,
    "material": Known("a text", _text),
    "col": Known("three numbers", _colour),
    "transparent": Known("True or False", _flag),
    "layer": Known("a whole number", _whole),
}


def checked(values: Any, known: Mapping[str, Known], where: str) -> Options:
    """Options whose names exist and whose values are of Python's own types.

    Args:
        values: by name.
        known: `OF_FACES` or `OF_REGIONS`.
        where: they stand, for messages.

    Raises:
        InputError: there is no such option, or its value is none that it may have.
    """
    if not isinstance(values, Mapping):
        raise InputError(f"{where} must have options by name, got {values!r}")
    found = {}
    for key, value in values.items():
        if key not in known:
            unknown = f"{_short(key)}{_elsewhere(key)}"
            raise InputError(f"{where} has an unknown option {unknown}; {_all(known)}")
        found[key] = known[key].plain(value)
        if found[key] is None:
            wrong = f"must be {known[key].what}, got {_short(value)}"
            raise InputError(f"option {key} of {where} {wrong}; {_all(known)}")
    return Options(found)


def _all(known: Mapping[str, Known]) -> str:
    return "there are " + ", ".join(f"{key} ({each.what})" for key, each in known.items())


def _elsewhere(key: Any) -> str:
    """A hint where a region's option is given to a face or the other way round."""
    if key in OF_REGIONS:
        return ", which is an option of regions"
    return ", which is an option of faces" if key in OF_FACES else ""


def _short(value: Any) -> str:
    try:
        text = repr(value)
    except (RecursionError, ValueError):
        text = f"a {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "..."
