"""Degenerate positions: coincident faces, tangency, contact along lines and at points.

They are normal input, and a region that touches itself says what touches what and has no skeleton.
"""

from __future__ import annotations

import json
from math import pi
from pathlib import Path

import pytest

from decomp import (
    Block,
    Cone,
    Cylinder,
    Geometry,
    HalfSpace,
    InfiniteCylinder,
    RegionBoundary,
    Solid,
    Sphere,
    Torus,
    skeleton,
)
from decomp.cli.main import main
from decomp.errors import ContactError, EmptyRegionError, OverlapError, UnboundedRegionError

CUBE = Block((-1, -1, -1), (2, 2, 2), name="cube")


def only(solid: Solid) -> RegionBoundary:
    return Geometry(solid).regions[0]


RESOLVED = {
    "ball inscribed in a cube": (CUBE & Sphere((0, 0, 0), 1), 4 / 3 * pi, 1, 0),
    "cylinder inscribed in a cube": (
        CUBE & InfiniteCylinder((0, 0, 0), (0, 0, 1), 1),
        2 * pi,
        3,
        2,
    ),
    "torus inscribed in a slab": (
        Torus((0, 0, 0), (0, 0, 1), 2, 1) & Block((-4, -4, -1), (8, 8, 2)),
        4 * pi**2,
        1,
        0,
    ),
    "ball inscribed in a cylinder": (
        Cylinder((0, 0, -2), (0, 0, 2), 1) & Sphere((0, 0, 0), 1),
        4 / 3 * pi,
        1,
        0,
    ),
    "blocks side by side": (CUBE | Block((1, -1, -1), (3, 2, 2)), 20, 6, 12),
    "blocks overlapping with flush sides": (CUBE | Block((0, -1, -1), (3, 2, 2)), 16, 6, 12),
    "smaller block on top": (CUBE | Block((-0.5, -0.5, 1), (1, 1, 1)), 9, 11, 24),
    "tool flush with a face": (CUBE - Block((0, -2, -2), (1, 4, 4)), 4, 6, 12),
    "hole flush with both ends": (CUBE - Cylinder((0, 0, -1), (0, 0, 1), 0.5), 8 - pi / 2, 7, 14),
    "plug that fills its hole": (
        (CUBE - Cylinder((0, 0, -2), (0, 0, 2), 0.5)) | Cylinder((0, 0, -1), (0, 0, 1), 0.5),
        8,
        6,
        12,
    ),
    "same solid twice": (CUBE | CUBE.translate((0, 0, 0)), 8, 6, 12),
    "cut through a corner point": (CUBE & HalfSpace((1, 1, 1), (1, 1, 1)), 8, 6, 12),
    "cut through an edge": (CUBE & HalfSpace((1, 1, 0), (1, 1, 0)), 8, 6, 12),
    "cut through a diagonal": (CUBE & HalfSpace((0, 0, 0), (1, -1, 0)), 4, 5, 9),
    "cut through three corners": (
        CUBE & HalfSpace((1, 1, -1), (1, 1, 1)),
        8 - 8 / 6,
        7,
        12,
    ),
    "cone cut at its apex": (
        Cone((0, 0, 0), 1, (0, 0, 2)) & HalfSpace((0, 0, 2), (0, 0, 1)),
        2 * pi / 3,
        2,
        1,
    ),
    "half cone": (Cone((0, 0, 0), 1, (0, 0, 2)) & HalfSpace((0, 0, 0), (1, 0, 0)), pi / 3, 3, 4),
    "cone touched by a plane along a ruling": (
        Cone((0, 0, 0), 1, (0, 0, 1)) & HalfSpace((0, 0, 1), (1, 0, 1)),
        pi / 3,
        2,
        1,
    ),
    "quarter of a cylinder": (
        Cylinder((0, 0, 0), (0, 0, 1), 1)
        & HalfSpace((0, 0, 0), (1, 0, 0))
        & HalfSpace((0, 0, 0), (0, 1, 0)),
        pi / 4,
        5,
        9,
    ),
    "half cylinder on its tangent plane": (
        Block((-2, 0, -1), (4, 1, 2)) | InfiniteCylinder((0, 0, 0), (0, 0, 1), 1) & CUBE,
        8 + pi,
        8,
        18,
    ),
    "ball cap flush with a cylinder": (
        Cylinder((0, 0, 0), (0, 0, 2), 1) | Sphere((0, 0, 2), 1),
        2 * pi + 2 / 3 * pi,
        3,
        2,
    ),
    "equal cylinders crossing": (
        InfiniteCylinder((0, 0, 0), (1, 0, 0), 1) & InfiniteCylinder((0, 0, 0), (0, 1, 0), 1),
        16 / 3,
        4,
        4,
    ),
    "three equal cylinders crossing": (
        InfiniteCylinder((0, 0, 0), (1, 0, 0), 1)
        & InfiniteCylinder((0, 0, 0), (0, 1, 0), 1)
        & InfiniteCylinder((0, 0, 0), (0, 0, 1), 1),
        8 * (2 - 2**0.5),
        12,
        24,
    ),
}

