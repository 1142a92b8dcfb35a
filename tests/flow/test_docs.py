"""The docs' first page works by the letter; the reference is the code's; the site builds."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from decomp.cli.main import main

ROOT = Path(__file__).parent.parent.parent
START = (ROOT / "docs" / "index.md").read_text()


def test_the_first_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    files = re.findall(r"```text (\S+)\n(.*?)```", START, flags=re.DOTALL)
    assert [name for name, _ in files] == ["plate.geo"]
    for name, text in files:
        Path(name).write_text(text)
    blocks = re.findall(r"```sh\n(.*?)```", START, flags=re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    assert len(lines) == 6
    for line in lines:
        program, *words = shlex.split(line)
        if program == "decomp":
            assert main(words) == 0, line
    assert {path.name for path in tmp_path.iterdir()} == {
        "plate.geo", "plate.msh", "plate.html", "middle.vtu"
    }  # fmt: skip
    assert "thickness           5 to 5" in capsys.readouterr().out


def test_the_first_pages_python(capsys: pytest.CaptureFixture[str]) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", START, flags=re.DOTALL)
    exec(compile(code, "index.md", "exec"), {})
    said = re.findall(r"# (\S+)$", code, flags=re.MULTILINE)
    assert capsys.readouterr().out.split() == said == ["face", "True"]


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


def test_the_site_builds(tmp_path: Path) -> None:
    pytest.importorskip("mkdocs")
    pytest.importorskip("material")
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "-d", str(tmp_path / "site")]
    run = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert "decomp mesh" in (tmp_path / "site" / "commands" / "index.html").read_text()
