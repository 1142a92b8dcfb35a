"""Groups of a mesh by name and by pattern."""

from __future__ import annotations

from collections.abc import Sequence

from decomp.errors import UnknownNameError
from decomp.meshes.group import NOUNS, Group
from decomp.meshes.patterns import matches
from decomp.near import listed, near


def named(groups: Sequence[Group], name: str, dimension: int | None) -> Group:
    """The group of a name.

    Raises:
        UnknownNameError: there is none, or there are several and no dimension tells which.
    """
    found = [g for g in groups if g.name == name and dimension in (None, g.dimension)]
    if len(found) == 1:
        return found[0]
    if found:
        which = " and ".join(f"a {NOUNS[g.dimension]} (dimension {g.dimension})" for g in found)
        raise UnknownNameError(f"{name!r} is {which}: tell its dimension too")
    raise UnknownNameError(
        f"there is no {_noun(dimension)} {name!r}{_others(groups, name, dimension)}"
    )


def selected(groups: Sequence[Group], pattern: str, dimension: int | None) -> tuple[Group, ...]:
    """The groups that a pattern stands for, in their order.

    Raises:
        UnknownNameError: there is none.
    """
    own = [g for g in groups if dimension in (None, g.dimension)]
    found = tuple(g for g in own if matches(pattern, g.name, g.kind))
    if found:
        return found
    raise UnknownNameError(
        f"{pattern!r} stands for no {_noun(dimension)}{_others(groups, pattern, dimension)}"
    )


def _noun(dimension: int | None) -> str:
    return "group" if dimension is None else NOUNS.get(dimension, f"group of dimension {dimension}")


def _others(groups: Sequence[Group], name: str, dimension: int | None) -> str:
    """What may have been meant: the name in another dimension, names near to it, or all."""
    elsewhere = [g for g in groups if g.name == name]
    if elsewhere:
        return f", but a {NOUNS[elsewhere[0].dimension]} of that name"
    names = [g.name for g in groups if dimension in (None, g.dimension)]
    return near(name, names) or (f"; there are {listed(names)}" if names else "; there are none")
