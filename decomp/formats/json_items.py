"""Values out of JSON, checked, with messages that name where they stand."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from decomp.csg.options import Known, Options, checked
from decomp.csg.solid import checked_name, checked_text
from decomp.errors import InputError
from decomp.formats.native_schema import KNOWN
from decomp.magnitude import check_magnitude
from decomp.near import near
from decomp.vectors import Array, frozen


@dataclass(frozen=True)
class Item:
    """A JSON object, and where it stands for the error messages."""

    value: Any
    where: str

    def __post_init__(self) -> None:
        if not isinstance(self.value, dict):
            raise InputError(f"{self.where} must be an object in {{ }}, not {shown(self.value)}")

    def only(self, *keys: str) -> None:
        """Refuse other keys."""
        for key in self.value:
            if key not in keys:
                known = ", ".join(keys)
                hint = near(str(key), keys)
                raise InputError(
                    f"{self.where} has an unknown key {key!r}; known are {known}{hint}"
                )

    def get(self, key: str) -> Any:
        """The value of a key that must be there."""
        if key not in self.value:
            raise InputError(f"{self.where} has no {key!r}")
        return self.value[key]

    def place(self, key: str) -> str:
        """Where a key stands, for messages."""
        return f"{self.where}.{key}"

    def text(self, key: str) -> str:
        """The text of a key."""
        value = self.get(key)
        if not isinstance(value, str):
            raise InputError(f"{self.place(key)} must be a text, not {shown(value)}")
        return checked_text(value, self.place(key))

    def kind(self) -> str:
        """The type of a node."""
        kind = self.text("type")
        if kind not in KNOWN:
            known = ", ".join(KNOWN)
            raise InputError(f"{self.where} has an unknown type {kind!r}; known are {known}")
        return kind

    def name(self) -> str | None:
        """The name of a node, if it has one."""
        value = self.value.get("name")
        if value is None:
            return None
        try:
            return checked_name(self.text("name"))
        except InputError as error:
            raise InputError(f"{self.where}: {error}") from None

    def items(self, key: str) -> list[Any]:
        """The list of a key."""
        return a_list(self.get(key), self.place(key))

    def whole(self, key: str) -> int:
        """The whole number of a key."""
        return a_whole_number(self.get(key), self.place(key))

    def number(self, key: str) -> float:
        """The number of a key."""
        return a_number(self.get(key), self.place(key))

    def vector(self, key: str) -> Array:
        """The three numbers (3,) of a key."""
        return a_vector(self.get(key), self.place(key))

    def options(self, known: Mapping[str, Known]) -> Options:
        """The options of a node or region, which may have the known ones."""
        item = Item(self.value.get("options", {}), self.place("options"))
        return checked(item.value, known, item.where)


def a_list(value: Any, where: str) -> list[Any]:
    """A value that must be a list."""
    if not isinstance(value, list):
        raise InputError(f"{where} must be a list in [ ], not {shown(value)}")
    return value


def a_whole_number(value: Any, where: str) -> int:
    """A value that must be a whole number."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError(f"{where} must be a whole number, not {shown(value)}")
    return value


def a_number(value: Any, where: str) -> float:
    """A value that must be a finite number, and not too large."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{where} must be a number, not {shown(value)}")
    try:
        result = float(value)
    except OverflowError:
        result = float("inf")
    check_magnitude(result, where)
    return result


def a_vector(value: Any, where: str) -> Array:
    """A value that must be a list of three numbers."""
    values = a_list(value, where)
    if len(values) != 3:
        raise InputError(f"{where} must be three numbers, not {len(values)}")
    return frozen([a_number(each, where) for each in values])


def shown(value: Any) -> str:
    """A short form of a wrong value."""
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else text[:37] + "..."
