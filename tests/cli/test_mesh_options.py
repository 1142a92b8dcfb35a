"""Options of meshes as one value: of Python, of the command line, of a batch."""

from __future__ import annotations

import inspect
import json
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

import decomp
from decomp.cli.main import main, parser
from decomp.cli.mesh_job import MeshJob
from decomp.cli.mesh_options import mesh_options
from decomp.cli.models import Around
from decomp.ways.options import MeshOptions

USUAL = MeshOptions()
NAMES = [each.name for each in fields(MeshOptions)]
EVERY = (
    "mesh part.geo --size 2 --maxh */a=0.5 --size-at 1,2,3=0.1 --size-at 1,2,3,4=0.2 "
    "--size-at 1,2,3,4,5,6=0.3 --layers 3 --circle 20 --order 2 --cells face --method sampled "
    "--volumes cells --sheets --group g=*/a,*/b --split-faces --edges --fields distance,cell "
    "--timeout 9 --outside ball:3 --outside-size 4 --outside-only --msh2"
)


def options_of(line: str) -> Any:
    return parser().parse_args(line.split())


def values(options: MeshOptions) -> dict[str, Any]:
    return {name: getattr(options, name) for name in NAMES}


def test_the_function_has_the_same_options_and_defaults() -> None:
    given = inspect.signature(decomp.mesh).parameters
    assert [name for name in given if name not in ("source", "progress")] == NAMES
    assert {name: given[name].default for name in NAMES} == values(USUAL)


def test_the_command_without_options_asks_for_nothing() -> None:
    found = mesh_options(options_of("mesh part.geo"))
    for name, value in values(found).items():
        usual = getattr(USUAL, name)
        assert value == usual or (not value and not usual), name


def test_the_command_reaches_every_option() -> None:
    """But a function of places, which has no words."""
    found = mesh_options(options_of(EVERY))
    same = [name for name, value in values(found).items() if value == getattr(USUAL, name)]
    assert same == ["size_field"]
    assert found.sizes == {"*/a": 0.5, "outside": 4}
    assert found.groups == {"g": ["*/a", "*/b"]}
    assert found.size_at == [
        ((1, 2, 3), 0.1),
        ((1, 2, 3), 4, 0.2),
        ((1, 2, 3), (4, 5, 6), 0.3),
    ]


def test_a_job_comes_through_to_its_process() -> None:
    job = MeshJob.of(options_of(f"{EVERY} -o part.msh"))
    assert job.outputs == (Path("part.msh"),)
    assert job.around == Around("ball", 3, only=True)
    assert job.version == "2.2"
    again = MeshJob.from_json(json.loads(json.dumps(job.as_json())))
    plain = json.loads(json.dumps(values(job.options)))
    assert values(again.options) == plain
    assert replace(again, options=job.options).__dict__ == job.__dict__


def test_options_that_do_not_go_together_are_refused_before_anything_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nor is a directory made for a batch."""
    monkeypatch.chdir(tmp_path)
    for line, said in (
        ("--outside-size 1", "--outside-size needs --outside ball or --outside box"),
        ("--outside-only", "--outside-only needs --outside ball or --outside box"),
    ):
        for models in ("none.geo", "none.geo nil.geo -o out"):
            assert main(f"mesh {models} {line}".split()) == 2
            assert capsys.readouterr().err == f"decomp: error: {said}\n"
    assert list(tmp_path.iterdir()) == []


def test_a_batch_is_meshed_with_all_options(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its processes get what the command was given: names, sizes, version and the space around."""
    monkeypatch.chdir(tmp_path)
    for name in ("one", "two"):
        block = decomp.Block((0, 0, 0), (2, 1, 1), name="b")
        decomp.save({"part": block}, f"{name}.json")
    line = (
        "mesh one.json two.json -o out --cells none --size 1 --group ends=part/b.x* "
        "--outside box --outside-size 2 --msh2 --fields region"
    )
    assert main(line.split()) == 0
    assert "one.json" in capsys.readouterr().out
    for name in ("one", "two"):
        mesh = decomp.read(f"out/{name}.msh")
        assert Path(f"out/{name}.msh").read_text().startswith("$MeshFormat\n2.2")
        assert {"part", "outside", "ends"} <= {group.name for group in mesh.groups}
        assert "region" in mesh.cell_data
