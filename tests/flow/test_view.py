"""`decomp view`: the page in headless Chromium, the image, what cannot be viewed."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from decomp.cli.main import main
from decomp.output import write
from decomp.view import page
from decomp.view.colours import CATEGORIES, rgb
from decomp.view.scene import scene_of
from tests import browser as browsers
from tests.mesh_output.shapes import bar
from tests.skeleton_fixtures import block


def test_parts_of_each_kind_of_file(tmp_path: Path) -> None:
    model = scene_of(tmp_path / "block.geo", block().skeleton)
    count = {g: sum(p.group == g for p in model.parts) for g in ("sheet", "cell", "face")}
    assert count == {"sheet": 13, "cell": 6, "face": 6}
    assert max(float(part.value.max()) for part in model.parts) == pytest.approx(1.0)
    bar().write(tmp_path / "bar.msh")
    mesh = scene_of(tmp_path / "bar.msh")
    assert [p.name for p in mesh.parts if p.group == "cell"] == [
        "left/front", "left/cell-1", "right/side"
    ]  # fmt: skip
    write(block().skeleton, tmp_path / "block.vtu")
    skeleton = scene_of(tmp_path / "block.vtu")
    assert {p.kind for p in skeleton.parts} == {"plane"}
    assert len(skeleton.parts) == 13


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("x.stl", "solid", "'.stl' is nothing that can be viewed; views are of .geo"),
        ("x.msh", "no mesh", "x.msh"),
        ("none.geo", None, "none.geo"),
    ],
)
def test_what_cannot_be_viewed(
    name: str, text: str | None, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if text is not None:
        (tmp_path / name).write_text(text)
    assert main(["view", str(tmp_path / name), "-o", str(tmp_path / "x.html")]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "x.html").exists()


def test_an_image_without_a_display(tmp_path: Path) -> None:
    from PIL import Image

    bar().write(tmp_path / "bar.msh")
    assert main(["view", str(tmp_path / "bar.msh"), "-o", str(tmp_path / "b.png")]) == 0
    pixels = np.asarray(Image.open(io.BytesIO((tmp_path / "b.png").read_bytes())).convert("RGB"))
    tones = pixels[(pixels < 250).any(axis=2)] / 255
    for colour in CATEGORIES[:2]:
        # a shaded colour keeps the ratios of its parts
        own = np.array(rgb(colour))
        near = np.abs(tones / tones.max(axis=1, keepdims=True) - own / own.max()).max(axis=1) < 0.03
        assert near.mean() > 0.05


@pytest.fixture(scope="module")
def window() -> Any:
    """A window that is on no screen, on the block's skeleton."""
    pyvista = pytest.importorskip("pyvista", reason="pyvista is not installed")
    from decomp.view.window import Window

    scene = scene_of(Path("block.geo"), block().skeleton)
    return Window(scene, pyvista, off_screen=True, window_size=(300, 240))


def test_the_window_explodes(window: Any) -> None:
    assert len(window.shown) == 13
    window.explode(1.0)
    away = [np.linalg.norm(actor.position) for part in window.shown for actor in part.actors]
    assert sum(length > 0.3 for length in away) >= 12
    window.explode(0.0)
    assert all(tuple(actor.position) == (0, 0, 0) for p in window.shown for actor in p.actors)


def test_the_window_slices_and_tells_names(window: Any) -> None:
    def opaque() -> int:
        pixels = window.plotter.screenshot(return_img=True).astype(int)
        return int((np.ptp(pixels, axis=2) > 40).sum())

    names = {window.name_at(x, y) for x in range(100, 200, 10) for y in range(80, 160, 10)}
    assert len(names) > 3
    assert names <= {part.name for part in window.shown} | {""}
    assert window.name_at(1, 120) == ""
    whole = opaque()
    window.slice_across(2)
    window.slice(0.3)
    assert 0 < opaque() < 0.8 * whole
    window.slice(0.0)
    assert opaque() < 0.02 * whole


