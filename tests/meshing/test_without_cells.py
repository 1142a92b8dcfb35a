"""Meshes without cells: no skeleton is computed, and all else is as with one."""

from __future__ import annotations

from functools import cache
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.cli.main import main
from decomp.csg.solid import Solid
from decomp.errors import GeometryError, InputError
from decomp.meshes.model import GroupKind, TetMesh
from decomp.meshes.quality import inverted, volumes
from tests.meshing.meshes import geometry
from tests.solids import SOLIDS

QUICK = (
    *("block", "cylinder", "sphere", "through hole", "blind hole", "bracket"),
    *("bite in a corner", "slot", "two boxes"),
)
SLOW = ("cone", "torus", "equal tee", "half torus", "ball in a box")
EVERY = (*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW))


@pytest.fixture(autouse=True)
def no_skeleton(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever computes a skeleton fails."""

    def refuse(*_: Any) -> Any:
        raise GeometryError("the seam cannot be followed near (1, 2, 3)")

    monkeypatch.setattr("decomp.meshing.surface.surface.traced", refuse)
    monkeypatch.setattr("decomp.skeletons.compute.traced", refuse)


@cache
def bare(name: str, **options: Any) -> TetMesh:
    return decomp.mesh(geometry(name), cells="none", **options)


def sound(source: decomp.Geometry, mesh: TetMesh, volume_error: float = 5e-3) -> None:
    """The mesh passes its check, which knows of no skeleton either."""
    found = check(source, mesh, volume_error=volume_error, unprojected=len(mesh.unprojected))
    assert found.shortcomings == ()
    assert len(mesh.unprojected) <= 0.002 * len(mesh.points)


@pytest.mark.parametrize("name", EVERY)
def test_faces_and_regions_alone(name: str) -> None:
    mesh, exact = bare(name), geometry(name)
    sound(exact, mesh)
    assert [g.name for g in mesh.groups if g.dimension == 3] == [r.name for r in exact.regions]
    kinds = {group.kind for group in mesh.groups}
    assert kinds <= {GroupKind.REGION, GroupKind.FACE, GroupKind.INTERFACE}
    content = volumes(mesh.points, mesh.tets)
    for group, region in zip(mesh.groups, exact.regions, strict=False):
        own = content[mesh.tet_tags == group.tag].sum()
        assert own == pytest.approx(region.volume, rel=5e-3)
        assert group.volume == region.volume


def test_neighbours_share_their_interface() -> None:
    mesh = bare("two boxes")
    (between,) = (g for g in mesh.groups if g.kind is GroupKind.INTERFACE)
    assert between.name == "left/a.xmax|right/b.xmin"
    corners = mesh.points[mesh.triangles[mesh.triangle_tags == between.tag]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(normal, axis=1).sum() / 2 == pytest.approx(4, rel=1e-12)


def test_a_face_between_two_faces_of_one_neighbour() -> None:
    """A slab under a region of two posts: each interface is where its post stands."""
    slab = decomp.Block((0, 0, 0), (6, 2, 1), name="slab")
    posts = decomp.Block((0, 0, 1), (2, 2, 1), name="left") | decomp.Block(
        (4, 0, 1), (2, 2, 1), name="right"
    )
    exact = decomp.Geometry({"slab": slab, "posts": posts})
    mesh = decomp.mesh(exact, size=0.7, cells="none")
    sound(exact, mesh)
    for name, low, high in (("left", 0, 2), ("right", 4, 6)):
        group = mesh.group(f"slab/slab.zmax|posts/{name}.zmin", 2)
        across = mesh.points[mesh.triangles[mesh.triangle_tags == group.tag]][..., 0]
        assert (across.min(), across.max()) == (low, high)


def test_a_region_that_touches_itself() -> None:
    """Along an edge, where both blocks share nodes and nothing else."""
    solid = decomp.Block((0, 0, 0), (1, 1, 1)) | decomp.Block((1, 1, 0), (1, 1, 1))
    exact = decomp.Geometry(solid)
    mesh = decomp.mesh(exact, size=0.4, cells="none")
    sound(exact, mesh)
    assert volumes(mesh.points, mesh.tets).sum() == pytest.approx(2, rel=1e-12)
    left = np.unique(mesh.tets[mesh.points[mesh.tets].mean(axis=1)[:, 0] < 1])
    right = np.unique(mesh.tets[mesh.points[mesh.tets].mean(axis=1)[:, 0] > 1])
    shared = mesh.points[np.intersect1d(left, right)]
    assert len(shared) >= 3
    assert (shared[:, :2] == 1).all()


@pytest.mark.slow
def test_two_materials_that_touch_along_curves() -> None:
    """A ball and the bar that touches its equator from inside (Viviani).

    Volumes from the integral over the bar's section; the ball's rest touches itself.
    """
    ball = decomp.Sphere((0, 0, 0), 2, name="ball")
    bar = decomp.Cylinder((1, 0, -3), (1, 0, 3), 1, name="bar")
    exact = decomp.Geometry({"core": ball & bar, "rest": ball - bar})
    core = 16 / 3 * (pi - 4 / 3)
    assert exact.regions[0].volume == pytest.approx(core, rel=1e-9)
    assert exact.regions[1].volume == pytest.approx(32 / 3 * pi - core, rel=1e-9)
    mesh = decomp.mesh(exact, size=1, cells="none")
    assert check(exact, mesh, unprojected=len(mesh.unprojected)).shortcomings == ()
    # where the walls touch there is no room for all
    assert len(mesh.unprojected) <= 0.005 * len(mesh.points)
    rest = volumes(mesh.points, mesh.tets)[mesh.tet_tags == mesh.group("rest", 3).tag]
    assert (rest > 0).all()
    # core and outside meet beyond the curve alone, and rest is between them before it
    core = mesh.triangles[mesh.triangle_tags == mesh.group("core/ball.surface", 2).tag]
    middle = mesh.points[core].mean(axis=1)
    near = middle[np.linalg.norm(middle - (2, 0, 0), axis=1) > 0.1]
    assert (np.hypot(near[:, 0] - 1, near[:, 1]) < 1.005).all()


def test_curved_elements() -> None:
    mesh = bare("blind hole", order=2)
    assert mesh.tets.shape[1] == 10
    assert not inverted(mesh.points, mesh.tets).any()
    exact = SOLIDS["blind hole"].volume
    assert volumes(mesh.points, mesh.tets).sum() == pytest.approx(exact, rel=2e-5)
    sound(geometry("blind hole"), mesh)


def test_layers() -> None:
    """As many elements between both sides as are asked for, in the middle of the plate."""
    plate = decomp.Block((0, 0, 0), (5, 4, 0.5), name="plate")
    mesh = decomp.mesh(plate, layers=3, cells="none")
    middle = mesh.points[mesh.tets].mean(axis=1)
    inside = (np.abs(middle[:, 0] - 2.5) < 1.5) & (np.abs(middle[:, 1] - 2) < 1)
    height = np.ptp(mesh.points[mesh.tets][inside][:, :, 2], axis=1)
    assert np.median(height) < 0.5 / 3 * 1.2


def test_sizes() -> None:
    """The file's own, of regions and faces, and elements around circles."""
    bore = decomp.Cylinder((0, 0, -1), (0, 0, 3), 0.5, name="bore")
    inner = decomp.Block((-2, -2, 0), (4, 4, 2), name="box") - bore
    outer = decomp.Block((2, -2, 0), (4, 4, 2), name="next")
    model = decomp.model(
        [decomp.Region("fine", inner, {"maxh": 0.3}), decomp.Region("coarse", outer)]
    )
    mesh = decomp.mesh(model, size=1.0, elements_per_circle=24, cells="none")
    sound(decomp.Geometry(model), mesh)
    on_bore = mesh.triangles[mesh.triangle_tags == mesh.group("fine/bore.side", 2).tag]
    around = np.unique(on_bore)
    at_bottom = mesh.points[around[np.isclose(mesh.points[around][:, 2], 0)]]
    assert len(at_bottom) >= 0.75 * 24
    edge = {}
    # lengths grow from 0.3 at x = 2 by 0.35 of the way
    for name, start in (("fine", -2), ("coarse", 3)):
        corners = mesh.points[mesh.tets[mesh.tet_tags == mesh.group(name, 3).tag]]
        corners = corners[corners[:, :, 0].mean(axis=1) > start]
        edge[name] = np.median(np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1))
    assert edge["fine"] < 0.3 * 1.3
    assert edge["coarse"] > 1.5 * edge["fine"]


