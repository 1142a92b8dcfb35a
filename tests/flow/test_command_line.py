"""Help, misspelt commands, what is said while kernels are compiled, shells."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from decomp.cli.main import main, parser

MESHES = Path(__file__).parent.parent.parent / "meshes"
COMMANDS = next(action.choices for action in parser()._actions if action.dest == "command")
RARE = {"advance", "gap_ahead"}
"""Kernels that seams call by themselves in rare cases; they take a second."""
UNUSED = """
import importlib, pkgutil, sys
import decomp
from decomp.cli.main import main
from numba.core.registry import CPUDispatcher
main(["warm"])
for found in pkgutil.walk_packages(decomp.__path__, "decomp."):
    if found.name.split(".")[-1] not in ("__main__", "window"):
        importlib.import_module(found.name)
for name in [name for name in sys.modules if name.startswith("decomp.")]:
    for kernel in vars(sys.modules[name]).values():
        if isinstance(kernel, CPUDispatcher) and not kernel.overloads:
            if kernel._compile_for_args.__class__.__name__ != "function":
                print(kernel.py_func.__name__)
"""


def python(*words: str, **more: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **more}
    command = [sys.executable, *words]
    return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)


@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_help_is_80_wide(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    shown = COMMANDS[name] if name else parser()
    assert [line for line in shown.format_help().splitlines() if len(line) > 80] == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            "mesh --lyers 3 a.geo",
            "decomp mesh: error: unrecognized arguments: --lyers; did you mean --layers?",
        ),
        ("mesh", "decomp mesh: error: the following arguments are required: MODEL"),
        (
            "mesh a.geo --size nothing",
            "decomp mesh: error: argument --size: 'nothing' is no number",
        ),
        ("info a.geo --wrong", "decomp info: error: unrecognized arguments: --wrong"),
    ],
)
def test_a_wrong_command_takes_two_lines(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(words.split())
    assert end.value.code == 2
    name = words.split()[0]
    assert capsys.readouterr().err.splitlines() == [said, f"see decomp {name} --help"]


def test_several_models_are_told_of(capsys: pytest.CaptureFixture[str]) -> None:
    both = [str(MESHES / name) for name in ("block.geo", "flange.geo")]
    assert main(["info", *both]) == 0
    text = capsys.readouterr().out
    assert text.index("model block") < text.index("model flange")
    assert main(["info", *both, "--json"]) == 0
    models = json.loads(capsys.readouterr().out)
    assert [each["model"] for each in models] == ["block", "flange"]


def test_one_of_several_is_missing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "nothing.geo", str(MESHES / "block.geo")]) == 1
    out, errors = capsys.readouterr()
    assert "volume  24 " in out
    assert errors.splitlines() == [
        "decomp: error: nothing.geo: no such file",
        "decomp: error: 1 of 2 models failed",
    ]


@pytest.mark.parametrize(
    ("command", "asked"), [("info", "volume  24"), ("describe", "plane"), ("skeleton", "")]
)
def test_quiet_says_what_was_asked_for(
    command: str, asked: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, str(MESHES / "block.geo"), "--quiet"]) == 0
    out, errors = capsys.readouterr()
    assert asked in out
    assert bool(out) == bool(asked)
    assert errors == ""


@pytest.mark.slow
def test_compiling_is_told_of_in_a_pipe(tmp_path: Path) -> None:
    kernel = (
        "from decomp.kernels.compiled import kernel\n@kernel\ndef twice(x):\n    return 2 * x\n"
    )
    (tmp_path / "doubling.py").write_text(kernel)
    code = (
        "import argparse, sys; from decomp.cli import main;"
        "main.parser = lambda: argparse.Namespace(parse_args=lambda words: argparse.Namespace("
        "verbose=False, quiet='-q' in words, version=False, command='twice', run=twice));\n"
        "def twice(options): import doubling; print(doubling.twice(4))\n"
        "main.main(sys.argv[1:])"
    )
    first = python("-c", code, PYTHONPATH=f"{tmp_path}:{Path.cwd()}")
    again = python("-c", code, PYTHONPATH=f"{tmp_path}:{Path.cwd()}")
    assert first.stdout == again.stdout == "8\n"
    assert first.stderr.startswith("decomp: compiling kernels (once, a minute")
    assert len(first.stderr.splitlines()) == 1
    assert again.stderr == ""
    (tmp_path / "doubling.py").write_text(kernel.replace("2 *", "3 *"))
    quiet = python("-c", code, "-q", PYTHONPATH=f"{tmp_path}:{Path.cwd()}")
    assert (quiet.stdout, quiet.stderr) == ("12\n", "")


@pytest.mark.slow
def test_warm_uses_every_kernel() -> None:
    done = python("-c", UNUSED)
    assert done.returncode == 0, done.stderr
    first, *unused = done.stdout.splitlines()
    assert first.startswith("kernels compiled and kept")
    assert set(unused) <= RARE


def test_a_shell_completes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "bash"]) == 0
    script = tmp_path / "decomp.bash"
    ask = (
        "COMP_WORDS=(decomp mesh --lay); COMP_CWORD=2; _shtab_decomp; "
        'printf "%s\\n" "${COMPREPLY[@]}"'
    )
    script.write_text(capsys.readouterr().out + ask)
    done = subprocess.run(["bash", str(script)], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["--layers"]


def test_from_stdin_to_stdout(tmp_path: Path) -> None:
    """The model comes through a pipe, and so goes the mesh; what is said goes to stderr."""
    model = (MESHES / "block.geo").read_bytes()
    convert = [sys.executable, "-m", "decomp", "convert", "-", "-"]
    as_json = subprocess.run(convert, input=model, capture_output=True, check=True).stdout
    assert json.loads(as_json)["regions"][0]["name"] == "block"
    words = ["mesh", "-", "--cells", "none", "--size", "1", "-o", "-"]
    command = [sys.executable, "-m", "decomp", *words]
    done = subprocess.run(command, input=as_json, capture_output=True, check=True)
    assert done.stdout.startswith(b"$MeshFormat\n4.1 1 8\n")
    assert b"region block" in done.stderr
    (tmp_path / "block.msh").write_bytes(done.stdout)
    named = ["skeleton", "json:-", "-o", "obj:-"]
    command = [sys.executable, "-m", "decomp", *named]
    done = subprocess.run(command, input=as_json, capture_output=True, check=True)
    assert b"\nv " in done.stdout
    assert b"certificate holds" in done.stderr
    command[-1] = "dwg:-"
    done = subprocess.run(command, input=as_json, capture_output=True, check=False)
    assert done.returncode == 2
    assert b"'.dwg' is unknown as a suffix for skeletons" in done.stderr
    assert main(["check", str(MESHES / "block.geo"), str(tmp_path / "block.msh")]) == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("mesh - other.geo -o made", "- is one model or one file"),
        ("skeleton part.geo --json -o -", "--json prints to stdout"),
    ],
)
def test_streams_that_would_mix(
    words: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words.split()) == 2
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
