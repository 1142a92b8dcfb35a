"""Small parts in wide air: the air's end is brought near, and what lies between is swept."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.csg.solid import Solid
from decomp.meshes.model import GroupKind
from decomp.meshes.quality import volumes
from decomp.meshing.far.nearer import Nearer, brought_near
from decomp.meshing.sizing.sizes import Wanted

PART = decomp.Block((-0.5, -0.5, -0.5), (1, 1, 1), name="part")
BOX = decomp.Block((-60, -50, -55), (110, 110, 120), name="end")
BALL = decomp.Sphere((3, 0, 0), 60, name="end")


def near(end: Solid, wanted: Wanted | None = None, part: Solid = PART) -> Nearer | None:
    exact = decomp.Geometry({"part": part, "air": end - part})
    return brought_near(exact, wanted or Wanted())


@pytest.mark.parametrize(
    ("end", "volume"), [(BOX, 110 * 110 * 120), (BALL, 4 / 3 * pi * 60**3)], ids=["box", "ball"]
)
def test_nothing_but_the_end_changes(end: Solid, volume: float) -> None:
    found = near(end)
    assert found is not None
    assert found.centre == pytest.approx([0, 0, 0], abs=1e-12)
    assert found.geometry.regions[0].volume == pytest.approx(1, rel=1e-12)
    left = volume / found.factor**3 - 1
    assert found.geometry.regions[1].volume == pytest.approx(left, rel=1e-9)
    names = {face.name for face in found.geometry.regions[1].faces}
    assert names == {*found.faces, *(face.name for face in found.geometry.regions[0].faces)}


def test_an_end_of_half_spaces() -> None:
    ways = np.concatenate([np.eye(3), -np.eye(3)])
    end = decomp.intersection([decomp.HalfSpace(40 * way, way, name="end") for way in ways])
    found = near(end)
    assert found is not None
    assert found.geometry.regions[1].volume == pytest.approx((80 / found.factor) ** 3 - 1)


def test_the_end_stays_where_it_has_to() -> None:
    """Where it is near, of another kind, shared, moved with its parts, or finer than a sweep."""
    assert near(decomp.Block((-3, -3, -3), (6, 6, 6))) is None
    assert near(decomp.Cylinder((0, 0, -60), (0, 0, 60), 60)) is None
    assert near(BOX, Wanted(size=3)) is None
    assert near(decomp.Block((-60, -60, -60), (120, 120, 120)).rotate((0, 0, 1), 10)) is None
    assert near(BOX, part=decomp.Block((-60, -1, -1), (1, 1, 1))) is None
    ground = decomp.Block((-60, -60, -60), (120, 120, 60))
    sky = decomp.Block((-60, -60, 0), (120, 120, 60)) - PART
    assert brought_near(decomp.Geometry({"ground": ground - PART, "sky": sky}), Wanted()) is None


@pytest.mark.slow
@pytest.mark.parametrize("end", [BOX, BALL], ids=["box", "ball"])
def test_the_mesh_of_a_small_part(end: Solid) -> None:
    exact = decomp.Geometry({"part": PART, "air": end - PART})
    mesh = decomp.mesh(exact, cells="none", fields=["region"])
    found = check(exact, mesh)
    assert found.shortcomings == ()
    assert len(mesh.unprojected) == 0
    assert [g.name for g in mesh.groups if g.kind is GroupKind.REGION] == ["part", "air"]
    content = volumes(mesh.points, mesh.tets)
    for group, region in zip(mesh.groups, exact.regions, strict=False):
        assert group.volume == region.volume
        own = content[mesh.tet_tags == group.tag].sum()
        assert own == pytest.approx(region.volume, rel=5e-3)
        assert mesh.cell_data["region"][mesh.tet_tags == group.tag].tolist() == [
            group.tag - 1
        ] * int((mesh.tet_tags == group.tag).sum())
    asked = mesh.group("air", 3).length
    assert asked is not None
    edges = mesh.points[mesh.tets[:, [0, 1]]]
    assert np.linalg.norm(edges[:, 0] - edges[:, 1], axis=1).max() <= 1.5 * asked


@pytest.mark.slow
def test_a_part_far_from_the_middle_and_from_the_origin() -> None:
    part = decomp.Sphere((1030, 20, -10), 1, name="part")
    air = decomp.Block((950, -80, -80), (160, 160, 160), name="end") - part
    exact = decomp.Geometry({"part": part, "air": air})
    assert exact.local is not exact or brought_near(exact, Wanted()) is not None
    mesh = decomp.mesh(exact, cells="none")
    assert check(exact, mesh).shortcomings == ()
