"""The native JSON form, which holds any model exactly.

The solids' nodes stand in one flat list, parts before the whole, and refer to their parts by
index; so a solid used twice is written once, and no depth of nesting is a depth of JSON.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from types import MappingProxyType
from typing import Any

import numpy as np

from decomp.csg.model import Ignored, Model, Region
from decomp.csg.primitives import (
    Block,
    Cone,
    Cylinder,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    Primitive,
    Sphere,
    Torus,
)
from decomp.csg.solid import (
    Complement,
    Copies,
    Difference,
    Intersection,
    Labelled,
    Options,
    Solid,
    Transformed,
    Union,
    checked_name,
    walk,
)
from decomp.errors import InputError, ParseError
from decomp.formats.source import Source
from decomp.similarity import Similarity
from decomp.vectors import Array, frozen

VERSION = 1
DEEPEST_OPTION = 16

# each primitive's fields: p a point or vector, d a unit vector, n a number
PRIMITIVES: dict[str, tuple[type[Primitive], dict[str, str]]] = {
    "block": (Block, {"corner": "p", "size": "p"}),
    "sphere": (Sphere, {"centre": "p", "radius": "n"}),
    "cylinder": (Cylinder, {"base": "p", "top": "p", "radius": "n"}),
    "cone": (Cone, {"base": "p", "base_radius": "n", "top": "p", "top_radius": "n"}),
    "torus": (Torus, {"centre": "p", "axis": "d", "major": "n", "minor": "n"}),
    "half_space": (HalfSpace, {"point": "p", "normal": "d"}),
    "infinite_cylinder": (InfiniteCylinder, {"point": "p", "axis": "d", "radius": "n"}),
    "infinite_cone": (InfiniteCone, {"apex": "p", "axis": "d", "half_angle": "n"}),
}
TYPE_OF = {cls: name for name, (cls, _) in PRIMITIVES.items()}
# the keys of every other node
NODES: dict[str, tuple[str, ...]] = {
    "union": ("parts",),
    "intersection": ("parts",),
    "difference": ("base", "tool"),
    "complement": ("part",),
    "transformed": ("part", "by"),
    "copies": ("part", "by"),
    "labelled": ("part", "name", "options"),
}
KNOWN = (*PRIMITIVES, *NODES)


def dumps(model: Model) -> str:
    """Write a model as JSON text, one node a line.

    Raises:
        InputError: an option's value has no JSON form, or a solid is of an unknown class.
    """
    index: dict[int, int] = {}
    nodes = []
    for node in walk([region.solid for region in model.regions]):
        nodes.append(_line(_node(node, index)))
        index[id(node)] = len(index)
    regions = [
        _line(
            {
                "name": region.name,
                "solid": index[id(region.solid)],
                "options": _options_out(region.options, f"region {region.name!r}"),
            }
        )
        for region in model.regions
    ]
    ignored = [_line({"statement": i.statement, "line": i.line}) for i in model.ignored]
    head = [_line({"format": "decomp"})[1:-1], _line({"version": VERSION})[1:-1]]
    head.append(_line({"name": model.name})[1:-1])
    lists = [("regions", regions), ("ignored", ignored), ("nodes", nodes)]
    body = [f'"{key}": [' + ",".join("\n  " + line for line in rows) + "\n]" for key, rows in lists]
    return "{\n" + ",\n".join(head + body) + "\n}\n"


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


def _line(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def _node(node: Solid, index: Mapping[int, int]) -> dict[str, Any]:
    """A node's JSON object, its parts given by their index."""
    if isinstance(node, Primitive):
        kind = TYPE_OF.get(type(node))
        if kind is None:
            raise InputError(f"a {type(node).__name__} has no JSON form")
        fields = {key: _plain_number(getattr(node, key)) for key in PRIMITIVES[kind][1]}
        return {"type": kind, "name": node.name, **fields}
    parts = [index[id(child)] for child in node.children()]
    match node:
        case Union():
            return {"type": "union", "parts": parts}
        case Intersection():
            return {"type": "intersection", "parts": parts}
        case Difference():
            return {"type": "difference", "base": parts[0], "tool": parts[1]}
        case Complement():
            return {"type": "complement", "part": parts[0]}
        case Transformed():
            return {"type": "transformed", "part": parts[0], "by": _similarity_out(node.by)}
        case Copies():
            moves = [_similarity_out(move) for move in node.by]
            return {"type": "copies", "part": parts[0], "by": moves}
        case Labelled():
            options = _options_out(node.options, f"label {node.name!r}")
            return {"type": "labelled", "part": parts[0], "name": node.name, "options": options}
        case _:
            raise InputError(f"a {type(node).__name__} has no JSON form")


