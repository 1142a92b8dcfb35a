"""`decomp view`: scenes of files, the image, the window, what cannot be viewed."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from decomp.cli.main import main
from decomp.drawing import of_mesh
from decomp.drawing.colouring import colouring
from decomp.drawing.colours import CATEGORIES, PALETTE, rgb, spread
from decomp.drawing.scene import Body
from decomp.meshes.incidence import faces_of
from decomp.skeletons.files import write
from decomp.view import page
from decomp.view.reading import scene_of
from tests.meshes.shapes import bar
from tests.skeleton_fixtures import block


def test_parts_of_each_kind_of_file(tmp_path: Path) -> None:
    model = scene_of(tmp_path / "block.geo", block().skeleton)
    count = {g: sum(p.group == g for p in model.parts) for g in ("sheet", "cell", "face")}
    assert count == {"sheet": 13, "cell": 6, "face": 6}
    (radius,) = model.fields
    assert float(radius.values.max()) == pytest.approx(1.0)
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
    assert "<title>&lt;/title&gt;" in text


def test_the_hull_of_some_tetrahedra() -> None:
    """What is between them and all else, each face once, and pointing out."""
    mesh = bar()
    neighbours = of_mesh.neighbours_of(mesh.tets)
    body = Body(mesh.tets, mesh.tet_tags, neighbours)
    for tet, around in enumerate(neighbours[:50]):
        for face, other in enumerate(around):
            if other >= 0:
                corners = set(faces_of(mesh.tets[[tet]])[face])
                assert corners <= set(mesh.tets[other])
    kept = np.flatnonzero(mesh.tet_tags == 3)
    faces, owner = of_mesh.hull(body, kept)
    a, b, c = np.moveaxis(mesh.points[faces], 1, 0)
    # a cube of side 1: its area, and its volume by the divergence theorem
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == pytest.approx(6)
    assert (a * np.cross(b, c)).sum() / 6 == pytest.approx(1)
    assert set(owner) <= set(kept)


def test_colours_differ() -> None:
    """All of few pieces, the neighbours among many, and as many as can where all are neighbours."""
    few = [np.array([k, k + 1]) for k in range(len(PALETTE))]
    assert sorted(spread(few, 30)) == list(range(len(PALETTE)))
    size = 12
    corner = np.arange((size + 1) ** 2).reshape(size + 1, size + 1)
    squares = [corner[i : i + 2, j : j + 2].ravel() for i in range(size) for j in range(size)]
    found = np.array(spread(squares, corner.size)).reshape(size, size)
    assert (found[1:] != found[:-1]).all()
    assert (found[:, 1:] != found[:, :-1]).all()
    counts = np.bincount(found.ravel())
    assert counts.max() - counts.min() <= 1
    clique = spread([np.arange(2)] * (2 * len(PALETTE)), 2)
    assert np.bincount(clique).tolist() == [2] * len(PALETTE)
    assert len(set(PALETTE)) == len(PALETTE)


def test_cells_and_regions_of_a_mesh_are_coloured_apart() -> None:
    scene = of_mesh.scene_of(bar())
    colours = colouring(scene)
    cells = [k for k, part in enumerate(scene.parts) if part.group == "cell"]
    assert len({colours.parts[k] for k in cells}) == 3
    assert len(set(colours.regions.values())) == 2
    assert list(colours.regions) == ["left", "right"]


def test_a_picture_as_it_is_asked_for(tmp_path: Path) -> None:
    from PIL import Image

    bar().write(tmp_path / "bar.msh")
    told = ["view", str(tmp_path / "bar.msh"), "--quiet", "-o"]
    assert main([*told, str(tmp_path / "a.png"), "--camera=-y", "--size-px", "320x200"]) == 0
    more = ["--camera=0,-2,0", "--clip", "y=0.3", "--size-px", "320x200"]
    assert main([*told, str(tmp_path / "b.png"), *more]) == 0
    one, other = (Image.open(tmp_path / f"{name}.png") for name in "ab")
    assert one.size == other.size == (320, 200)
    # cut across its elements there are more of their edges
    dark = [int((np.asarray(image.convert("L")) < 70).sum()) for image in (one, other)]
    assert dark[0] != dark[1]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("--camera up", "'up' is none of iso, .*, nor X,Y,Z"),
        ("--camera 0,0,0", "0,0,0 tells no direction"),
        ("--camera 1,nan,0", "tells no direction"),
        ("--clip w", "'w' is no axis: x, y or z, such as y or y=2.5"),
        ("--clip y=", "'' is no number to cut y at"),
        ("--clip y=inf", "'inf' is no number"),
        ("--size-px 12", "'12' is no size such as 1200x900"),
        ("--size-px 10x10", "sides must be from 64 to 8192 pixels, not 10x10"),
        ("--clip y=5", "cut at y = 5, nothing is left to be seen"),
    ],
)
def test_pictures_that_cannot_be(
    given: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bar().write(tmp_path / "bar.msh")
    told = ["view", str(tmp_path / "bar.msh"), "-o", str(tmp_path / "b.png"), *given.split()]
    try:
        assert main(told) == 2
    except SystemExit as ended:
        assert ended.code == 2
    assert re.search(message, " ".join(capsys.readouterr().err.split()))
    assert not (tmp_path / "b.png").exists()


def test_a_page_has_no_camera(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bar().write(tmp_path / "bar.msh")
    told = ["view", str(tmp_path / "bar.msh"), "-o", str(tmp_path / "b.html"), "--clip", "y"]
    assert main(told) == 2
    assert "--size-px are of pictures: give a .png with -o" in capsys.readouterr().err
