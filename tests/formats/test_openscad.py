"""OpenSCAD's .csg: structure, emptiness, modifiers, and what is wrong with wrong files."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.csg.primitives import Block, Cone, Cylinder, Sphere, Torus
from decomp.csg.solid import Difference, Intersection, Solid, Transformed, Union
from decomp.errors import ParseError, UnsupportedError
from decomp.formats import loads

HERE = "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"
MOVED = "[[1, 0, 0, 5], [0, 1, 0, 3], [0, 0, 1, 0], [0, 0, 0, 1]]"


def read(text: str) -> Solid:
    (region,) = loads(text, "csg").regions
    assert region.name == "solid"
    return region.solid


def same(a: object, *b: float) -> bool:
    return np.array_equal(np.asarray(a), np.asarray(b))


def test_cube() -> None:
    block = read("cube(size = [1, 2, 3], center = false);")
    assert isinstance(block, Block)
    assert same(block.corner, 0, 0, 0)
    assert same(block.size, 1, 2, 3)
    assert block.name == "cube1"
    block = read("cube(4, true);")
    assert isinstance(block, Block)
    assert same(block.corner, -2, -2, -2)


def test_sphere_and_cylinder() -> None:
    ball = read("sphere($fn = 0, $fa = 12, $fs = 2, r = 10);")
    assert isinstance(ball, Sphere)
    assert ball.radius == 10
    rod = read("cylinder($fn = 0, h = 4, r1 = 5, r2 = 5, center = true);")
    assert isinstance(rod, Cylinder)
    assert same(rod.base, 0, 0, -2)
    assert same(rod.top, 0, 0, 2)
    tip = read("cylinder(h = 4, r1 = 0, r2 = 5, center = false);")
    assert isinstance(tip, Cone)
    assert (tip.base_radius, tip.top_radius) == (0, 5)
    assert isinstance(read("cylinder(4, 5, 5);"), Cylinder)
    assert isinstance(read("cylinder(h = 4, d = 2);"), Cylinder)


def test_top_level_is_a_union() -> None:
    tree = read("cube(1);\nsphere(1);\ncube(2);")
    assert isinstance(tree, Union)
    assert [part.name for part in tree.parts] == ["cube1", "sphere1", "cube2"]  # type: ignore[attr-defined]


def test_groups_of_one_are_that_one() -> None:
    assert isinstance(
        read("group(){union(){color([1,0,0,1]){render(convexity = 2){cube(1);}}}}"), Block
    )


def test_difference_subtracts_the_rest() -> None:
    tree = read("difference(){cube(1);sphere(1);sphere(2);}")
    assert isinstance(tree, Difference)
    assert isinstance(tree.base, Block)
    assert isinstance(tree.tool, Union)
    assert len(tree.tool.parts) == 2


def test_intersection() -> None:
    tree = read("intersection(){cube(1);sphere(1);sphere(2);}")
    assert isinstance(tree, Intersection)
    assert len(tree.parts) == 3


@pytest.mark.parametrize(
    "empty",
    [
        "group();",
        "union(){}",
        "intersection();",
        "difference();",
        "cube(0);",
        "cube([1, 0, 2]);",
        "sphere(0);",
        "cylinder(h = 0);",
        "cylinder(h = 1, r1 = 0, r2 = 0);",
        "difference(){group(); cube(1);}",
        "intersection(){cube(1); group();}",
        "intersection(){%cube(1);}",
        f"multmatrix({HERE}) {{ cube(0); }}",
        "*cube(1);",
        "%cube(1);",
        "rotate_extrude(){circle(r = 0);}",
    ],
)
def test_what_is_empty_in_openscad_is_empty(empty: str) -> None:
    assert isinstance(read(f"{empty}\nsphere(1);"), Sphere)
    with pytest.raises(ParseError, match="holds no solid"):
        loads(empty, "csg")


def test_objects_without_volume_are_reported() -> None:
    model = loads("cube(1);\ncube(0);\nsphere($fn = 6, r = 1);\n", "csg")
    assert [(i.statement, i.line) for i in model.ignored] == [
        ("cube without volume", 2),
        ("$fn = 6 (surfaces are exact, not facets)", 3),
    ]


def test_modifiers() -> None:
    assert isinstance(read("#cube(1);"), Block)
    assert isinstance(read("difference(){%sphere(1);cube(1);}"), Block)
    assert isinstance(read("difference(){*sphere(1);cube(1);}"), Block)
    assert isinstance(
        read("cube(1);multmatrix(" + MOVED + "){cube(2);!group(){sphere(1);}}"), Sphere
    )
    assert isinstance(read("!group(){sphere(1);}!cube(1);"), Sphere)
    assert isinstance(read("*group(){!sphere(1);}cube(1);"), Block)


@pytest.mark.parametrize("dropped", ["minkowski(){cube(1);}", "sphere(inf);", 'text(t = "}");'])
def test_what_is_dropped_may_be_wrong(dropped: str) -> None:
    assert isinstance(read(f"*{dropped} %group(){{{dropped}}} cube(1);"), Block)


def test_multmatrix() -> None:
    tree = read("multmatrix([[0, -2, 0, 7], [2, 0, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]) {cube(1);}")
    assert isinstance(tree, Transformed)
    assert tree.by.scale == pytest.approx(2)
    np.testing.assert_allclose(tree.by.points(np.array([1.0, 0, 0])), [7, 2, 0], atol=1e-15)
    mirror = read(
        "multmatrix([[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {cube(1);}"
    )
    assert isinstance(mirror, Transformed)
    assert np.linalg.det(mirror.by.rotation) == pytest.approx(-1)


def test_rotate_extrude_of_a_moved_circle_is_a_torus() -> None:
    ring = read(
        "rotate_extrude(angle = 360, convexity = 2, $fn = 0) {\n group() {\n"
        f"multmatrix({MOVED}) {{ circle($fn = 0, $fa = 12, $fs = 2, r = 2); }} }} }}"
    )
    assert isinstance(ring, Torus)
    assert (ring.major, ring.minor) == (5, 2)
    assert same(ring.axis, 0, 0, 1)
    assert same(ring.centre, 0, 0, 3)


def test_rotate_extrude_follows_every_transform_of_the_circle() -> None:
    twice = "[[0, 2, 0, -1], [-2, 0, 0, 1], [0, 0, 1, 9], [0, 0, 0, 1]]"
    ring = read(
        f"rotate_extrude() {{ multmatrix({twice}) {{ multmatrix({MOVED}) {{ circle(1); }} }} }}"
    )
    assert isinstance(ring, Torus)
    assert ring.major == pytest.approx(5)
    assert ring.centre[2] == pytest.approx(-9)
    assert ring.minor == pytest.approx(2)


def test_comments_and_names_in_any_script() -> None:
    assert isinstance(read('// ünïcode ☠\n/* "x */ cube(1); // end'), Block)
    with pytest.raises(UnsupportedError, match=r"1:1: sfære is not supported"):
        loads("sfære();", "csg")


@pytest.mark.parametrize(
    "construct",
    [
        "linear_extrude(height = 5, center = false, scale = [1, 1]) { circle(r = 1); }",
        "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2]]);",
        "minkowski(convexity = 0) { cube(1); sphere(1); }",
        "hull() { cube(1); }",
        'text(text = "a;{\\"", size = 10);',
        'import(file = "x.stl", layer = "", timestamp = 0);',
        'surface(file = "a.png", center = false);',
        "projection(cut = false) { cube(1); }",
        "resize(newsize = [1, 2, 3], auto = [false, false, false]) { cube(1); }",
        "offset(r = 1) { circle(1); }",
        "square(size = [1, 1], center = false);",
        "circle(r = 1);",
        "multmatrix([[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(1); }",
        "multmatrix([[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(1); }",
        "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]]) { cube(1); }",
        "rotate_extrude(angle = 180) { multmatrix(" + MOVED + ") { circle(1); } }",
        "rotate_extrude() { circle(r = 1); }",
        "rotate_extrude() { multmatrix(" + MOVED + ") { circle(r = 5); } }",
        "translate([1, 2, 3]) { cube(1); }",
    ],
)
def test_other_constructs_are_refused_by_name(construct: str) -> None:
    name = construct.split("(")[0]
    with pytest.raises(UnsupportedError) as caught:
        loads(f"cube(1);\ngroup() {{\n\t{construct}\n}}", "csg", path="x.csg")
    assert str(caught.value).startswith(f"x.csg:3:2: {name}")


def test_uneven_scale_is_called_so() -> None:
    with pytest.raises(UnsupportedError, match="non-uniform scale or shear"):
        loads("multmatrix([[1,0,0,0],[0,2,0,0],[0,0,1,0],[0,0,0,1]]){cube(1);}", "csg")


def test_flat_children_beside_others_are_refused() -> None:
    with pytest.raises(UnsupportedError, match="1:9: circle") as caught:
        loads("cube(1);circle(1);", "csg")
    assert caught.value.column == 9
    with pytest.raises(UnsupportedError, match="rotate_extrude of anything but a circle"):
        loads("rotate_extrude(){sphere(1);}", "csg")


WRONG = {
    "infinite": ("sphere(r = inf);", 1, 1, "r must be finite, got inf"),
    "nan": ("cube(1);\n cube([1, nan, 1]);", 2, 2, "size must be finite"),
    "negative cube": ("cube([1, -1, 1]);", 1, 1, "block size must be positive"),
    "negative sphere": ("sphere(-1);", 1, 1, "must not be negative"),
    "negative height": ("cylinder(h = -1);", 1, 1, "must not be negative"),
    "text for a number": ('sphere(r = "x");', 1, 1, "must be a number"),
    "two sizes": ("cube([1, 2]);", 1, 1, "one number or three"),
    "list in a list": ("cube([1, [2], 3]);", 1, 1, "must be a number"),
    "unknown parameter": ("cube(siz = 1);", 1, 1, "unknown parameter 'siz'"),
    "bad center": ("cube(1, center = [1]);", 1, 1, "center must be true or false"),
    "infinite matrix": ("multmatrix([[inf,0,0,0],[0,1,0,0],[0,0,1,0]]){cube(1);}", 1, 1, "finite"),
    "ragged matrix": ("multmatrix([[1,0,0,0],[0,1,0]]){cube(1);}", 1, 1, "four rows"),
    "no matrix": ("multmatrix(){cube(1);}", 1, 1, "four rows"),
    "children": ("cube(1){sphere(1);}", 1, 1, "takes no children"),
    "no semicolon": (
        "cube(1)\nsphere(1);",
        2,
        1,
        "'sphere' does not belong here; expected '{' or ';'",
    ),
    "open brace": ("group(){\ncube(1);", 2, 9, "the file ends here; expected"),
    "extra brace": ("cube(1);}", 1, 9, "'}' does not belong here"),
    "scad": ("x = 5;\ncube(x);", 1, 3, "assignments belong to .scad files"),
    "open text": ('cube(1);\ntext("abc', 2, 6, "the text that starts here has no end"),
    "open comment": ("cube(1);\n/* abc", 2, 1, "the comment that starts here has no end"),
    "two values": ("sphere(r = 1, 2);", 1, 8, "r takes one value"),
    "empty": ("", 1, 1, "holds no solid"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_files(case: str) -> None:
    text, line, column, message = WRONG[case]
    with pytest.raises(ParseError) as caught:
        loads(text, "csg")
    assert message in caught.value.message
    assert (caught.value.line, caught.value.column) == (line, column)


def test_the_first_fault_in_the_file_is_reported() -> None:
    with pytest.raises(UnsupportedError, match="2:1: hull"):
        loads("cube(1);\nhull();\nsphere(inf);", "csg")


@pytest.mark.parametrize("special", ["$fe = 0.1", "$fa = 12, $fs = 2", "$fn = 0, $t = 0", "$vpd=1"])
@pytest.mark.parametrize("call", ["cube(size = 1, {})", "sphere({}, r = 1)", "cylinder(h = 1, {})"])
def test_special_variables_may_be_given_to_anything(call: str, special: str) -> None:
    assert loads(call.format(special) + ";", "csg").regions
    with pytest.raises(ParseError, match="unknown parameter 'fe'"):
        loads(call.format("fe = 1") + ";", "csg")
