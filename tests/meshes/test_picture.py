"""Pictures: what is seen of a mesh cut open, sections, lines, names, lengths."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from decomp.drawing import of_mesh, picture, raster
from decomp.drawing.camera import VIEWS, axes, fitted
from decomp.drawing.colours import rgb
from decomp.drawing.cutting import kept, sections
from decomp.drawing.lettering import bar_length, layout
from decomp.drawing.picture import Clip, Look, creases
from decomp.drawing.raster import Triangles
from decomp.drawing.scene import Part, Scene
from decomp.errors import InputError
from decomp.vectors import Array
from tests.meshes.shapes import bar


def decoded(data: bytes) -> np.ndarray:
    """The colours (height, width, 3) of a picture."""
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


def large_areas(colours: np.ndarray) -> int:
    """How many colours fill more than a hundredth of the picture, white aside."""
    flat = colours.reshape(-1, 3).astype(np.int64) @ [1 << 16, 1 << 8, 1]
    found, count = np.unique(flat, return_counts=True)
    return int(((count > len(flat) / 100) & (found != 0xFFFFFF)).sum())


def area(corners: Array) -> float:
    """Of triangles (k, 3, 3)."""
    a, b, c = np.moveaxis(corners, 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def plain(corners: Array) -> Triangles:
    """Grey triangles with all lines."""
    count = len(corners)
    return Triangles(corners, np.ones((count, 3), dtype=np.bool_), np.full((count, 3), 0.5))


def test_a_bar(tmp_path: Path) -> None:
    """Behind y = 1/2 there are two regions, each with its top and its front."""
    path = tmp_path / "bar.png"
    bar(4).write(path)
    colours = decoded(path.read_bytes())
    assert colours.shape == (picture.PICTURE_HEIGHT, picture.PICTURE_WIDTH, 3)
    assert (colours[[0, 0, -1, -1], [0, -1, 0, -1]] == 255).all()
    # front and top of the left and the right, and the right end
    assert large_areas(colours) == 5
    # the names' colours are beside the drawing, unlit
    for colour in ("#0072B2", "#E69F00"):
        spots = np.argwhere((np.abs(colours - 255 * np.array(rgb(colour))) < 1).all(axis=2))
        assert len(spots) > 100
        assert spots[:, 1].min() > 0.8 * picture.PICTURE_WIDTH


def test_a_bar_is_cut_where_it_is_told() -> None:
    """Seen from the front, the section is a rectangle of 2 x 1, as far behind as it is asked."""
    scene = of_mesh.scene_of(bar())
    look = Look(np.array(VIEWS["-y"]), Clip(1, 0.3), 500, 400)
    colours = decoded(picture.encoded(scene, look))
    assert colours.shape == (400, 500, 3)
    place = layout([("left", ""), ("right", "")], 500, 400)
    drawn = (colours[: place.foot, : place.column] < 250).any(axis=2)
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    wide, high = np.ptp(columns) + 1, np.ptp(rows) + 1
    assert wide == pytest.approx((1 - 2 * picture.DRAWING_MARGIN) * place.column, abs=2)
    assert wide / high == pytest.approx(2, rel=0.02)


@pytest.mark.parametrize("at", [-0.1, 1.0, 7.0])
def test_a_plane_that_leaves_nothing(at: float) -> None:
    scene = of_mesh.scene_of(bar())
    look = Look(np.array(VIEWS["-y"]), Clip(1, at))
    if at < 0:
        assert len(picture.encoded(scene, look)) > 1000
        return
    with pytest.raises(InputError, match=rf"cut at y = {at:g}, nothing .* from y = 0 to 1"):
        picture.encoded(scene, look)


def test_far_away_a_plane_is_told_in_the_models_coordinates() -> None:
    near = of_mesh.scene_of(bar())
    far = replace(near, origin=np.array([0.0, 1e6, 0.0]))
    look = Look(clip=Clip(1, 0.3), width=200, height=200)
    there = replace(look, clip=Clip(1, 1e6 + 0.3))
    assert (decoded(picture.encoded(near, look)) == decoded(picture.encoded(far, there))).all()


def test_a_section_of_a_cube_is_a_hexagon() -> None:
    """Across the diagonal through the middle: six sides of sqrt(1/2)."""
    mesh = bar(1)
    cube = mesh.tets[mesh.tet_tags == 3]
    normal = np.full(3, 1 / np.sqrt(3))
    distance = (mesh.points - [1.5, 0.5, 0.5]) @ normal
    found = sections(mesh.points[cube], distance[cube], np.zeros((len(cube), 3)))
    assert np.abs((found.corners - [1.5, 0.5, 0.5]) @ normal).max() < 1e-12
    assert area(found.corners) == pytest.approx(3 * np.sqrt(3) / 4)


def test_a_section_along_faces_is_of_what_is_kept() -> None:
    """At x = 1 the faces of the right are taken, none of the left."""
    mesh = bar()
    colours = np.zeros((len(mesh.tets), 3))
    colours[mesh.tet_tags == 3] = 1.0
    distance = mesh.points[:, 0] - 1
    found = sections(mesh.points[mesh.tets], distance[mesh.tets], colours)
    assert area(found.corners) == pytest.approx(1)
    assert (found.colours == 1).all()


def test_lines_of_sections_are_no_diagonals() -> None:
    """A quadrilateral of two triangles has four lines."""
    tet = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]])
    for distance, lines in (([-1.0, 1, 1, 1], 3), ([-1.0, -1, 1, 1], 4), ([-1.0, -1, -1, 1], 3)):
        found = sections(tet, np.array([distance]), np.zeros((1, 3)))
        assert int(found.sides.sum()) == lines


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3), st.integers(0, 2**32 - 1))
def test_a_plane_parts_triangles(ways: list[float], seed: int) -> None:
    """What is on one side and what is on the other are all."""
    corners = np.random.default_rng(seed).normal(size=(20, 3, 3))
    distance = corners @ np.array(ways) - 0.1
    one, other = kept(plain(corners), distance, True), kept(plain(corners), -distance, False)
    assert area(one.corners) + area(other.corners) == pytest.approx(area(corners))
    assert (one.corners @ np.array(ways) - 0.1 >= -1e-9).all()


def test_flat_sheets_have_no_lines_inside() -> None:
    """Of a square of two triangles the diagonal is none, unless it is bent."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    square = np.array([[0, 1, 2], [0, 2, 3]])
    assert creases(points, square).tolist() == [[True, False, True], [True, True, False]]
    points[3, 2] = 1.0
    assert creases(points, square).all()


