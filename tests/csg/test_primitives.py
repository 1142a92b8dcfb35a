"""Primitives are what their descriptions say: faces, measures, places, units of angles."""

from __future__ import annotations

import re
from collections.abc import Callable
from math import pi, sqrt

import numpy as np
import pytest

import decomp
from decomp import Block, Cone, Cylinder, HalfSpace, InfiniteCone, InfiniteCylinder, Sphere, Torus
from decomp.csg.primitives import Primitive
from decomp.errors import InputError

BOX = Block((-9, -9, -9), (18, 18, 18), name="box")
SOLIDS = {
    "block": (Block((1, 2, 3), (4, 5, 6)), 4 * 5 * 6, (1, 2, 3), (5, 7, 9)),
    "block between": (Block.between((1, 2, 3), (4, 5, 6)), 27, (1, 2, 3), (4, 5, 6)),
    "sphere": (Sphere((1, 2, 3), 2), 4 / 3 * pi * 8, (-1, 0, 1), (3, 4, 5)),
    "cylinder": (Cylinder((1, 2, 3), (1, 2, 7), 2), pi * 4 * 4, (-1, 0, 3), (3, 4, 7)),
    "cone": (Cone((0, 0, 6), 2, (0, 0, 0)), pi * 4 * 6 / 3, (-2, -2, 0), (2, 2, 6)),
    "frustum": (Cone((0, 0, 0), 1, (0, 0, 3), 2), pi * (1 + 2 + 4), (-2, -2, 0), (2, 2, 3)),
    "torus": (Torus((0, 0, 1), (0, 0, 7), 3, 1), 2 * pi**2 * 3, (-4, -4, 0), (4, 4, 2)),
    "half-space": (HalfSpace((0, 0, 2), (0, 0, 5)) & BOX, 18 * 18 * 11, (-9, -9, -9), (9, 9, 2)),
    "infinite cylinder": (
        InfiniteCylinder((1, 0, 0), (0, 0, -3), 2) & BOX,
        pi * 4 * 18,
        (-1, -2, -9),
        (3, 2, 9),
    ),
    # a half-angle of 30 degrees: at 9 from the apex the radius is 9 / sqrt(3)
    "infinite cone": (
        InfiniteCone((0, 0, 0), (0, 0, 2), 30) & BOX,
        pi * 27 * 9 / 3,
        (-9 / sqrt(3), -9 / sqrt(3), 0),
        (9 / sqrt(3), 9 / sqrt(3), 9),
    ),
    # radius 1 at z = 0 and 2 at z = 3, so the apex is at z = -3
    "infinite cone through": (
        InfiniteCone.through((0, 0, 0), 1, (0, 0, 3), 2) & BOX,
        pi * 16 * 12 / 3,
        (-4, -4, -3),
        (4, 4, 9),
    ),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_measures(name: str) -> None:
    solid, volume, low, high = SOLIDS[name]
    region = decomp.Geometry(solid).regions[0]
    assert region.volume == pytest.approx(volume, rel=1e-9)
    assert region.bounds == pytest.approx(np.array([low, high]), abs=1e-9)


@pytest.mark.parametrize(
    "primitive",
    [
        Block((0, 0, 0), (1, 1, 1)),
        Sphere((0, 0, 0), 1),
        Cylinder((0, 0, 0), (0, 0, 1), 1),
        Cone((0, 0, 0), 1, (0, 0, 1), 2),
        Torus((0, 0, 0), (0, 0, 1), 2, 1),
        InfiniteCylinder((0, 0, 0), (0, 0, 1), 1),
        InfiniteCone((0, 0, 0), (0, 0, 1), 45),
    ],
    ids=lambda primitive: type(primitive).__name__,
)
def test_faces_are_those_of_the_description(primitive: Primitive) -> None:
    (told,) = re.findall(r"Faces?:((?:,?\s+`\w+`)+)\.", type(primitive).__doc__ or "")
    assert re.findall(r"\w+", told) == [name for name, _ in primitive.half_spaces()]


def test_a_pointed_cone_has_no_face_at_its_point() -> None:
    names = [face.name for face in decomp.Geometry(SOLIDS["cone"][0]).regions[0].faces]
    assert names == ["cone1.side", "cone1.base"]


def test_a_half_spaces_face_has_its_name() -> None:
    cut = HalfSpace((0, 0, 2), (0, 0, 1), name="lid")
    assert "lid" in [face.name for face in decomp.Geometry(cut & BOX).regions[0].faces]
    unnamed = decomp.Geometry(HalfSpace((0, 0, 2), (0, 0, 1)) & BOX)
    assert "plane1" in [face.name for face in unnamed.regions[0].faces]


def test_a_block_between_corners_is_named() -> None:
    block = Block.between((1, 2, 3), (4, 6, 8), name="part")
    assert isinstance(block, Block)
    assert (block.corner.tolist(), block.size.tolist()) == ([1, 2, 3], [3, 4, 5])
    assert block.name == "part"


SOLID = Block((0, 0, 0), (1, 1, 1))
REFUSED: dict[str, tuple[Callable[[], object], str]] = {
    "corners the wrong way round": (
        lambda: Block.between((0, 5, 0), (1, 2, 3)),
        r"block between \(0, 5, 0\) and \(1, 2, 3\): .* but is not along y",
    ),
    "a flat block": (lambda: Block.between((0, 0, 0), (0, 1, 0)), "is not along x, z"),
    "a size for a corner": (lambda: Block.between((5, 5, 5), (2, 2, 2)), "not along x, y, z"),
    "two numbers": (lambda: Block.between((0, 0), (1, 1, 1)), "low corner must be three numbers"),
    "an infinite corner": (
        lambda: Block.between((0, 0, 0), (1, 1, float("nan"))),
        "high corner must be finite",
    ),
    "a union of one": (lambda: decomp.union(SOLID), "union takes a list of solids"),  # type: ignore[arg-type]
    "a model of a number": (lambda: decomp.model(3), "a model is made of"),  # type: ignore[arg-type]
    "a model of unnamed solids": (lambda: decomp.model([SOLID]), "is no region"),  # type: ignore[list-item]
    "a model of a name": (lambda: decomp.model("x.geo"), "a model is made of"),  # type: ignore[arg-type]
    "a named number": (lambda: decomp.model({"a": 3}), "region 'a' must be a solid, got 3"),  # type: ignore[dict-item]
    "a name that is none": (lambda: decomp.model({3: SOLID}), "3 cannot be a name"),  # type: ignore[dict-item]
    "no tolerance": (lambda: decomp.skeleton(SOLID, tolerance=0), "must be positive, got 0"),
    "a coarse tolerance": (lambda: decomp.skeleton(SOLID, tolerance=2), "at most 0.1, got 2"),
    "a tolerance in words": (
        lambda: decomp.skeleton(SOLID, tolerance="fine"),  # type: ignore[arg-type]
        "tolerance must be a number",
    ),
    "no time": (lambda: decomp.mesh(SOLID, timeout=0), "timeout must be positive, got 0"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused(name: str) -> None:
    make, message = REFUSED[name]
    with pytest.raises(InputError, match=message):
        make()


def test_empty_and_whole_sets() -> None:
    with pytest.raises(decomp.DecompError, match="is empty"):
        decomp.Geometry(decomp.union([]))
    with pytest.raises(decomp.DecompError, match="is unbounded"):
        decomp.Geometry(decomp.intersection([]))
    assert decomp.Geometry(decomp.union([]) | SOLID).regions[0].volume == pytest.approx(1)
    assert decomp.Geometry(decomp.intersection([]) & SOLID).regions[0].volume == pytest.approx(1)
