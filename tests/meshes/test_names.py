"""Whatever a group is called, its name comes back from a .msh file, and Gmsh reads the file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from decomp.cli.main import main
from decomp.csg.model import model
from decomp.csg.primitives import Block
from decomp.formats import save
from decomp.meshes.files.msh_names import names_section, read_names
from decomp.meshes.files.msh_reader import read_msh
from decomp.meshes.model import TetMesh
from tests.meshes.opened import opened
from tests.meshes.shapes import bar, cube
from tests.meshes.test_reading import KINDS

NAMES = [
    "$EndPhysicalNames",
    "$EndPhysicalNames/p.xmin",
    '$EndPhysicalNames\n"',
    "$Nodes\n1\n1 0 0 0\n$EndNodes\n",
    '"quoted"',
    "back\\slash\\x41\\u0041\\",
    "",
    " ",
    "\x1b[2J\x07\0",
    "a line\r\nand another\u2028one",
    "\ud800",
    "Größe 𝄞",
    "long " * 60,
    "ä" * 200,
    "x" * 5000,
]


def named(name: str) -> TetMesh:
    """A mesh with a volume and a surface of a name, and others called almost so."""
    mesh = bar()
    groups = [
        replace(group, name=name + "'" * (k // 2)) if k in (0, 2, 4, 6) else group
        for k, group in enumerate(mesh.groups)
    ]
    return replace(mesh, name=name, groups=tuple(groups))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", KINDS)
def test_round_trip(kind: str, name: str, tmp_path: Path) -> None:
    mesh, path = named(name), tmp_path / "named.msh"
    mesh.write(path, **KINDS[kind])
    read = read_msh(path)
    assert read.names == {(g.dimension, g.tag): g.name for g in mesh.groups}
    assert len(read.tets) == len(mesh.tets)
    with opened(path) as gmsh:
        assert len(gmsh.model.mesh.getElementsByType(4)[0]) == len(mesh.tets)
        found = [gmsh.model.getPhysicalName(group.dimension, group.tag) for group in mesh.groups]
    assert len(set(found)) == len({group.name for group in mesh.groups})
    if name.isprintable() and len(name.encode()) <= 240 and '"' not in name and "\\" not in name:
        assert found == [group.name for group in mesh.groups]


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.text(st.characters(), max_size=300), max_size=4))
def test_any_names(names: list[str]) -> None:
    keyed = {(2, k): name for k, name in enumerate(names, 1)}
    section, _, comments = names_section(keyed.items()).partition(b"$EndPhysicalNames\n")
    assert read_names(section, comments) == keyed


@pytest.mark.parametrize("suffix", [".vtu", ".xdmf"])
@pytest.mark.parametrize("name", NAMES)
def test_names_in_xml(name: str, suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"named{suffix}"
    named(name).write(path)
    ElementTree.parse(path)


@pytest.mark.parametrize("region", ["$EndPhysicalNames", "\x1b[2J", "a\\x41", "r" * 400])
def test_check_reads_names_back(
    region: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mesh = cube()
    groups = [
        replace(g, name=region + g.name.removeprefix("cube"), regions=(region,))
        for g in mesh.groups
    ]
    paths = [str(tmp_path / name) for name in ("model.json", "mesh.msh")]
    save(model({region: Block((0, 0, 0), (1, 1, 1), "cube")}), paths[0])
    replace(mesh, groups=tuple(groups)).write(paths[1])
    assert main(["check", *paths]) == 0, capsys.readouterr().err
    assert "\x1b" not in capsys.readouterr().out
