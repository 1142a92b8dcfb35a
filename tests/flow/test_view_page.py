"""The page of `decomp view` in headless Chromium, without a network."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from decomp.cli.main import main
from decomp.drawing import of_mesh
from decomp.drawing.colours import rgb
from decomp.meshes.model import Group, GroupKind, TetMesh
from decomp.view import page
from decomp.view.reading import scene_of
from tests import browser as browsers
from tests.meshes.shapes import bar
from tests.skeleton_fixtures import block

SHOWN = "window.decompView.pieces.filter(p => p.visible).map(p => p.name)"


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers.launched("--use-gl=angle", "--use-angle=swiftshader") as chromium:
        yield chromium


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Pages of a skeleton and of a mesh with fields."""
    folder = tmp_path_factory.mktemp("pages")
    scenes = {
        "block": scene_of(folder / "block.geo", block().skeleton),
        "bar": of_mesh.scene_of(with_fields(bar())),
    }
    for name, scene in scenes.items():
        (folder / f"{name}.html").write_bytes(page.encoded(scene))
    return {name: folder / f"{name}.html" for name in scenes}


def with_fields(mesh: TetMesh) -> TetMesh:
    """With x at the nodes and 1 or 2, left or right of the middle, on tetrahedra."""
    half = 1 + (mesh.points[mesh.tets].mean(axis=1)[:, 0] > 1).astype(np.int64)
    return replace(mesh, point_data={"along": mesh.points[:, 0]}, cell_data={"half": half})


class Opened:
    """A page, and what its console complains of."""

    def __init__(self, browser: Any, path: Path, width: int = 1280, more: str = "") -> None:
        size = {"width": width, "height": 800}
        self.view = browser.new_page(viewport=size, offline=True, has_touch=width < 500)
        self.loud = browsers.complaints(self.view)
        self.view.goto(path.as_uri() + more)
        self.view.wait_for_function("window.decompView !== undefined", timeout=30000)

    def put(self, name: str, value: float | str, event: str = "input") -> None:
        """Give a control a value."""
        self.view.evaluate(
            "([name, value, event]) => { const e = document.getElementById(name); e.value = value;"
            " e.dispatchEvent(new Event(event)); }",
            [name, value, event],
        )

    def drawn(self) -> np.ndarray:
        """The colours (height, width, 3), without the corner that tells directions."""
        from PIL import Image

        shot = self.view.locator("#stage canvas").screenshot()
        colours = np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)
        colours[-84:, -84:] = 255
        return colours

    def shown(self) -> list[str]:
        """The names of the parts that are shown."""
        names: list[str] = self.view.evaluate(SHOWN)
        return names

    def seen(self, column: int, row: int) -> str:
        """The name of what is seen at a pixel of the drawing."""
        name: str = self.view.evaluate(
            "([x, y]) => { const box = document.querySelector('#stage canvas')"
            ".getBoundingClientRect(); return window.decompView.seenAt(box.x + x, box.y + y)"
            "?.piece.name ?? ''; }",
            [column, row],
        )
        return name

    def close(self) -> None:
        """Close it; it must have complained of nothing."""
        assert self.loud == []
        self.view.close()


def filled(colours: np.ndarray, colour: str) -> float:
    """The share of a drawing that has exactly a colour: nothing but filled sections is unlit."""
    return float((np.abs(colours - 255 * np.array(rgb(colour))).max(axis=2) < 1.5).mean())


def colour_of(opened: Opened, name: str) -> str:
    """The colour of the chip beside a name, of a volume first."""
    tone: str = opened.view.locator(f'.item[title="{name}"] .chip').first.evaluate(
        "e => getComputedStyle(e).backgroundColor"
    )
    parts = [int(part) for part in tone.removeprefix("rgb(").removesuffix(")").split(",")]
    return "#" + "".join(f"{part:02X}" for part in parts)


def test_a_skeleton(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["block"])
    before = opened.drawn()
    assert ((before < 250).any(axis=2)).mean() > 0.05
    # the sheets, in glass faces
    assert sum("/sheet-" in name for name in opened.shown()) == 13
    assert len(opened.shown()) == 19
    opened.put("explode", 1)
    apart = opened.view.evaluate("window.decompView.pieces.map(p => p.mesh.position.length())")
    assert sum(length > 0.3 for length in apart) >= 12
    assert (opened.drawn() != before).any(axis=2).mean() > 0.02
    opened.put("explode", 0)
    # the list hides by name, and all of a group
    boxes = opened.view.locator(".item input[type=checkbox]")
    sheets = opened.view.locator("details:has(#all-sheet) .item input")
    assert (boxes.count(), sheets.count()) == (25, 13)
    sheets.first.uncheck()
    assert len(opened.shown()) == 18
    opened.view.locator("#all-sheet").check()
    opened.view.locator("#all-sheet").uncheck()
    opened.view.locator("#all-face").uncheck()
    left = np.argwhere((opened.drawn() <= 250).any(axis=2))
    assert left.tolist() == []
    opened.view.locator("#all-sheet").check()
    # names appear under the pointer
    box = opened.view.locator("#stage canvas").bounding_box()
    opened.view.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert opened.view.locator("#tip").inner_text().startswith("solid/sheet-")
    opened.close()


