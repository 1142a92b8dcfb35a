"""Gmsh's formats, read by Gmsh's own library, which also saves what it has read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from decomp.meshes.files import encoded, form_of
from decomp.meshes.files.entities import entities
from decomp.meshes.model import TetMesh
from tests.meshes.opened import named_sizes, opened
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
VOLUME = 2.0


def sizes(mesh: TetMesh) -> dict[tuple[int, str], int]:
    tags = {2: mesh.triangle_tags, 3: mesh.tet_tags}
    return {(g.dimension, g.name): int((tags[g.dimension] == g.tag).sum()) for g in mesh.groups}


@pytest.mark.parametrize("shape", MESHES)
@pytest.mark.parametrize("kind", KINDS)
def test_gmsh_reads_every_group_and_saves_it_again(kind: str, shape: str, tmp_path: Path) -> None:
    mesh = MESHES[shape]
    path, again = tmp_path / "bar.msh", tmp_path / "again.msh"
    path.write_bytes(encoded(mesh, form_of(path), **KINDS[kind]))
    with opened(path) as gmsh:
        assert named_sizes(gmsh) == sizes(mesh)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        order = np.argsort(tags)
        assert np.array_equal(tags[order], np.arange(1, len(mesh.points) + 1))
        assert np.array_equal(coordinates.reshape(-1, 3)[order], mesh.points)
        own = gmsh.model.mesh.getElementsByType(4 if mesh.order == 1 else 11)
        nodes = own[1].reshape(-1, mesh.tets.shape[1]).astype(np.int64) - 1
        by_tag = np.argsort(mesh.tet_tags, kind="stable")
        expected = mesh.tets if kind == "old" else mesh.tets[by_tag]
        assert {tuple(row) for row in nodes.tolist()} == {tuple(r) for r in expected.tolist()}
        quality = gmsh.model.mesh.getElementQualities
        assert quality(own[0], "minDetJac").min() > 0
        assert quality(own[0], "volume").sum() == pytest.approx(VOLUME, rel=1e-12)
        gmsh.write(str(again))
    with opened(again) as gmsh:
        assert named_sizes(gmsh) == sizes(mesh)
        assert len(gmsh.model.mesh.getNodes()[0]) == len(mesh.points)


def test_volumes_know_their_surfaces(tmp_path: Path) -> None:
    mesh = bar()
    _, _, volumes = entities(mesh).bounds
    assert volumes == {1: [1, 2, 5, 9], 2: [-9, 1, 2, 5], 3: [-5, 3, 4]}
    path = tmp_path / "bar.msh"
    path.write_bytes(encoded(mesh, form_of(path)))
    with opened(path) as gmsh:
        for tag, found in volumes.items():
            bounds = gmsh.model.getBoundary([(3, tag)], oriented=False)
            assert {t for _, t in bounds} == set(map(abs, found))


def test_curves_and_points() -> None:
    """The sheet's end cuts the interface's rim at two points and x = 0 at two more."""
    mesh = bar()
    placed = entities(mesh)
    ends = {tuple(p) for p in mesh.points[placed.points].tolist()}
    assert ends == {(x, 0.5, z) for x in (0.0, 1.0) for z in (0.0, 1.0)}
    curves, surfaces, _ = placed.bounds
    # a closed curve around x = 2; around x = 0 two; about the interface two; four of the sheet
    assert sorted(map(len, curves.values())) == [0, *[2] * 8]
    assert {tag: len(found) for tag, found in surfaces.items()} == {
        1: 3,
        2: 6,
        3: 3,
        4: 1,
        5: 3,
        9: 4,
    }
    counts = np.bincount(placed.dimension, minlength=4)
    assert counts.sum() == len(mesh.points)
    assert counts[0] == 4
    on_curves = placed.dimension == 1
    x, y, z = mesh.points[on_curves].T
    rim = ((y % 1 == 0) | (z % 1 == 0)) & np.isin(x, (0, 1, 2))
    assert (rim | ((y == 0.5) & (x <= 1))).all()
