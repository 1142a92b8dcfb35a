"""The README's command runs; its Python example prints what its comments say."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from decomp.cli.main import main
from tests import pages

README = Path(__file__).parent.parent / "README.md"


def test_the_main_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What follows the installation."""
    first = next(text for language, _, text in pages.blocks("README.md") if language == "sh")
    words = shlex.split(first.split("&&")[-1])
    assert words[0] == ".venv/bin/decomp"
    (tmp_path / "meshes").symlink_to(README.parent / "meshes")
    monkeypatch.chdir(tmp_path)
    assert main(words[1:]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"meshes", "bearing.msh", "bearing.png"}


def test_the_python_example(capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = (text for language, _, text in pages.blocks("README.md") if language == "python")
    exec(compile(block, str(README), "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("5497.345")
    assert lines[0].endswith(" -1")
    assert lines[1].endswith("'hole#1.side', 'hole#2.side']")
    assert lines[2].startswith("plate.zmin [2.5")
    assert lines[-1] == "[-2.5]"


def test_the_package_docstring() -> None:
    import doctest

    import decomp

    assert doctest.testmod(decomp).failed == 0
