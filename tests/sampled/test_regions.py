"""Of several regions only those that cannot be traced are sampled, and meshes take either."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import decomp
from decomp.checking.check import check
from decomp.cli.main import main
from decomp.errors import ContactError, GeometryError
from decomp.sampled import sampling
from decomp.skeletons import drafts
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.model import Method
from decomp.ways.surfaces import surfaces_by

FILE = """algebraic3d
solid box = orthobrick(0,0,0; 4,4,2);
solid rod = cylinder(2,2,-1; 2,2,3; 0.8) and box;
solid air = box and not rod;
tlo rod;
tlo air;
"""


def rod_in_air() -> dict[str, decomp.Solid]:
    box = decomp.Block((0, 0, 0), (4, 4, 2), name="box")
    rod = decomp.Cylinder((2, 2, 0), (2, 2, 2), 0.8, name="rod")
    return {"rod": rod, "air": box - rod}


@pytest.fixture
def refusing(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of regions that tracing refuses."""
    names: list[str] = []
    actual = drafts.region_curves

    def traced(context: RegionContext, samples: int) -> object:
        if context.boundary.name in names:
            raise GeometryError("a seam goes astray")
        return actual(context, samples)

    monkeypatch.setattr(drafts, "region_curves", traced)
    return names


@pytest.mark.parametrize("bad", ["rod", "air"])
def test_only_the_region_that_is_refused_is_sampled(refusing: list[str], bad: str) -> None:
    model = rod_in_air()
    traced = {region.name: region for region in decomp.skeleton(model).regions}
    refusing.append(bad)
    found = decomp.skeleton(model, method="auto")
    for region in found.regions:
        sampled = region.name == bad
        assert region.method is (Method.SAMPLED if sampled else Method.TRACED)
        assert region.cause == ("a seam goes astray" if sampled else None)
        other = traced[region.name]
        assert region.certificate.euler == other.certificate.euler
        for what in ("sheets", "seams", "cells", "reflexive"):
            assert len(getattr(region, what)) == len(getattr(other, what)), what
        volumes = {cell.name: cell.volume for cell in other.cells}
        assert {c.name: c.volume for c in region.cells} == pytest.approx(volumes, rel=2e-3)
    # one complex: the interface is the same triangles for both
    rod, air = ({p for s in r.face_sides for p, _ in s} for r in found.regions)
    assert len(rod & air) == 1


@pytest.mark.slow
@pytest.mark.parametrize("cells", ["skeleton", "face"])
def test_a_mesh_conforms_to_a_skeleton_of_both_ways(refusing: list[str], cells: str) -> None:
    model = rod_in_air()
    refusing.append("rod")
    made = decomp.mesh(model, size=0.8, cells=cells, method="auto")  # type: ignore[arg-type]
    assert [(each.region, each.method) for each in made.found_by] == [
        ("rod", "sampled"),
        ("air", "traced"),
    ]
    refusing.clear()
    assert not check(model, made, volume_error=1e-3).shortcomings
    again = check(model, made, volume_error=1e-3, surfaces=surfaces_by("sampled"))
    assert not again.shortcomings


@pytest.mark.slow
def test_a_sampled_mesh_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], refusing: list[str]
) -> None:
    model, out = tmp_path / "bar.geo", tmp_path / "bar.msh"
    model.write_text("algebraic3d\nsolid bar = orthobrick(0,0,0; 4,3,2);\ntlo bar;\n")
    refusing.append("bar")
    report = tmp_path / "bar.json"
    command = ["mesh", str(model), "-o", str(out), "--size", "1.5", "--report", str(report)]
    assert main([*command, "--method", "auto"]) == 0
    text = capsys.readouterr().out
    assert "    skeleton sampled: tracing failed, as a seam goes astray\n" in text
    (region,) = json.loads(report.read_text())["regions"]
    assert (region["method"], region["cause"]) == ("sampled", "a seam goes astray")
    assert main(["check", str(model), str(out)]) == 0
    assert main([*command, "--method", "traced"]) == 3
    assert "a seam goes astray" in capsys.readouterr().err


def test_cells_are_written_of_either_way(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], refusing: list[str]
) -> None:
    model = tmp_path / "two.geo"
    model.write_text(FILE)
    refusing.append("rod")
    assert main(["cells", str(model), "-o", str(tmp_path / "out"), "--method", "auto"]) == 0
    assert "method     sampled: tracing failed" in capsys.readouterr().out
    assert len(list((tmp_path / "out").glob("*.stl"))) == 10


def test_what_neither_way_gives_keeps_the_first_cause(
    refusing: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from decomp.skeletons.certificate import certificate

    refusing.append("solid")
    monkeypatch.setattr(certificate, "INTRUSION", -1.0)
    monkeypatch.setattr(sampling, "FLOORS", (12.0, 14.0))
    with pytest.raises(GeometryError, match=r"^a seam goes astray; sampled instead: ") as caught:
        decomp.skeleton(decomp.Block((0, 0, 0), (4, 3, 2)), method="auto")
    ways = [each.what for each in caught.value.tries]
    assert ways == [
        "traced",
        "sampled",
        "sampled: edges of 1/12 of the size",
        "sampled: edges of 1/14 of the size",
    ]
    assert caught.value.stage == "tracing"


def test_a_region_that_touches_itself_is_not_sampled() -> None:
    touching = decomp.Block((0, 0, 0), (1, 1, 1)) | decomp.Block((1, 1, 0), (2, 2, 1))
    with pytest.raises(ContactError):
        decomp.skeleton(touching, method="auto")
