"""Trees of solids as flat lists, in which they are pickled and copied however deep they are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from decomp.csg.solid import Solid, walk

Packed = tuple[tuple[tuple[type[Solid], dict[str, Any]], ...], tuple[int, ...]]
"""Each node's class and fields, parts before the whole, and which nodes are the roots."""


@dataclass(frozen=True)
class _Part:
    """Stands for a node earlier in the list."""

    number: int


def packed(roots: Sequence[Solid]) -> Packed:
    """The nodes below some solids; a solid that is used twice is there once."""
    number: dict[int, int] = {}
    nodes = []
    for node in walk(roots):

        def part(value: Solid) -> _Part:
            return _Part(number[id(value)])

        nodes.append((type(node), _mapped(vars(node), Solid, part)))
        number[id(node)] = len(number)
    return tuple(nodes), tuple(number[id(root)] for root in roots)


def unpacked(given: Packed) -> tuple[Solid, ...]:
    """The solids that were packed."""
    nodes: list[Solid] = []
    for kind, fields in given[0]:
        node = object.__new__(kind)
        vars(node).update(_mapped(fields, _Part, lambda part: nodes[part.number]))
        nodes.append(node)
    return tuple(nodes[number] for number in given[1])


def unpacked_one(given: Packed) -> Solid:
    """The only solid that was packed."""
    (solid,) = unpacked(given)
    return solid


def _mapped(
    fields: dict[str, Any], kind: type[Any], change: Callable[[Any], Any]
) -> dict[str, Any]:
    """Fields in which values of a kind, or tuples of them, are changed."""
    found = {}
    for key, value in fields.items():
        if isinstance(value, kind):
            value = change(value)
        elif isinstance(value, tuple) and any(isinstance(each, kind) for each in value):
            value = tuple(change(each) for each in value)
        found[key] = value
    return found
