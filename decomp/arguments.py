"""Checks of arguments that are no numbers of geometry: counts, choices, switches, calls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from decomp.errors import InputError
from decomp.vectors import number


def whole(value: Any, what: str, least: int = 1) -> int:
    """Return `value` as a whole number that is not too small.

    Raises:
        InputError: it is none; the message names `what`.
    """
    found = number(value, what)
    if found != int(found) or found < least:
        raise InputError(f"{what} must be a whole number from {least}, got {value!r}")
    return int(found)


def one_of(value: Any, allowed: Sequence[Any], what: str) -> Any:
    """Return the one of `allowed` that `value` is.

    Raises:
        InputError: it is none; the message names `what`.
    """
    if isinstance(value, np.generic):
        value = value.item()
    for each in allowed:
        if type(value) is type(each) and value == each:
            return each
    named = ", ".join(repr(each) for each in allowed)
    raise InputError(f"{what} must be one of {named}, got {value!r}")


def switch(value: Any, what: str) -> bool:
    """Return `value` as True or False.

    Raises:
        InputError: it is neither; the message names `what`.
    """
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{what} must be True or False, got {value!r}")
    return bool(value)


def called(value: Any, what: str) -> None:
    """Refuse what is neither None nor can be called.

    Raises:
        InputError: the message names `what`.
    """
    if value is not None and not callable(value):
        raise InputError(f"{what} must be a function or None, got {value!r}")
