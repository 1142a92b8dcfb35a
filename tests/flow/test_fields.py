"""Fields on meshes: exact against closed forms, and as Gmsh, meshio and PyVista read them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

import decomp
from decomp.cli.main import main
from decomp.errors import InputError
from decomp.meshes.fields import FIELDS
from tests.meshes.opened import opened

OUTER, INNER, LENGTH = 2.0, 1.5, 3.0


@cache
def tube() -> decomp.TetMesh:
    outer = decomp.Cylinder((0, 0, 0), (0, 0, LENGTH), OUTER, name="outer")
    hole = decomp.Cylinder((0, 0, -1), (0, 0, LENGTH + 1), INNER, name="hole")
    return decomp.mesh(outer - hole, size=0.6, layers=4, fields=FIELDS)


def walls(points: np.ndarray) -> np.ndarray:
    """Distances (n, 4) from outer side, hole, bottom and top of the tube."""
    rho = np.hypot(points[:, 0], points[:, 1])
    z = points[:, 2]
    return np.stack([OUTER - rho, rho - INNER, z, LENGTH - z], axis=1)


def test_distance() -> None:
    mesh = tube()
    exact = np.abs(walls(mesh.points).min(axis=1))
    assert np.abs(mesh.point_data["distance"] - exact).max() < 1e-12


def test_thickness() -> None:
    """The balls between the walls have their diameter, those in the mitres four times the radius
    less: a ball that touches wall and bottom touches them as far from their edge as it is high."""
    mesh = tube()
    near = np.sort(walls(mesh.points), axis=1)
    inner = near[:, 0] > 1e-3
    gap = OUTER - INNER
    on_wall = walls(mesh.points).argmin(axis=1) < 2
    from_end = np.minimum(mesh.points[:, 2], LENGTH - mesh.points[:, 2])
    exact = np.where(from_end > gap / 2, gap, 2 * from_end)
    clear = on_wall & (near[:, 1] - near[:, 0] > 1e-6)
    found = mesh.point_data["thickness"]
    assert clear.sum() > 100
    off = np.abs(found - exact)
    assert off[clear & inner].max() < 1e-9
    # at nodes on the boundary it is asked 2e-5 diagonals inside, which may be as far along the wall
    diagonal = np.sqrt(2 * (2 * OUTER) ** 2 + LENGTH**2)
    assert off[clear].max() < 2 * 2e-5 * diagonal
    assert (found[inner] >= 2 * mesh.point_data["distance"][inner] - 1e-12).all()
    assert found.max() <= gap + 1e-9


def test_numbers_of_tetrahedra() -> None:
    mesh = tube()
    names = {g.tag: g.name for g in mesh.groups if g.dimension == 2}
    wall = ("solid/outer.side", "solid/hole.side", "solid/outer.base", "solid/outer.top")
    index = {name: k for k, name in enumerate(wall)}
    found = [index[names[tag]] for tag in mesh.cell_data["nearest"].tolist()]
    exact = walls(mesh.points[mesh.tets].mean(axis=1))
    assert (exact[np.arange(len(found)), found] <= exact.min(axis=1) + 1e-12).all()
    assert np.array_equal(mesh.cell_data["cell"], mesh.grouped(volumes="cells").tet_tags)
    assert (mesh.cell_data["region"] == 0).all()


@pytest.mark.parametrize(("text", "version"), [(False, "4.1"), (True, "4.1"), (True, "2.2")])
def test_gmsh_reads_them(text: bool, version: str, tmp_path: Path) -> None:
    mesh = tube().grouped(volumes="cells")
    path = tmp_path / "tube.msh"
    mesh.write(path, text=text, version=version)
    with opened(path) as gmsh:
        views = {}
        for tag in gmsh.view.getTags().tolist():
            number = gmsh.view.getIndex(tag)
            name = gmsh.option.getString(f"View[{number}].Name")
            views[name] = gmsh.view.getHomogeneousModelData(tag, 0)
        assert set(views) == set(FIELDS)
        kind, tags, values = views["distance"][:3]
        assert kind == "NodeData"
        at = {int(t): gmsh.model.mesh.getNode(t)[0] for t in tags[:50]}
        for tag, value in list(zip(tags, values, strict=True))[:50]:
            assert value == pytest.approx(abs(walls(at[int(tag)][None]).min()), abs=1e-12)
        kind, tags, values = views["cell"][:3]
        assert kind == "ElementData"
        assert len(tags) == len(mesh.triangles) + len(mesh.tets)
        for tag, value in list(zip(tags, values, strict=True))[len(mesh.triangles) :: 97]:
            entity = gmsh.model.mesh.getElement(tag)[3]
            assert entity == value


def test_others_read_them(tmp_path: Path) -> None:
    mesh = tube()
    mesh.write(tmp_path / "t.vtu")
    mesh.write(tmp_path / "t.msh")
    read = meshio.read(tmp_path / "t.vtu")
    same = meshio.read(tmp_path / "t.msh")
    own = mesh.to_meshio()
    grid, vtk = mesh.to_pyvista(), pyvista.read(tmp_path / "t.vtu")
    for name in ("distance", "thickness"):
        for found in (read, same, own, grid, vtk):
            assert np.array_equal(found.point_data[name], mesh.point_data[name])
    for name in ("nearest", "cell"):
        assert np.array_equal(read.cell_data_dict[name]["tetra"], mesh.cell_data[name])
        assert np.array_equal(own.cell_data_dict[name]["tetra"], mesh.cell_data[name])
        assert np.array_equal(grid.cell_data[name], mesh.cell_data[name])


def test_names_that_are_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError, match="'depth' is no field; there are distance, thickness"):
        decomp.mesh(decomp.Block((0, 0, 0), (1, 1, 1)), fields=["depth"])
    model = tmp_path / "b.geo"
    model.write_text("algebraic3d\nsolid b = orthobrick (0,0,0; 1,1,1);\ntlo b;\n")
    out = str(tmp_path / "b.inp")
    assert main(["mesh", str(model), "-o", out, "--fields", "distance"]) == 2
    assert "are written into .msh and .vtu files" in capsys.readouterr().err


def test_two_regions_and_second_order() -> None:
    """Nodes of the interface are on the boundary of both; centroids know their own region."""
    box = decomp.Block((0, 0, 0), (2, 1, 1), name="box")
    ball = decomp.Sphere((0.5, 0.5, 0.5), 0.3, name="ball")
    mesh = decomp.mesh({"in": ball, "out": box - ball}, size=0.5, order=2, fields=FIELDS)
    away = np.linalg.norm(mesh.points - 0.5, axis=1)
    on = np.unique(
        mesh.triangles[
            mesh.triangle_tags == next(g.tag for g in mesh.groups if g.kind.value == "interface")
        ]
    )
    assert np.abs(mesh.point_data["distance"][on]).max() < 1e-9
    inside = np.linalg.norm(mesh.points - [0.5, 0.5, 0.5], axis=1) < 0.29
    assert mesh.point_data["thickness"][inside] == pytest.approx(0.6, abs=1e-6)
    assert len(away) == len(mesh.point_data["thickness"])
    volumes = {g.tag: g.regions[0] for g in mesh.groups if g.dimension == 3}
    named = [("in", "out")[k] for k in mesh.cell_data["region"]]
    assert named == [volumes[tag] for tag in mesh.tet_tags.tolist()]