TOUCHING = {
    "log on a table": (CUBE | Cylinder((-2, 0, 2), (2, 0, 2), 1, name="log"), 8 + 4 * pi, 2),
    "bore tangent to a face": (
        CUBE - InfiniteCylinder((0, 0, 0.5), (1, 0, 0), 0.5, name="bore"),
        8 - pi / 2,
        1,
    ),
    "ball on a table": (CUBE | Sphere((0, 0, 2), 1, name="ball"), 8 + 4 / 3 * pi, 2),
    "bubble that touches a face": (
        CUBE - Sphere((0, 0, 0.5), 0.5, name="bubble"),
        8 - pi / 6,
        2,
    ),
    "two balls": (
        Sphere((0, 0, 0), 1, name="one") | Sphere((2, 0, 0), 1, name="two"),
        8 / 3 * pi,
        2,
    ),
    "cubes that share an edge": (CUBE | Block((1, 1, -1), (2, 2, 2), name="other"), 16, 2),
    "cubes that share a corner": (CUBE | Block((1, 1, 1), (2, 2, 2), name="other"), 16, 2),
    "cone on its tip": (
        CUBE | Cone((0, 0, 1), 0, (0, 0, 2), 0.5, name="top"),
        8 + pi / 12,
        2,
    ),
    "hourglass": (
        Cone((0, 0, -1), 1, (0, 0, 0)) | Cone((0, 0, 0), 0, (0, 0, 1), 1),
        2 / 3 * pi,
        2,
    ),
    "parallel cylinders that touch": (
        Cylinder((0, 0, 0), (0, 0, 1), 1, name="one")
        | Cylinder((2, 0, 0), (2, 0, 1), 1, name="two"),
        2 * pi,
        2,
    ),
    "ring on a table": (
        Block((-4, -4, -2), (8, 8, 1)) | Torus((0, 0, 0), (0, 0, 1), 2, 1),
        64 + 4 * pi**2,
        1,
    ),
    "ball with a bore through its equator": (
        Sphere((0, 0, 0), 2) - InfiniteCylinder((1, 0, 0), (0, 0, 1), 1),
        32 / 3 * pi - 9.644049708034453,
        1,
    ),
    "three cubes around an edge": (
        Block((0, 0, 0), (1, 1, 1)) | Block((1, 1, 0), (1, 1, 1)) | Block((1, 1, 1), (1, 1, 1)),
        3,
        2,
    ),
}
"""Solids that touch themselves, with their volume, and the Euler characteristic of their inside."""


@pytest.mark.parametrize("name", RESOLVED)
def test_degenerate_positions_are_resolved(name: str) -> None:
    solid, volume, faces, edges = RESOLVED[name]
    region = only(solid)
    assert region.volume == pytest.approx(volume, rel=1e-11)
    assert len(region.faces) == faces
    assert len(region.edges) == edges


@pytest.mark.parametrize("name", TOUCHING)
def test_solids_that_touch_themselves_have_a_boundary(name: str) -> None:
    solid, volume, euler = TOUCHING[name]
    region = only(solid)
    assert region.volume == pytest.approx(volume, rel=1e-11)
    assert region.euler == euler
    assert region.touches
    assert all("touches itself" in said for said in region.touches)


@pytest.mark.parametrize("name", TOUCHING)
def test_they_have_no_skeleton(name: str) -> None:
    geometry = Geometry(TOUCHING[name][0])
    with pytest.raises(ContactError) as caught:
        skeleton(geometry)
    assert str(caught.value) == geometry.regions[0].touches[0]


def test_points_beside_a_contact_are_asked() -> None:
    """Above, below and beside the line in which a bore touches the top of a cube."""
    geometry = Geometry(TOUCHING["bore tangent to a face"][0])
    points = [(0.0, 0.4, 0.95), (0.0, -0.4, 0.95), (0.0, 0.0, 0.5), (0.0, 0.01, 1.01)]
    assert geometry.region_of(points).tolist() == [0, 0, -1, -1]
    near = geometry.nearest(points)
    assert near.distance.tolist() == pytest.approx([0.05, 0.05, 0.5, 0.01], rel=1e-12)


