"""Meshes of models: exact, tagged, whole."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.errors import InputError
from decomp.meshes.faces import faces_of, least_dihedral
from decomp.meshes.model import GroupKind, TetMesh
from decomp.meshes.quality import inverted, volumes
from decomp.meshes.report import report
from decomp.meshing.backends.base import Task, Tetrahedra
from decomp.meshing.backends.table import mesher
from decomp.meshing.repairs.shortening import LONGEST_EDGE
from decomp.meshing.repairs.splitting import held
from tests.meshing.meshers import put_in_place
from tests.meshing.meshes import MODELS, geometry, meshed
from tests.solids import SOLIDS

PLANAR = ("block", "bracket", "fichera")
CURVED = ("cylinder", "through hole", "blind hole", "slot", "round boss", "unequal tee")
EVERY = (*PLANAR, *CURVED, *MODELS)


def regions_of(mesh: TetMesh) -> np.ndarray:
    """The region (m,) of each tetrahedron."""
    names = {region: k for k, region in enumerate(dict.fromkeys(g.regions[0] for g in mesh.groups))}
    table = {g.tag: names[g.regions[0]] for g in mesh.groups if g.dimension == 3}
    return np.array([table[tag] for tag in mesh.tet_tags.tolist()])


@pytest.mark.parametrize("name", EVERY)
def test_elements_are_sound(name: str) -> None:
    mesh = meshed(name)
    assert not inverted(mesh.points, mesh.tets).any()
    faces_of(mesh.tets)  # raises where a face is in three elements
    assert np.array_equal(np.unique(mesh.tets), np.arange(len(mesh.points)))
    least = least_dihedral(mesh.points, mesh.tets)
    assert least.min() >= 8
    assert least.mean() >= 45


@pytest.mark.parametrize("name", EVERY)
def test_every_element_has_one_group(name: str) -> None:
    mesh = meshed(name)
    for tags, dimension in ((mesh.tet_tags, 3), (mesh.triangle_tags, 2)):
        known = [group.tag for group in mesh.groups if group.dimension == dimension]
        assert len(set(known)) == len(known)
        assert set(tags.tolist()) == set(known)
    keys = np.sort(mesh.triangles, axis=1)
    assert len(np.unique(keys, axis=0)) == len(keys)


@pytest.mark.parametrize("name", EVERY)
def test_every_face_between_regions_is_tagged_once(name: str) -> None:
    mesh = meshed(name)
    faces = faces_of(mesh.tets)
    region = np.append(regions_of(mesh), -1)
    sides = region[faces.tets]
    outer = faces.triangles[sides[:, 0] != sides[:, 1]]
    kinds = {group.tag: group.kind for group in mesh.groups if group.dimension == 2}
    wanted = np.array(
        [kinds[tag] is not GroupKind.SHEET for tag in mesh.triangle_tags.tolist()], dtype=bool
    )
    tagged = np.sort(mesh.triangles[wanted], axis=1)
    assert set(map(tuple, np.sort(outer, axis=1).tolist())) == set(map(tuple, tagged.tolist()))
    hull = {tuple(t) for t in faces.triangles[faces.tets[:, 1] < 0].tolist()}
    turned = {tuple(np.roll(t, k)) for t in hull for k in range(3)}
    boundary = np.array(
        [kinds[tag] is GroupKind.FACE for tag in mesh.triangle_tags.tolist()], dtype=bool
    )
    assert all(tuple(t) in turned for t in mesh.triangles[boundary].tolist())


@pytest.mark.parametrize("name", EVERY)
def test_edges_are_as_long_as_asked(name: str) -> None:
    found = report(meshed(name))
    for part in (*found.regions, *found.surfaces):
        if part.edges is not None:
            assert part.edges.asked is not None and part.edges.wanted is not None
            assert part.edges.longest <= LONGEST_EDGE * part.edges.asked
            assert part.edges.mean <= 1.05 * part.edges.asked
            assert part.edges.mean >= 0.75 * part.edges.wanted


@pytest.mark.parametrize("name", ["block", "bracket", "cylinder", "sphere"])
def test_the_size_is_the_length_of_edges(name: str) -> None:
    exact = decomp.Geometry(SOLIDS[name].make())
    size = exact.diagonal / 12
    found = report(decomp.mesh(exact, size=size)).regions[0].edges
    assert found is not None and found.asked == size
    assert 0.75 * size <= found.mean <= 1.05 * size
    assert found.longest <= 1.5 * size


def test_sizes_of_regions_and_faces_are_lengths_of_edges() -> None:
    top = decomp.HalfSpace((0, 0, 1), (0, 0, 1), name="top").named("cut", maxh=0.2)
    below = decomp.Block((0, 0, 0), (3, 3, 2), name="below") & top
    beside = decomp.Block((3, 0, 0), (2, 3, 1), name="beside")
    model = decomp.model([decomp.Region("a", below), decomp.Region("b", beside, {"maxh": 0.4})])
    mesh = decomp.mesh(model, size=0.8)
    found = report(mesh)
    assert [region.edges and region.edges.asked for region in found.regions] == [0.8, 0.4]
    assert [(s.name, s.maxh) for s in found.surfaces if s.maxh] == [("a/cut.top", 0.2)]
    assert mesh.group("a/cut.top", 2).maxh == 0.2
    assert mesh.group("b/beside.xmax", 2).maxh is None
    (own,) = (surface.edges for surface in found.surfaces if surface.edges is not None)
    assert own.asked == 0.2
    assert 0.15 <= own.mean <= 0.21 and own.longest <= 0.3
    for region in found.regions:
        assert region.edges is not None and region.edges.asked is not None
        assert region.edges.longest <= 1.5 * region.edges.asked
        assert region.edges.mean <= 1.05 * region.edges.asked


@pytest.mark.parametrize("value", [0, -1.0, "much"])
def test_a_faces_size_that_is_none_is_refused(value: object) -> None:
    with pytest.raises(InputError, match="maxh"):
        decomp.Block((0, 0, 0), (1, 1, 1)).named("part", maxh=value)


@pytest.mark.parametrize("name", EVERY)
def test_volumes(name: str) -> None:
    mesh = meshed(name)
    content = volumes(mesh.points, mesh.tets)
    for region in geometry(name).regions:
        own = [g.tag for g in mesh.groups if g.dimension == 3 and g.regions == (region.name,)]
        total = content[np.isin(mesh.tet_tags, own)].sum()
        assert total == pytest.approx(region.volume, rel=1e-12 if name in PLANAR else 5e-3)


@pytest.mark.parametrize("name", EVERY)
def test_boundary_nodes_are_on_their_faces(name: str) -> None:
    mesh, exact = meshed(name), geometry(name)
    carriers = {
        f"{region.name}/{face.name}": region.carriers[face.carrier]
        for region in exact.regions
        for face in region.faces
    }
    free = np.setdiff1d(np.arange(len(mesh.points)), mesh.unprojected)
    assert len(mesh.unprojected) <= 0.002 * len(mesh.points)
    for group in mesh.groups:
        if group.kind in (GroupKind.FACE, GroupKind.INTERFACE):
            nodes = np.unique(mesh.triangles[mesh.triangle_tags == group.tag])
            for full in group.name.split("|"):
                off = carriers[full].signed_distance(mesh.points[np.intersect1d(nodes, free)])
                assert np.abs(off).max() <= 1e-12 * exact.diagonal


@pytest.mark.parametrize("name", EVERY)
def test_sheet_nodes_are_equally_far_from_the_cells_on_both_sides(name: str) -> None:
    mesh, exact = meshed(name), geometry(name)
    kinds = {group.tag: group.kind for group in mesh.groups if group.dimension == 2}
    sheet = [tag for tag, kind in kinds.items() if kind is GroupKind.SHEET]
    nodes = np.unique(mesh.triangles[np.isin(mesh.triangle_tags, sheet)])
    nodes = np.setdiff1d(nodes, mesh.unprojected)
    # away from its sheet a node has one nearest place, which moves as far as the node itself does;
    # on it there are at least two, which come close to each other where a sheet ends in a rim
    step = 1e-5 * exact.diagonal
    ways = np.random.default_rng(1).normal(size=(40, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    at = mesh.points[nodes]
    feet = np.stack([exact.index.nearest(at + step * way).foot for way in ways])
    depth = np.abs(exact.index.distance(at))
    spread = np.linalg.norm(feet - feet[0], axis=2).max(axis=0)
    inner = depth > 0.02 * exact.diagonal
    assert inner.any()
    assert (spread[inner] > 10 * step).all()
    assert (spread[inner] > 0.05 * depth[inner]).mean() > (0.95 if "tee" in name else 0.99)


@pytest.mark.parametrize("name", PLANAR)
def test_no_element_is_held_by_the_boundary(name: str) -> None:
    mesh = meshed(name)
    assert len(held(mesh.tets, regions_of(mesh))[0]) == 0


def test_cells_of_a_planar_solid_are_exact() -> None:
    mesh = meshed("block")
    content = volumes(mesh.points, mesh.tets)
    for group in mesh.groups:
        if group.kind is GroupKind.CELL:
            assert content[mesh.tet_tags == group.tag].sum() == pytest.approx(
                group.volume, rel=1e-12
            )


def test_neighbours_share_their_interface() -> None:
    mesh = meshed("two boxes")
    interface = [g for g in mesh.groups if g.kind is GroupKind.INTERFACE]
    assert [g.name for g in interface] == ["left/a.xmax|right/b.xmin"]
    triangles = mesh.triangles[mesh.triangle_tags == interface[0].tag]
    corners = mesh.points[triangles]
    assert np.abs(corners[..., 0] - 2).max() == 0
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(normal, axis=1).sum() / 2 == pytest.approx(4, rel=1e-12)
    assert (normal[:, 0] > 0).all()


def test_the_sheet_of_an_edge_with_itself_is_tagged() -> None:
    """Under the saddle edge of a tee: both its sides are in one cell.

    It is a few elements large and ends in points, so that chords leave out some of it.
    """
    mesh, sheets = meshed("unequal tee"), decomp.skeleton(geometry("unequal tee")).regions[0].sheets
    (sheet,) = (sheet for sheet in sheets if sheet.sites[0] == sheet.sites[1])
    tag = mesh.group("solid/run.side+branch.side|run.side+branch.side", 2).tag
    a, b, c = np.moveaxis(mesh.points[mesh.triangles[mesh.triangle_tags == tag]], 1, 0)
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 2
    assert 0.65 * sheet.area < area < 1.02 * sheet.area


def test_regions_without_sheets() -> None:
    mesh = meshed("two boxes", volumes="regions", sheets=False)
    assert [g.name for g in mesh.groups if g.dimension == 3] == ["left", "right"]
    assert not [g for g in mesh.groups if g.kind is GroupKind.SHEET]
    assert volumes(mesh.points, mesh.tets)[mesh.tet_tags == 1].sum() == pytest.approx(8, rel=1e-12)


def test_a_cell_for_each_face() -> None:
    mesh = meshed("bracket", cells="face")
    cells = [g for g in mesh.groups if g.kind is GroupKind.CELL]
    assert len(cells) == 8
    assert all(len(g.faces) == 1 for g in cells)
    content = volumes(mesh.points, mesh.tets)
    for group in cells:
        total = content[mesh.tet_tags == group.tag].sum()
        assert total == pytest.approx(group.volume, rel=5e-3)


@pytest.mark.parametrize("name", ["cylinder", "blind hole"])
def test_quadratic_elements(name: str) -> None:
    straight, curved = meshed(name), meshed(name, order=2)
    assert curved.tets.shape[1] == 10
    assert curved.triangles.shape[1] == 6
    assert not inverted(curved.points, curved.tets).any()
    exact = SOLIDS[name].volume
    error = volumes(curved.points, curved.tets).sum() / exact - 1
    assert abs(error) < 2e-5
    assert abs(error) < 0.05 * abs(volumes(straight.points, straight.tets).sum() / exact - 1)
    faces = [g.tag for g in curved.groups if g.kind is GroupKind.FACE]
    nodes = np.unique(curved.triangles[np.isin(curved.triangle_tags, faces)])
    nodes = np.setdiff1d(nodes, curved.unprojected)
    found = geometry(name)
    assert np.abs(found.index.distance(curved.points[nodes])).max() <= 1e-12 * found.diagonal


def test_layers_across_a_thin_plate() -> None:
    plate = decomp.Block((0, 0, 0), (5, 4, 0.5), name="plate")
    mesh = decomp.mesh(plate, layers=2)
    middle = mesh.points[mesh.tets].mean(axis=1)
    inside = (np.abs(middle[:, 0] - 2.5) < 1.5) & (np.abs(middle[:, 1] - 2) < 1)
    length = np.ptp(mesh.points[mesh.tets][inside], axis=1)
    assert np.median(length) < 0.5 / 2 * 1.2


@pytest.mark.parametrize(
    "wrong",
    [
        {"size": 0.0},
        {"size": float("nan")},
        {"layers": 0},
        {"elements_per_circle": 2},
        {"order": 3},
        {"cells": "faces"},
        {"volumes": "all"},
    ],
)
def test_options_out_of_range(wrong: dict[str, object]) -> None:
    with pytest.raises(InputError):
        decomp.mesh(decomp.Block((0, 0, 0), (1, 1, 1)), **wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("times", [1, 2])
def test_tetwild_is_run_again_where_it_left_out_triangles(
    times: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A dent in what it returns: the mesh is made of what it returns next, if that is sound."""
    asked: list[float] = []
    tetwild = mesher()

    def dented(task: Task, *rest: Any) -> Tetrahedra:
        made = tetwild.run(task, *rest)
        asked.append(task.tolerance)
        if len(asked) > times:
            return made
        centre = made.points[made.tets].mean(axis=1)
        inside = np.linalg.norm(centre - [2, 1.5, 0.2], axis=1) > 0.5
        return replace(made, tets=made.tets[inside])

    put_in_place(replace(tetwild, run=dented), monkeypatch)
    solid = decomp.Block((0, 0, 0), (4, 3, 2), name="block")
    mesh = decomp.mesh(solid)
    assert len(asked) == 2
    assert asked[1] < asked[0]
    whole = volumes(mesh.points, mesh.tets).sum() == pytest.approx(24, rel=1e-9)
    assert whole == (times == 1)


@pytest.mark.slow
def test_a_housing_with_a_bore_in_its_floor() -> None:
    """By way of the skeleton: the wall below the bore is thinner than an edge is asked to be."""
    body = decomp.Block((0, 0, 0), (50, 36, 24)) - decomp.Block((3, 2.5, 8), (44, 31, 24))
    exact = decomp.Geometry(body - decomp.Cylinder((-1, 18, 3.6), (51, 18, 3.6), 2.5))
    (region,) = exact.regions
    assert region.euler == 0
    assert region.volume == pytest.approx(50 * 36 * 24 - 44 * 31 * 16 - 50 * pi * 6.25, rel=1e-12)
    mesh = decomp.mesh(exact, size=5)
    found = check(exact, mesh, volume_error=5e-3, unprojected=len(mesh.unprojected))
    assert found.shortcomings == ()
    assert len(mesh.unprojected) <= 0.002 * len(mesh.points)
