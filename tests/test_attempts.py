"""What is tried again, and what a failure tells of it."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import NoReturn

import numpy as np
import pytest

import decomp
from decomp.attempts import Way, first_of, stage
from decomp.cli.main import main
from decomp.errors import EmptyRegionError, GeometryError, OverlapError, Try
from decomp.located import located
from decomp.places import seen_from
from decomp.skeletons.sheets.drawn_sheets import CrossingError

BALLS = """algebraic3d
solid one = sphere (0,0,0; 1);
solid two = sphere (2,0,0; 1);
solid kiss = one or two;
tlo kiss;
"""


def failing(error: GeometryError) -> Way[int]:
    def run() -> NoReturn:
        raise error

    return Way(f"way of {error}", run)


def test_the_first_way_that_succeeds() -> None:
    asked = []
    ways = [failing(GeometryError("a")), Way("second", lambda: 2), Way("third", lambda: 3)]
    assert first_of(asked.append(way.what) or way for way in ways) == 2
    assert asked == ["way of a", "second"]


def test_a_failure_keeps_its_first_cause() -> None:
    with pytest.raises(GeometryError) as caught:
        first_of([failing(OverlapError("a")), failing(GeometryError("b"))])
    assert type(caught.value) is OverlapError
    assert str(caught.value) == "a"
    assert caught.value.tries == (
        Try("way of a", "OverlapError", "a"),
        Try("way of b", "GeometryError", "b"),
    )


def test_ways_within_ways_are_told_of() -> None:
    def inner() -> int:
        return first_of([failing(GeometryError("a")), failing(GeometryError("b"))])

    with pytest.raises(GeometryError) as caught:
        first_of([Way("outer", inner), failing(GeometryError("c"))])
    whats = [each.what for each in caught.value.tries]
    assert whats == ["outer", "outer: way of a", "outer: way of b", "way of c"]


def test_only_after_some_errors() -> None:
    first = Way("first", failing(GeometryError("a")).run, (EmptyRegionError,))
    with pytest.raises(GeometryError, match="a") as caught:
        first_of([first, Way("second", lambda: 2)])
    assert caught.value.tries == ()


def test_places_and_sites() -> None:
    error = GeometryError("lost at {at}, in {braces}", ["a", "b"], at=np.array([1, 2.5, 3]))
    assert str(error) == "lost at (1, 2.5, 3), in {braces}"
    assert error.place == (1, 2.5, 3)
    assert error.sites == ("a", "b")
    assert error.as_json()["place"] == (1, 2.5, 3)
    advised = error.advised("do it")
    assert str(advised) == f"{error}; do it"
    assert (advised.place, advised.sites) == (error.place, error.sites)
    assert GeometryError("{at} nowhere").place is None


def test_places_are_the_users() -> None:
    """A model far from the origin is computed about a point of its own."""
    with seen_from(np.array([1e6, 0, -3]), 10.0):
        error = GeometryError("lost at {at}", at=np.array([1, 2.5, 3]))
    assert error.place == (1000001, 2.5, 0)
    assert str(error) == "lost at (1000001, 2.5, 0)"


@pytest.mark.parametrize(
    "error",
    [
        GeometryError("at {at}", ["a"], at=np.arange(3.0)),
        CrossingError("at {at}", np.zeros((1, 2), dtype=np.int64), ["a"], np.ones(3)),
    ],
)
def test_errors_are_pickled(error: GeometryError) -> None:
    with pytest.raises(GeometryError) as caught, stage("sheets", "part"):
        raise error
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert again.as_json() == error.as_json()


def test_stages_are_the_innermost() -> None:
    with pytest.raises(GeometryError) as caught, stage("refining"), stage("tracing", "part"):
        raise GeometryError("a")
    assert (caught.value.stage, caught.value.region) == ("tracing", "part")


def test_the_nearest_site_is_told() -> None:
    block = decomp.Geometry(decomp.Block((1e6, 0, 0), (4, 4, 2), name="block"))
    with pytest.raises(GeometryError) as caught, block.frame(), located(block):
        raise GeometryError("lost at {at}", at=np.array([1e6 + 2, 2, 1.5]) - block.offset)
    error = caught.value
    assert error.place == (1000002, 2, 1.5)
    assert (error.sites, error.region) == (("block.zmax",), "solid")


def test_the_report_tells_of_a_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("kiss.geo").write_text(BALLS)
    assert main(["mesh", "kiss.geo", "--report", "kiss.json"]) == 3
    found = json.loads(Path("kiss.json").read_text())["failed"]
    assert "touches itself" in found["error"]
    assert not Path("kiss.msh").exists()
    assert capsys.readouterr().err.count("\n") == 1


def test_verbose(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*_: object, **__: object) -> int:
        with stage("tracing", "part"):
            first = GeometryError("a", ["hole.side", "plate.zmax"])
            return first_of([failing(first), failing(GeometryError("b"))])

    monkeypatch.setattr("decomp.ways.skeleton.traced_skeleton", fails)
    decomp.save(decomp.Block((0, 0, 0), (1, 1, 1)), tmp_path / "a.json")
    out = str(tmp_path / "a.vtu")
    assert main(["skeleton", str(tmp_path / "a.json"), "-o", out]) == 3
    assert capsys.readouterr().err == "decomp: error: a\n"
    assert main(["skeleton", str(tmp_path / "a.json"), "-o", out, "--verbose"]) == 3
    assert capsys.readouterr().err.splitlines() == [
        "decomp: error: a",
        "  in tracing, region part, at hole.side and plate.zmax",
        "  tried: way of a: GeometryError: a",
        "  tried: way of b: GeometryError: b",
    ]
