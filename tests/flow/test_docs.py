"""The docs' pages work by the letter; the reference is the code's."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from decomp.cli.main import main
from decomp.formats.native_schema import NODES, PRIMITIVES
from tests import pages

ROOT = Path(__file__).parent.parent.parent
PAGES = {
    "api.md": (1, ""),
    "formats.md": (7, "plate.geo ring.csg washer.json same.json"),
    "index.md": (1, "bearing.msh"),
    "mesh.md": (
        15,
        "around.msh graded.msh part.geo part.msh part.vtu plain.msh fields.vtu made named.msh "
        "names.toml",
    ),
    "theory.md": (1, ""),
    "tutorial.md": (8, "blind_hole.msh blind_hole.png blind_hole.html pipe.geo pipe.vtu"),
}
"""Pages whose blocks are executed, how many there are, and the files that are there then."""
ELSEWHERE = {
    "coming-from.md": "tests/flow/test_coming_from.py",
    "commands.md": "tests/flow/test_docs.py",
    "examples/README.md": "tests/flow/test_examples.py",
    "limits.md": "tests/flow/test_newcomers.py",
    "solvers.md": "tests/meshes/test_solvers.py",
}
"""Pages with blocks that are seen to by tests of their own."""


@pytest.mark.parametrize("page", PAGES)
def test_pages_are_true(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "meshes").symlink_to(ROOT / "meshes")
    count, files = PAGES[page]
    assert pages.run(f"docs/{page}", tmp_path) == count
    assert {path.name for path in tmp_path.iterdir()} - {"meshes"} == set(files.split())


def test_no_page_is_left_out() -> None:
    docs = ROOT / "docs"
    names = {path.relative_to(docs).as_posix() for path in docs.rglob("*.md")}
    told = {name for name in names if any(pages.blocks(f"docs/{name}"))}
    assert told == {*PAGES, *ELSEWHERE}
    for name, test in ELSEWHERE.items():
        assert Path(name).name in (ROOT / test).read_text(), name


def test_the_native_nodes_are_all_told_of() -> None:
    told = dict(
        re.findall(r"^\| `(\w+)` \| (.*) \|$", (ROOT / "docs/formats.md").read_text(), re.M)
    )
    known = {name: tuple(fields) for name, (_, fields) in PRIMITIVES.items()} | NODES
    assert {name: told[name] for name in known} == {
        name: ", ".join(f"`{key}`" for key in keys) for name, keys in known.items()
    }


def test_the_command_reference_is_the_codes() -> None:
    made = subprocess.run(
        [sys.executable, "-c", "import command_reference as c; print(c.reference(), end='')"],
        cwd=ROOT / "docs",
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    page = (ROOT / "docs" / "commands.md").read_text()
    assert page == made, "run: python docs/command_reference.py"


def test_a_file_of_another_program(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What a newcomer may try is told what can be read, not which byte is odd."""
    path = tmp_path / "part.step"
    path.write_bytes(b"\x89\xff\x00binary")
    assert main(["mesh", str(path)]) == 2
    message = capsys.readouterr().err
    assert "part.step: this is no text that describes a model" in message
    assert ".geo" in message


def test_what_adding_takes_is_there() -> None:
    """The files that the page leads to, and the names in them."""
    page = (ROOT / "docs/adding.md").read_text()
    paths = set(re.findall(r"`((?:decomp|tests|docs|benchmarks)/[\w./]+)`", page))
    assert len(paths) > 40
    assert [path for path in sorted(paths) if not (ROOT / path).exists()] == []
    for name, path in (
        ("FORMATS", "decomp/formats/table.py"),
        ("FORMATS", "decomp/meshes/files/table.py"),
        ("MESHERS", "decomp/meshing/backends/table.py"),
        ("COMMANDS", "decomp/cli/main.py"),
    ):
        assert re.search(rf"`{name}`[^`]*`{path}`", page), path
        assert f"\n{name} = " in (ROOT / path).read_text()