def test_a_contact_names_the_faces_and_the_place() -> None:
    said = only(TOUCHING["bore tangent to a face"][0]).touches[0]
    for part in ("bore.side", "cube.zmax", "near (", "1)"):
        assert part in said


def test_info_tells_of_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "kiss.geo"
    path.write_text(
        "algebraic3d\nsolid kiss = sphere (0,0,0; 1) or sphere (2,0,0; 1);\ntlo kiss;\n"
    )
    assert main(["info", str(path)]) == 0
    assert "no skeleton: region 'kiss' touches itself at the point (1, 0, 0)" in (
        capsys.readouterr().out
    )
    assert main(["info", str(path), "--json"]) == 0
    (said,) = json.loads(capsys.readouterr().out)["regions"][0]["touches"]
    assert "touches itself" in said


def test_tangent_carriers_are_known() -> None:
    for name, kinds in (("two balls", ["sphere"] * 2), ("log on a table", ["cylinder", "plane"])):
        geometry = Geometry(TOUCHING[name][0])
        carriers = geometry.regions[0].carriers
        (pair,) = geometry.boundaries.tangent
        assert sorted(carriers[k].kind for k in pair) == kinds


def test_touching_regions_are_no_overlap() -> None:
    ball = Sphere((0, 0, 0), 0.5)
    found = Geometry({"shell": CUBE - ball, "core": ball})
    assert sum(region.volume for region in found.regions) == pytest.approx(8)


def test_regions_know_which_others_they_touch() -> None:
    ball = Sphere((0, 0, 0), 0.5)
    beside = Block((1, -0.5, -0.5), (1, 1, 1))
    apart = Block((3, 0, 0), (1, 1, 1))
    at_an_edge = Block((1, 1, -1), (1, 1, 2))
    found = Geometry(
        {"cube": CUBE - ball, "core": ball, "beside": beside, "apart": apart, "edge": at_an_edge}
    )
    assert found.boundaries.touching == ((0, 1), (0, 2))


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (CUBE, CUBE.translate((0.5, 0.3, 0.1))),
        (CUBE, Sphere((0, 0, 0), 0.5)),
        (Sphere((0, 0, 0), 0.5), CUBE),
        (Sphere((0, 0, 0), 1), Sphere((0, 0, 0), 1)),
        (Sphere((0, 0, 0), 1), Sphere((1.9, 0, 0), 1)),
        (CUBE, CUBE),
        (Torus((0, 0, 0), (0, 0, 1), 2, 0.5), CUBE.translate((0.7, 0, 0))),
    ],
)
def test_an_overlap_names_both_regions_and_a_common_point(first: Solid, second: Solid) -> None:
    with pytest.raises(OverlapError) as caught:
        Geometry({"first": first, "second": second})
    message = str(caught.value)
    assert "'first'" in message
    assert "'second'" in message
    point = [float(x) for x in message.split("point (")[1].split(")")[0].split(",")]
    for solid in (first, second):
        assert Geometry(solid).contains([point])[0]


@pytest.mark.parametrize(
    ("solid", "direction"),
    [
        (HalfSpace((0, 0, 0), (0, 0, 1)), None),
        (InfiniteCylinder((0, 0, 0), (0, 0, 1), 1), (0, 0, 1)),
        (
            InfiniteCylinder((0, 0, 0), (0, 0, 1), 1) & HalfSpace((0, 0, 0), (0, 0, 1)),
            (0, 0, -1),
        ),
        (~Sphere((0, 0, 0), 1), None),
        (CUBE | ~CUBE, None),
        (
            HalfSpace((0, 0, 0), (-1, 0, 0)) & HalfSpace((1, 0, 0), (1, 0, 0)),
            None,
        ),
    ],
)
def test_an_unbounded_region_names_a_direction(
    solid: Solid, direction: tuple[float, float, float] | None
) -> None:
    with pytest.raises(UnboundedRegionError, match="reaches infinity in direction") as caught:
        only(solid)
    if direction:
        text = str(caught.value).split("direction (")[1].split(")")[0]
        found = [float(x) for x in text.split(",")]
        assert found == pytest.approx(direction, abs=0.01)


@pytest.mark.parametrize(
    "solid",
    [
        CUBE - CUBE,
        CUBE & ~CUBE,
        CUBE & Sphere((9, 0, 0), 1),
        CUBE & Block((1, -1, -1), (2, 2, 2)),
        CUBE - Block((-2, -2, -2), (4, 4, 4)),
    ],
)
def test_an_empty_region_says_so(solid: Solid) -> None:
    with pytest.raises(EmptyRegionError, match="region 'solid' is empty"):
        only(solid)
