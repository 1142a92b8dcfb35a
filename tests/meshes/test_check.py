"""A right mesh passes; each fault made on purpose is found, and told in one line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.cli.main import main
from decomp.meshes.files.msh_reader import NONE, SEVERAL, ReadMesh, read_msh
from decomp.meshes.model import Group, GroupKind, TetMesh
from tests.meshes.shapes import cube, quadratic

CUBE = {"cube": decomp.Block((0, 0, 0), (1, 1, 1), name="cube")}
FILE = """algebraic3d
solid cube = orthobrick (0,0,0; 1,1,1);
tlo cube;
"""


def read() -> ReadMesh:
    mesh = cube()
    names = {(group.dimension, group.tag): group.name for group in mesh.groups}
    return ReadMesh(
        mesh.points, mesh.tets, mesh.tet_tags, mesh.triangles, mesh.triangle_tags, names
    )


def changed(array: np.ndarray, row: int, value: object) -> np.ndarray:
    result = array.copy()
    result[row] = value
    return result


def moved(mesh: ReadMesh, node: int, by: list[float]) -> ReadMesh:
    return replace(mesh, points=changed(mesh.points, node, mesh.points[node] + by))


def renamed(mesh: ReadMesh, dimension: int, tag: int, name: str) -> ReadMesh:
    return replace(mesh, names={**mesh.names, (dimension, tag): name})


def split_in_three(mesh: ReadMesh) -> ReadMesh:
    """One more tetrahedron on an inner face."""
    face = next(row for row in mesh.triangles if 8 in row)
    node = next(k for k in range(8) if k not in face)
    return replace(
        mesh,
        tets=np.concatenate([mesh.tets, [[*face, node]]]),
        tet_tags=np.append(mesh.tet_tags, 1),
    )


FAULTS: dict[str, tuple[Callable[[ReadMesh], ReadMesh], str]] = {
    "turned": (
        lambda m: replace(m, tets=changed(m.tets, 0, m.tets[0][[1, 0, 2, 3]])),
        "1 inverted tetrahedra",
    ),
    "ungrouped": (
        lambda m: replace(m, tet_tags=changed(m.tet_tags, 3, NONE)),
        "1 tetrahedra in no physical group",
    ),
    "in several": (
        lambda m: replace(m, triangle_tags=changed(m.triangle_tags, 3, SEVERAL)),
        "1 triangles in several physical groups",
    ),
    "third": (split_in_three, "2 faces in three tetrahedra"),
    "untagged": (
        lambda m: replace(
            m,
            triangles=m.triangles[m.triangle_tags != 2],
            triangle_tags=m.triangle_tags[m.triangle_tags != 2],
        ),
        "2 boundary faces without a physical group",
    ),
    "twice": (
        lambda m: replace(
            m,
            triangles=np.concatenate([m.triangles, m.triangles[:1]]),
            triangle_tags=np.append(m.triangle_tags, 5),
        ),
        "1 triangles that stand twice in it",
    ),
    "loose": (
        lambda m: replace(m, triangles=changed(m.triangles, 0, [0, 1, 6])),
        "1 triangles that are faces of no tetrahedron",
    ),
    "inward": (
        lambda m: replace(
            m,
            triangles=np.where(
                (m.triangle_tags == 1)[:, None], m.triangles[:, [1, 0, 2]], m.triangles
            ),
        ),
        "2 boundary triangles that point inward",
    ),
    "unknown cell": (
        lambda m: renamed(m, 3, 2, "cube/lid"),
        "1 volumes that the model has not: cube/lid",
    ),
    "lost cell": (
        lambda m: renamed(m, 3, 2, "cube/lid"),
        "1 cells without a volume: cube/cube.xmax",
    ),
    "unknown surface": (
        lambda m: renamed(m, 2, 2, "lid"),
        "1 surfaces that the model has not: lid",
    ),
    "lost face": (lambda m: renamed(m, 2, 2, "lid"), "1 faces without a surface: cube/cube.xmax"),
    "volume": (
        lambda m: moved(m, 0, [0.1, 0.1, 0.1]),
        "region cube has volume 0.9 in place of 1: off by 0.1, more than 0.005",
    ),
    "off": (
        lambda m: moved(m, 0, [0.1, 0.1, 0.1]),
        "1 nodes are off their exact surfaces, by up to 0.1 at (0.1, 0.1, 0.1)",
    ),
    "outside": (
        lambda m: moved(m, 0, [-0.1, -0.1, -0.1]),
        "6 tetrahedra reach more than 2 epsilon into a region that is not theirs",
    ),
    "across": (
        lambda m: moved(m, 8, [0.1, 0, 0]),
        "tetrahedra reach more than 2 epsilon into a cell that is not theirs",
    ),
    "mistagged": (
        # all of its nodes are where the cells meet
        lambda m: replace(m, tet_tags=changed(m.tet_tags, 0, 2)),
        "tetrahedra reach more than 2 epsilon into a cell that is not theirs",
    ),
}


def test_a_right_mesh() -> None:
    found = check(CUBE, cube())
    assert found.shortcomings == ()
    assert (found.tets, found.nodes, found.groups) == (12, 9, 24)
    assert found.volume_error < 1e-15
    assert (found.off_surface, found.stray) == (0.0, 0)
    assert check(CUBE, quadratic(cube())).shortcomings == ()


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault(fault: str) -> None:
    spoil, expected = FAULTS[fault]
    lines = check(CUBE, spoil(read())).shortcomings
    assert sum(line.startswith(expected) or expected in line for line in lines) == 1, lines


def test_little_is_forgiven() -> None:
    mesh = moved(read(), 0, [1e-4, 1e-4, 1e-4])
    assert len(check(CUBE, mesh).shortcomings) == 1
    assert check(CUBE, mesh, unprojected=1).shortcomings == ()
    shifted = moved(read(), 8, [0.006, 0, 0])
    # it is on the sheets between four of the cells no longer
    assert check(CUBE, shifted).off_surface == pytest.approx(0.006 / np.sqrt(2), rel=1e-6)
    assert check(CUBE, shifted, unprojected=1).shortcomings == ()
    assert len(check(CUBE, shifted, unprojected=1, epsilon=1e-3).shortcomings) == 1


BALL = {"ball": decomp.Sphere((0, 0, 0), 1, name="ball")}


@pytest.fixture(scope="module")
def coarse() -> TetMesh:
    return decomp.mesh(BALL, size=0.7)


def test_what_straight_edges_leave_out_is_told(coarse: TetMesh) -> None:
    found = check(BALL, coarse)
    assert found.shortcomings == ()
    assert found.volume_error > 1e-2
    assert found.chord_error == pytest.approx(found.volume_error, rel=0.02)
    assert found.unexplained_error < 5e-4


@pytest.mark.parametrize("part", [0.99, 1.01])
def test_what_they_do_not_explain_fails(coarse: TetMesh, part: float) -> None:
    found = check(BALL, replace(coarse, points=part * coarse.points), unprojected=10**6)
    assert found.unexplained_error == pytest.approx(abs(1 - part**3), rel=0.05)
    (line,) = found.shortcomings
    assert line.startswith("region ball has volume ") and "of straight edges" in line


def test_a_hole_fails(coarse: TetMesh) -> None:
    inner = np.flatnonzero(np.linalg.norm(coarse.points[coarse.tets].mean(axis=1), axis=1) < 0.3)
    kept = np.setdiff1d(np.arange(len(coarse.tets)), inner)
    holed = replace(
        coarse, tets=coarse.tets[kept], tet_tags=coarse.tet_tags[kept], cell_data={}, parts=None
    )
    lines = check(BALL, holed).shortcomings
    assert any(line.startswith("region ball has volume ") for line in lines)


def test_middle_nodes_are_shared() -> None:
    mesh = quadratic(cube())
    torn = replace(
        mesh,
        points=np.concatenate([mesh.points, mesh.points[mesh.tets[0, 4:5]]]),
        tets=changed(mesh.tets, 0, [*mesh.tets[0, :4], len(mesh.points), *mesh.tets[0, 5:]]),
    )
    assert [line.split(",")[0] for line in check(CUBE, torn).shortcomings] == [
        "1 edges with more than one middle node"
    ]


def test_whole_regions() -> None:
    """Without cells no skeleton is needed; sheets may be tagged all the same."""
    mesh = cube()
    sheets = replace(
        mesh,
        tet_tags=np.ones_like(mesh.tet_tags),
        groups=(Group(GroupKind.REGION, 1, "cube", ("cube",)), *mesh.groups[6:]),
    )
    assert check(CUBE, sheets).shortcomings == ()
    kept = mesh.triangle_tags <= 6
    surfaces = [g for g in mesh.groups if g.kind is GroupKind.FACE]
    plain = replace(
        mesh,
        tet_tags=np.ones_like(mesh.tet_tags),
        triangles=mesh.triangles[kept],
        triangle_tags=mesh.triangle_tags[kept],
        groups=(Group(GroupKind.REGION, 1, "cube", ("cube",)), *surfaces),
    )
    assert check(CUBE, plain).shortcomings == ()


def two_cubes() -> tuple[dict[str, decomp.Solid], TetMesh]:
    """Two cubes side by side, one region each, that share a face."""
    mesh = cube()
    other = mesh.points + np.array([1.0, 0, 0])
    shared = {4 + k: k for k in range(4)}
    number = np.array([*range(len(mesh.points)), *range(len(mesh.points))])
    place = np.zeros(len(mesh.points), dtype=np.int64)
    fresh = [k for k in range(9) if k not in shared.values()]
    place[fresh] = len(mesh.points) + np.arange(len(fresh))
    for here, there in shared.items():
        place[there] = number[here]
    left = mesh.triangle_tags <= 6
    right = left & (mesh.triangle_tags != 1)
    groups = [Group(GroupKind.REGION, k + 1, name, (name,)) for k, name in enumerate("ab")]
    sides = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")
    groups += [
        Group(GroupKind.FACE, k + 1, f"a/a.{side}", ("a",))
        for k, side in enumerate(sides)
        if side != "xmax"
    ]
    groups += [
        Group(GroupKind.FACE, k + 11, f"b/b.{side}", ("b",))
        for k, side in enumerate(sides)
        if side != "xmin"
    ]
    groups.append(Group(GroupKind.INTERFACE, 2, "a/a.xmax|b/b.xmin", ("a", "b")))
    made = TetMesh(
        "two",
        np.concatenate([mesh.points, other[fresh]]),
        np.concatenate([mesh.tets, place[mesh.tets]]),
        np.repeat([1, 2], len(mesh.tets)),
        np.concatenate([mesh.triangles[left], place[mesh.triangles[right]]]),
        np.concatenate([mesh.triangle_tags[left], mesh.triangle_tags[right] + 10]),
        tuple(groups),
        np.array([], dtype=np.int64),
    )
    solids = {
        "a": decomp.Block((0, 0, 0), (1, 1, 1), name="a"),
        "b": decomp.Block((1, 0, 0), (1, 1, 1), name="b"),
    }
    return solids, made


def test_interfaces() -> None:
    solids, mesh = two_cubes()
    assert check(solids, mesh).shortcomings == ()
    kept = mesh.triangle_tags != 2
    bare = replace(mesh, triangles=mesh.triangles[kept], triangle_tags=mesh.triangle_tags[kept])
    lines = check(solids, bare).shortcomings
    assert [line.split(",")[0] for line in lines] == [
        "2 faces between regions without a physical group"
    ]
    swapped = replace(mesh, tet_tags=changed(mesh.tet_tags, 0, 2))
    lines = check(solids, swapped).shortcomings
    assert any("into a region that is not theirs" in line for line in lines)


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model, good, bad = tmp_path / "cube.geo", tmp_path / "cube.msh", tmp_path / "bad.msh"
    model.write_text(FILE)
    cube().write(good)
    assert main(["check", str(model), str(good)]) == 0
    text = capsys.readouterr().out
    assert text.startswith(f"{good}: 12 tetrahedra, 9 nodes, 24 groups\n")
    assert text.endswith("  nothing falls short\n")
    replace(cube(), triangle_tags=changed(cube().triangle_tags, 0, 3)).write(bad, version="2.2")
    assert read_msh(bad).names[2, 3] == "cube/cube.ymin"
    assert main(["check", str(model), str(bad)]) == 1
    text = capsys.readouterr()
    assert "  FAILS: 1 nodes are off their exact surfaces, by up to 1 at " in text.out
    assert text.err == f"decomp: error: {bad} falls short of {model} in 1 way\n"
    assert main(["check", str(model), str(tmp_path / "none.msh")]) == 2
    assert main(["check", str(model), str(bad), "--quiet"]) == 1
    assert capsys.readouterr().out == ""
