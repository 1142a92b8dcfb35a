"""Names of groups by pattern: `*/bolt*.side`, `core*`, `part/base.zmax&hole.side`.

A name is `region`, `region/face`, `region/face&face` of an edge or vertex, or several of these
joined by `|` of what several regions share; a sheet is `region/cell|cell`. A pattern has the same
form, and in each of its pieces `*` stands for any characters, `?` for one, `[ab]` for one of some.

- Without any of `/ . & |` it names regions; without `/` it names faces in any region.
- Without `|` it names whatever has one side that it names; with it, all sides. Order is free.
- Sheets, which bear the names of the cells that they part, are named by patterns with `|` alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase
from itertools import permutations

from decomp.meshes.group import GroupKind

Side = tuple[str, tuple[str, ...]]
"""A region, empty for none, and faces in it."""
MOST_ORDERED = 6
"""Sides and faces are tried in every order up to so many."""


def names_regions(pattern: str) -> bool:
    """Whether a pattern can name regions alone."""
    return not set(pattern) & set("/.&|")


def names_edges(pattern: str) -> bool:
    """Whether a pattern can name edges and vertices alone."""
    return "&" in pattern


def matches(pattern: str, name: str, kind: GroupKind) -> bool:
    """Whether a pattern stands for a name of something of a kind."""
    if pattern == name:
        return True
    wanted, sides = _sides(pattern, True), _sides(name, False)
    if "|" not in pattern:
        return kind is not GroupKind.SHEET and any(_is(wanted[0], side) for side in sides)
    return len(wanted) == len(sides) and _in_some_order(wanted, sides)


def matching(pattern: str, names: Iterable[tuple[str, GroupKind]]) -> list[str]:
    """Those of some names that a pattern stands for."""
    return [name for name, kind in names if matches(pattern, name, kind)]


def simple_patterns(pattern: str) -> list[str]:
    """The patterns for the single faces that one for interfaces or edges names; else itself."""
    if not set(pattern) & set("|&"):
        return [pattern]
    return [f"{region}/{face}" for region, faces in _sides(pattern, True) for face in faces]


def _sides(text: str, is_pattern: bool) -> list[Side]:
    """The sides of a name or pattern; one without a region has that of the side before it."""
    result: list[Side] = []
    region = "*" if is_pattern and not names_regions(text) else ""
    for piece in text.split("|"):
        start, slash, rest = piece.partition("/")
        if slash:
            region = start
        result.append((region, tuple((rest if slash else piece).split("&"))))
    return result


def _is(pattern: Side, side: Side) -> bool:
    """Whether a side is what a pattern's stands for."""
    (region, wanted), (own, faces) = pattern, side
    if bool(region) != bool(own) or not fnmatchcase(own, region) or len(wanted) != len(faces):
        return False
    orders: Iterable[Sequence[str]] = permutations(faces) if len(faces) <= MOST_ORDERED else [faces]
    return any(all(map(fnmatchcase, order, wanted)) for order in orders)


def _in_some_order(wanted: Sequence[Side], sides: Sequence[Side]) -> bool:
    orders: Iterable[Sequence[Side]] = (
        permutations(sides) if len(sides) <= MOST_ORDERED else [sides]
    )
    return any(all(map(_is, wanted, order)) for order in orders)
