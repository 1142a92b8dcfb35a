"""What meshio, PyVista and Gmsh read from each format is what was written."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

from decomp.meshes.files import write
from decomp.meshes.model import TetMesh
from tests.meshes.opened import opened
from tests.meshes.shapes import bar, quadratic

MESHES = {
    "straight": bar(),
    "curved": quadratic(bar(), bend=0.2),
}
VTK = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]


def expected(mesh: TetMesh) -> set[tuple[int, ...]]:
    """The tetrahedra with their tags in front, nodes in VTK's order."""
    tets = mesh.tets[:, VTK[: mesh.tets.shape[1]]]
    return {tuple(row) for row in np.column_stack([mesh.tet_tags, tets]).tolist()}


def found(mesh: meshio.Mesh, data: str) -> set[tuple[int, ...]]:
    rows: set[tuple[int, ...]] = set()
    for block, tags in zip(mesh.cells, mesh.cell_data[data], strict=True):
        if block.type.startswith("tetra"):
            rows |= {tuple(row) for row in np.column_stack([tags, block.data]).tolist()}
    return rows


@pytest.mark.parametrize(
    ("suffix", "data", "shape"),
    [
        (".msh", "gmsh:physical", "straight"),
        (".msh", "gmsh:physical", "curved"),
        (".vtu", "group", "straight"),
        (".vtu", "group", "curved"),
        # meshio knows no quadratic elements among others in XDMF, not even those that it wrote
        (".xdmf", "gmsh:physical", "straight"),
    ],
)
def test_meshio(suffix: str, data: str, shape: str, tmp_path: Path) -> None:
    mesh = MESHES[shape]
    path = tmp_path / f"bar{suffix}"
    mesh.write(path)
    read = meshio.read(path)
    if suffix != ".msh":
        assert np.array_equal(read.points, mesh.points)
        assert found(read, data) == expected(mesh)
    triangles = [block for block in read.cells if block.type.startswith("triangle")]
    assert sum(len(block.data) for block in triangles) == len(mesh.triangles)
    if suffix == ".vtu":
        assert read.field_data["surface right/side"].tolist() == [3]
    else:
        assert read.field_data["right/side"].tolist() == [3, 2]
        assert read.field_data["left/cell-1"].tolist() == [2, 3]
        assert read.field_data["left:front|back"].tolist() == [9, 2]


@pytest.mark.parametrize("version", ["4.1", "2.2"])
def test_meshio_reads_gmsh_tags(version: str, tmp_path: Path) -> None:
    """meshio numbers nodes anew in format 4.1, in the order of the file."""
    mesh = MESHES["curved"]
    path = tmp_path / "bar.msh"
    mesh.write(path, version=version)
    read = meshio.read(path)
    for block, tags in zip(read.cells, read.cell_data["gmsh:physical"], strict=True):
        centres = read.points[block.data].mean(axis=1)
        own = mesh.tets if block.type == "tetra10" else mesh.triangles
        own_tags = mesh.tet_tags if block.type == "tetra10" else mesh.triangle_tags
        rows = {(*row, tag) for row, tag in zip(rounded(centres), tags.tolist(), strict=True)}
        known = zip(rounded(mesh.points[own].mean(axis=1)), own_tags.tolist(), strict=True)
        assert rows <= {(*row, tag) for row, tag in known}


def rounded(points: np.ndarray) -> list[tuple[float, ...]]:
    return [tuple(row) for row in np.round(points, 9).tolist()]


@pytest.mark.parametrize("shape", MESHES)
def test_medit(shape: str, tmp_path: Path) -> None:
    mesh = MESHES[shape]
    path = tmp_path / "bar.mesh"
    mesh.write(path)
    if mesh.order == 1:
        read = meshio.read(path)
        assert np.array_equal(read.points, mesh.points)
        assert found(read, "medit:ref") == expected(mesh)
    with opened(path) as gmsh:
        kind = 4 if mesh.order == 1 else 11
        tags, _ = gmsh.model.mesh.getElementsByType(kind)
        assert len(tags) == len(mesh.tets)
        assert gmsh.model.mesh.getElementQualities(tags, "minDetJac").min() > 0
        volume = gmsh.model.mesh.getElementQualities(tags, "volume").sum()
        assert volume == pytest.approx(2.0, rel=1e-12)
        assert {tag for _, tag in gmsh.model.getEntities(3)} == {1, 2, 3}


@pytest.mark.parametrize("shape", MESHES)
@pytest.mark.parametrize("suffix", [".vtu", ".xdmf"])
def test_pyvista(suffix: str, shape: str, tmp_path: Path) -> None:
    mesh = MESHES[shape]
    path = tmp_path / f"bar{suffix}"
    mesh.write(path)
    read = pyvista.read(path) if suffix == ".vtu" else as_paraview_reads(path)
    assert np.array_equal(read.points, mesh.points)
    assert read.n_cells == len(mesh.triangles) + len(mesh.tets)
    sizes = read.compute_cell_sizes(length=False, area=False)
    assert sizes["Volume"].sum() == pytest.approx(2.0, rel=1e-3 if mesh.order == 2 else 1e-12)
    if suffix == ".vtu":
        assert read.field_data["volume left/cell-1"].tolist() == [2]
        assert read.field_data["surface left:front|back"].tolist() == [9]
        assert read.field_data["region right"].tolist() == [1]
        assert len(read.field_data) == len(mesh.groups) + 2
        first = read["group"][: len(mesh.triangles)] == 1
        assert (read["bc"][: len(mesh.triangles)][first] == 7).all()
        assert (read["bc"][len(mesh.triangles) :] == -1).all()


def as_paraview_reads(path: Path) -> pyvista.UnstructuredGrid:
    """PyVista's own XDMF reader takes nothing but files with time steps, which meshio refuses."""
    reader = vtkXdmfReader()
    reader.SetFileName(str(path))
    reader.Update()
    return pyvista.wrap(reader.GetOutputDataObject(0))


def test_objects() -> None:
    mesh = MESHES["straight"]
    read = mesh.to_meshio()
    assert found(read, "gmsh:physical") == expected(mesh)
    assert [len(rows) for rows in read.cell_sets["right/side"]] == [
        int((mesh.triangle_tags == 3).sum()),
        int((mesh.tet_tags == 3).sum()),
    ]
    grid = MESHES["curved"].to_pyvista()
    assert grid.n_cells == len(mesh.tets)
    assert grid["region"].tolist() == (mesh.tet_tags == 3).astype(int).tolist()
    assert list(grid.field_data["regions"]) == ["left", "right"]
    sizes = MESHES["straight"].to_pyvista().compute_cell_sizes(length=False, area=False)
    assert sizes["Volume"].min() > 0
    assert sizes["Volume"].sum() == pytest.approx(2.0, rel=1e-12)


def test_unknown_suffix(tmp_path: Path) -> None:
    from decomp.errors import InputError

    with pytest.raises(InputError, match=r"'\.stl' is unknown as a suffix for meshes; use \.msh"):
        write(MESHES["straight"], tmp_path / "bar.stl")
    with pytest.raises(InputError, match="'4' is not written"):
        write(MESHES["straight"], tmp_path / "bar.msh", version="4")
    assert not list(tmp_path.iterdir())
