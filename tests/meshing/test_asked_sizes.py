"""Lengths asked for by name, at places and by a function; what decided is told."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import decomp
from decomp.cli.main import main
from decomp.errors import InputError, UnknownNameError
from decomp.meshes.report import as_text, report
from decomp.meshing.sizing.named_sizes import checked_sizes, sized
from decomp.meshing.sizing.size_places import field_of, places_of
from decomp.meshing.sizing.wishes import SLOPE, Reason, joined, shorter
from decomp.vectors import Array

LOW = decomp.Block((0, 0, 0), (4, 4, 1), name="low")
HIGH = decomp.Block((0, 0, 1), (4, 4, 1), name="high")
TWO = {"base": LOW, "cover": HIGH}


def lengths_of(mesh: decomp.TetMesh, inside: Array) -> Array:
    """Edges of the tetrahedra whose middles are inside."""
    own = mesh.tets[inside]
    ends = own[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2)
    ends = np.unique(np.sort(ends, axis=1), axis=0)
    return np.asarray(np.linalg.norm(mesh.points[ends[:, 0]] - mesh.points[ends[:, 1]], axis=1))


def middles(mesh: decomp.TetMesh) -> Array:
    return np.asarray(mesh.points[mesh.tets].mean(axis=1))


def test_regions_and_faces_by_pattern() -> None:
    sizes = {"*": 0.9, "cover": 0.6, "base/*.zmin": 0.25}
    mesh = decomp.mesh(TWO, sizes=sizes, cells="none")
    found = {each.name: each for each in report(mesh).regions}
    assert found["base"].maxh == 0.9
    assert found["cover"].maxh == 0.6
    assert found["base"].edges is not None
    assert found["base"].edges.longest <= 1.5 * 0.9
    face = mesh.triangles[mesh.triangle_tags == mesh.group("base/low.zmin").tag]
    sides = mesh.points[face[:, [0, 1, 2]]] - mesh.points[face[:, [1, 2, 0]]]
    assert np.linalg.norm(sides, axis=2).max() <= 1.5 * 0.25
    assert "size of base/low.zmin" in [each.what for each in found["base"].deciders]


def test_a_region_goes_before_size_and_file() -> None:
    given = decomp.Geometry(decomp.model([decomp.Region("base", LOW, {"maxh": 0.3})]))
    geometry, of_regions = sized(given, {"ba*": 1.5})
    assert of_regions == {"base": 1.5}
    assert geometry.model.regions[0].options["maxh"] == 1.5
    assert given.model.regions[0].options["maxh"] == 0.3


@pytest.mark.parametrize(
    ("pattern", "said"),
    [
        ("bases", "'bases' of sizes stands for no region; did you mean 'base'?"),
        ("base/lwo.zmin", "stands for no face; did you mean 'base/low.zmin'"),
    ],
)
def test_patterns_that_stand_for_nothing(pattern: str, said: str) -> None:
    with pytest.raises(UnknownNameError) as error:
        decomp.mesh(TWO, sizes={pattern: 1})
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"sizes": 3}, "sizes must be lengths by pattern"),
        ({"sizes": {"base": -1}}, "size of 'base' must be"),
        ({"sizes": {3: 1}}, "sizes must have patterns as keys"),
        ({"sizes": {"*": 100}}, "size 100 is an edge's length"),
        ({"size_at": 3}, "size_at must be a list"),
        ({"size_at": [((0, 0, 0), 1, 2, 3)]}, "entry 1 of size_at must be"),
        ({"size_at": [((0, 0, 0), 1), ((0, 0), 1)]}, "entry 2 of size_at"),
        ({"size_at": [((0, 0, 0), -1, 1)]}, "radius of entry 1 of size_at"),
        ({"size_field": 3}, "size_field must be a function"),
        ({"size_field": lambda points: points}, "an array of shape"),
        (
            {"size_field": lambda points: np.zeros(len(points))},
            "size_field must be above 0, but is",
        ),
    ],
)
def test_bad_options(options: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        decomp.mesh(LOW, cells="none", **options)  # type: ignore[arg-type]


def test_lengths_beside_places() -> None:
    point, ball, box = places_of(
        [((0, 0, 0), 0.5), ((1, 0, 0), 2, 0.5), ((1, 1, 1), (0, 0, 0), 0.5)]
    )
    nowhere = np.zeros(3)
    at = np.array([[0.0, 0, 0], [0, 3, 0], [4, 0, 0], [2, 2, 1]])
    assert point.lengths(at, nowhere) == pytest.approx(
        [0.5, 0.5 + 3 * SLOPE, 0.5 + 4 * SLOPE, 1.55]
    )
    assert ball.lengths(at, nowhere)[:1] == pytest.approx([0.5])
    assert ball.lengths(at, nowhere)[2] == pytest.approx(0.5 + SLOPE)
    assert box.lengths(at, nowhere)[[0, 3]] == pytest.approx([0.5, 0.5 + SLOPE * np.sqrt(2)])
    # places are the user's, points are counted from the offset
    assert ball.lengths(at - [1e6, 0, 0], np.array([1e6, 0, 0])) == pytest.approx(
        ball.lengths(at, nowhere)
    )


def test_a_ball_of_short_edges() -> None:
    mesh = decomp.mesh(LOW, size=1, size_at=[((1, 1, 0.5), 0.5, 0.15)], cells="none")
    near = np.linalg.norm(middles(mesh) - [1, 1, 0.5], axis=1)
    assert 0.6 * 0.15 < lengths_of(mesh, near < 0.5).mean() < 1.15 * 0.15
    assert lengths_of(mesh, near < 0.4).max() <= 1.5 * 0.15
    assert lengths_of(mesh, near > 2.5).mean() > 2.5 * 0.15
    (found,) = report(mesh).regions
    assert found.deciders[0].what == "the ball about (1, 1, 0.5)"


def test_a_function_of_the_place() -> None:
    def wanted(points: Array) -> Array:
        return np.asarray(0.1 + 0.3 * points[:, 0])

    mesh = decomp.mesh(LOW, size=2, size_field=wanted, cells="none")
    x = middles(mesh)[:, 0]
    for low, high in ((0, 1), (1, 2), (2, 3)):
        own = (x > low) & (x < high)
        assert 0.6 < lengths_of(mesh, own).mean() / wanted(middles(mesh)[own]).mean() < 1.2
    assert any("size_field decides" in line for line in as_text(report(mesh)))


def test_longer_lengths_than_all_over_ask_for_nothing() -> None:
    plain = decomp.mesh(LOW, size=0.8, cells="none")
    places, nowhere = [((2, 2, 0.5), 50.0)], lambda points: np.full(len(points), np.inf)
    asked = decomp.mesh(LOW, size=0.8, size_at=places, size_field=nowhere, cells="none")
    assert 0.6 < len(asked.tets) / len(plain.tets) < 1.6
    assert [each.what for each in report(asked).regions[0].deciders] == []


def test_lengths_between_points_are_linear() -> None:
    random = np.random.default_rng(3)
    points = np.concatenate([random.uniform(size=(40, 3)), np.indices((2, 2, 2)).reshape(3, -1).T])
    found = field_of((points, 1 + points @ [1, 2, 3]))
    assert found is not None
    asked = random.uniform(size=(200, 3))
    assert found(asked) == pytest.approx(1 + asked @ [1, 2, 3], rel=1e-12)
    assert found(np.array([[9.0, 9, 9]])) == pytest.approx([7.0])
    flat = field_of((points * [1, 1, 0], np.full(len(points), 0.5)))
    assert flat is not None
    assert flat(asked) == pytest.approx(np.full(200, 0.5))


def test_far_from_the_origin() -> None:
    away = np.array([1e6, -1e6, 0])
    part = LOW.translate(away)
    mesh = decomp.mesh(part, size=1, size_at=[((1e6 + 1, 1 - 1e6, 0.5), 0.2)], cells="none")
    (found,) = report(mesh).regions
    assert "the point (1000001, -999999, 0.5)" in [each.what for each in found.deciders]


def test_the_least_of_two_and_its_reason() -> None:
    here, there = np.zeros((1, 3)), np.array([[10.0, 0, 0]])
    one = joined([(here, np.array([1.0]), Reason("one")), (there, np.array([2.0]), Reason("two"))])
    other = joined([(here, np.array([2.0]), Reason("two"))])
    lengths, which, reasons = shorter(one, other, np.array([[0.0, 0, 0], [10, 0, 0], [1, 0, 0]]))
    assert lengths == pytest.approx([1, 2, 1 + SLOPE], rel=0.25)
    assert [reasons[k].what for k in which] == ["one", "two", "one"]


def test_no_plane_face_is_said_to_be_bent() -> None:
    bored = LOW - decomp.Cylinder((2, 2, -1), (2, 2, 2), 0.5, name="bore")
    mesh = decomp.mesh(bored, size=0.8, elements_per_circle=24, cells="none")
    (found,) = report(mesh).regions
    assert [each.what for each in found.deciders] == ["curvature of solid/bore.side"]


def test_checked_sizes() -> None:
    assert checked_sizes(None) == {}
    assert checked_sizes({"a": 1}) == {"a": 1.0}


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "part.json", tmp_path / "part.json.report.json"
    decomp.save(decomp.model(TWO, "part"), path)
    words = ["mesh", str(path), "--cells", "none", "-o", str(tmp_path / "part.msh")]
    asked = ["--maxh", "base=1", "--maxh", "*/*.zmax=0.3", "--size-at", "4,4,2,0.5=0.1"]
    assert main([*words, *asked, "--report", str(out)]) == 0
    assert "the ball about (4, 4, 2) decides at" in capsys.readouterr().out
    base, cover = json.loads(out.read_text())["regions"]
    assert base["maxh"] == 1
    assert {"what", "share", "length"} == set(cover["deciders"][0])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--maxh", "3"], "must be PATTERN=H"),
        (["--maxh", "a=x"], "'x' is no number"),
        (["--size-at", "1,2=3"], "must be X,Y,Z=H"),
        (["--outside-size", "3"], "--outside-size needs --outside"),
    ],
)
def test_wrong_commands(
    words: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "part.json"
    decomp.save(decomp.model(LOW, "part"), path)
    try:
        code = main(["mesh", str(path), *words])
    except SystemExit as end:
        code = end.code
    assert code == 2
    assert said in capsys.readouterr().err