def pipe() -> Solid:
    return decomp.Cylinder((0, 0, 0), (0, 0, 4), 1, name="outer") - decomp.Cylinder(
        (0, 0, -1), (0, 0, 5), 0.96, name="inner"
    )


@pytest.mark.slow
def test_a_thin_wall() -> None:
    """Edges are at most four times as long as the wall is thick, and it stays whole."""
    exact = decomp.Geometry(pipe())
    mesh = decomp.mesh(exact, size=0.5, cells="none")
    sound(exact, mesh, volume_error=1e-2)


@pytest.mark.slow
def test_a_film_between_two_blocks() -> None:
    """Three regions, the middle one a hundred times thinner than it is long."""
    layers = {"low": (0.0, 0.5), "film": (0.5, 0.54), "high": (0.54, 1.0)}
    solids: dict[str, Solid] = {
        name: decomp.Block((0, 0, a), (4, 4, b - a), name=name) for name, (a, b) in layers.items()
    }
    exact = decomp.Geometry(solids)
    mesh = decomp.mesh(exact, size=0.5, cells="none")
    sound(exact, mesh)
    assert sum(g.kind is GroupKind.INTERFACE for g in mesh.groups) == 2


PARTS = {
    "rod end": (decomp.Cylinder((60, 0, 0), (60, 0, 8), 10) | decomp.Block((0, -7, 2), (60, 14, 4)))
    - decomp.Cylinder((60, 0, -1), (60, 0, 9), 6),
    "hole as deep as wide": decomp.Block((0, 0, 0), (80, 60, 10))
    - decomp.Cylinder((60, 15, 5), (60, 15, 11), 5),
    "round groove": decomp.Cylinder((0, 0, 0), (0, 0, 50), 35)
    - decomp.Cylinder((0, 0, -1), (0, 0, 38), 29)
    - (decomp.Cylinder((0, 0, 40), (0, 0, 42), 40) - decomp.Cylinder((0, 0, 39), (0, 0, 43), 33)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PARTS)
def test_parts_whose_skeletons_are_hard(name: str) -> None:
    exact = decomp.Geometry(PARTS[name])
    sound(exact, decomp.mesh(exact, cells="none"))


def test_fields() -> None:
    exact = geometry("blind hole")
    mesh = bare("blind hole", fields=("distance", "thickness", "nearest", "region"))
    distance = exact.index.nearest(mesh.points).distance
    assert np.array_equal(mesh.point_data["distance"], distance)
    assert (mesh.point_data["thickness"] >= 2 * distance - 1e-9).all()
    assert (mesh.cell_data["region"] == 0).all()
    names = {g.tag: g.name.removeprefix("plate/") for g in mesh.groups if g.dimension == 2}
    named = [names[tag] for tag in mesh.cell_data["nearest"].tolist()]
    near = exact.index.nearest(mesh.points[mesh.tets].mean(axis=1)).site
    region = exact.regions[0]
    for name, number in zip(named, near.tolist(), strict=True):
        site = exact.sites[number]
        if site.kind.value == "face":
            assert name.endswith(region.faces[site.index].name)


def test_there_is_no_field_of_cells() -> None:
    with pytest.raises(InputError, match="'cell' tells of cells"):
        decomp.mesh(geometry("block"), cells="none", fields=["cell"])


def test_the_error_of_a_skeleton_tells_of_it() -> None:
    with pytest.raises(GeometryError, match=r"near \(1, 2, 3\); '--cells none' makes a mesh"):
        decomp.mesh(geometry("block"))


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.geo").write_text(
        "algebraic3d\nsolid a = orthobrick (0,0,0; 2,1,1) and not sphere (1,0.5,1; 0.3);\ntlo a;\n"
    )
    asked = ["mesh", "a.geo", "--size", "0.4", "-o", "a.msh"]
    assert main(asked) == 3
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert said[0].endswith("; '--cells none' makes a mesh without cells")
    assert not Path("a.msh").exists()
    assert main([*asked, "--cells", "none", "--html", "a.html", "--fields", "nearest"]) == 0
    text = capsys.readouterr().out
    assert "region a: " in text
    assert "cell" not in text
    assert "7 faces" in text
    assert "<html" in Path("a.html").read_text()
    assert main(["check", "a.geo", "a.msh"]) == 0
    assert main([*asked, "--cells", "none", "--fields", "cell"]) == 2
    assert "'cell' tells of cells" in capsys.readouterr().err
