"""The native JSON form, which holds any model exactly.

The solids' nodes stand in one flat list, parts before the whole, and refer to their parts by
index; so a solid used twice is written once, and no depth of nesting is a depth of JSON.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from decomp.csg.model import Ignored, Model, Region
from decomp.csg.options import OF_FACES, OF_REGIONS
from decomp.csg.primitives import Primitive
from decomp.csg.solid import (
    Complement,
    Copies,
    Difference,
    Intersection,
    Labelled,
    Solid,
    Transformed,
    Union,
)
from decomp.errors import InputError, ParseError
from decomp.formats.json_items import Item, a_list, a_vector, a_whole_number, shown
from decomp.formats.native_schema import FIXED, KNOWN, NODES, OPEN, PRIMITIVES, VERSION
from decomp.formats.native_writing import dumps, encoded
from decomp.formats.source import Source
from decomp.magnitude import check_length
from decomp.similarity import Similarity
from decomp.vectors import Array, frozen

__all__ = ["dumps", "encoded", "read"]
UNIT = 1e-12
"""A direction whose length lacks less to 1 is a unit vector, and kept as it is."""
ORTHOGONAL = 1e-9
"""The entries of a rotation times its transpose are no farther off."""
FIXED_TO = 1e-12
"""A point that a transform leaves where it is moves by less, as a part of the coordinates."""


def read(source: Source, name: str = "model") -> Model:
    """Read a model; `name` is used where the text gives none.

    Raises:
        ParseError: the text is no JSON, or does not follow the schema.
    """
    try:
        document = json.loads(source.text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise ParseError(
            f"this is no JSON: {error.msg[0].lower()}{error.msg[1:]}",
            source.path,
            error.lineno,
            error.colno,
        ) from None
    except RecursionError:
        raise ParseError(
            "the JSON is nested too deep: nodes belong in one flat list", source.path
        ) from None
    except ValueError as error:
        raise ParseError(f"this is no usable JSON: {error}", source.path) from None
    try:
        return _model(document, name)
    except InputError as error:
        raise ParseError(str(error), source.path) from None


def _refuse_constant(word: str) -> float:
    raise ValueError(f"{word} is not allowed, numbers must be finite")


def _model(document: Any, name: str) -> Model:
    top = Item(document, "the file")
    if top.get("format") != "decomp":
        raise InputError(f"'format' must be 'decomp', not {shown(document['format'])}")
    if top.whole("version") != VERSION:
        raise InputError(f"version {document['version']} is not known, only {VERSION}")
    top.only("format", "version", "name", "regions", "ignored", "nodes")
    nodes: list[Solid] = []
    values = top.items("nodes")
    for k, value in enumerate(values):
        if not isinstance(value, dict) or value.get("type") not in KNOWN:
            Item(value, f"nodes[{k}]").kind()
    for k, value in enumerate(values):
        nodes.append(_solid(Item(value, f"nodes[{k}]"), nodes))
    regions = []
    for k, value in enumerate(top.items("regions")):
        item = Item(value, f"regions[{k}]")
        item.only("name", "solid", "options")
        solid = _earlier(item.get("solid"), nodes, item.place("solid"))
        regions.append(Region(item.text("name"), solid, item.options(OF_REGIONS)))
    ignored = []
    for k, value in enumerate(a_list(document.get("ignored", []), "ignored")):
        item = Item(value, f"ignored[{k}]")
        item.only("statement", "line")
        line = None if item.get("line") is None else item.whole("line")
        ignored.append(Ignored(item.text("statement"), line))
    return Model(tuple(regions), top.text("name") if "name" in document else name, tuple(ignored))


def _solid(item: Item, nodes: list[Solid]) -> Solid:
    kind = item.kind()
    if kind in PRIMITIVES:
        return _primitive(item, *PRIMITIVES[kind])
    item.only("type", *NODES[kind])

    def part(key: str) -> Solid:
        return _earlier(item.get(key), nodes, item.place(key))

    match kind:
        case "union" | "intersection":
            where = item.place("parts")
            parts = tuple(_earlier(each, nodes, where) for each in item.items("parts"))
            return Union(parts) if kind == "union" else Intersection(parts)
        case "difference":
            return Difference(part("base"), part("tool"))
        case "complement":
            return Complement(part("part"))
        case "transformed":
            return Transformed(part("part"), _similarity_in(item.get("by"), item.place("by")))
        case "copies":
            moves = [
                _similarity_in(each, f"{item.place('by')}[{k}]")
                for k, each in enumerate(item.items("by"))
            ]
            if not moves:
                raise InputError(f"{item.place('by')} must hold at least one transform")
            return Copies(part("part"), tuple(moves))
        case _:
            return Labelled(part("part"), item.name(), item.options(OF_FACES))


def _primitive(item: Item, cls: type[Primitive], fields: Mapping[str, str]) -> Primitive:
    item.only("type", "name", *fields)
    values: dict[str, Any] = {
        key: item.number(key) if kind == "n" else item.vector(key) for key, kind in fields.items()
    }
    try:
        result = cls(**values, name=item.name())
    except InputError as error:
        raise InputError(f"{item.where}: {error}") from None
    for key, kind in fields.items():
        # a direction that is a unit vector stays as it is, to the last bit
        if kind == "d" and abs(float(np.linalg.norm(values[key])) - 1) < UNIT:
            object.__setattr__(result, key, values[key])
    return result


def _similarity_in(value: Any, where: str) -> Similarity:
    item = Item(value, where)
    item.only("rotation", "scale", "offset", *OPEN, FIXED)
    place = item.place("rotation")
    rows = [a_vector(row, place) for row in item.items("rotation")]
    rotation = frozen(rows) if len(rows) == 3 else frozen(np.zeros((3, 3)))
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > ORTHOGONAL:
        raise InputError(f"{place} must be an orthogonal matrix, three rows of three numbers")
    scale = item.number("scale")
    if scale <= 0:
        raise InputError(f"{item.place('scale')} must be positive, got {scale:g}")
    check_length(scale, item.place("scale"))
    doubt, shift = (item.number(key) if key in item.value else 0.0 for key in OPEN)
    if min(doubt, shift) < 0:
        raise InputError(f"{where}: doubt and shift must not be negative, got {doubt:g}, {shift:g}")
    fixed = item.vector(FIXED) if FIXED in item.value else None
    result = Similarity(rotation, scale, item.vector("offset"), doubt, shift, fixed)
    if fixed is not None:
        _refuse_loose(result, fixed, item.place(FIXED))
    return result


def _refuse_loose(by: Similarity, fixed: Array, where: str) -> None:
    """Raise InputError if a fixed point is none."""
    size = float(np.abs(fixed).max() + np.abs(by.offset).max())
    if float(np.abs(by.points(fixed) - fixed).max()) > FIXED_TO * (1 + by.scale) * size:
        raise InputError(f"{where} must be a point that the transform leaves where it is")


def _earlier(value: Any, nodes: list[Solid], where: str) -> Solid:
    index = a_whole_number(value, where)
    if not 0 <= index < len(nodes):
        raise InputError(f"{where} is {index}, which is no node before it ({len(nodes)} there)")
    return nodes[index]
