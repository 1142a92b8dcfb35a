"""The snippets of docs/solvers.md: one problem, the same flow of heat from every solver."""

from __future__ import annotations

import contextlib
import re
import shutil
import subprocess
from math import log, pi
from pathlib import Path

import pytest

from tests import pages
from tests.meshes.other_pythons import said_by

PAGE = "docs/solvers.md"
EXACT = 2 * pi / (log(2) + log(3 / 2) / 0.1)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the page has been executed."""
    directory = tmp_path_factory.mktemp("solvers")
    with contextlib.chdir(directory):
        assert pages.run(PAGE, directory) == 7
    return directory


def test_the_page(place: Path) -> None:
    """scikit-fem, Gmsh and Netgen have run; CalculiX does if it is installed."""
    files = {"pipe.geo", "pipe.msh", "pipe22.msh", "pipe.inp", "pipe.mesh", "heat.inp"}
    assert {path.name for path in place.iterdir()} == files
    if shutil.which("ccx") is None:
        return
    run = subprocess.run(
        ["ccx", "heat"], cwd=place, capture_output=True, text=True, timeout=100, check=False
    )
    assert "*ERROR" not in run.stdout
    (flow,) = re.findall(r"^ +(\S+)$", (place / "heat.dat").read_text(), re.MULTILINE)
    assert -float(flow) == pytest.approx(EXACT, rel=0.01)


@pytest.mark.parametrize(
    ("snippet", "modules"),
    [("dolfinx.py", "dolfinx, gmsh"), ("pymfem.py", "mfem.ser"), ("sfepy.py", "sfepy, meshio")],
)
def test_other_solvers(snippet: str, modules: str, request: pytest.FixtureRequest) -> None:
    (text,) = (text for _, name, text in pages.blocks(PAGE) if name == snippet)
    ratio = said_by(text, modules, request.getfixturevalue("place"))
    assert float(ratio.split()[-1]) == pytest.approx(1, rel=0.01)