def test_sections_of_cells_are_filled(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["block"])
    opened.view.locator("#all-sheet").uncheck()
    opened.view.locator("#all-cell").check()
    opened.view.locator("#edges").uncheck()
    opened.view.locator('[id="view--y"]').click()
    opened.put("slice", 0.5)
    colours = opened.drawn()
    # cut across y, all but two of six cells are seen, and nothing else
    cells = opened.view.locator("details:has(#all-cell) .item").all()
    names = [cell.get_attribute("title") for cell in cells]
    tones = {name: colour_of(opened, name) for name in names}
    wide = {name for name, tone in tones.items() if filled(colours, tone) > 0.005}
    assert len(wide) >= 4
    # what is pointed at is what is seen
    rows, columns = np.nonzero((colours < 250).any(axis=2))
    for k in np.linspace(0, len(rows) - 1, 25).astype(int).tolist():
        row, column = int(rows[k]), int(columns[k])
        near = colours[row - 3 : row + 4, column - 3 : column + 4].reshape(-1, 3)
        if len(near) == 49 and (near == near[0]).all():
            name = opened.seen(column, row)
            assert np.abs(255 * np.array(rgb(tones[name])) - near[0]).max() < 1.5
    opened.close()


def test_sections_of_tetrahedra_begin_on_the_near_side(
    browser: Any, pages: dict[str, Path]
) -> None:
    opened = Opened(browser, pages["bar"])
    opened.view.locator("#edges").uncheck()
    tones = [colour_of(opened, name) for name in ("left/front", "right/side")]
    opened.view.locator('[id="view--y"]').click()
    assert [filled(opened.drawn(), tone) for tone in tones] == [0, 0]
    opened.put("slice", 0.25)
    whole = opened.drawn()
    left, right = (filled(whole, tone) for tone in tones)
    # two squares of one size, and no light on them
    assert left > 0.05
    assert right == pytest.approx(left, rel=0.05)
    assert "y = 0.25" in opened.view.locator("#slice-said").inner_text()
    # from behind it would begin at the other end; flipped, the plane stays and the rest is kept
    opened.view.locator('[id="view-+y"]').click()
    assert [filled(opened.drawn(), tone) for tone in tones] == [0, 0]
    opened.view.locator("#flip").click()
    assert filled(opened.drawn(), tones[1]) > 0.05
    assert "y = 0.25" in opened.view.locator("#slice-said").inner_text()
    # along whole elements nothing is cut
    opened.view.locator("#whole").check()
    assert [filled(opened.drawn(), tone) for tone in tones] == [0, 0]
    assert ((opened.drawn() < 250).any(axis=2)).mean() > 0.05
    opened.close()


