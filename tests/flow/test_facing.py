"""The mid-surface against closed forms, and its files.

A block with two parallel holes has a plane sheet between them. From (0, y) on it the holes' axes
at x = +-1.5 are seen at the angle 2 atan(1.5 / |y|), which is 120 degrees at |y| = 1.5 / tan 60.
"""

from __future__ import annotations

from functools import cache
from math import radians, sqrt, tan
from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh
from scipy.integrate import quad

import decomp
from decomp.cli.main import main
from decomp.errors import InputError
from tests.skeleton_fixtures import block
from tests.skeletons.computed import skeleton_of, source_of

HALF, RADIUS, DEPTH = 1.5, 0.5, 6.0


@cache
def drilled() -> tuple[decomp.Geometry, decomp.Skeleton]:
    hole = decomp.Cylinder((-HALF, 0, -1), (-HALF, 0, DEPTH + 1), RADIUS, name="left")
    other = decomp.Cylinder((HALF, 0, -1), (HALF, 0, DEPTH + 1), RADIUS, name="right")
    geometry = decomp.Geometry(decomp.Block((-4, -3, 0), (8, 6, DEPTH), name="b") - hole - other)
    return geometry, decomp.skeleton(geometry)


def between_holes(surface: decomp.MidSurface, skeleton: decomp.Skeleton) -> np.ndarray:
    named = [{skeleton.sites[k].name for k in row} for row in surface.sites]
    return np.array([names == {"left.side", "right.side"} for names in named])


@pytest.mark.parametrize("angle", [100.0, 120.0, 160.0])
def test_the_cut_is_the_exact_curve(angle: float) -> None:
    geometry, skeleton = drilled()
    surface = decomp.mid_surface(skeleton, angle)
    own = surface.triangles[between_holes(surface, skeleton)]
    points = surface.points[np.unique(own)]
    reach = HALF / tan(radians(angle / 2))
    assert np.abs(points[:, 0]).max() < 1e-12
    assert np.abs(points[:, 1]).max() == pytest.approx(reach, abs=1e-9)
    # the sheet ends where the block's top and bottom are as near as the holes
    exact = quad(lambda y: DEPTH - 2 * (sqrt(HALF**2 + y**2) - RADIUS), -reach, reach)[0]
    a, b, c = np.moveaxis(surface.points[own], 1, 0)
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
    assert area == pytest.approx(exact, rel=2e-3)
    assert surface.angle.min() >= angle - 1e-6
    assert surface.thickness == pytest.approx(-2 * geometry.distance(surface.points), abs=1e-9)


def test_thickness_is_linear_within_the_tolerance() -> None:
    geometry, skeleton = drilled()
    surface = decomp.mid_surface(skeleton, 60.0)
    middle = surface.points[surface.triangles].mean(axis=1)
    linear = surface.thickness[surface.triangles].mean(axis=1)
    assert np.abs(linear + 2 * geometry.distance(middle)).max() < 6 * skeleton.tolerance


def test_sheets_stay_joined() -> None:
    """Every edge of one triangle alone is free: no point of another triangle lies on it."""
    surface = decomp.mid_surface(drilled()[1], 110.0)
    sides = np.sort(surface.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    a, b = surface.points[edges[count == 1]].transpose(1, 0, 2)
    way = b - a
    for point in surface.points:
        along = np.clip(((point - a) * way).sum(axis=1) / (way**2).sum(axis=1), 0, 1)
        gap = np.linalg.norm(a + along[:, None] * way - point, axis=1)
        assert not ((gap < 1e-9) & (along > 1e-6) & (along < 1 - 1e-6)).any()


def test_a_threshold_that_all_sheets_exceed_keeps_the_skeleton() -> None:
    _, skeleton = drilled()
    whole = sum(sheet.area for sheet in skeleton.regions[0].sheets)
    assert decomp.mid_surface(skeleton, 0.0).area == pytest.approx(whole, rel=1e-3)


def test_mitres_go_at_their_own_angle() -> None:
    """All but the middle sheet of a plate see their walls at 90 degrees exactly: not more."""
    plate = decomp.skeleton(decomp.Block((0, 0, 0), (4, 3, 0.2)))
    middle = decomp.mid_surface(plate, 90.0)
    assert middle.area == pytest.approx(3.8 * 2.8, rel=1e-12)
    assert middle.thickness == pytest.approx(0.2)
    assert len(set(decomp.mid_surface(plate, 89.9).sheet.tolist())) == 13


@pytest.mark.parametrize("angle", [-1.0, 180.0, float("nan")])
def test_angles_that_cannot_be(angle: float) -> None:
    with pytest.raises(InputError, match=r"from 0 to less than 180|must be finite"):
        decomp.mid_surface(block().skeleton, angle)


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = tmp_path / "plate.geo"
    model.write_text("algebraic3d\nsolid p = orthobrick (0,0,0; 4,3,0.2);\ntlo p;\n")
    files = [tmp_path / f"mid{suffix}" for suffix in (".vtu", ".ply", ".obj", ".stl")]
    words = [word for path in files for word in ("-o", str(path))]
    assert main(["skeleton", str(model), "--facing", "120", *words]) == 0
    text = capsys.readouterr().out
    assert "  sheets           1  area 10.64\n" in text
    assert "  thickness           0.2 to 0.2\n" in text
    grid = meshio.read(files[0])
    assert grid.point_data["thickness"] == pytest.approx(0.2)
    assert grid.point_data["radius"] == pytest.approx(0.1)
    assert grid.cell_data["facing"][0] == pytest.approx(180.0)
    raw = trimesh.load(files[1], process=False).metadata["_ply_raw"]
    assert raw["vertex"]["data"]["thickness"] == pytest.approx(0.2)
    for path in files[1:]:
        assert trimesh.load(path).area == pytest.approx(10.64, rel=1e-6)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--facing", "180"], "must be from 0 to less than 180"),
        (["--facing", "120", "--boundary"], "leave --boundary away"),
        (["--facing", "120", "-o", "x.json"], "'.json' is unknown as a suffix for mid-surfaces"),
    ],
)
def test_what_cannot_be(
    words: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = tmp_path / "p.geo"
    model.write_text("algebraic3d\nsolid p = orthobrick (0,0,0; 1,1,1);\ntlo p;\n")
    try:
        code = main(["skeleton", str(model), *words])
    except SystemExit as end:
        code = int(str(end.code))
    assert code == 2
    assert message in capsys.readouterr().err


def test_where_no_walls_face_each_other(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = tmp_path / "cube.geo"
    model.write_text("algebraic3d\nsolid p = orthobrick (0,0,0; 1,1,1);\ntlo p;\n")
    assert main(["skeleton", str(model), "--facing", "120"]) == 0
    assert "empty; no walls face each other so much" in capsys.readouterr().out


def test_sheets_of_an_edge_with_itself() -> None:
    """Where equal pipes cross; over an edge's turning points the nearest feet lie beside it."""
    skeleton = skeleton_of("equal tee")
    surface = decomp.mid_surface(skeleton, 105.0)
    assert (surface.sites[:, 0] == surface.sites[:, 1]).any()
    distance = decomp.Geometry(source_of("equal tee")).distance(surface.points)
    assert surface.thickness == pytest.approx(-2 * distance, abs=1e-9)
