"""Netgen's .geo: structure, names, options, and what is wrong with wrong files."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from decomp.csg.model import Ignored, Model
from decomp.csg.primitives import (
    Block,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    InfiniteEllipticCylinder,
    Primitive,
    Sphere,
    Torus,
)
from decomp.csg.solid import Complement, Copies, Intersection, Labelled, Solid, Transformed, Union
from decomp.errors import FileError, ParseError, UnsupportedError
from decomp.formats import loads
from decomp.formats.native import dumps
from tests.formats.membership import contains


def read(body: str) -> Model:
    return loads("algebraic3d\n" + body, "geo")


def solid(body: str) -> Solid:
    """The solid of `main` as written."""
    return read(f"solid main = {body};\ntlo main;").regions[0].solid


def primitive(body: str) -> Primitive:
    found = solid(body)
    assert isinstance(found, Primitive)
    return found


def same(a: object, *b: float) -> bool:
    return np.array_equal(np.asarray(a), np.asarray(b))


def test_primitives() -> None:
    plane = primitive("plane (1, 2, 3; 0, 0, 2)")
    assert isinstance(plane, HalfSpace)
    assert same(plane.point, 1, 2, 3)
    assert same(plane.normal, 0, 0, 1)
    ball = primitive("sphere (.5, -1e-1, 2.; 0.25)")
    assert isinstance(ball, Sphere)
    assert same(ball.centre, 0.5, -0.1, 2)
    assert ball.radius == 0.25
    rod = primitive("cylinder (1, 0, 0; 1, 0, 4; 2)")
    assert isinstance(rod, InfiniteCylinder)
    assert same(rod.point, 1, 0, 0)
    assert same(rod.axis, 0, 0, 1)
    tip = primitive("cone (0, 0, 0; 1; 0, 0, 2; 3)")
    assert isinstance(tip, InfiniteCone)
    assert same(tip.apex, 0, 0, -1)
    assert tip.half_angle == pytest.approx(45)
    brick = primitive("orthobrick (1, 2, 3; 4, 6, 8)")
    assert isinstance(brick, Block)
    assert same(brick.size, 3, 4, 5)
    ring = primitive("torus (0, 0, 0; 1, 0, 0; 2; 1)")
    assert isinstance(ring, Torus)
    assert (ring.major, ring.minor) == (2, 1)
    assert isinstance(primitive("cone (0, 0, 0; 1; 0, 0, 2; 1)"), InfiniteCylinder)


@pytest.mark.parametrize("corners", ["1, 2, 3; 4, 6, 8", "4, 6, 8; 1, 2, 3", "4, 2, 8; 1, 6, 3"])
def test_corners_of_bricks_come_in_any_order(corners: str) -> None:
    brick = primitive(f"orthobrick ({corners})")
    assert isinstance(brick, Block)
    assert same(brick.corner, 1, 2, 3)
    assert same(brick.size, 3, 4, 5)


def test_and_binds_tighter_than_or() -> None:
    balls = " ".join(["sphere (0,0,0; 1) or", "sphere (0,0,0; 2) and sphere (0,0,0; 3)"])
    tree = solid(balls + " or not sphere (0,0,0; 4)")
    assert isinstance(tree, Union)
    assert [type(part) for part in tree.parts] == [Labelled, Intersection, Complement]
    tree = solid("(sphere (0,0,0; 1) or sphere (0,0,0; 2)) and sphere (0,0,0; 3)")
    assert isinstance(tree, Intersection)
    assert [type(part) for part in tree.parts] == [Union, Labelled]


def test_not_binds_tightest() -> None:
    tree = solid("not sphere (0,0,0; 1) and sphere (0,0,0; 2)")
    assert isinstance(tree, Intersection)
    assert isinstance(tree.parts[0], Complement)


def test_names() -> None:
    model = read(
        "solid hole = ((cylinder (0,0,0; 0,0,1; 1)));\n"
        "solid cube = plane (0,0,0; -1,0,0) and sphere (0,0,0; 2) and plane (1,0,0; 1,0,0);\n"
        "solid main = cube and not hole and plane (0,0,9; 0,0,1); tlo main;"
    )
    cube, without, cut = model.regions[0].solid.children()
    labels = [(part.name, part.part.name) for part in cube.children()]  # type: ignore[attr-defined]
    assert labels == [("cube", "plane1"), ("cube", "sphere1"), ("cube", "plane2")]
    (hole,) = without.children()
    assert isinstance(hole, InfiniteCylinder)
    assert hole.name == "hole"
    assert isinstance(cut, Labelled)
    assert cut.name == "main"
    assert model.regions[0].name == "main"


def test_a_lone_complement_keeps_the_solids_name_as_prefix() -> None:
    (inside,) = solid("not plane (0,0,0; 0,0,1)").children()
    assert isinstance(inside, Labelled)
    assert inside.name == "main"


def test_shared_solids_are_shared_nodes() -> None:
    model = read(
        "solid ball = sphere (0,0,0; 1);\nsolid b = orthobrick (0,0,0; 2,2,2);\n"
        "solid a = b and not ball;\ntlo a;\ntlo ball;"
    )
    tool = model.regions[0].solid.children()[1].children()[0]
    assert tool is model.regions[1].solid


def test_flags_and_options() -> None:
    model = read(
        "solid s = sphere (0,0,0; 1) -bc = 1 -maxh=2;\n"
        "tlo s -maxh=0.4 -bc=2 -col=[1, 0.5, -0] -material=copper -transparent -layer=2;"
    )
    (region,) = model.regions
    assert isinstance(region.solid, Labelled)
    assert region.solid.name is None
    assert dict(region.solid.options) == {"bc": 1, "maxh": 2}
    assert isinstance(region.solid.part, Sphere)
    assert region.solid.part.name == "s"
    assert dict(region.options) == {
        "maxh": 0.4,
        "bc": 2,
        "col": (1, 0.5, 0),
        "material": "copper",
        "transparent": True,
        "layer": 2,
    }
    assert model.ignored == ()
    again = loads(dumps(model), "json")
    assert dict(again.regions[0].options) == dict(region.options)


def test_flags_that_are_no_options_are_ignored_and_told_of() -> None:
    """Those that Netgen knows with a value for each face too."""
    model = read(
        "solid s = sphere (0,0,0; 1) -bc=[1, 2]\n -bcname=[a, b] -material=tin -maxh=1;\n"
        "tlo s -l=[a, b]\n -maxH=2\n - foo;"
    )
    (region,) = model.regions
    assert dict(region.solid.options) == {"maxh": 1}  # type: ignore[attr-defined]
    assert dict(region.options) == {}
    assert [(each.statement, each.line) for each in model.ignored] == [
        ("-bc=[1, 2] of solid s", 2),
        ("-bcname=[a, b] of solid s", 3),
        ("-material=tin of solid s", 3),
        ("-l=[a, b] of tlo s", 4),
        ("-maxH=2 of tlo s", 5),
        ("-foo of tlo s", 6),
    ]


@pytest.mark.parametrize(
    ("flag", "said"),
    [
        ("-maxh=-1", "option maxh of tlo s must be a length above zero, got -1"),
        ("-maxh=0", "must be a length above zero, got 0"),
        ("-maxh=fine", "must be a length above zero, got 'fine'"),
        ("-maxh", "must be a length above zero, got True"),
        ("-maxh=[1,2]", "must be a length above zero, got (1, 2)"),
        ("-bc=1.5", "must be a whole number, got 1.5"),
        ("-material=3", "must be a text, got 3"),
        ("-col=[1,2]", "must be three numbers, got (1, 2)"),
        ("-transparent=1", "must be True or False, got 1"),
    ],
)
def test_wrong_values_of_flags(flag: str, said: str) -> None:
    with pytest.raises(ParseError) as caught:
        read(f"solid s = sphere (0,0,0; 1);\ntlo s -layer=1\n  {flag};")
    assert said in str(caught.value)
    assert (caught.value.line, caught.value.column) == (4, 3)


def test_translate() -> None:
    tree = solid("translate (1, 2, 3; sphere (0,0,0; 1))")
    assert isinstance(tree, Transformed)
    assert same(tree.by.offset, 1, 2, 3)


def test_multitranslate_makes_one_more_than_its_number() -> None:
    tree = solid("multitranslate (1, 0, 0; 9; sphere (0,0,0; 0.2))")
    assert isinstance(tree, Copies)
    assert [move.offset[0] for move in tree.by] == list(range(10))


def test_rotate_turns_by_netgens_euler_angles() -> None:
    a, b, c = 0.3, 0.5, -0.7
    tree = solid(f"rotate (1, 2, 3; {a}, {b}, {c}; sphere (0,0,0; 1))")
    assert isinstance(tree, Transformed)

    def z(t: float) -> np.ndarray:
        return np.array([[cos(t), sin(t), 0], [-sin(t), cos(t), 0], [0, 0, 1]])

    x = np.array([[1, 0, 0], [0, cos(b), sin(b)], [0, -sin(b), cos(b)]])
    centre = np.array([1, 2, 3])
    expected = z(c) @ x @ z(a)
    np.testing.assert_allclose(tree.by.rotation, expected, atol=1e-15)
    np.testing.assert_allclose(tree.by.offset, centre - expected @ centre, atol=1e-14)


def test_multirotate_has_its_first_copy_on_the_solid() -> None:
    tree = solid(f"multirotate (0,0,0; {-pi / 2},0,0; 4; sphere (5,0,0; 1))")
    assert isinstance(tree, Copies)
    centres = np.array([move.points(np.array([5.0, 0, 0])) for move in tree.by])
    np.testing.assert_allclose(centres[:, 0], [5, 0, -5, 0], atol=1e-14)
    np.testing.assert_allclose(centres[:, 1], [0, 5, 0, -5], atol=1e-14)


def test_statements_that_make_no_region_are_reported() -> None:
    model = read(
        "solid p1 = plane (0,0,0; 0,0,-1);\nsolid s = sphere (0,0,0; 1);\ntlo s; ;\n"
        "boundingbox (-1, -1, -1;\n   1, 1, 1); # the box\n"
        "identify periodic p1 s -tlo=s;\nsingular point p1 s s -factor=2;\npoint (0,0,0);\n"
        "boundarycondition p1 s 3;\nboundaryconditionname p1 s wall;\nboundarycolor p1 s 1,0,0;\n"
        "define constant identprec = 1e-4\ntlo s p1 -col=[1,0,0];\n"
        "curve2d c = (2; 0,0; # here\n 1,1; 1; 2,1,2);\n"
    )
    assert model.ignored == (
        Ignored("boundingbox (-1, -1, -1; 1, 1, 1)", 5),
        Ignored("identify periodic p1 s -tlo=s", 7),
        Ignored("singular point p1 s s -factor=2", 8),
        Ignored("point (0,0,0)", 9),
        Ignored("boundarycondition p1 s 3", 10),
        Ignored("boundaryconditionname p1 s wall", 11),
        Ignored("boundarycolor p1 s 1,0,0", 12),
        Ignored("define constant identprec = 1e-4", 13),
        Ignored("tlo s p1 -col=[1,0,0]", 14),
        Ignored("curve2d c = (2; 0,0; 1,1; 1; 2,1,2)", 15),
    )


def test_a_comment_may_stand_among_numbers() -> None:
    ball = primitive("sphere (0, # 9, 9\n 1, - 2 # 7\n; 3)")
    assert isinstance(ball, Sphere)
    assert same(ball.centre, 0, 1, -2)


def test_elliptic_cylinders() -> None:
    oval = primitive("ellipticcylinder (1, 2, 3; 0, 4, 0; 0, 0, -.5)")
    assert isinstance(oval, InfiniteEllipticCylinder)
    assert same(oval.point, 1, 2, 3)
    assert same(oval.first, 0, 4, 0)
    assert same(oval.second, 0, 0, -0.5)
    # inside where ((p - c) . va / |va|^2)^2 + ((p - c) . vb / |vb|^2)^2 < 1
    points = np.array([[9, 5.9, 3], [9, 6.1, 3], [-9, 2, 3.4], [1, 2, 3.6], [1, 5.4, 3.4]])
    assert contains(oval, points).tolist() == [True, False, True, False, False]


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        (
            "0,0,0; 1,0,0; 1,1,0",
            r"x.geo:2:9: .*\(1, 0, 0\) must be at right angles to the other, \(1, 1, 0\), but the "
            r"angle is 45 degrees \(in solid 'a'\)",
        ),
        ("0,0,0; 1,0,0; 0,0,0", "x.geo:2:9: .*second semi-axis must not be the zero vector"),
        ("0,0,0; 1,0,0; 2", "x.geo:2:.*ellipticcylinder \\(centre; semi-axis; other semi-axis\\)"),
    ],
)
def test_wrong_elliptic_cylinders(numbers: str, message: str) -> None:
    text = f"algebraic3d\nsolid a=ellipticcylinder ({numbers});\ntlo a;\n"
    with pytest.raises(FileError, match=message):
        loads(text, "geo", path="x.geo")


@pytest.mark.parametrize(
    "construct",
    [
        "ellipsoid (0,0,0; 1,0,0; 0,1,0; 0,0,2)",
        "ellipticcone (0,0,0; 5,0,0; 0,2,0; 5; 0.5)",
        "extrusion (path; profile; 0,0,1)",
        "revolution (0,0,0; 1,0,0; curve)",
        "polyhedron (0,0,0; 1,0,0; 0,1,0; 0,0,1;; 1,3,2; 1,4,3)",
    ],
)
def test_other_surfaces_are_refused_by_name(construct: str) -> None:
    name = construct.split()[0]
    with pytest.raises(UnsupportedError) as caught:
        loads(
            f"# first\nalgebraic3d\nsolid a = sphere (0,0,0; 1)\n  or {construct};\n",
            "geo",
            path="x.geo",
        )
    assert str(caught.value).startswith(f"x.geo:4:6: {name} (in solid 'a') is not supported")


WRONG = {
    "no header": ("solid a = sphere (0,0,0; 1); tlo a;", 1, 1, "no 'algebraic3d'"),
    "empty": ("# nothing\n", 1, 10, "no 'algebraic3d'"),
    "no tlo": ("algebraic3d\nsolid a = sphere (0,0,0; 1);", 2, 29, "names no solid"),
    "undefined": ("algebraic3d\nsolid a = b and b;", 2, 11, "'b' is not defined"),
    "undefined tlo": ("algebraic3d\ntlo a;", 2, 5, "'a' is not defined"),
    "undefined patch": (
        "algebraic3d\nsolid a = sphere (0,0,0; 1);\ntlo a top;",
        3,
        7,
        "'top' is not defined",
    ),
    "self-reference": ("algebraic3d\nsolid a = not a;", 2, 15, "'a' refers to itself"),
    "cycle": (
        "algebraic3d\nsolid a = not b;\nsolid b = not a;\n",
        2,
        15,
        "'b' is used here, but defined only in line 3",
    ),
    "redefined": (
        "algebraic3d\nsolid a = sphere (0,0,0; 1);\nsolid a = sphere (0,0,0; 2);",
        3,
        7,
        "defined in line 2, and with another body in line 3",
    ),
    "two tlos": (
        "algebraic3d\nsolid a = sphere (0,0,0; 1);\ntlo a;tlo a -maxh=1;",
        3,
        11,
        "a tlo in line 3, and with other flags",
    ),
    "negative radius": (
        "algebraic3d\nsolid a = sphere (0,0,0; -1);",
        2,
        11,
        "sphere radius must be positive, got -1 (in solid 'a')",
    ),
    "zero normal": ("algebraic3d\nsolid a = plane (0,0,0; 0,0,0);", 2, 11, "zero vector"),
    "zero axis": ("algebraic3d\nsolid a = cylinder (1,0,0; 1,0,0; 1);", 2, 11, "zero vector"),
    "flat brick": ("algebraic3d\nsolid a = orthobrick (0,0,0; 1,1,0);", 2, 11, "is not along z"),
    "spindle": ("algebraic3d\nsolid a = torus (0,0,0; 0,0,1; 1; 2);", 2, 11, "spindle torus"),
    "overflow": ("algebraic3d\nsolid a = sphere (0,0,1e999; 1);", 2, 11, "must be finite"),
    "nan": ("algebraic3d\nsolid a = sphere (0,0,nan; 1);", 2, 22, "',' does not belong here"),
    "two numbers": ("algebraic3d\nsolid a = sphere (0,0; 1);", 2, 11, "expected lists of 3; 1"),
    "half a copy": (
        "algebraic3d\nsolid a = multitranslate (1,0,0; 1.5; sphere (0,0,0; 1));",
        2,
        11,
        "whole number of copies",
    ),
    "endless copies": (
        "algebraic3d\nsolid a = multitranslate (1,0,0; 1e300; sphere (0,0,0; 1));",
        2,
        11,
        "whole number of copies",
    ),
    "no semicolon": (
        "algebraic3d\nsolid a = sphere (0,0,0; 1)\ntlo a;",
        3,
        1,
        "'tlo' does not belong here; expected 'and', 'or', a flag such as -maxh=0.5 or ';'",
    ),
    "open parenthesis": (
        "algebraic3d\nsolid a = (sphere (0,0,0; 1);",
        2,
        29,
        "';' does not belong here; expected ')'",
    ),
    "cut short": (
        "algebraic3d\nsolid a = sphere (0,0",
        2,
        22,
        "the file ends here; expected ')' or ';'",
    ),
    "keyword as name": ("algebraic3d\nsolid point = p;", 2, 7, "expected a name"),
    "misspelt": ("algebraic3d\nsold a = b;", 2, 1, "'sold' starts no statement"),
    "stray sign": ("algebraic3d\nsolid a = $;", 2, 11, "'$' does not belong here; expected"),
    "two flag values": (
        "algebraic3d\nsolid a = sphere (0,0,0; 1) -bc=1,2;",
        2,
        33,
        "-bc takes one number",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_files(case: str) -> None:
    text, line, column, message = WRONG[case]
    with pytest.raises(ParseError) as caught:
        loads(text, "geo")
    assert message in caught.value.message
    assert (caught.value.line, caught.value.column) == (line, column)


def test_only_surface_patches_are_no_model() -> None:
    with pytest.raises(FileError, match="names no solid"):
        read("solid s = sphere (0,0,0; 1);\ntlo s s;")


BRICK = "orthobrick (0, 0, 0; 2, 2, 2)"


@pytest.mark.parametrize(
    "again",
    [
        "solid p = plane (0, 0, 1; 0, 0, 1);",
        "solid p=plane(0,0,1;0,0,1);",
        "solid p = # the same\n plane ( 0, # once more\n 0.0, 1.; 0,0,1e0 ) ;",
    ],
)
def test_defined_again_with_the_same_body(again: str) -> None:
    """As Netgen reads it, whatever the blanks, comments and digits."""
    first = "solid p = plane (0, 0, 1; 0, 0, 1);\n"
    rest = f"solid a = {BRICK} and p;\n{again}\nsolid b = {BRICK} and p;\ntlo a;\n"
    once = loads("algebraic3d\n" + first + rest.replace(again, ""), "geo")
    twice = loads("algebraic3d\n" + first + rest, "geo")
    assert dumps(twice) == dumps(once)


@pytest.mark.parametrize(
    "again",
    [
        "plane (0, 0, 1; 0, 0, -1)",
        "plane (0, 0, 1; 0, 0, 1) -bc=1",
        "not plane (0, 0, 1; 0, 0, 1)",
        "p",
    ],
)
def test_defined_again_with_another_body(again: str) -> None:
    text = f"algebraic3d\nsolid p = plane (0, 0, 1; 0, 0, 1);\n\n\nsolid p = {again};\n"
    with pytest.raises(ParseError, match=r"^5:7: .*in line 2, and with another body in line 5"):
        loads(text, "geo")


def test_tlo_twice() -> None:
    model = loads(f"algebraic3d\nsolid a = {BRICK};\ntlo a -maxh=1;\ntlo a -maxh=1.0;\n", "geo")
    assert [region.name for region in model.regions] == ["a"]
    assert [str(each) for each in model.ignored] == ["line 4: tlo a -maxh=1.0"]


@pytest.mark.parametrize("word", ["tube", "cylinder", "solid", "or", "point", "gencyl", "tlo"])
@pytest.mark.parametrize(
    "text",
    ["solid {} = sphere (0,0,0; 1);", "tlo {};", "solid a = sphere (0,0,0; 1) -material={};"],
)
def test_words_of_the_format_are_no_names(word: str, text: str) -> None:
    with pytest.raises(ParseError, match=f"'{word}' is a word of the format"):
        loads("algebraic3d\n" + text.format(word), "geo")


@pytest.mark.parametrize("text", ["tlo a;", "tlo a -maxh=1;\ntlo b;", "", "point (1, 0, 0);"])
def test_no_solid_at_all(text: str) -> None:
    with pytest.raises(ParseError, match="defines no solid"):
        loads("algebraic3d\n" + text, "geo")