def test_fields_their_range_and_histogram(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["bar"])
    options = opened.view.locator("#colour option").all_inner_texts()
    # its tetrahedra are all alike: quality is no field to colour by
    assert options == ["name", "region", "along", "half"]
    every = len(bar().tets)
    opened.view.select_option("#colour", label="half")
    counts = [
        int(text.split(": ")[1])
        for text in opened.view.locator("#histogram title").all_text_contents()
    ]
    assert (counts[0], counts[-1], sum(counts)) == (every // 2, every // 2, every)
    # the first bar selects the left half, and the drawing has no other
    opened.view.locator('[id="view--y"]').click()
    before = (opened.drawn() < 250).any(axis=2)
    box = opened.view.locator("#histogram").bounding_box()
    opened.view.mouse.click(box["x"] + 2, box["y"] + box["height"] / 2)
    after = (opened.drawn() < 250).any(axis=2)
    assert f"{every // 2} of {every}" in opened.view.locator("#counted").inner_text()
    assert after.sum() == pytest.approx(before.sum() / 2, rel=0.05)
    assert after[:, after.shape[1] // 2 + 5 :].sum() == 0
    opened.view.locator("#whole-range").click()
    assert ((opened.drawn() < 250).any(axis=2) == before).mean() > 0.999
    # another field has another range
    opened.put("most", 0.4)
    opened.view.select_option("#colour", label="along")
    assert f"{every} of {every}" in opened.view.locator("#counted").inner_text()
    opened.close()


def test_a_range_of_radii_cuts_sheets_exactly(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["block"])
    opened.view.select_option("#colour", label="radius")
    opened.put("least", 0.5)
    lowest = opened.view.evaluate(
        "Math.min(...window.decompView.pieces.filter(p => p.group === 'sheet' && p.visible)"
        ".flatMap(p => p.corners.map(([a, b, s]) => window.decompView.fields[0].values[a] * (1 - s)"
        " + window.decompView.fields[0].values[b] * s)))"
    )
    assert lowest == pytest.approx(0.5, abs=1e-6)
    opened.close()


def test_search_and_one_alone(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["bar"])
    first = opened.shown()
    assert first == ["left/front", "left/cell-1", "right/side"]
    opened.view.locator("#search").fill("*/left.*")
    visible = [each for each in opened.view.locator(".item").all() if each.is_visible()]
    assert {each.get_attribute("title") for each in visible} == {"left/left.xmin", "left/left.rest"}
    # the box of the group shows what was found alone
    opened.view.locator("#all-face").check()
    assert opened.shown() == [*first, "left/left.xmin", "left/left.rest"]
    opened.view.locator("#all-face").uncheck()
    opened.view.locator("#search").fill("")
    row = opened.view.locator('.item[title="right/side"]').first
    row.hover()
    row.locator("button").click()
    assert opened.shown() == ["right/side"]
    opened.view.locator("#back").click()
    assert opened.shown() == first
    opened.close()


def test_an_address_shows_one_alone(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["bar"], more="#only=left%2Fcell-1")
    assert opened.shown() == ["left/cell-1"]
    opened.close()


def test_on_a_phone(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["bar"], width=400)
    assert opened.view.evaluate("document.documentElement.scrollWidth") == 400
    stage = opened.view.locator("#stage").bounding_box()
    side = opened.view.locator("#side").bounding_box()
    assert stage["height"] > 350
    assert side["y"] >= stage["y"] + stage["height"] - 1
    assert opened.view.evaluate("document.getElementById('side').scrollWidth") <= 400
    drawn = (opened.drawn() < 250).any(axis=2)
    assert drawn.mean() > 0.05
    # all of it is in the picture
    assert not drawn[:, [0, -1]].any()
    assert opened.view.locator('.item[title="left/front"] button').is_visible()
    opened.close()


def test_the_command(browser: Any, tmp_path: Path) -> None:
    bar().write(tmp_path / "bar.msh")
    assert main(["view", str(tmp_path / "bar.msh"), "-o", str(tmp_path / "bar.html")]) == 0
    opened = Opened(browser, tmp_path / "bar.html")
    text = opened.view.locator("#names").inner_text()
    for name in ("Cells (3)", "Interfaces (2)", "front", "cell-1"):
        assert name in text
    opened.close()


def test_many_names_are_folded_under_their_regions(browser: Any, tmp_path: Path) -> None:
    mesh = bar(4)
    # twelve slices in each region
    part = (mesh.points[mesh.tets].mean(axis=1)[:, 0] * 12).astype(np.int64)
    names = [f"{'left' if k < 12 else 'right'}/slice-{k}" for k in range(24)]
    solids = [
        Group(GroupKind.CELL, k + 1, name, (name.partition("/")[0],))
        for k, name in enumerate(names)
    ]
    groups = (*solids, *(group for group in mesh.groups if group.dimension == 2))
    mesh = replace(mesh, tet_tags=part + 1, groups=groups)
    path = tmp_path / "slices.html"
    path.write_bytes(page.encoded(of_mesh.scene_of(mesh)))
    opened = Opened(browser, path)
    assert not opened.view.locator('.item[title="right/slice-20"]').is_visible()
    opened.view.locator('input[name="right"]').first.uncheck()
    assert opened.shown() == names[:12]
    # what is searched for is unfolded
    opened.view.locator("#search").fill("slice-20")
    assert opened.view.locator('.item[title="right/slice-20"]').is_visible()
    opened.close()


def test_two_fingers_come_nearer(browser: Any, pages: dict[str, Path]) -> None:
    opened = Opened(browser, pages["bar"], width=400)
    before = (opened.drawn() < 250).any(axis=2).mean()
    touch = opened.view.context.new_cdp_session(opened.view)
    for kind, gap in (("touchStart", 40), ("touchMove", 70), ("touchMove", 100), ("touchEnd", 0)):
        fingers = [{"x": 200 + sign * gap, "y": 200, "id": sign + 1} for sign in (-1, 1)]
        touches = fingers if gap else []
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})
    assert (opened.drawn() < 250).any(axis=2).mean() > 2 * before
    opened.close()


def test_without_graphics_it_says_so(browser: Any, pages: dict[str, Path]) -> None:
    view = browser.new_page(offline=True)
    view.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    view.goto(pages["bar"].as_uri())
    assert "picture with decomp view -o" in view.locator("#without").inner_text()
    view.close()
