"""The report as a page: its figures, its histograms, names that are no markup; in a browser."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from decomp.cli.main import main
from decomp.csg.model import Ignored
from decomp.meshes.report import report
from decomp.view import report_page
from decomp.view.histogram import HIGH, histogram
from decomp.view.table import Figure, Link, table
from tests import browser as browsers
from tests.meshes.shapes import bar

EXACT = {"left": 1.0, "right": 1.0}


def test_bars_count_all() -> None:
    rng = np.random.default_rng(0)
    values = rng.uniform(-0.5, 1.5, 1000)
    text = histogram(values, 0.0, 1.0, "values")
    counts = [int(count) for count in re.findall(r"<title>(\d+)</title>", text)]
    assert sum(counts) == 1000
    assert counts[0] > (values < 0).sum()
    heights = [float(h) for h in re.findall(r' height="([\d.]+)"', text)]
    assert max(heights) == pytest.approx(HIGH)


def test_entries_of_tables() -> None:
    text = table(
        ("<name>", "value"),
        [[Link('a"<b>', "face"), Figure(1 / 3)], ["plain", Figure(None)], ["&", 7]],
    )
    assert "&lt;name&gt;" in text
    assert 'data-name="a&quot;&lt;b&gt;" data-group="face">a&quot;&lt;b&gt;</a>' in text
    assert '<td data-value="0.3333333333333333">0.3333</td>' in text
    assert "<td></td>" in text
    assert '<td data-value="7">7</td>' in text


def test_figures_and_names() -> None:
    mesh = bar()
    odd = replace(mesh.groups[0], name="</script><b>left</b>")
    mesh = replace(mesh, groups=(odd, *mesh.groups[1:]))
    found = report(mesh, EXACT, ignored=(Ignored("curve2d <i>", 3),))
    text = report_page.encoded(mesh, found).decode()
    assert "&lt;b&gt;left&lt;/b&gt;" in text
    assert "<b>left" not in text
    assert "curve2d &lt;i&gt;" in text
    assert f"<b>{len(mesh.tets)}</b>tetrahedra of order 1" in text
    page, _, view = text.partition('<script type="application/json" id="page">')
    sums = [int(n) for n in re.findall(r"<title>(\d+)</title>", page)]
    assert sum(sums) == 2 * len(mesh.tets)
    # the script that holds the view ends where its text does
    assert view.index("</script>") == view.index('"</script>\n<script>') + 1


def test_what_is_amiss_is_marked() -> None:
    mesh = bar()
    fine = report(mesh, EXACT)
    assert "class=bad" not in report_page.encoded(mesh, fine).decode()
    worse = replace(fine, quality=replace(fine.quality, inverted=2))
    assert "<li class=bad><b>2</b>inverted" in report_page.encoded(mesh, worse).decode()


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("b.geo").write_text("algebraic3d\nsolid b = orthobrick (0,0,0; 1,1,1);\ntlo b;\n")
    assert main(["mesh", "b.geo", "--size", "0.5", "--html", "b.html", "--quiet"]) == 0
    text = Path("b.html").read_text()
    for part in ("<h1>b</h1>", "b/b.xmin", "TetWild", "least dihedral angle"):
        assert part in text
    assert main(["mesh", "b.geo", "--html", "none/b.html"]) == 2


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers.launched("--use-gl=angle", "--use-angle=swiftshader") as chromium:
        yield chromium


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    mesh = bar()
    result = tmp_path_factory.mktemp("report") / "bar.html"
    result.write_bytes(report_page.encoded(mesh, report(mesh, EXACT, [("TetWild", 1.0)])))
    return result


def opened(browser: Any, path: Path, width: int = 1280) -> tuple[Any, list[str]]:
    view = browser.new_page(viewport={"width": width, "height": 800}, offline=True)
    loud = browsers.complaints(view)
    view.goto(path.as_uri())
    return view, loud


def test_names_are_shown_in_the_view(browser: Any, path: Path) -> None:
    view, loud = opened(browser, path)
    # picture, sizes and quality come first, and take no more than two screens
    top = view.evaluate("document.querySelector('details').getBoundingClientRect().top")
    assert 300 < top < 1600
    assert view.evaluate("document.querySelector('#picture img').naturalWidth") == 1200
    shown = "frame.contentWindow.decompView.pieces.filter(p => p.visible).map(p => p.name)"
    view.get_by_text("Cells (3)").click()
    view.locator('a[data-name="left/cell-1"]').click()
    view.wait_for_function("frame.contentWindow.decompView !== undefined", timeout=9000)
    view.wait_for_function(f"{shown}.length === 1")
    assert view.evaluate(shown) == ["left/cell-1"]
    assert not view.locator("#picture").is_visible()
    # a region is all its volumes
    view.locator('details:has-text("Regions") a[data-name="left"]').click()
    view.wait_for_function(f"{shown}.length === 2")
    assert view.evaluate(shown) == ["left/front", "left/cell-1"]
    assert loud == []
    view.close()


def test_tables_are_sorted(browser: Any, path: Path) -> None:
    view, loud = opened(browser, path)
    view.get_by_text("Surfaces (6)").click()
    box = view.locator("details:has-text('Surfaces')")

    def column(number: int) -> list[str]:
        cells = box.locator(f"tbody td:nth-child({number})")
        return list(cells.all_inner_texts())

    first, names = [int(text) for text in column(3)], column(1)
    box.get_by_role("button", name="triangles").click()
    assert [int(text) for text in column(3)] == sorted(first)
    box.get_by_role("button", name="triangles").click()
    assert [int(text) for text in column(3)] == sorted(first, reverse=True)
    box.get_by_role("button", name="surface").click()
    assert column(1) != names
    assert set(column(1)) == set(names)
    assert column(1)[-2:] == ["right/right.xmax", "right/side"]
    assert box.locator("th[aria-sort=ascending]").count() == 1
    assert loud == []
    view.close()


def test_on_a_phone(browser: Any, path: Path) -> None:
    view, loud = opened(browser, path, width=400)
    assert view.evaluate("document.documentElement.scrollWidth") == 400
    assert loud == []
    view.close()
