"""What is read from a .msh file is what was written, by this package and by Gmsh."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from decomp.errors import FileError
from decomp.meshes.files.msh_reader import NONE, SEVERAL, ReadMesh, read_msh
from decomp.meshes.model import TetMesh
from tests.meshes.opened import opened
from tests.meshes.shapes import bar, quadratic

KINDS = {
    "binary": {},
    "text": {"text": True},
    "old": {"version": "2.2"},
}
MESHES = {
    "straight": bar(),
    "curved": quadratic(bar(), bend=0.2),
}


def rows(elements: np.ndarray, tags: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(row) for row in np.column_stack([tags, elements]).tolist()}


def assert_same(read: ReadMesh, mesh: TetMesh) -> None:
    assert np.array_equal(read.points, mesh.points)
    assert len(read.tets) == len(mesh.tets)
    assert rows(read.tets, read.tet_tags) == rows(mesh.tets, mesh.tet_tags)
    assert rows(read.triangles, read.triangle_tags) == rows(mesh.triangles, mesh.triangle_tags)
    assert read.names == {(g.dimension, g.tag): g.name for g in mesh.groups}


@pytest.mark.parametrize("shape", MESHES)
@pytest.mark.parametrize("kind", KINDS)
def test_what_was_written(kind: str, shape: str, tmp_path: Path) -> None:
    path = tmp_path / "bar.msh"
    MESHES[shape].write(path, **KINDS[kind])
    assert_same(read_msh(path), MESHES[shape])


@pytest.mark.parametrize("version", [4.1, 2.2])
def test_what_gmsh_saves(version: float, tmp_path: Path) -> None:
    mesh = MESHES["curved"]
    path, again = tmp_path / "bar.msh", tmp_path / "again.msh"
    mesh.write(path)
    with opened(path) as gmsh:
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", 1 if version == 4.1 else 0)
        gmsh.model.addPhysicalGroup(3, [1, 2], 20, "left")
        gmsh.model.removePhysicalGroups([(2, 4)])
        gmsh.option.setNumber("Mesh.SaveAll", 1 if version == 4.1 else 0)
        gmsh.write(str(again))
    read = read_msh(again)
    assert np.sort(read.tet_tags).tolist() == [SEVERAL] * 384 + [3] * 384
    assert read.names[3, 20] == "left"
    assert read.names[2, 9] == "left:front|back"
    assert len(read.tets) == len(mesh.tets)
    # Gmsh saves what is in no group to format 4.1 alone, and there only when told to
    assert (read.triangle_tags == NONE).sum() == (32 if version == 4.1 else 0)


def test_the_other_byte_order(tmp_path: Path) -> None:
    path = tmp_path / "bar.msh"
    mesh = MESHES["straight"]
    mesh.write(path)
    data = path.read_bytes()
    at = data.index(b"8\n") + 2
    path.write_bytes(data[:at] + data[at : at + 4][::-1] + data[at + 4 :])
    with pytest.raises(FileError, match="the file ends too early, or its counts are wrong"):
        read_msh(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("hello", "this is no .msh file"),
        ("$MeshFormat\n4 0 8\n$EndMeshFormat\n", "format 4 is not read, only 4.1 and 2.2"),
        ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", r"there is no section \$Nodes"),
        ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n", r"section \$Nodes has no end"),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n"
            "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n",
            "nodes that it does not define",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n"
            "$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n",
            "1 elements of Gmsh's type 5: only tetrahedra and triangles are read",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n"
            "$Elements\n2\n1 4 2 1 1 1 2 3 4\n$EndElements\n",
            r"section \$Elements ends too early",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 x y z\n$EndNodes\n",
            r"section \$Nodes holds what is no number",
        ),
    ],
)
def test_what_cannot_be_read(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.msh"
    path.write_text(text)
    with pytest.raises(FileError, match=message):
        read_msh(path)
    with pytest.raises(FileError, match="cannot be read: No such file"):
        read_msh(tmp_path / "none.msh")
