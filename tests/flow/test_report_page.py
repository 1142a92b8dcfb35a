"""The report as a page: its figures, its histograms, names that are no markup."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from decomp.cli.main import main
from decomp.tetra.report import report
from decomp.view import report_page
from tests.mesh_output.shapes import bar


def test_bars_count_all() -> None:
    rng = np.random.default_rng(0)
    values = rng.uniform(-0.5, 1.5, 1000)
    text = report_page.histogram(values, 0.0, 1.0, "values")
    counts = [int(count) for count in re.findall(r"<title>(\d+)</title>", text)]
    assert sum(counts) == 1000
    assert counts[0] > (values < 0).sum()
    heights = [float(h) for h in re.findall(r' height="([\d.]+)"', text)]
    assert max(heights) == pytest.approx(report_page.HIGH)


def test_figures_and_names() -> None:
    mesh = bar()
    odd = replace(mesh.groups[0], name="<b>left</b>")
    mesh = replace(mesh, groups=(odd, *mesh.groups[1:]))
    text = report_page.encoded(mesh, report(mesh, {"left": 1.0, "right": 1.0})).decode()
    assert "&lt;b&gt;left&lt;/b&gt;" in text
    assert "<b>" not in text
    assert f"{len(mesh.tets)} tetrahedra of order 1" in text
    sums = [int(n) for n in re.findall(r"<title>(\d+)</title>", text)]
    assert sum(sums) == 2 * len(mesh.tets)


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("b.geo").write_text("algebraic3d\nsolid b = orthobrick (0,0,0; 1,1,1);\ntlo b;\n")
    assert main(["mesh", "b.geo", "--size", "0.5", "--html", "b.html", "--quiet"]) == 0
    text = Path("b.html").read_text()
    for part in ("<h1>b</h1>", "b/b.xmin", "TetWild", "least dihedral angle"):
        assert part in text
    assert main(["mesh", "b.geo", "--html", "none/b.html"]) == 2
