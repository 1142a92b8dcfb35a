"""The snippets of docs/solvers.md: one problem, the same flow of heat from every solver."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import subprocess
import sys
from math import log, pi
from pathlib import Path

import pytest

from tests import pages

PAGE = "docs/solvers.md"
EXACT = 2 * pi / (log(2) + log(3 / 2) / 0.1)
PYTHONS = (sys.executable, "/usr/bin/python3")
"""Debian's packages are for the second."""


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
def test_other_solvers(
    snippet: str, modules: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    able = [p for p in PYTHONS if _run(p, f"import {modules}", tmp_path) is not None]
    if not able:
        pytest.skip(f"{modules} not installed")
    (text,) = (text for _, name, text in pages.blocks(PAGE) if name == snippet)
    ratio = _run(able[0], text, request.getfixturevalue("place"))
    assert ratio is not None
    assert float(ratio.split()[-1]) == pytest.approx(1, rel=0.01)


def _run(python: str, text: str, place: Path) -> str | None:
    """What a program prints, None if it fails."""
    if not Path(python).exists():
        return None
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    run = subprocess.run(
        [python, "-c", text],
        cwd=place,
        env=environment,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    return run.stdout if run.returncode == 0 else None
