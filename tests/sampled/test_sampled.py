"""Sampled skeletons are the traced ones; what cannot be had is refused, and nothing is silent."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import decomp
from decomp.cli.main import main
from decomp.complex.model import PatchKind
from decomp.errors import GeometryError, InputError
from decomp.sampled import sampling
from decomp.sampled.jumps import without_jump
from decomp.sampled.sampling import sampled_skeleton
from decomp.sites.site import SiteKind
from decomp.skeletons.model import Method, RegionSkeleton, Skeleton
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.ways import skeleton as ways
from tests.skeletons.computed import skeleton_of
from tests.solids import SOLIDS

AGREES = [
    "block",
    "bracket",
    pytest.param("fichera", marks=pytest.mark.slow),
]
"""Planar faces, reentrant edges and vertices, round faces and edges."""


def areas(skeleton: Skeleton, region: RegionSkeleton) -> dict[frozenset[str], float]:
    """The area of the sheets between each two sites."""
    found: Counter[frozenset[str]] = Counter()
    for sheet in region.sheets:
        found[frozenset(skeleton.sites[k].name for k in sheet.sites)] += sheet.area  # type: ignore[assignment]
    return dict(found)


def sampled(solid: decomp.Solid) -> Skeleton:
    """A sampled skeleton; TetWild is not repeatable, so one that is refused is tried once more."""
    try:
        return decomp.skeleton(solid, method="sampled")
    except GeometryError:
        return decomp.skeleton(solid, method="sampled")


@pytest.mark.parametrize("name", AGREES)
def test_a_sampled_skeleton_is_the_traced_one(name: str) -> None:
    traced = skeleton_of(name)
    found = sampled(SOLIDS[name].make())
    one, two = found.regions[0], traced.regions[0]
    assert (one.method, two.method) == (Method.SAMPLED, Method.TRACED)
    ours, theirs = areas(found, one), areas(traced, two)
    assert ours.keys() == theirs.keys()
    for pair, area in theirs.items():
        assert ours[pair] == pytest.approx(area, rel=1e-2), pair
    for what in ("sheets", "seams", "trims", "rims", "junctions", "cells", "face_cells"):
        assert len(getattr(one, what)) == len(getattr(two, what)), what
    volumes = {cell.name: cell.volume for cell in two.cells}
    assert {cell.name for cell in one.cells} == volumes.keys()
    for cell in one.cells:
        assert cell.volume == pytest.approx(volumes[cell.name], rel=5e-3)
    assert one.certificate.euler == SOLIDS[name].euler
    assert one.certificate.residual <= 1e-12
    assert one.certificate.chord_error <= 5e-4
    assert one.certificate.coverage <= 1e-3
    assert one.certificate.flipped == one.certificate.open_cells == 0


@pytest.mark.parametrize(
    "name",
    [
        "cylinder",
        "sphere",
        pytest.param("capsule", marks=pytest.mark.slow),
        pytest.param("slot", marks=pytest.mark.slow),
        pytest.param("round boss", marks=pytest.mark.slow),
    ],
)
def test_round_parts_have_their_axes_and_centres(name: str) -> None:
    """Reflexive loci are lines and points between the walls; smooth edges part cells, no more.

    Areas agree to the tolerance that the sampled skeleton states: a small sheet is known to that
    part of all sheets.
    """
    traced = skeleton_of(name)
    found = sampled(SOLIDS[name].make())
    one, two = found.regions[0], traced.regions[0]
    ours, theirs = areas(found, one), areas(traced, two)
    assert ours.keys() == theirs.keys()
    resolved = found.tolerance * sum(theirs.values())
    for pair, area in theirs.items():
        assert ours[pair] == pytest.approx(area, rel=1e-2, abs=resolved), pair
    for dimension in (0, 1):
        lengths = [
            [locus.length for locus in each.reflexive if locus.dimension == dimension]
            for each in (one, two)
        ]
        assert len(lengths[0]) == len(lengths[1]), dimension
        assert sum(lengths[0]) == pytest.approx(sum(lengths[1]), rel=1e-9)
    volumes = {cell.name: cell.volume for cell in two.face_cells}
    for cell in one.face_cells:
        assert cell.volume == pytest.approx(volumes[cell.name], rel=1e-2)
    assert one.certificate.euler == SOLIDS[name].euler
    assert one.certificate.residual <= 1e-12
    assert one.certificate.flipped == one.certificate.open_cells == 0


def test_the_axis_of_a_rod_is_exact_and_ends_in_its_cones() -> None:
    rod = decomp.Cylinder((0, 0, 0), (0, 0, 6), 1)
    found = sampled(rod)
    (axis,) = found.regions[0].reflexive
    assert axis.line is not None
    points = found.complex.points[found.complex.lines[axis.line].vertices]
    assert np.abs(points[:, :2]).max() <= 1e-12
    assert sorted(points[[0, -1], 2]) == pytest.approx([1, 5], abs=1e-12)
    ends = set(found.complex.lines[axis.line].vertices[[0, -1]].tolist())
    on_sheets = {
        vertex
        for sheet in found.regions[0].sheets
        for vertex in found.complex.patches[sheet.patch].triangles.reshape(-1).tolist()
    }
    assert ends <= on_sheets


def test_two_cones_with_one_tip_meet_in_it() -> None:
    """A rod as long as it is wide has no axis left, and its centre is the tip of both cones."""
    found = sampled(decomp.Cylinder((0, 0, 0), (0, 0, 2), 1))
    region = found.regions[0]
    assert (region.certificate.euler, len(region.sheets), region.reflexive) == (1, 2, ())
    one, two = (
        set(found.complex.patches[sheet.patch].triangles.reshape(-1).tolist())
        for sheet in region.sheets
    )
    (tip,) = one & two
    assert found.complex.points[tip] == pytest.approx([0, 0, 1], abs=1e-12)


@pytest.mark.parametrize("times, held", [(2.0, True), (20.0, False)])
def test_the_tolerance_that_is_reached_is_stated_or_the_skeleton_is_refused(
    monkeypatch: pytest.MonkeyPatch, times: float, held: bool
) -> None:
    """Sheets that cannot be refined keep the chords that they have."""
    from decomp.complex.refining.refine import refined as actual

    def coarse(given: object, tolerance: float, **_: object) -> object:
        return actual(given, times * tolerance, lenient=True)  # type: ignore[arg-type]

    monkeypatch.setattr(sampling, "refined", coarse)
    monkeypatch.setattr(sampling, "SAMPLED_FINENESSES", 1)
    monkeypatch.setattr(sampling, "FLOORS", (12.0,))
    rod = decomp.Geometry(decomp.Cylinder((0, 0, 0), (0, 0, 6), 1))
    if held:
        made = sampled_skeleton(rod, 5e-4, lambda what, done: None).skeleton
        stated = made.tolerance / made.diagonal
        assert 5e-4 < stated <= sampling.LOOSEST * 5e-4
        assert made.regions[0].certificate.chord_error <= stated
    else:
        with pytest.raises(GeometryError, match=r"is .*, allowed"):
            sampled_skeleton(rod, 5e-4, lambda what, done: None)


def test_junctions_of_a_block_are_where_they_must_be() -> None:
    found = decomp.skeleton(decomp.Block((0, 0, 0), (4, 3, 2)), method="sampled")
    inner = [j for j in found.regions[0].junctions if j.radius > 0]
    points = {tuple(np.round(found.complex.points[j.vertex], 12).tolist()) for j in inner}
    assert points == {(x, y, 1.0) for x in (1.0, 3.0) for y in (1.0, 2.0)}


def test_where_tracing_fails_it_is_sampled_and_the_cause_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*_: object) -> Skeleton:
        raise GeometryError("a seam goes astray at (1, 2, 3)")

    monkeypatch.setattr(ways, "traced_skeleton", fails)
    model, out = tmp_path / "block.geo", tmp_path / "block.json"
    model.write_text("algebraic3d\nsolid b = orthobrick(0,0,0; 4,3,2);\ntlo b;\n")
    assert main(["skeleton", str(model), "-o", str(out), "--method", "auto"]) == 0
    text = capsys.readouterr().out
    assert "  method     sampled: tracing failed, as a seam goes astray at (1, 2, 3)\n" in text
    region = json.loads(out.read_text())["regions"][0]
    assert (region["method"], region["cause"]) == ("sampled", "a seam goes astray at (1, 2, 3)")
    assert main(["skeleton", str(model), "--method", "traced"]) == 3
    assert "a seam goes astray" in capsys.readouterr().err


def test_what_neither_way_gives_is_refused_with_both_causes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from decomp.skeletons.certificate import certificate

    def fails(*_: object) -> Skeleton:
        raise GeometryError("a seam goes astray")

    monkeypatch.setattr(ways, "traced_skeleton", fails)
    monkeypatch.setattr(certificate, "INTRUSION", -1.0)
    monkeypatch.setattr(sampling, "FLOORS", (12.0,))
    block = decomp.Block((0, 0, 0), (4, 3, 2))
    with pytest.raises(GeometryError, match="goes astray; sampled instead: no sampled skeleton"):
        decomp.skeleton(block, method="auto")


def test_a_skeleton_that_fails_its_certificate_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from decomp.skeletons.certificate import certificate

    monkeypatch.setattr(certificate, "INTRUSION", -1.0)
    monkeypatch.setattr(sampling, "FLOORS", (12.0,))
    block = decomp.Geometry(decomp.Block((0, 0, 0), (4, 3, 2)))
    with pytest.raises(GeometryError, match="intrusion is 0, allowed -1"):
        sampled_skeleton(block, 5e-4, lambda what, done: None)


def test_a_wall_without_a_jump_is_no_sheet() -> None:
    """A trim surface of the bracket handed in as a sheet is found out."""
    made = decomp.skeleton(SOLIDS["bracket"].make(), method="sampled")
    region = made.regions[0]
    assert not without_jump(made.complex, made.radius, region, made.sites)
    trim = next(p for p in made.complex.patches if p.kind is PatchKind.TRIM)
    edge = next(k for k, site in enumerate(made.sites) if site.kind is SiteKind.EDGE)
    face = made.sites[edge].name.split("|")[0]
    pair = next(k for k, site in enumerate(made.sites) if site.name == face), edge
    surface = made.complex.patches[region.sheets[0].patch].surface
    assert isinstance(surface, SheetSurface)
    points = made.complex.points[np.unique(trim.triangles)]
    feet = surface.incidence.feet(pair, points)
    false = replace(trim, surface=SheetSurface(surface.incidence, pair, points, feet))
    mesh = replace(made.complex, patches=(*made.complex.patches, false))
    sheet = replace(region.sheets[0], sites=pair, patch=len(mesh.patches) - 1)
    wrong = replace(region, sheets=(*region.sheets, sheet))
    (line,) = without_jump(mesh, made.radius, wrong, made.sites)
    assert line.startswith(f"no jump across the sheet of {face} and ")


def test_the_files_of_a_sampled_skeleton_say_so(tmp_path: Path) -> None:
    from decomp.skeletons.files import write

    made = decomp.skeleton(decomp.Block((0, 0, 0), (4, 3, 2)), method="sampled")
    write(made, tmp_path / "block.vtu")
    write(made, tmp_path / "block.json")
    assert json.loads((tmp_path / "block.json").read_text())["regions"][0]["method"] == "sampled"
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.read(tmp_path / "block.vtu")
    assert np.asarray(grid.field_data["region_method"]).reshape(-1).tolist() == [1]


def test_there_are_three_methods() -> None:
    block = decomp.Block((0, 0, 0), (4, 3, 2))
    with pytest.raises(InputError, match=r"method must be one of .*'auto'.* got 'guessed'"):
        decomp.skeleton(block, method="guessed")  # type: ignore[arg-type]
