"""The lines of docs/coming-from.md: ours are run, and theirs where their libraries are there."""

from __future__ import annotations

import contextlib
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from markdown_it import MarkdownIt
from markdown_it.token import Token

from decomp.cli.main import main
from tests import pages

PAGE = "docs/coming-from.md"
BEFORE = {
    "Gmsh": "import gmsh; gmsh.initialize(interruptible=False); "
    "model, option = gmsh.model, gmsh.option; occ, field = model.occ, model.mesh.field; "
    "option.setNumber('General.Terminal', 0)",
    "Netgen": "from netgen.csg import *",
    "PyVista": "import pyvista as pv",
}
"""What their lines follow; the page says so."""
NOT_PYTHON = ("gmsh part", "netgen -", "solid plate =")
Row = tuple[str, str, str]


def tables() -> dict[str, list[Row]]:
    """By heading what each row is about, their line and ours (empty if there is none)."""
    found: dict[str, list[Row]] = {}
    heading, cells, before = "", [""], ""
    for token in MarkdownIt().enable("table").parse((pages.ROOT / PAGE).read_text("utf-8")):
        if token.type == "tr_open":
            cells = []
        elif token.type == "inline" and before == "heading_open":
            heading = token.content
        elif token.type == "inline" and before == "td_open":
            cells.append(_line(token) if cells else token.content)
        elif token.type == "tr_close" and cells:
            what, theirs, ours = cells
            found.setdefault(heading, []).append((what, theirs, ours))
        before = token.type
    return found


def _line(cell: Token) -> str:
    """The code of a cell; other words are none."""
    return " ".join(part.content for part in cell.children or [] if part.type == "code_inline")


def value(line: str, names: dict[str, Any]) -> Any:
    """What an expression gives; None for statements."""
    with contextlib.suppress(SyntaxError):
        return eval(compile(line, PAGE, "eval"), names)
    exec(compile(line, PAGE, "exec"), names)
    return None


def ran_ours(place: Path) -> Iterator[tuple[str, str, Any]]:
    """Heading, what it is about, and what each of our lines gives, in the page's order."""
    assert pages.run(PAGE, place) == 2
    names: dict[str, Any] = {}
    for language, _, text in pages.blocks(PAGE):
        if language == "python":
            exec(compile(text, PAGE, "exec"), names)
    for heading, rows in tables().items():
        for what, _, ours in rows:
            if ours.startswith("decomp "):
                assert main(shlex.split(ours)[1:]) == 0, ours
            elif ours:
                yield heading, what, value(ours, names)


@pytest.mark.slow
def test_our_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    given = {(heading, what): found for heading, what, found in ran_ours(tmp_path)}
    assert {heading for heading, _ in given} == {"Gmsh", "Netgen", "pygmsh", "PyVista", "Abaqus"}
    exact = (20 * 10 - 4 * np.pi) * 4
    assert given["Gmsh", "volume"] == pytest.approx(exact, rel=1e-9)
    assert [group.name for group in given["Gmsh", "faces to be found"]] == ["part/hole.side"]
    assert len(given["Gmsh", "a group's nodes"]) > 20
    assert "bore" in given["Netgen", "names of boundaries"]
    assert given["PyVista", "distance to the boundary"] == pytest.approx([-1])
    assert [len(rows) for rows in given["pygmsh", "elements of a group"]][-1] > 100
    (meet,) = given["Abaqus", "faces where parts meet"]
    assert meet.name == "part/hole.side|pin/hole.side"
    assert "SURFACE" in (tmp_path / "part.inp").read_text()


@pytest.mark.parametrize("program", BEFORE)
def test_their_lines(program: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert pages.run(PAGE, tmp_path) == 2
    names: dict[str, Any] = {}
    try:
        exec(BEFORE[program], names)
    except OSError as error:
        pytest.skip(f"{program} lacks a library of the system's: {error}")
    given = {}
    try:
        for what, theirs, _ in tables()[program]:
            if theirs and not theirs.startswith(NOT_PYTHON):
                given[what] = value(theirs, names)
    finally:
        if program == "Gmsh":
            names["gmsh"].finalize()
    assert len(given) > 8
    exact = (20 * 10 - 4 * np.pi) * 4
    if program == "Gmsh":
        assert given["volume"] == pytest.approx(exact, rel=1e-6)
        assert len(given["faces to be found"]) == 1
    elif program == "Netgen":
        assert {"bore", "default"} & given["names of boundaries"] == {"bore", "default"}
    else:
        assert given["volume, area"][0] == pytest.approx(exact, rel=1e-2)
