"""Tables of formats: suffixes, help, errors and files are made of their records."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import decomp
import decomp.formats as models
import decomp.meshes.files as meshes
from decomp.cli.main import main, parser
from decomp.errors import InputError
from decomp.files.format import Format, format_named, format_of, suffixes, told
from decomp.formats.table import FORMATS, ModelFormat, listed
from decomp.meshes.files.table import FORMATS as MESHES
from decomp.meshes.files.table import MeshFormat
from decomp.midsurfaces.table import FORMATS as MID_SURFACES
from decomp.skeletons.files.table import CELL_FORMATS
from decomp.skeletons.files.table import FORMATS as SKELETONS

TABLES: dict[str, tuple[Format, ...]] = {
    "models": FORMATS,
    "meshes": MESHES,
    "skeletons": SKELETONS,
    "cells": CELL_FORMATS,
    "mid-surfaces": MID_SURFACES,
}
NEEDED = {
    "models": ("read",),
    "meshes": ("encoded",),
    "skeletons": ("encoded",),
    "cells": ("surface",),
    "mid-surfaces": ("encoded",),
}
A, B = Format("one", (".a", ".aa"), "nowhere"), Format("", (".b",), "nowhere")


@pytest.mark.parametrize("table", TABLES)
def test_a_tables_modules_have_what_its_records_tell_of(table: str) -> None:
    every = suffixes(TABLES[table])
    assert len(set(every)) == len(every)
    for form in TABLES[table]:
        assert all(suffix.startswith(".") and suffix.islower() for suffix in form.suffixes)
        module = form.loaded()
        needed = list(NEEDED[table])
        needed += ["read"] if getattr(form, "is_read", False) else []
        needed += ["encoded"] if getattr(form, "written", False) else []
        assert all(callable(getattr(module, name)) for name in needed)


def test_formats_are_found_by_suffix_and_by_name() -> None:
    assert format_of("x.AA", (A, B), "things") is A
    assert format_of("/dev/null", (A, B), "things") is A
    with pytest.raises(InputError, match=r"'\.c' is unknown as a suffix for things; use \.a, \.aa"):
        format_of("x.c", (A, B), "things")
    assert format_named("b", (A, B), "things") is B
    with pytest.raises(InputError, match="'c' is no format for things; use a, b"):
        format_named("c", (A, B), "things")
    assert told((A, B)) == ".a/.aa (one), .b"


def made_module(monkeypatch: pytest.MonkeyPatch, **functions: Any) -> str:
    """The name of a module that has some functions."""
    module = ModuleType("format_of_the_tests")
    module.__dict__.update(functions)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    return module.__name__


def with_format(
    package: ModuleType, table: str, form: Format, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Add a line to a table, and to what has been made of it already."""
    longer = (*getattr(package, table), form)
    for module in list(sys.modules.values()):
        if module.__name__.startswith("decomp.") and getattr(module, table, None) == longer[:-1]:
            monkeypatch.setattr(module, table, longer)


def test_a_model_of_a_new_format(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One module and one line: it is read by suffix and by its first words, and told of."""

    def read(source: Any, name: str) -> decomp.Model:
        if "ball" not in source.text:
            raise source.wrong("no ball", 0)
        return decomp.model(decomp.Sphere((0, 0, 0), float(source.text.split()[-1]), name="ball"))

    form = ModelFormat("Balls", (".ball", ".bl"), made_module(monkeypatch, read=read), "!ball ")
    with_format(models, "FORMATS", form, monkeypatch)
    assert listed().endswith("decomp .json or Balls .ball/.bl")
    for name in ("x.ball", "x.bl", "x"):
        (tmp_path / name).write_text("!ball 2")
        assert decomp.Geometry(tmp_path / name).regions[0].volume == pytest.approx(32 / 3 * np.pi)
    (tmp_path / "bad.ball").write_text("cube")
    assert main(["info", str(tmp_path / "bad.ball")]) == 2
    assert capsys.readouterr().err.endswith("bad.ball:1:1: no ball\n")


def test_a_mesh_of_a_new_format(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It is written, offered by the command and named in its errors."""

    def encoded(mesh: decomp.TetMesh) -> bytes:
        return f"{len(mesh.tets)} tetrahedra".encode()

    form = MeshFormat("counts", (".count",), made_module(monkeypatch, encoded=encoded))
    with_format(meshes, "FORMATS", form, monkeypatch)
    assert ".count (counts)" in command_help("mesh")
    mesh = decomp.mesh(decomp.Block((0, 0, 0), (1, 1, 1)), size=0.5, cells="none")
    mesh.write(tmp_path / "x.count")
    assert (tmp_path / "x.count").read_text() == f"{len(mesh.tets)} tetrahedra"
    with pytest.raises(InputError, match=r"\.png, \.count$"):
        mesh.write(tmp_path / "x.counts")


def command_help(name: str) -> str:
    """The help of a command, in one line."""
    (commands,) = (each for each in parser()._actions if each.dest == "command")
    assert isinstance(commands.choices, dict)
    return " ".join(commands.choices[name].format_help().split())


def test_help_tells_all_formats() -> None:
    for command, table in (("mesh", MESHES), ("skeleton", SKELETONS), ("cells", CELL_FORMATS)):
        assert told(table) in command_help(command)
    for command in ("mesh", "info", "convert"):
        assert listed() in command_help(command)
    assert told(MID_SURFACES) in command_help("skeleton")


def test_records_are_known_without_what_reads_and_writes_files() -> None:
    """The command line starts without numpy, which every writer needs."""
    import subprocess

    program = (
        "import sys; from decomp.cli.main import parser; parser(); print('numpy' in sys.modules)"
    )
    found = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert found.stdout == "False\n"
