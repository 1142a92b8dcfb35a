"""Writing models in the native JSON form."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from decomp.csg.model import Model
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
    walk,
)
from decomp.errors import InputError
from decomp.formats.native_schema import FIXED, OPEN, PRIMITIVES, TYPE_OF, VERSION
from decomp.similarity import Similarity


def encoded(model: Model) -> bytes:
    """The contents of a file.

    Raises:
        InputError: a solid is of an unknown class, or a name cannot be written.
    """
    try:
        return dumps(model).encode()
    except UnicodeEncodeError as error:
        raise InputError(f"a name or option has no UTF-8 form: {error.object!r}") from None


def dumps(model: Model) -> str:
    """Write a model as JSON text, one node a line.

    Raises:
        InputError: a solid is of an unknown class.
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
                "options": dict(region.options),
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
            options = dict(node.options)
            return {"type": "labelled", "part": parts[0], "name": node.name, "options": options}
        case _:
            raise InputError(f"a {type(node).__name__} has no JSON form")


def _plain_number(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else float(value)


def _similarity_out(by: Similarity) -> dict[str, Any]:
    written = {
        "rotation": by.rotation.tolist(),
        "scale": float(by.scale),
        "offset": by.offset.tolist(),
    }
    written.update({key: float(getattr(by, key)) for key in OPEN if getattr(by, key)})
    if by.fixed is not None and by.fixed.any():
        written[FIXED] = by.fixed.tolist()
    return written