def _plain_number(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else float(value)


def _similarity_out(by: Similarity) -> dict[str, Any]:
    return {
        "rotation": by.rotation.tolist(),
        "scale": float(by.scale),
        "offset": by.offset.tolist(),
    }


def _options_out(options: Options, where: str) -> dict[str, Any]:
    return {
        _option_key(key, where): _option_out(value, f"option {key!r} of {where}")
        for key, value in options.items()
    }


def _option_key(key: Any, where: str) -> str:
    if not isinstance(key, str):
        raise InputError(f"{where} has an option {key!r}, whose name is no text")
    return key


def _option_out(value: Any, where: str, depth: int = 0) -> Any:
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if depth <= DEEPEST_OPTION:
        if value is None or isinstance(value, (bool, int, str)):
            return value
        if isinstance(value, float) and isfinite(value):
            return value
        if isinstance(value, (list, tuple)):
            return [_option_out(each, where, depth + 1) for each in value]
        if isinstance(value, Mapping):
            return {
                _option_key(key, where): _option_out(each, where, depth + 1)
                for key, each in value.items()
            }
    shown = repr(value) if isinstance(value, float) else f"a {type(value).__name__}"
    raise InputError(f"{where} is {shown}, which has no JSON form")


@dataclass(frozen=True)
class _Item:
    """A JSON object, and where it stands for the error messages."""

    value: Any
    where: str

    def __post_init__(self) -> None:
        if not isinstance(self.value, dict):
            raise InputError(f"{self.where} must be an object in {{ }}, not {_shown(self.value)}")

    def only(self, *keys: str) -> None:
        for key in self.value:
            if key not in keys:
                known = ", ".join(keys)
                raise InputError(f"{self.where} has an unknown key {key!r}; known are {known}")

    def get(self, key: str) -> Any:
        if key not in self.value:
            raise InputError(f"{self.where} has no {key!r}")
        return self.value[key]

    def place(self, key: str) -> str:
        return f"{self.where}.{key}"

    def text(self, key: str) -> str:
        value = self.get(key)
        if not isinstance(value, str):
            raise InputError(f"{self.place(key)} must be a text, not {_shown(value)}")
        return value

    def kind(self) -> str:
        kind = self.text("type")
        if kind not in KNOWN:
            known = ", ".join(KNOWN)
            raise InputError(f"{self.where} has an unknown type {kind!r}; known are {known}")
        return kind

    def name(self) -> str | None:
        value = self.value.get("name")
        return None if value is None else checked_name(self.text("name"))

    def items(self, key: str) -> list[Any]:
        return _list(self.get(key), self.place(key))

    def whole(self, key: str) -> int:
        return _whole(self.get(key), self.place(key))

    def number(self, key: str) -> float:
        return _number(self.get(key), self.place(key))

    def vector(self, key: str) -> Array:
        return _vector(self.get(key), self.place(key))

    def options(self) -> Options:
        item = _Item(self.value.get("options", {}), self.place("options"))
        return MappingProxyType(
            {key: _option_in(each, item.place(key)) for key, each in item.value.items()}
        )


def _model(document: Any, name: str) -> Model:
    top = _Item(document, "the file")
    if top.get("format") != "decomp":
        raise InputError(f"'format' must be 'decomp', not {_shown(document['format'])}")
    if top.whole("version") != VERSION:
        raise InputError(f"version {document['version']} is not known, only {VERSION}")
    top.only("format", "version", "name", "regions", "ignored", "nodes")
    nodes: list[Solid] = []
    values = top.items("nodes")
    for k, value in enumerate(values):
        if not isinstance(value, dict) or value.get("type") not in KNOWN:
            _Item(value, f"nodes[{k}]").kind()
    for k, value in enumerate(values):
        nodes.append(_solid(_Item(value, f"nodes[{k}]"), nodes))
    regions = []
    for k, value in enumerate(top.items("regions")):
        item = _Item(value, f"regions[{k}]")
        item.only("name", "solid", "options")
        solid = _earlier(item.get("solid"), nodes, item.place("solid"))
        regions.append(Region(item.text("name"), solid, item.options()))
    ignored = []
    for k, value in enumerate(_list(document.get("ignored", []), "ignored")):
        item = _Item(value, f"ignored[{k}]")
        item.only("statement", "line")
        ignored.append(Ignored(item.text("statement"), item.whole("line")))
    return Model(tuple(regions), top.text("name") if "name" in document else name, tuple(ignored))


def _solid(item: _Item, nodes: list[Solid]) -> Solid:
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
            return Labelled(part("part"), item.name(), item.options())


def _primitive(item: _Item, cls: type[Primitive], fields: Mapping[str, str]) -> Primitive:
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
        if kind == "d" and abs(float(np.linalg.norm(values[key])) - 1) < 1e-12:
            object.__setattr__(result, key, values[key])
    return result


def _similarity_in(value: Any, where: str) -> Similarity:
    item = _Item(value, where)
    item.only("rotation", "scale", "offset")
    place = item.place("rotation")
    rows = [_vector(row, place) for row in item.items("rotation")]
    rotation = frozen(rows) if len(rows) == 3 else frozen(np.zeros((3, 3)))
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-9:
        raise InputError(f"{place} must be an orthogonal matrix, three rows of three numbers")
    scale = item.number("scale")
    if scale <= 0:
        raise InputError(f"{item.place('scale')} must be positive, got {scale:g}")
    return Similarity(rotation, scale, item.vector("offset"))


def _earlier(value: Any, nodes: list[Solid], where: str) -> Solid:
    index = _whole(value, where)
    if not 0 <= index < len(nodes):
        raise InputError(f"{where} is {index}, which is no node before it ({len(nodes)} there)")
    return nodes[index]


def _list(value: Any, where: str) -> list[Any]:
    if not isinstance(value, list):
        raise InputError(f"{where} must be a list in [ ], not {_shown(value)}")
    return value


def _whole(value: Any, where: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError(f"{where} must be a whole number, not {_shown(value)}")
    return value


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{where} must be a number, not {_shown(value)}")
    try:
        result = float(value)
    except OverflowError:
        result = float("inf")
    if not isfinite(result):
        raise InputError(f"{where} must be finite")
    return result


def _vector(value: Any, where: str) -> Array:
    values = _list(value, where)
    if len(values) != 3:
        raise InputError(f"{where} must be three numbers, not {len(values)}")
    return frozen([_number(each, where) for each in values])


def _option_in(value: Any, where: str, depth: int = 0) -> Any:
    if depth > DEEPEST_OPTION:
        raise InputError(f"{where} is nested too deep")
    if isinstance(value, list):
        return tuple(_option_in(each, where, depth + 1) for each in value)
    if isinstance(value, dict):
        return {key: _option_in(each, where, depth + 1) for key, each in value.items()}
    if isinstance(value, float) and not isfinite(value):
        raise InputError(f"{where} must be finite")
    return value


def _shown(value: Any) -> str:
    """A short form of a wrong value."""
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else text[:37] + "..."