def test_categories_differ_to_colour_blind_eyes() -> None:
    """Neighbours differ by much in brightness or in the blue-yellow way, which most keep."""
    tones = np.array([rgb(colour) for colour in CATEGORIES])
    linear = np.where(tones <= 0.04045, tones / 12.92, ((tones + 0.055) / 1.055) ** 2.4)
    # deuteranopia: Vienot, Brettel and Mollon 1999, one matrix in linear RGB
    seen = linear @ np.array([[0.293, 0.707, 0], [0.293, 0.707, 0], [-0.022, 0.022, 1]]).T
    seen = np.clip(seen, 0, 1)
    gaps = np.abs(seen[:, None] ** 0.45 - seen[None] ** 0.45).max(axis=2)
    assert gaps[~np.eye(len(gaps), dtype=bool)].min() > 0.07


def test_names_cannot_break_out_of_the_page(tmp_path: Path) -> None:
    from dataclasses import replace

    scene = scene_of(tmp_path / "b.geo", block().skeleton)
    bad = replace(scene, title="</title><b>", parts=(replace(scene.parts[0], name="</script>"),))
    text = page.encoded(bad).decode()
    assert "</script><" not in text.split('id="data"')[1].split("</script>")[0]
    assert "\\u003c/script>" in text
    assert "<title>&lt;/title>" in text


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers.launched("--use-gl=angle", "--use-angle=swiftshader") as chromium:
        yield chromium


def opened(browser: Any, path: Path) -> tuple[Any, list[str]]:
    """A page without network, and what its console complains of."""
    view = browser.new_page(viewport={"width": 1280, "height": 800}, offline=True)
    loud = browsers.complaints(view)
    view.goto(path.as_uri())
    view.wait_for_function("window.decompView !== undefined", timeout=30000)
    return view, loud


def put(view: Any, name: str, value: float) -> None:
    """Move a slider."""
    view.evaluate(
        "([name, value]) => { const e = document.getElementById(name); e.value = value; "
        "e.dispatchEvent(new Event('input')); }",
        [name, value],
    )


def drawn(view: Any) -> np.ndarray:
    from PIL import Image

    shot = view.locator("#stage canvas").screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def test_the_page_in_a_browser(browser: Any, tmp_path: Path) -> None:
    path = tmp_path / "block.html"
    path.write_bytes(page.encoded(scene_of(tmp_path / "block.geo", block().skeleton)))
    view, loud = opened(browser, path)
    before = drawn(view)
    assert ((before < 250).any(axis=2)).mean() > 0.05
    # explode moves parts apart
    put(view, "explode", 1)
    apart = view.evaluate("window.decompView.meshes.map(m => m.position.length())")
    assert sum(length > 0.3 for length in apart) >= 12
    assert (drawn(view) != before).any(axis=2).mean() > 0.02
    # the list hides by name
    boxes = view.locator("#names details").first.locator(".item input")
    assert boxes.count() == 13
    boxes.first.uncheck()
    visible = view.evaluate("window.decompView.meshes.filter(m => m.visible).length")
    assert visible == 12
    view.locator("#all-sheet").uncheck()
    assert (drawn(view) > 250).all()
    view.locator("#all-sheet").check()
    # slicing takes away, colours change, names appear under the pointer
    whole = drawn(view)
    put(view, "slice", 0.4)
    assert (drawn(view) < 250).sum() < (whole < 250).sum()
    view.select_option("#colour", "value")
    assert view.locator("#bar").count() == 1
    put(view, "slice", 1)
    put(view, "explode", 0)
    box = view.locator("#stage canvas").bounding_box()
    view.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert view.locator("#tip").inner_text().startswith("solid/sheet-")
    assert loud == []
    view.close()


def test_a_mesh_in_a_browser(browser: Any, tmp_path: Path) -> None:
    bar().write(tmp_path / "bar.msh")
    assert main(["view", str(tmp_path / "bar.msh"), "-o", str(tmp_path / "bar.html")]) == 0
    view, loud = opened(browser, tmp_path / "bar.html")
    assert ((drawn(view) < 250).any(axis=2)).mean() > 0.05
    text = view.locator("#names").inner_text()
    for name in ("left/front", "left/cell-1", "right/side"):
        assert name in text
    assert loud == []
    view.close()
