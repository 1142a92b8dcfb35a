"""What the sheets of skeletons lie on: figures 1, 2 and 4 of the paper, and other solids."""

from __future__ import annotations

import json
import time
from collections import Counter
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

import decomp
from decomp.cli.main import main
from decomp.skeletons.sheet_kinds import sheet_kinds
from decomp.voronoi import Kind
from tests.skeletons.computed import skeleton_of
from tests.skeletons.on_equations import off_equations
from tests.solids import SOLIDS

MESHES = Path(__file__).parents[2] / "meshes"

MODELS = [
    "block",
    "through hole",
    "blind hole",
    "bracket",
    "countersink",
    "conical pit",
    "round boss",
    "unequal tee",
    "lens",
    "eccentric hole",
    "capsule",
]


@pytest.mark.parametrize("model", MODELS)
def test_vertices_lie_on_the_equations(model: str) -> None:
    """To 1e-10 of the diagonal; those of all models: see the tests of certificates."""
    skeleton = skeleton_of(model)
    assert off_equations(skeleton) <= 1e-10
    for region in skeleton.regions:
        for sheet, kind in zip(region.sheets, sheet_kinds(skeleton, region), strict=True):
            used = np.unique(skeleton.complex.patches[sheet.patch].triangles)
            p = skeleton.complex.points[used]
            pieces = [kind, *kind.also]
            if kind.surface is not None:
                surfaces = [piece.surface for piece in pieces]
                gaps = [np.abs(each.difference(p)) for each in surfaces if each is not None]
                assert np.min(gaps, axis=0).max() <= 1e-10 * skeleton.diagonal
                assert sheet.parity is None or kind.parity.value == sheet.parity.value
            polynomial = kind.polynomial
            assert polynomial is not None
            if kind.also:
                continue
            slope = np.linalg.norm(polynomial.gradient(p), axis=1)
            clear = slope > 1e-6 * slope.max()
            assert (np.abs(polynomial(p)) / np.where(clear, slope, np.inf)).max() <= (
                1e-9 * skeleton.diagonal
            )


def named(file: str) -> dict[str, Kind]:
    """The kinds of a model's sheets by the last parts of their sites' names."""
    skeleton = decomp.skeleton(MESHES / file)
    (region,) = skeleton.regions
    found = {}
    for kind in sheet_kinds(skeleton, region):
        edges = [site.name.split("|") for site in kind.sites]
        words = ["|".join(part.split(".", 1)[1] for part in edge) for edge in edges]
        found[" / ".join(sorted(words))] = kind.kind
    return found


def test_figure_1_block() -> None:
    """13 planes."""
    assert list(named("block.geo").values()) == [Kind.PLANE] * 13


def test_figures_2_and_4_blind_hole() -> None:
    """Under the hole a plane, around it a parabolic torus, beside it a cone."""
    found = named("blind_hole.geo")
    under = {pair: kind for pair, kind in found.items() if "zmin" in pair and "x" not in pair}
    assert Kind.PLANE in under.values()
    kinds = Counter(found.values())
    assert kinds[Kind.REVOLVED_PARABOLA] == 1
    assert kinds[Kind.CIRCULAR_CONE] == 1
    assert kinds[Kind.PARABOLIC_CYLINDER] == 4
    (torus,) = [pair for pair, kind in found.items() if kind is Kind.REVOLVED_PARABOLA]
    assert "|" in torus and "zmin" in torus
    (cone,) = [pair for pair, kind in found.items() if kind is Kind.CIRCULAR_CONE]
    assert "zmax" in cone and "|" not in cone


def test_sheet_about_an_apex() -> None:
    """Under a conical pit cones go over to paraboloids about the apex."""
    skeleton = skeleton_of("conical pit")
    (region,) = skeleton.regions
    pairs = [
        (kind.kind, *(other.kind for other in kind.also)) for kind in sheet_kinds(skeleton, region)
    ]
    assert any(Kind.PARABOLOID in pair for pair in pairs)


