"""Which names a pattern stands for."""

from __future__ import annotations

import pytest

from decomp.meshes.group import GroupKind
from decomp.meshes.patterns import matches, matching, simple_patterns
from decomp.meshes.pieces import whole_name

NAMES = (
    ("core", GroupKind.REGION),
    ("air", GroupKind.REGION),
    ("core/bolt#1.side", GroupKind.FACE),
    ("core/bolt#2.side", GroupKind.FACE),
    ("core/base.zmax", GroupKind.FACE),
    ("core/base.zmax@2", GroupKind.FACE),
    ("core/bolt#1.top|air/bolt#1.top", GroupKind.INTERFACE),
    ("core/bolt#1.side|base.zmax", GroupKind.SHEET),
    ("core/base.zmax&bolt#1.side", GroupKind.EDGE),
    ("core/base.xmin&base.ymin&base.zmax", GroupKind.VERTEX),
    ("core/base.zmin|air/box.xmax&box.zmin", GroupKind.EDGE),
)


@pytest.mark.parametrize(
    ("pattern", "found"),
    [
        ("core", ["core"]),
        ("*", ["core", "air"]),
        ("[ab]*", ["air"]),
        ("*/bolt*.side", ["core/bolt#1.side", "core/bolt#2.side"]),
        ("bolt*.side", ["core/bolt#1.side", "core/bolt#2.side"]),
        ("core/bolt#?.side", ["core/bolt#1.side", "core/bolt#2.side"]),
        ("air/*", ["core/bolt#1.top|air/bolt#1.top"]),
        ("*.top", ["core/bolt#1.top|air/bolt#1.top"]),
        ("air/*|core/*", ["core/bolt#1.top|air/bolt#1.top"]),
        ("base.zmax", ["core/base.zmax"]),
        ("base.zmax*", ["core/base.zmax", "core/base.zmax@2"]),
        ("core/base.zmax|bolt*.side", ["core/bolt#1.side|base.zmax"]),
        ("core/bolt*.side&base.zmax", ["core/base.zmax&bolt#1.side"]),
        ("*&base.zmax", ["core/base.zmax&bolt#1.side"]),
        ("base.*&base.zmax&*.ymin", ["core/base.xmin&base.ymin&base.zmax"]),
        ("box.*&box.zmin", ["core/base.zmin|air/box.xmax&box.zmin"]),
        ("core", ["core"]),
        ("c", []),
        ("CORE", []),
    ],
)
def test_what_a_pattern_stands_for(pattern: str, found: list[str]) -> None:
    assert matching(pattern, NAMES) == found


def test_a_name_stands_for_itself() -> None:
    """Also where it holds what patterns are made of."""
    for name, kind in (*NAMES, ("a[1]*", GroupKind.REGION), ("x|y/z", GroupKind.FACE)):
        assert matches(name, name, kind)
    assert not matches("a[1]*", "a[1]b", GroupKind.REGION)


def test_single_faces_of_a_pattern() -> None:
    assert simple_patterns("core/a.x&b.*") == ["core/a.x", "core/b.*"]
    assert simple_patterns("core/a.x|air/b.*") == ["core/a.x", "air/b.*"]
    assert simple_patterns("a.x&b.y") == ["*/a.x", "*/b.y"]
    assert simple_patterns("core") == ["core"]


@pytest.mark.parametrize(
    ("name", "whole"),
    [
        ("sink/base.zmax@12", "sink/base.zmax"),
        ("sink/base.zmax@2|chip/chip.zmin@3", "sink/base.zmax|chip/chip.zmin"),
        ("sink/base.zmax@2&fin.xmin", "sink/base.zmax&fin.xmin"),
        ("sink/a@2.zmax", "sink/a@2.zmax"),
        ("sink/left@2", "sink/left"),
        ("left@3&base.zmax@2", "left&base.zmax"),
        ("sink/bolt#2.side", "sink/bolt#2.side"),
    ],
)
def test_pieces(name: str, whole: str) -> None:
    assert whole_name(name) == whole