def test_the_picture_of_a_sheet() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    sheet = Part("sheet", "", "sheet-0", "plane", np.array([[0, 1, 2], [0, 2, 3]]))
    scene = Scene("square", points, (sheet,))
    colours = decoded(picture.encoded(scene, Look(np.array(VIEWS["+z"]), None, 300, 300)))
    place = layout([("sheet-0", "")], 300, 300)
    middle = colours[: place.foot, : place.column]
    rows, columns = np.nonzero((middle < 250).any(axis=2))
    inside = middle[rows.min() + 5 : rows.max() - 4, columns.min() + 5 : columns.max() - 4]
    assert (inside == inside[0, 0]).all()


@pytest.mark.parametrize("name", VIEWS)
def test_views_are_turned_the_right_way(name: str) -> None:
    right, up, towards = axes(np.array(VIEWS[name]))
    assert np.cross(right, up) == pytest.approx(towards)
    if name[1] == "z":
        assert right.tolist() == [1, 0, 0]
    else:
        assert up[2] > 0


def test_a_projection_fills_its_place() -> None:
    points = np.random.default_rng(0).normal(size=(50, 3))
    low, high = np.array([10.0, 20]), np.array([110.0, 220])
    found = fitted(points, np.array(VIEWS["iso"]), low, high)(points)[:, :2]
    least, most = found.min(axis=0), found.max(axis=0)
    assert (least >= low - 1e-9).all()
    assert (most <= high + 1e-9).all()
    assert min(high - low - (most - least)) == pytest.approx(0, abs=1e-9)


@given(st.floats(1e-9, 1e9))
def test_lengths_of_bars_are_round(most: float) -> None:
    length = bar_length(most)
    assert most / 2.5 * (1 - 1e-12) <= length <= most * (1 + 1e-12)
    assert f"{length:.0e}"[0] in "125"


def test_names_that_do_not_fit() -> None:
    many = [(f"cell-{k}", "#000000") for k in range(100)]
    place = layout(many, 600, 300)
    shown = [name for name, _ in place.names]
    assert shown[-1] == f"and {101 - len(shown)} more"
    assert len(shown) * place.row <= 300
    (name, _), *_ = layout([("x" * 300 + "y" * 300, "#000000")], 600, 300).names
    assert name.startswith("xx")
    assert name.endswith("yy")
    assert "..." in name
    assert layout([("x" * 600, "#000000")], 600, 300).column > 0.6 * 600


def test_what_is_nearer_hides_what_is_behind() -> None:
    """Whichever is drawn first."""
    far = [[10.0, 10, 0], [90, 10, 0], [10, 90, 0]]
    near = [[10.0, 10, 1], [40, 10, 1], [10, 40, 1]]
    sides = np.array([[True, True, True], [False, True, True]])
    for order in ([0, 1], [1, 0]):
        image, depth = np.ones((100, 100, 3)), np.full((100, 100), -np.inf)
        colours = np.array([[1.0, 0, 0], [0, 1, 0]])
        raster.draw(np.array([far, near])[order], colours[order], sides[order], image, depth)
        assert image[15, 15].tolist() == [0, 1, 0]
        assert image[30, 50].tolist() == [1, 0, 0]
        assert image[70, 70].tolist() == [1, 1, 1]
        # the edge of the far one, and the side of the near one that has none
        assert image[10, 60].tolist() == [raster.DARK, 0, 0]
        assert image[24, 25].tolist() == [0, 1, 0]