def test_naming_costs_little() -> None:
    """Less than a tenth of a skeleton's time, equations included."""
    skeleton_of("blind hole")
    start = time.process_time()
    skeleton = decomp.skeleton(SOLIDS["blind hole"].make())
    middle = time.process_time()
    for region in skeleton.regions:
        for kind in sheet_kinds(skeleton, region):
            assert kind.equation()
    assert time.process_time() - middle <= 0.1 * (middle - start)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "bar.geo"
    path.write_text("algebraic3d\nsolid bar = orthobrick (0, 0, 0; 4, 1, 1);\ntlo bar;\n")
    return path


def test_describe(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", str(model), "--quiet"]) == 0
    out = capsys.readouterr().out
    assert "y - z = 0" in out
    assert "plane, degree 1" in out
    assert "even" in out
    assert main(["describe", str(model), "--json", "--quiet"]) == 0
    (region,) = json.loads(capsys.readouterr().out)["regions"]
    assert len(region["sheets"]) == 12
    for row in region["sheets"]:
        assert (row["kind"], row["degree"]) == ("plane", 1)
        assert row["equation"].endswith("= 0")
        assert len(row["axes"]) == 3
        # the frame's z axis is the plane's normal, its origin on the plane
        assert np.linalg.norm(row["axes"][2]) == pytest.approx(1)
    assert main(["describe", str(model), "--digits", "0", "--quiet"]) == 2


def test_describe_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", str(tmp_path / "missing.geo")]) != 0
    assert "error" in capsys.readouterr().err


def test_sheets_on_one_plane_of_a_pair() -> None:
    """Crossing holes of equal radius: their surface is a pair of planes, each sheet on one."""
    skeleton = skeleton_of("equally cross-drilled block")
    (region,) = skeleton.regions
    found = [kind for kind in sheet_kinds(skeleton, region) if kind.part_of is not None]
    assert len(found) == 4
    for kind in found:
        assert (kind.kind, kind.degree) == (Kind.PLANE, 1)
        assert kind.part_of is not None and kind.part_of.kind is Kind.PLANE_PAIR
        assert kind.equation() in ("x - z = 0", "x + z = 0")


def test_vtu_holds_equations_by_sheet(tmp_path: Path) -> None:
    """The same as the JSON form, for readers of VTK's files and for meshio."""
    from decomp.skeletons.files import as_json, vtu
    from decomp.skeletons.files.elements import elements

    skeleton = skeleton_of("blind hole")
    path = tmp_path / "out.vtu"
    path.write_bytes(vtu.encoded(elements(skeleton)))
    told = [sheet["surface"] for sheet in as_json.contents(skeleton)["regions"][0]["sheets"]]
    grid = pyvista.read(path)
    rows = json.loads(bytes(grid.field_data["sheets"]))
    assert [{k: v for k, v in row.items() if k != "name"} for row in rows] == told
    assert [row["name"] for row in rows] == [f"solid/sheet-{k}" for k in range(len(told))]
    field = grid.GetFieldData()

    def columns(name: str) -> list[str]:
        array = field.GetAbstractArray(name)
        return [array.GetComponentName(k) for k in range(array.GetNumberOfComponents())]

    kinds, powers = columns("surface_counts"), columns("sheet_equation")
    assert (powers[0], powers[-2:]) == ("x^4", ["z", "1"])
    p = grid.points[grid.cells_dict[5]].mean(axis=1)
    for k, row in enumerate(told):
        assert kinds[grid.field_data["sheet_surface"][k]] == row["kind"]
        assert grid.field_data["sheet_degree"][k] == row["degree"]
        if row["degree"] == 1:
            coefficients = grid.field_data["sheet_equation"][k][-4:]
            own = p[grid.cell_data["sheet"][grid.celltypes == 5] == k]
            assert np.abs(own @ coefficients[:3] + coefficients[3]).max() <= 1e-12
    assert "sheet_equation" in meshio.read(path).field_data
