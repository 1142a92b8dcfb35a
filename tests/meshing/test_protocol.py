"""The protocol of meshers: every entry of the table gives meshes that are named and exact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import Delaunay, cKDTree  # type: ignore[import-untyped]

import decomp
from decomp.meshes.faces import volumes
from decomp.meshing.backends.base import (
    Mesher,
    MeshingError,
    Repair,
    Task,
    Tetrahedra,
    TimeLimit,
)
from decomp.meshing.backends.table import mesher
from decomp.vectors import Array, Ints
from tests.meshing.meshers import put_in_place

FLAT = 1e-9
"""Tetrahedra of less than this part of an edge's cube are between points of one plane."""
BLOCK = decomp.Block((0, 0, 0), (4, 3, 2), name="block")
Run = Callable[[Task, TimeLimit, Callable[[str], None]], Tetrahedra]


def delaunay(task: Task, limit: TimeLimit, tell: Callable[[str], None]) -> Tetrahedra:
    """Fill a convex body of planes with one cell: the Delaunay tetrahedra of points in it.

    Points are at random, so that but for those of one face no four are in a plane.
    """
    random, spacing = np.random.default_rng(1), 0.7 * task.length
    corners = task.points[task.triangles]
    sides = np.unique(np.sort(task.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
    along = random.uniform(size=(len(sides), 40, 1))
    ends = task.points[sides][:, :, None]
    on_sides = ((1 - along) * ends[:, 0] + along * ends[:, 1]).reshape(-1, 3)
    weights = random.dirichlet((1, 1, 1), (len(corners), 200))
    on_faces = np.einsum("kpc,kcd->kpd", weights, corners).reshape(-1, 3)
    inside = random.uniform(task.points.min(axis=0), task.points.max(axis=0), (2_000, 3))
    inside = inside[depth(task, inside) > 0.4 * spacing]
    points = apart(np.concatenate([task.points, on_sides, on_faces, inside]), 0.6 * spacing)
    tets = Delaunay(points).simplices.astype(np.int64)
    content = volumes(points, tets)
    tets[content < 0] = tets[content < 0][:, [0, 1, 3, 2]]
    return Tetrahedra(points, tets[np.abs(content) > FLAT * spacing**3], task.tolerance)


def depth(task: Task, points: Array) -> Array:
    """How deep points (n,) are in a body of planes; less than 0 outside. By `beside`, not by the
    triangles' sense, normals are turned out of the body."""
    corners = task.points[task.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    normal[task.beside[:, 1] < 0] *= -1
    away = np.einsum("nkc,kc->nk", points[:, None] - corners[:, 0], normal)
    return -np.asarray(away.max(axis=1))


def apart(points: Array, least: float) -> Array:
    """Points of which none is closer than `least` to one before it."""
    close = cKDTree(points).query_pairs(least, output_type="ndarray")
    gone = np.zeros(len(points), dtype=np.bool_)
    for one, two in close[np.lexsort(close.T[::-1])].tolist():
        gone[two] |= not gone[one]
    return points[~gone]


def knowing(task: Task, limit: TimeLimit, tell: Callable[[str], None]) -> Tetrahedra:
    """As `delaunay`, and it knows the only cell."""
    made = delaunay(task, limit, tell)
    return replace(made, cells=np.zeros(len(made.tets), dtype=np.int64))


@pytest.mark.parametrize("run", [delaunay, knowing])
@pytest.mark.parametrize("order", [1, 2])
def test_a_mesher_of_ones_own(
    run: Run, order: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """It fills a block: with all names, exact nodes and volume, and `check` finds no fault."""
    turned = BLOCK.rotate((1, 2, 3), 40).translate((5, 6, 7))
    told: list[str] = []
    put_in_place(Mesher("Delaunay", frozenset(), run), monkeypatch)
    mesh = decomp.mesh(
        turned,
        size=1.2,
        cells="none",
        order=order,
        progress=lambda what, done: told.append(what),
    )
    assert "Delaunay" in told
    assert not any("TetWild" in what for what in told)
    names = {group.name for group in mesh.groups}
    sides = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")
    assert names == {"solid", *(f"solid/block.{side}" for side in sides)}
    assert volumes(mesh.points, mesh.tets[:, :4]).sum() == pytest.approx(24, rel=1e-12)
    assert len(mesh.unprojected) == 0
    mesh.write(tmp_path / "block.msh")
    assert decomp.check(turned, tmp_path / "block.msh").shortcomings == ()


def test_what_a_mesher_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    """All triangles, with the cells on both their sides: these enclose the regions' volumes."""
    given: list[Task] = []

    def refusing(task: Task, limit: TimeLimit, tell: Callable[[str], None]) -> Tetrahedra:
        given.append(task)
        raise MeshingError(f"no more than {limit.clock:g} s")

    put_in_place(Mesher("none", frozenset(), refusing), monkeypatch)
    beside = decomp.Block((4, 0, 0), (2, 3, 2), name="beside")
    with pytest.raises(MeshingError, match="no more than 7 s"):
        decomp.mesh({"one": BLOCK, "two": beside}, size=1.2, cells="face", timeout=7)
    (task,) = given
    corners = task.points[task.triangles]
    under = np.linalg.det(corners - np.array([3.0, 1.0, 1.0])) / 6
    found = [
        under[task.beside[:, 1] == cell].sum() - under[task.beside[:, 0] == cell].sum()
        for cell in range(12)
    ]
    # of a block the cell of a face is a pyramid or a roof, by the nearest of six planes
    assert sum(found) == pytest.approx(24 + 12, rel=1e-12)
    assert min(found) > 0
    assert (np.unique(task.triangles) == np.arange(len(task.points))).all()
    assert set(np.unique(task.beside)) == set(range(-1, 12))
    assert task.length == pytest.approx(float(task.lengths(task.points).max()), rel=0.5)


@pytest.mark.parametrize("repairs", [frozenset(), frozenset({Repair.CHANCE})])
def test_a_mesher_is_run_again_only_if_it_fails_by_chance(
    repairs: frozenset[Repair], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[float] = []

    def dented(task: Task, limit: TimeLimit, tell: Callable[[str], None]) -> Tetrahedra:
        made = delaunay(task, limit, tell)
        asked.append(task.tolerance)
        if len(asked) > 1:
            return made
        middle = made.points[made.tets].mean(axis=1)
        return replace(made, tets=made.tets[np.linalg.norm(middle - [2, 1.5, 0], axis=1) > 1])

    put_in_place(Mesher("dented", repairs, dented), monkeypatch)
    mesh = decomp.mesh(BLOCK, size=1.2, cells="none")
    assert len(asked) == (2 if repairs else 1)
    whole = volumes(mesh.points, mesh.tets).sum() == pytest.approx(24, rel=1e-12)
    assert whole == bool(repairs)


def test_cells_that_have_several_parts_are_asked_for_theirs() -> None:
    """Two faces that no sheet parts all over: the cell is told, its part is found."""
    from decomp.meshing.naming.classify import parts_of_cells
    from decomp.meshing.surface.cells import OUTSIDE, CellMap

    geometry = decomp.Geometry(BLOCK)
    sites = {site.name: number for number, site in enumerate(geometry.sites)}
    part = np.full(len(sites), OUTSIDE, dtype=np.int64)
    inside = [number for number, site in enumerate(geometry.sites) if site.region >= 0]
    part[inside] = 0
    part[[n for n in inside if geometry.sites[n].name.endswith("zmax")]] = 1
    known = CellMap((), np.array([0]), part, np.array([0, 0]), np.zeros(len(sites), np.int64))
    known = replace(known, cells=(None,))  # type: ignore[arg-type]
    points = np.array([[2, 1.5, z] for z in (0.1, 1.9)])[:, None] + 0.01 * np.eye(4, 3)
    tets: Ints = np.arange(8).reshape(2, 4)
    told = np.array([0, 0])
    found = parts_of_cells(geometry, known, points.reshape(-1, 3), tets, told)
    assert found.tolist() == [0, 1]
    found = parts_of_cells(geometry, known, points.reshape(-1, 3), tets, np.array([OUTSIDE, 0]))
    assert found.tolist() == [OUTSIDE, 1]


def test_the_tables_first_entry_is_tetwild() -> None:
    assert mesher().title == "TetWild"
    assert mesher().repairs == set(Repair)
