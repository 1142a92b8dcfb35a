"""Elliptic cylinders from file to mesh: every command makes them, or says what does."""

from __future__ import annotations

import json
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest

import decomp
from decomp.cli.main import main
from decomp.errors import InputError
from decomp.voronoi import site_of

PLATE = """algebraic3d
solid bore = ellipticcylinder (15, 15, 0; 6, 3, 0; -1.5, 3, 0);
solid slab = orthobrick (0, 0, 0; 40, 30, 5);
solid plate = slab and not bore;
tlo plate;
"""
VOLUME = 6000 - 5 * pi * sqrt(45 * 11.25)


@pytest.fixture
def plate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = Path("plate.geo")
    path.write_text(PLATE)
    return path


def test_info(plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(plate), "--json"]) == 0
    (region,) = json.loads(capsys.readouterr().out)["regions"]
    assert region["volume"] == pytest.approx(VOLUME, rel=1e-13)
    assert [f["carrier"] for f in region["faces"] if f["name"] == "bore.side"] == [
        "elliptic cylinder"
    ]
    assert main(["info", str(plate)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "    slab.xmin  plane              area 150" in lines
    assert any(line.startswith("    bore.side  elliptic cylinder  area 162.48") for line in lines)


def test_converted_it_is_the_same(plate: Path) -> None:
    assert main(["convert", str(plate), "same.json"]) == 0
    one, two = decomp.Geometry("plate.geo"), decomp.Geometry("same.json")
    assert one.regions[0].volume == two.regions[0].volume


@pytest.mark.parametrize("command", ["skeleton", "describe", "cells", "mesh"])
def test_what_is_not_traced_says_what_to_do(
    plate: Path, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    outputs = {"skeleton": ["-o", "o.vtu"], "cells": ["-o", "."], "mesh": ["-o", "o.msh"]}
    assert main([command, str(plate), *outputs.get(command, [])]) == 3
    said = capsys.readouterr().err
    assert said.startswith(
        "decomp: error: region 'plate': bore.side is on an elliptic cylinder, of which no skeleton "
        "is traced: '--method sampled' looks for it by sampling"
    )
    assert ("'--cells none' makes a mesh without cells" in said) == (command == "mesh")
    assert said.count("\n") == 1
    assert not list(Path().glob("o.*"))


def test_the_algebra_refuses_it() -> None:
    post = decomp.EllipticCylinder((0, 0, 0), (0, 0, 1), (2, 0, 0), 1)
    (carrier,) = (c for c in decomp.Geometry(post).regions[0].carriers if not c.traceable)
    with pytest.raises(InputError, match=r"elliptic cylinder: .*--method sampled.*--cells none"):
        site_of(carrier)


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2])
def test_a_mesh_without_cells(plate: Path, order: int) -> None:
    geometry = decomp.Geometry(str(plate))
    mesh = decomp.mesh(geometry, cells="none", order=order)
    mesh.write("plate.msh")
    found = decomp.check(geometry, "plate.msh")
    assert found.shortcomings == ()
    assert found.stray == 0
    # straight edges cut corners of the bore, so that the plate is a little too large
    assert found.volume_error < (2e-3 if order == 1 else 2e-5)
    side = mesh.triangles[mesh.triangle_tags == mesh.group("plate/bore.side").tag]
    nodes = mesh.points[np.unique(side)] - [15, 15, 0]
    u, v = nodes @ [6, 3, 0] / 45, nodes @ [-1.5, 3, 0] / 11.25
    assert u**2 + v**2 == pytest.approx(1, abs=1e-13)


@pytest.mark.slow
def test_a_sampled_skeleton(plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["skeleton", str(plate), "--method", "auto", "-o", "o.vtu"]) == 0
    said = "sampled: tracing failed, as region 'plate': bore.side is on an elliptic cylinder"
    assert said in capsys.readouterr().out
    assert main(["describe", str(plate), "--method", "sampled", "--json"]) == 0
    (region,) = json.loads(capsys.readouterr().out)["regions"]
    assert region["method"] == "sampled"
    beside = [s for s in region["sheets"] if any("bore.side" in site for site in s["sites"])]
    assert [s["kind"] for s in beside] == ["general algebraic surface"] * 2
    assert len(region["sheets"]) == 15


@pytest.mark.slow
def test_inside_a_long_one_the_certificate_misses_its_axis_sheet() -> None:
    post = decomp.EllipticCylinder((0, 0, 0), (0, 0, 5), (3, 0, 0), 2, name="post")
    with pytest.raises(decomp.GeometryError, match="coverage"):
        decomp.skeleton(post, method="sampled")
