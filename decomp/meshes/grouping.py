"""Which groups a mesh has: chosen when they are made, from parts that stay as they are.

1. Names of the user's, with the regions, faces or edges that their patterns stand for.
2. Volumes: regions, cells, or regions of one material together.
3. Surfaces: faces and interfaces, the pieces of each together; sheets if they are wanted.
4. Edges and vertices, if they are wanted.
Every element is in one group; one that two names would take is an error.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from decomp.arguments import one_of, switch
from decomp.errors import InputError
from decomp.meshes.group import Group, GroupKind
from decomp.meshes.mesh_edges import MeshEdges, mesh_edges
from decomp.meshes.parts import Parts, looked_up
from decomp.meshes.patterns import matching, names_edges, names_regions
from decomp.meshes.pieces import whole_name
from decomp.near import listed, near
from decomp.vectors import Ints

Volumes = Literal["regions", "cells", "materials"]
Named = Mapping[str, "str | Sequence[str]"]
"""Patterns, one or several, by the name of the group that joins what they stand for."""
VOLUMES = ("regions", "cells", "materials")
NAMES_OF_DIMENSION = {3: "regions", 2: "faces", 1: "edges", 0: "vertices"}


@dataclass(frozen=True)
class Chosen:
    """What is made a group.

    Args:
        volumes: a group for each region, for each cell, or for all regions of one material and
            each region without one.
        sheets: whether there are groups for sheets.
        groups: names for what patterns stand for (`decomp.meshes.patterns`).
        split_faces: whether pieces of one face have groups of their own.
        edges: whether there are groups for edges and vertices.

    Raises:
        InputError: one of them is of a wrong kind.
    """

    volumes: Volumes = "regions"
    sheets: bool = False
    groups: Named = field(default_factory=dict)
    split_faces: bool = False
    edges: bool = False

    def __post_init__(self) -> None:
        one_of(self.volumes, VOLUMES, "volumes")
        for what in ("sheets", "split_faces", "edges"):
            object.__setattr__(self, what, switch(getattr(self, what), what))
        object.__setattr__(self, "groups", checked_groups(self.groups))

    def check(self, with_cells: bool, materials: Iterable[str | None]) -> None:
        """Refuse what a model, or a mesh without cells, does not have.

        Raises:
            InputError: cells or sheets are wanted and there are none, or materials.
        """
        wanted = "volumes of cells" if self.volumes == "cells" else "sheets" if self.sheets else ""
        if wanted and not with_cells:
            raise InputError(
                f"{wanted} are wanted, and a mesh without cells has none: ask for volumes of "
                "regions and no sheets, or leave the cells in"
            )
        if self.volumes == "materials" and not any(materials):
            raise InputError(
                "volumes of materials are wanted, and no region has one: give regions a "
                "'-material', or take volumes of regions"
            )


def checked_groups(groups: Named | None) -> dict[str, tuple[str, ...]]:
    """Patterns by name, as tuples.

    Raises:
        InputError: they are no such thing.
    """
    if not isinstance(groups, Mapping):
        raise InputError(
            f"groups must be patterns by name, such as {{'bolts': '*/bolt*.side'}}, got {groups!r}"
        )
    result = {}
    for name, given in groups.items():
        patterns = (given,) if isinstance(given, str) else given
        if not isinstance(name, str) or not name.strip():
            raise InputError(f"a group's name must be a text and not empty, got {name!r}")
        if (
            not isinstance(patterns, (list, tuple))
            or not patterns
            or not all(isinstance(each, str) and each.strip() for each in patterns)
        ):
            raise InputError(
                f"group {name!r} must have a pattern or a list of some, such as '*/bolt*.side', "
                f"got {given!r}"
            )
        result[name] = tuple(each.strip() for each in patterns)
    return result


@dataclass(frozen=True, eq=False)
class Grouped:
    """Groups, and the elements in them.

    Args:
        groups: those of volumes first, then of surfaces, edges and vertices.
        tet_tags: (m,) of all tetrahedra.
        rows: (k,) the triangles of the parts that are in a group.
        triangle_tags: (k,) of these.
        surface_tags: the tag of each surface's group.
        lines: (e, 2) or (e, 3) edges of triangles.
        line_tags: (e,) of these.
        nodes: (p,) nodes at vertices.
        node_tags: (p,) of these.
    """

    groups: tuple[Group, ...]
    tet_tags: Ints
    rows: Ints
    triangle_tags: Ints
    surface_tags: Mapping[int, int]
    lines: Ints
    line_tags: Ints
    nodes: Ints
    node_tags: Ints


def grouped(parts: Parts, chosen: Chosen) -> Grouped:
    """Make the groups.

    Raises:
        InputError: a pattern stands for nothing, two names for the same, or a name is taken.
    """
    chosen.check(bool(parts.cells), parts.materials)
    surfaces = [s for s in parts.surfaces if chosen.sheets or s.kind is not GroupKind.SHEET]
    wants_edges = chosen.edges or any(
        names_edges(each) for patterns in chosen.groups.values() for each in patterns
    )
    edges = mesh_edges(parts, chosen.split_faces) if wants_edges else MeshEdges.none(parts)
    there = {3: parts.regions, 2: surfaces, 1: edges.edges, 0: edges.vertices}
    named = names_given(chosen.groups, there, chosen.split_faces)

    units = parts.cells if chosen.volumes == "cells" else parts.regions
    of_region = dict(named[3])
    if chosen.volumes == "materials":
        for region, material in zip(parts.regions, parts.materials, strict=True):
            if material:
                of_region.setdefault(region.name, material)
    given = {u.name: of_region[u.regions[0]] for u in units if u.regions[0] in of_region}
    solid, tags = _joined(units, given)
    tet_tags = looked_up(tags, parts.of_tets if units is parts.solids else parts.region_of_tets)

    sheets = {s.name for s in surfaces if s.kind is GroupKind.SHEET}

    def usual(name: str) -> str:
        return name if chosen.split_faces or name in sheets else whole_name(name)

    flat, surface_tags = _joined(surfaces, named[2], usual)
    found = looked_up(surface_tags, parts.of_triangles, 0)
    rows = np.flatnonzero(found)

    def thin(units: Sequence[Group], of: Ints) -> tuple[list[Group], Ints]:
        names = named[units[0].dimension] if units else {}
        made, tags = _joined([u for u in units if chosen.edges or u.name in names], names)
        return made, looked_up(tags, of, 0)

    lines, line_tags = thin(edges.edges, edges.of_lines)
    corners, node_tags = thin(edges.vertices, edges.of_nodes)
    return Grouped(
        (*solid, *flat, *lines, *corners),
        tet_tags,
        rows,
        found[rows],
        surface_tags,
        edges.lines[line_tags > 0],
        line_tags[line_tags > 0],
        edges.nodes[node_tags > 0],
        node_tags[node_tags > 0],
    )


def names_given(
    groups: Mapping[str, Sequence[str]], there: Mapping[int, Sequence[Group]], split: bool
) -> dict[int, dict[str, str]]:
    """By dimension, the name of the user's for each region, surface, edge or vertex with one.

    Args:
        groups: patterns by the names of groups.
        there: parts by dimension, that is 3 to 0.
        split: whether a piece of a face is named alone.

    Raises:
        InputError: a pattern stands for nothing, two names for the same, one for unlike things.
    """
    result: dict[int, dict[str, str]] = {dimension: {} for dimension in there}
    for name, patterns in groups.items():
        found = [standing_for(pattern, name, there, split) for pattern in patterns]
        dimensions = {dimension for dimension, _ in found}
        if len(dimensions) > 1:
            what = " and ".join(NAMES_OF_DIMENSION[d] for d in sorted(dimensions, reverse=True))
            raise InputError(f"group {name!r} would join {what}: give each a group of its own")
        taken = result[dimensions.pop()]
        for each in dict.fromkeys(n for _, own in found for n in own):
            if each in taken:
                raise InputError(
                    f"{each} would be in two groups, {taken[each]!r} and {name!r}: an element is "
                    "in one; let their patterns stand for different ones"
                )
            taken[each] = name
    return result


def standing_for(
    pattern: str, group: str, there: Mapping[int, Sequence[Group]], split: bool
) -> tuple[int, list[str]]:
    """The dimension of what a pattern of a group stands for, and its names.

    Raises:
        InputError: it stands for nothing.
    """
    asked = (3,) if names_regions(pattern) else (1, 0) if names_edges(pattern) else (2,)
    # a name stands for itself, whatever characters it holds
    exact = [d for d, units in there.items() if any(u.name == pattern for u in units)]
    for dimension in (*exact, *asked):
        units = there[dimension]
        own = set(matching(pattern, ((u.name, u.kind) for u in units)))
        if not split and dimension == 2:
            # a face stands for all its pieces
            also = set(matching(pattern, ((whole_name(u.name), u.kind) for u in units)))
            own |= {u.name for u in units if whole_name(u.name) in also}
        if own:
            return dimension, [u.name for u in units if u.name in own]
    names = [u.name for dimension in asked for u in there[dimension]]
    hint = near(pattern, names) or f"; there are {listed(names)}"
    if asked == (3,) and matching(f"*/{pattern}", ((u.name, u.kind) for u in there[2])):
        hint = f"; '*/{pattern}' stands for faces"
    raise InputError(
        f"{pattern!r} of group {group!r} stands for none of the "
        f"{NAMES_OF_DIMENSION[asked[0]]}{hint}"
    )


def _joined(
    units: Sequence[Group], given: Mapping[str, str], usual: Callable[[str], str] = str
) -> tuple[list[Group], dict[int, int]]:
    """A group for each name, in the order of its first unit; and the tag of each unit's group.

    Args:
        units: parts.
        given: the group's name for some of them, by their own names.
        usual: the group's name for the others.

    Raises:
        InputError: a given name is one that others usually have.
    """
    members: dict[str, list[Group]] = {}
    usually: dict[str, set[str]] = {}
    for unit in units:
        members.setdefault(given.get(unit.name) or usual(unit.name), []).append(unit)
        usually.setdefault(usual(unit.name), set()).add(unit.name)
    theirs = set(given.values())
    groups: list[Group] = []
    tags: dict[int, int] = {}
    for tag, (name, own) in enumerate(members.items(), 1):
        if name in theirs and name in usually and usually[name] != {u.name for u in own}:
            raise InputError(
                f"{name!r} cannot be the name of a group of "
                f"{listed((unit.name for unit in own if unit.name != name), 3)}: it is the "
                "model's name of something else; choose another one"
            )
        groups.append(_group(name, tag, own))
        tags |= {unit.tag: tag for unit in own}
    return groups, tags


def _group(name: str, tag: int, own: Sequence[Group]) -> Group:
    """The group of some parts."""
    if len(own) == 1:
        return replace(own[0], tag=tag, name=name, members=_members(name, own))
    kinds = {unit.kind for unit in own}
    conditions = {unit.bc for unit in own}
    return Group(
        kinds.pop() if len(kinds) == 1 else GroupKind.FACE,
        tag,
        name,
        tuple(dict.fromkeys(region for unit in own for region in unit.regions)),
        volume=_each((unit.volume for unit in own), sum),
        maxh=min((unit.maxh for unit in own if unit.maxh is not None), default=None),
        bc=conditions.pop() if len(conditions) == 1 else None,
        length=_each((unit.length for unit in own), min),
        members=_members(name, own),
    )


def _members(name: str, own: Sequence[Group]) -> tuple[str, ...]:
    names = tuple(unit.name for unit in own)
    return () if names == (name,) else names


def _each(values: Iterable[float | None], of: Callable[[Sequence[float]], float]) -> float | None:
    """Something of all values, None if one of them is."""
    known = list(values)
    return None if None in known else of([each for each in known if each is not None])
