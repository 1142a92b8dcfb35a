"""What is known of a mesh's groups and parts beyond names and tags, and how .msh files hold it.

It is one JSON text in the section of comments, which other programs pass over, cut into lines of
bounded length as Gmsh reads no longer ones: `decomp: {"model": ...`. No line begins with `$`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

from decomp.meshes.group import Group, GroupKind
from decomp.meshes.model import TetMesh
from decomp.shown import Shown

START, LINE_BYTES = b"decomp: ", 200
KEYS = ("groups", "regions", "cells", "surfaces")


@dataclass(frozen=True)
class About(Shown):
    """All of a mesh but its elements.

    Args:
        model: its name.
        groups: that are written.
        regions, cells, surfaces: the parts, as in `decomp.meshes.parts.Parts`.
        materials: of the regions.
        sizes: how many triangles each surface has, in the file or not.
        unprojected: nodes off their surfaces, counted from 0.
    """

    model: str
    groups: tuple[Group, ...]
    regions: tuple[Group, ...]
    cells: tuple[Group, ...]
    surfaces: tuple[Group, ...]
    materials: tuple[str | None, ...]
    sizes: tuple[int, ...]
    unprojected: tuple[int, ...]


def about(mesh: TetMesh) -> About | None:
    """What is known of a mesh; None if its parts are not."""
    parts = mesh.parts
    if parts is None:
        return None
    return About(
        mesh.name,
        mesh.groups,
        parts.regions,
        parts.cells,
        parts.surfaces,
        parts.materials,
        tuple(int((parts.of_triangles == each.tag).sum()) for each in parts.surfaces),
        tuple(mesh.unprojected.tolist()),
    )


def about_lines(known: About | None) -> Iterator[bytes]:
    """The lines of comments."""
    if known is None:
        return
    values: dict[str, Any] = {"model": known.model}
    values |= {key: [_plain(group) for group in getattr(known, key)] for key in KEYS}
    values |= {key: getattr(known, key) for key in ("materials", "sizes", "unprojected")}
    text = json.dumps(values, separators=(",", ":")).replace("$", "\\u0024").encode()
    for start in range(0, len(text), LINE_BYTES):
        yield START + text[start : start + LINE_BYTES]


def read_about(comments: bytes) -> About | None:
    """What some comments tell; None if they are not decomp's, or have been changed."""
    lines = (line.rstrip(b"\r") for line in comments.split(b"\n"))
    text = b"".join(line[len(START) :] for line in lines if line.startswith(START))
    if not text:
        return None
    try:
        values = json.loads(text)
        groups = {key: tuple(map(_group, values[key])) for key in KEYS}
        materials = tuple(None if m is None else str(m) for m in values["materials"])
        sizes, off = (tuple(map(int, values[key])) for key in ("sizes", "unprojected"))
        return About(
            str(values["model"]), **groups, materials=materials, sizes=sizes, unprojected=off
        )
    except (ValueError, KeyError, TypeError):
        return None


def _plain(group: Group) -> dict[str, Any]:
    """A group as JSON values, without what it does not have."""
    values = {key: value for key, value in asdict(group).items() if value not in (None, ())}
    return values | {"kind": group.kind.value}


def _group(values: dict[str, Any]) -> Group:
    known = {field.name for field in fields(Group)}
    given = {key: _tuple(value) for key, value in values.items() if key in known}
    return Group(**{**given, "kind": GroupKind(given["kind"])})


def _tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


def by_tag(groups: Iterable[Group] | Sequence[Group]) -> dict[int, Group]:
    """Parts by their tags."""
    return {group.tag: group for group in groups}
