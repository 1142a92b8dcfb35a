"""What a mesh has, in figures that can be derived by hand."""

from __future__ import annotations

import json
from dataclasses import replace
from math import degrees, pi

import numpy as np
import pytest

from decomp.cli.stages import Stages
from decomp.csg.model import Ignored
from decomp.meshes.report import as_json, as_text, report
from decomp.view.report_page import encoded
from tests.meshes.shapes import bar, cube, quadratic


def test_a_bar() -> None:
    found = report(bar(), {"left": 1.0, "right": 1.25}, [("tracing", 1.5), ("TetWild", 2.5)])
    assert (found.order, found.nodes, found.tets) == (1, 9 * 5 * 5, 8 * 4 * 4 * 6)
    assert [(r.name, r.tets) for r in found.regions] == [("left", 384), ("right", 384)]
    assert [r.volume for r in found.regions] == pytest.approx([1.0, 1.0])
    assert [r.error for r in found.regions] == pytest.approx([0.0, -0.2])
    assert [c.volume for c in found.cells] == pytest.approx([0.5, 0.5, 1.0])
    assert [c.tets for c in found.cells] == [192, 192, 384]
    assert [s.triangles for s in found.surfaces] == [32, 128, 128, 32, 32, 32]
    assert [s.bc for s in found.surfaces] == [7, None, None, None, None, None]
    # of the tetrahedra on a path from corner to corner of a cube
    angles = [pi / 4, pi / 4, pi / 3, pi / 2, pi / 2, pi / 2]
    assert found.quality.least_dihedral == pytest.approx(45)
    assert found.quality.mean_least_dihedral == pytest.approx(45)
    assert found.quality.greatest_dihedral == pytest.approx(90)
    assert found.quality.mean_dihedral == pytest.approx(degrees(np.mean(angles)))
    assert found.quality.inverted == 0
    values = json.loads(json.dumps(as_json(found)))
    assert values["seconds"] == 4.0
    assert values["stages"][1] == {"stage": "TetWild", "seconds": 2.5}
    assert values["tets_per_cell"] == {"least": 192, "median": 192.0, "greatest": 384}
    assert values["cells"][1]["faces"] == ["left.back", "a", "b", "c"]
    assert values["regions"][1]["error"] == pytest.approx(-0.2)


def test_as_text() -> None:
    text = as_text(report(bar(), {"left": 1.0, "right": 1.0}, [("TetWild", 2.5)]))
    assert text[0] == ("model bar: 768 tetrahedra of order 1, 225 nodes, 384 tagged triangles")
    assert "region left: 384 tetrahedra in 2 cells, volume 1 (exact 1, off by " in text[1]
    # of 4^3 boxes: 300 of their edges, 240 diagonals of their sides, 64 of their own
    mean = (300 + 240 * 2**0.5 + 64 * 3**0.5) / 4 / (300 + 240 + 64)
    assert text[2] == f"    edges: mean {mean:.4g}, longest {3**0.5 / 4:.4g}"
    assert "  tetrahedra per cell: 192 to 384, median 192" in text[5]
    assert text[6] == "  groups: 3 cells, 4 faces, 1 interface, 1 sheet"
    assert text[7].startswith("  all edges: mean 0.31")
    assert "  cell left/cell-1: left.back, a, b, c" in text
    assert text[-1] == "  2.5 s: TetWild 2.5"


def test_ignored_statements_are_told_of() -> None:
    found = report(bar(), ignored=[Ignored("point (1,1,1)", 4)])
    assert as_text(found)[-1] == "  ignored: line 4: point (1,1,1)"
    assert list(as_json(found)["ignored"]) == [{"statement": "point (1,1,1)", "line": 4}]
    page = encoded(bar(), found).decode()
    assert "<summary>Ignored statements (" in page
    assert "<td>4</td><td>point (1,1,1)</td>" in page
    assert "Ignored" not in encoded(bar(), report(bar())).decode()


def test_lengths_of_edges() -> None:
    mesh = cube()
    # from the middle to eight corners, twelve edges, a diagonal on each of six sides
    lengths = [0.75**0.5] * 8 + [1.0] * 12 + [2**0.5] * 6
    given = [
        replace(g, length=1.25) if g.dimension == 3 else replace(g, maxh=0.5, length=0.5)
        for g in mesh.groups
    ]
    mesh = replace(mesh, groups=tuple(given), lengths=np.full(len(mesh.points), 0.8))
    found = report(mesh)
    edges = found.regions[0].edges
    assert edges is not None
    assert edges.number == 26
    assert edges.mean == pytest.approx(np.mean(lengths))
    assert (edges.longest, edges.asked) == (pytest.approx(2**0.5), 1.25)
    assert edges.wanted == pytest.approx(0.8)
    side = found.surfaces[0].edges
    assert side is not None and side.number == 5
    assert side.mean == pytest.approx((4 + 2**0.5) / 5)
    assert (side.asked, side.wanted) == (0.5, pytest.approx(0.5))
    values = as_json(found)
    assert values["surfaces"][0]["maxh"] == 0.5
    assert values["regions"][0]["edges"]["longest"] == pytest.approx(2**0.5)
    text = "\n".join(as_text(found))
    assert "(asked 1.25, 0.8 in the mean with curvature and thin places)" in text
    assert "longest 1.414 (asked 0.5)" in text


def test_curved_volumes() -> None:
    found = report(quadratic(bar(), bend=0.3))
    assert sum(region.volume for region in found.regions) == pytest.approx(2.0, rel=1e-12)
    assert found.regions[0].exact is None
    assert report(cube()).quality.inverted == 0


def test_corners_on_the_boundary() -> None:
    """All but those that touch one of the two nodes inside."""
    assert report(cube()).bridging == 0
    mesh = bar(1)
    middle = np.flatnonzero((np.abs(mesh.points[:, 1:] - 0.5) < 1e-9).all(axis=1))
    inside = middle[(mesh.points[middle, 0] % 1) != 0]
    touching = np.isin(mesh.tets, inside).any(axis=1).sum()
    assert report(mesh).bridging == len(mesh.tets) - touching


def test_stages(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 1.0, 3.0, 4.0, 10.0, 10.5])
    monkeypatch.setattr("decomp.cli.stages.time.perf_counter", lambda: next(clock))
    told = []
    stages = Stages(lambda what, done: told.append((what, done)))
    for what, done in (("reading", 0), ("tracing a", 0.1), ("tracing b", 0.2), ("TetWild", 0.5)):
        stages(what, done)
    assert stages.spent() == (("reading", 2.0), ("tracing", 1.0), ("TetWild", 6.0))
    assert len(told) == 4
