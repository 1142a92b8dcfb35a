"""CalculiX pulls at a bar by the names in its file."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from decomp.meshes.files.inp import number_field, valid_names
from decomp.meshes.model import TetMesh
from tests.meshes.shapes import bar, quadratic

STEEL, PULL = 210e3, 30.0
DECK = f"""
*MATERIAL, NAME=STEEL
*ELASTIC
{STEEL}, 0.
*SOLID SECTION, ELSET=LEFT, MATERIAL=STEEL
*SOLID SECTION, ELSET=RIGHT_SIDE, MATERIAL=STEEL
*BOUNDARY
LEFT_LEFT_XMIN, 1, 1
FIX, 1, 3
*STEP
*STATIC
*DSLOAD
RIGHT_RIGHT_XMAX, P, {-PULL}
*NODE PRINT, NSET=RIGHT_RIGHT_XMAX
U
*NODE PRINT, NSET=NALL, TOTALS=ONLY
RF
*EL PRINT, ELSET=LEFT_CELL_1, TOTALS=ONLY
EVOL
*END STEP
"""


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
@pytest.mark.parametrize("mesh", [bar(), quadratic(bar())], ids=["C3D4", "C3D10"])
def test_a_bar_is_pulled(mesh: TetMesh, tmp_path: Path) -> None:
    """Without lateral contraction the right end moves by pull * length / stiffness."""
    # rounding leaves coordinates such as this one
    middle = np.flatnonzero((mesh.points == [1, 0, 0]).all(axis=1))
    mesh.points[middle, 1] = -6.738033317856796e-15
    mesh.write(tmp_path / "bar.inp")
    corner = int(
        np.flatnonzero((mesh.points[:, 0] == 0) & (mesh.points[:, 1:] == 0).all(axis=1))[0]
    )
    along = int(np.flatnonzero((mesh.points == [0, 1, 0]).all(axis=1))[0])
    fixed = f"*NSET, NSET=FIX\n{corner + 1},\n*BOUNDARY\n{along + 1}, 3, 3\n"
    (tmp_path / "pull.inp").write_text(f"*INCLUDE, INPUT=bar.inp\n{fixed}{DECK}")
    run = subprocess.run(
        ["ccx", "-i", "pull"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert run.returncode == 0, run.stdout[-2000:]
    assert "*ERROR" not in run.stdout
    assert "*WARNING" not in run.stdout
    rows = re.findall(
        r"^ +\d+ +(\S+) +(\S+) +(\S+)$", (tmp_path / "pull.dat").read_text(), re.MULTILINE
    )
    moved = np.array(rows, dtype=float)
    count = len(np.unique(mesh.triangles[mesh.triangle_tags == 4]))
    assert len(moved) == count
    assert moved[:, 0] == pytest.approx(PULL * 2 / STEEL, rel=1e-5)
    assert np.abs(moved[:, 1:]).max() < 1e-9


def test_numbers_fit_into_their_fields() -> None:
    values = [-6.738033317856796e-15, -0.012355684142083406, 1e-300, -1.7976931348623157e308, 0.1]
    values += (
        np.random.default_rng(0).normal(size=1000) * 10.0 ** np.arange(-20, 20).repeat(25)
    ).tolist()
    for value in values:
        text = number_field(value)
        assert len(text) <= 20
        assert float(text) == pytest.approx(value, rel=1e-12)
    assert number_field(-2.9974545379268234) == "-2.9974545379268234"


def test_names_are_valid_and_different() -> None:
    long = "x" * 100
    names = valid_names(["part/hole.side", "part_hole-side", "2/x", "±", long, long, "nall"])
    assert names[:4] == ["PART_HOLE_SIDE", "PART_HOLE_SIDE_2", "G_2_X", "G"]
    assert names[6] == "NALL_2"
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[A-Z][A-Z0-9_]{0,79}", name) for name in names)


def test_a_cell_and_a_face_of_one_name(tmp_path: Path) -> None:
    """Element sets have names of their own."""
    bar().write(tmp_path / "bar.inp")
    text = (tmp_path / "bar.inp").read_text()
    assert "** ELSET RIGHT_SIDE: right/side\n" in text
    assert "** NSET, SURFACE RIGHT_SIDE: right/side\n" in text
    for line in ("*ELEMENT, TYPE=C3D4, ELSET=RIGHT_SIDE", "*NSET, NSET=RIGHT_SIDE"):
        assert text.count(f"{line}\n") == 1
    assert text.count("*SURFACE, NAME=RIGHT_SIDE, TYPE=ELEMENT\n") == 1
