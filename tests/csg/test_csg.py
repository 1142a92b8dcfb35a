"""Models in Python: constructors that check, names, copies, transforms, deep trees."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import FrozenInstanceError
from math import inf, nan, pi
from typing import Any

import numpy as np
import pytest

from decomp import (
    Block,
    Cone,
    Cylinder,
    Geometry,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    Model,
    Region,
    Solid,
    Sphere,
    Torus,
    carriers,
    union,
)
from decomp.csg.halfspaces import half_space_form
from decomp.csg.model import model
from decomp.errors import InputError

BLOCK = Block((0, 0, 0), (1, 1, 1))

BAD_INPUT: dict[str, tuple[Callable[[], object], str]] = {
    "NaN centre": (lambda: Sphere((nan, 0, 0), 1), "sphere centre must be finite"),
    "infinite corner": (lambda: Block((0, inf, 0), (1, 1, 1)), "block corner must be finite"),
    "two coordinates": (lambda: Sphere((0, 0), 1), "three numbers"),
    "text": (lambda: Sphere("abc", 1), "three numbers"),
    "zero radius": (lambda: Sphere((0, 0, 0), 0), "sphere radius must be positive, got 0"),
    "negative radius": (lambda: Cylinder((0, 0, 0), (0, 0, 1), -2), "must be positive, got -2"),
    "infinite radius": (lambda: Sphere((0, 0, 0), inf), "must be finite, got inf"),
    "flat block": (lambda: Block((0, 0, 0), (1, 0, 1)), "positive along each axis"),
    "cylinder without height": (lambda: Cylinder((1, 1, 1), (1, 1, 1), 1), "zero vector"),
    "zero normal": (lambda: HalfSpace((0, 0, 0), (0, 0, 0)), "plane normal"),
    "cone that is a cylinder": (lambda: Cone((0, 0, 0), 1, (0, 0, 1), 1), "that is a cylinder"),
    "cone without radius": (lambda: Cone((0, 0, 0), 0, (0, 0, 1), 0), "both are zero"),
    "cone with negative radius": (lambda: Cone((0, 0, 0), -1, (0, 0, 1), 1), "not be negative"),
    "cone too wide": (lambda: InfiniteCone((0, 0, 0), (0, 0, 1), 90), "between 0 and 90"),
    "horn torus": (lambda: Torus((0, 0, 0), (0, 0, 1), 1, 1), "a horn torus"),
    "spindle torus": (lambda: Torus((0, 0, 0), (0, 0, 1), 1, 2), "a spindle torus"),
    "zero scale": (lambda: BLOCK.scale(0), "scale factor must be positive"),
    "zero mirror": (lambda: BLOCK.mirror((0, 0, 0)), "mirror normal"),
    "uneven scale": (lambda: BLOCK.transform(np.diag([1, 2, 1, 1])), "not a similarity"),
    "shear": (lambda: BLOCK.transform([[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]), "shears"),
    "flattening": (lambda: BLOCK.transform(np.diag([1, 1, 0, 1])), "determinant is 0"),
    "no copies": (lambda: BLOCK.linear_copies((1, 0, 0), 0), "above zero, got 0"),
    "half a copy": (lambda: BLOCK.polar_copies((0, 0, 1), 2.5), "whole number"),  # type: ignore[arg-type]
    "empty name": (lambda: BLOCK.named(""), "cannot be a name"),
    "name with a dot": (lambda: Sphere((0, 0, 0), 1, name="a.b"), "cannot be a name"),
    "no region": (lambda: Model(()), "has no region"),
    "same names": (lambda: Model((Region("a", BLOCK), Region("a", BLOCK))), "2 regions are named"),
    "not a solid": (lambda: BLOCK | 3, "which is none"),  # type: ignore[operator]
}


@pytest.mark.parametrize("name", BAD_INPUT)
def test_bad_input_is_refused_with_the_value(name: str) -> None:
    make, message = BAD_INPUT[name]
    with pytest.raises(InputError) as caught:
        make()
    assert message in str(caught.value)


def test_names_survive_to_the_faces() -> None:
    plate = Block((0, 0, 0), (4, 4, 2), name="plate")
    hole = Cylinder((1, 1, -1), (1, 1, 3), 0.2, name="hole").linear_copies((1, 0, 0), 2)
    names = [f.name for f in Geometry((plate - hole).named("part")).regions[0].faces]
    assert names == [
        "part.plate.xmin",
        "part.plate.xmax",
        "part.plate.ymin",
        "part.plate.ymax",
        "part.plate.zmin",
        "part.plate.zmax",
        "part.hole#1.side",
        "part.hole#2.side",
    ]


def test_a_face_cut_in_two_gets_two_names() -> None:
    slot = Block((1, -1, 1), (1, 6, 2), name="slot")
    region = Geometry(Block((0, 0, 0), (4, 4, 2), name="plate") - slot).regions[0]
    names = [f.name for f in region.faces if f.name.startswith("plate.zmax")]
    assert names == ["plate.zmax", "plate.zmax@2"]


def test_unnamed_primitives_are_numbered_by_kind() -> None:
    region = Geometry(BLOCK - Sphere((0, 0, 0), 0.3) - Sphere((1, 1, 1), 0.3)).regions[0]
    assert {f.name for f in region.faces} >= {"block1.xmin", "sphere1.surface", "sphere2.surface"}


WRONG = [
    ({"maxH": 1}, "unknown option 'maxH'"),
    ({"material": "tin"}, "'material', which is an option of regions"),
    *(
        ({"maxh": value}, f"option maxh of solid 'x' must be a length above zero, got {value!r}")
        for value in (-1, 0, None, float("nan"), float("inf"), True, "1", [1], 10**400)
    ),
    *(({"bc": value}, "must be a whole number") for value in (1.5, "1", True, None, float("nan"))),
    *(({"bcname": value}, "must be a text") for value in ("", 1, None)),
]


@pytest.mark.parametrize(("options", "said"), WRONG)
def test_wrong_options_are_refused(options: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as caught:
        BLOCK.named("x", **options)
    assert said[:60] in str(caught.value)
    exist = "; there are maxh (a length above zero), bc (a whole number), bcname (a text)"
    assert str(caught.value).endswith(exist)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"maxH": 1}, "region 'x' has an unknown option 'maxH'; there are maxh "),
        ({"bcname": "a"}, "'bcname', which is an option of faces"),
        ({"maxh": -1}, "option maxh of region 'x' must be a length above zero, got -1"),
        ({"col": (1, 2)}, "must be three numbers, got (1, 2)"),
        ({"col": "red"}, "must be three numbers, got 'red'"),
        ({"transparent": 1}, "must be True or False"),
        ({"layer": 1.5}, "must be a whole number"),
        (5, "must have options by name, got 5"),
    ],
)
def test_wrong_options_of_regions_are_refused(options: Any, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        Region("x", BLOCK, options)


def test_options_become_plain_and_read_only() -> None:
    given = {"maxh": np.float64(4), "bc": np.int32(2)}
    solid = BLOCK.named("x", **given)
    assert dict(solid.options) == {"maxh": 4.0, "bc": 2}
    assert [type(value) for value in solid.options.values()] == [float, int]
    mine: dict[str, Any] = {"maxh": 1, "material": "tin", "col": np.array([1, 0, 0])}
    region = Region("x", BLOCK, mine)
    mine["maxh"] = 2
    assert dict(region.options) == {"maxh": 1, "material": "tin", "col": (1, 0, 0)}
    with pytest.raises(TypeError):
        region.options["maxh"] = 3  # type: ignore[index]


def test_options_reach_the_faces_and_inner_ones_win() -> None:
    hole = Cylinder((0.5, 0.5, -1), (0.5, 0.5, 2), 0.2, name="hole").named("inner", bc=3)
    region = Geometry((BLOCK - hole).named("outer", bc=1, maxh=0.1)).regions[0]
    options = {f.name: dict(f.options) for f in region.faces}
    assert options["outer.block1.xmin"] == {"bc": 1, "maxh": 0.1}
    assert options["outer.inner.hole.side"] == {"bc": 3, "maxh": 0.1}


def test_polar_copies_share_out_a_full_turn_and_span_a_part() -> None:
    ball = Sphere((2, 0, 0), 0.1)
    full = half_space_form(model(ball.polar_copies((0, 0, 1), 4)))
    half = half_space_form(model(ball.polar_copies((0, 0, 1), 3, 180)))
    centres = np.array([[2, 0, 0], [0, 2, 0], [-2, 0, 0], [0, -2, 0]])
    assert full.regions_at(centres)[:, 0].tolist() == [True] * 4
    assert half.regions_at(centres)[:, 0].tolist() == [True, True, True, False]


@pytest.mark.parametrize(
    "solid",
    [
        Cylinder((0, 0, 0), (0, 0, 2), 1),
        InfiniteCylinder((0, 0, 0), (0, 0, 2), 1) & Block((-2, -2, 0), (4, 4, 2)),
        Block((-2, -2, 0), (4, 4, 2))
        - (Block((-2, -2, 0), (4, 4, 2)) - Cylinder((0, 0, -1), (0, 0, 3), 1)),
    ],
)
def test_ways_to_say_the_same_agree(solid: Solid) -> None:
    region = Geometry(solid).regions[0]
    assert region.volume == pytest.approx(2 * pi)
    assert region.area == pytest.approx(6 * pi)
    assert len(region.faces) == 3


def test_primitives_cannot_be_changed() -> None:
    with pytest.raises(FrozenInstanceError):
        Sphere((0, 0, 0), 1).radius = 2  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        Sphere((0, 0, 0), 1).centre[0] = 2


def test_bounds_are_exact() -> None:
    tilted = Torus((1, 2, 3), (1, 1, 0.5), 2, 0.5)
    low, high = Geometry(tilted).regions[0].bounds
    axis = np.array([1, 1, 0.5]) / 1.5
    reach = 2 * np.sqrt(1 - axis**2) + 0.5
    assert np.allclose(low, np.array([1, 2, 3]) - reach, atol=1e-12)
    assert np.allclose(high, np.array([1, 2, 3]) + reach, atol=1e-12)


def test_a_cone_reaches_to_its_apex() -> None:
    low, high = Geometry(Cone((0, 0, 0), 1, (0, 0, 2))).regions[0].bounds
    assert np.allclose(low, [-1, -1, 0])
    assert np.allclose(high, [1, 1, 2])


@pytest.mark.parametrize("kind", ["cylinder", "cone", "torus"])
def test_feet_of_points_on_a_skew_axis_lie_on_the_carrier(kind: str) -> None:
    """There the direction away from the axis is rounding error."""
    axis = np.array([1.0, 2.0, -0.7]) / np.sqrt(5.49)
    start = np.array([0.3, -0.2, 0.1])
    carrier = {
        "cylinder": carriers.Cylinder(start, axis, 0.4),
        "cone": carriers.Cone(start, axis, 0.3),
        "torus": carriers.Torus(start, axis, 1.0, 0.4),
    }[kind]
    points = start + np.linspace(0.1, 3, 200)[:, None] * axis
    feet = carrier.foot(points)
    assert np.abs(carrier.signed_distance(feet)).max() <= 1e-14
    gaps = np.linalg.norm(points - feet, axis=1) - np.abs(carrier.signed_distance(points))
    assert np.abs(gaps).max() <= 1e-14


DEEP = 10_000


def test_deep_trees_need_no_recursion() -> None:
    left: Solid = BLOCK
    right: Solid = BLOCK
    moved: Solid = BLOCK
    for k in range(DEEP):
        step = Block((k / DEEP, 0, 0), (1, 1, 1))
        left = left | step
        right = step | right
        moved = (moved if k % 2 else ~moved).translate((1e-4, 0, 0))
    for solid in (left, right):
        form = half_space_form(model(solid))
        inside = form.regions_at(np.array([[1.5, 0.5, 0.5], [2.5, 0.5, 0.5]]))
        assert inside[:, 0].tolist() == [True, False]
    form = half_space_form(model(moved))
    assert form.regions_at(np.array([[1.5, 0.5, 0.5]])).tolist() == [[True]]


def test_a_solid_used_exponentially_often_is_expanded_once() -> None:
    solid: Solid = BLOCK
    for _ in range(100):
        solid = (solid | solid) & solid
    assert len(half_space_form(model(solid)).carriers) == 6


def test_many_parts_in_one_union() -> None:
    balls = union([Sphere((3 * k, 0, 0), 1) for k in range(300)])
    region = Geometry(balls).regions[0]
    assert region.volume == pytest.approx(300 * 4 / 3 * pi)
    assert region.euler == 300


def test_nearly_equal_carriers_stay_apart() -> None:
    """Above the tolerance nothing is merged, however small the step."""
    step = Cylinder((0, 0, 0), (0, 0, 1), 1, name="a") | Cylinder(
        (0, 0, 0.5), (0, 0, 2), 1.0000001, name="b"
    )
    region = Geometry(step).regions[0]
    assert len(region.faces) == 5
    assert region.volume == pytest.approx(pi * (0.5 + 1.5 * 1.0000001**2), rel=1e-12)


def test_carriers_that_differ_by_rounding_are_one() -> None:
    turned = Block((-1, -1, -1), (2, 2, 2)).rotate((1, 2, 3), 77).rotate((1, 2, 3), -77)
    region = Geometry(Block((-1, -1, -1), (2, 2, 2)) | turned).regions[0]
    assert len(region.faces) == 6
    assert region.volume == pytest.approx(8, rel=1e-12)
