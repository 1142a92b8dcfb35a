"""What Python users meet: names at top level, texts of objects, pictures, hints in errors."""

from __future__ import annotations

import re
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np
import pytest
from PIL import Image

import decomp
from decomp.errors import InputError
from decomp.near import listed, near
from decomp.shown import LONGEST_LINE, Shown, short


@cache
def part() -> decomp.Geometry:
    plate = decomp.Block((0, 0, 0), (4, 3, 1), name="plate")
    hole = decomp.Cylinder((2, 1.5, -1), (2, 1.5, 2), 0.8, name="hole")
    return decomp.Geometry({"part": plate - hole})


@cache
def skeleton() -> decomp.Skeleton:
    return decomp.skeleton(part())


@cache
def mesh() -> decomp.TetMesh:
    return decomp.mesh(part(), size=1, fields=["distance"])


def results() -> list[Any]:
    region, found = part().regions[0], skeleton().regions[0]
    return [
        *(part(), part().model, part().model.regions[0], region),
        *(region.faces[0], region.edges[-1], region.vertices[0]),
        *(skeleton(), found, found.sheets[0], found.seams[0], found.junctions[0], found.cells[0]),
        *(found.certificate, skeleton().complex, skeleton().complex.patches[0]),
        *(decomp.mid_surface(skeleton()), part().nearest(np.zeros((1000, 3)))),
        *(mesh(), mesh().groups[0], mesh().parts, decomp.report(mesh())),
        decomp.check(part(), mesh()),
    ]


def test_every_result_is_short() -> None:
    for each in results():
        text = repr(each)
        assert len(text) <= LONGEST_LINE, text
        assert "\n" not in text and "array(" not in text, text
        if isinstance(each, Shown):
            page = each._repr_html_()
            assert len(page) < 20_000 and page.startswith("<b>") and page.count("<table>") > 0


def test_what_results_say() -> None:
    assert repr(part()) == (
        "<Geometry model: regions (part), faces 7, edges 14, vertices 8, diagonal 5.09902>"
    )
    assert repr(part().regions[0]).startswith(
        "<RegionBoundary part: faces 7, edges 14, vertices 8, volume 9.989381, area "
    )
    text = repr(mesh())
    assert re.fullmatch(
        r"<TetMesh model: nodes \d+, tetrahedra \d+, order 1, cells \d+, volumes \(part\), "
        r"surfaces \d+, fields \(distance, cell\)>",
        text,
    )
    assert '<td style="text-align:left">part/hole.side</td>' in mesh()._repr_html_()
    assert mesh().summary().splitlines()[0].startswith("model model: ")
    assert "  groups: 1 volume, 7 faces" in mesh().summary().splitlines()


def test_names_of_others_are_no_html() -> None:
    region = decomp.Region("<b>", decomp.Block((0, 0, 0), (1, 1, 1), name="<i>"))
    text = decomp.Geometry(decomp.model([region]))._repr_html_()
    assert "&lt;b&gt;" in text
    assert '<td style="text-align:left"><b>' not in text


def test_values_in_a_few_words() -> None:
    assert short(np.zeros((5, 3))) == "5 x 3"
    assert short(np.arange(3.0)) == "(0, 1, 2)"
    assert short(("a", "b")) == "(a, b)"
    assert short(["long name"] * 50) == "50"
    assert short(()) == "none"
    assert short(True) == "yes"
    assert short(1 / 3) == "0.3333333"
    assert short("x" * 100) == "x" * 57 + "..."
    assert short("\x1b[2J") == "\\x1b[2J"
    assert short({}) == "none"


def test_names_at_top_level() -> None:
    listed_names = dir(decomp)
    assert {"mesh", "check", "read", "report", "Certificate", "Group", "__version__"} <= set(
        listed_names
    )
    for name in listed_names:
        assert getattr(decomp, name) is not None
        assert name == "__version__" or not name.startswith("_")
    assert decomp.__version__ == version("decomp")
    with pytest.raises(AttributeError, match="no attribute 'Blok'; did you mean 'Block'"):
        decomp.Blok  # noqa: B018


def test_near_names() -> None:
    assert near("zmax", ["a.zmax", "b"]) == "; did you mean 'a.zmax'?"
    assert near("BASE", ["base"]) == "; did you mean 'base'?"
    assert near("base", ["bass", "vase", "case", "x"]).count("'") == 6
    assert near("q", ["base"]) == ""
    assert listed(map(str, range(10)), 3) == "0, 1, 2 and 7 more"


HINTS = {
    "field": (lambda: decomp.mesh(part(), fields=["distanc"]), "did you mean 'distance'?"),
    "face": (lambda: part().regions[0].face_named("hole.sid"), "did you mean 'hole.side'?"),
    "colour": (lambda: mesh().plot("distanse"), "did you mean 'distance'?"),
    "group": (lambda: mesh().group("part/hole.sid"), "did you mean 'part/hole.side'?"),
}


@pytest.mark.parametrize("what", HINTS)
def test_hints(what: str) -> None:
    call, hint = HINTS[what]
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).endswith(hint), str(caught.value)


def test_an_undefined_solid_is_near_another(tmp_path: Any) -> None:
    path = tmp_path / "part.geo"
    path.write_text("algebraic3d\nsolid plate = sphere (0,0,0; 1);\ntlo plat;\n")
    with pytest.raises(InputError, match=r"'plat' is not defined; did you mean 'plate'\?"):
        decomp.load(path)


@pytest.mark.parametrize("what", [part, skeleton, mesh])
def test_plots(what: Any, tmp_path: Any) -> None:
    path = tmp_path / "plot.png"
    what().plot(off_screen=True, screenshot=path, window_size=(200, 150))
    with Image.open(path) as image:
        colours = image.convert("RGB").getcolors(200 * 150)
    assert colours is not None and len(colours) > 20
