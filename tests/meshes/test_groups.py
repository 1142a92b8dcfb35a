"""Groups of one mesh, chosen in every way, in every format: a heat sink of three fins on a chip.

The fins part the top of the base into four pieces; base and chip share a part of their faces.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
import skfem

import decomp
from decomp.checking.check import check
from decomp.cli.main import main
from decomp.csg.model import Region, model
from decomp.errors import InputError
from decomp.meshes.files.msh_reader import read_msh
from decomp.meshes.group import GroupKind
from decomp.meshes.model import TetMesh
from tests.meshes.opened import named_sizes, opened
from tests.meshes.test_reading import KINDS

PIECES = [f"sink/base.zmax{end}" for end in ("", "@2", "@3", "@4")]
PRESSED = "sink/base.zmin|chip/chip.zmax"


@cache
def sink() -> decomp.Geometry:
    base = decomp.Block((0, 0, 0), (10, 6, 1), name="base")
    fins = decomp.Block((1, 0, 1), (1, 6, 2), name="fin").linear_copies((3, 0, 0), 3)
    chip = decomp.Block((3, 2, -1), (2, 2, 1), name="chip")
    lid = decomp.Block((3, 2, -2), (2, 2, 1), name="lid")
    return decomp.Geometry(
        model(
            [
                Region("sink", base | fins, {"material": "metal"}),
                Region("chip", chip),
                Region("lid", lid, {"material": "metal"}),
            ]
        )
    )


def clean(order: int, size: float) -> TetMesh:
    """A mesh with all nodes on their surfaces: TetWild's luck, of which other tests are."""
    for _ in range(4):
        made = decomp.mesh(sink(), size=size, order=order)
        if not len(made.unprojected):
            break
    return made


@cache
def mesh() -> TetMesh:
    return clean(1, 1.5)


def area(made: TetMesh, name: str) -> float:
    own = made.triangles[made.triangle_tags == made.group(name, 2).tag, :3]
    a, b, c = np.moveaxis(made.points[own], 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def names(made: TetMesh, dimension: int) -> list[str]:
    return [group.name for group in made.groups if group.dimension == dimension]


def test_usual_groups() -> None:
    made = mesh()
    assert names(made, 3) == ["sink", "chip", "lid"]
    assert not [g for g in made.groups if g.kind is GroupKind.SHEET or g.dimension < 2]
    assert made.group("sink/base.zmax").members == tuple(PIECES)
    assert area(made, "sink/base.zmax") == pytest.approx((10 - 3) * 6, rel=1e-12)
    assert area(made, PRESSED) == pytest.approx(4, rel=1e-12)
    assert set(made.cell_data) == {"cell"}
    assert made.cell_data["cell"].min() == 1
    assert made.cell_data["cell"].max() == len(made.all_parts.cells)


def test_split_faces() -> None:
    made = mesh().grouped(split_faces=True)
    assert set(PIECES) <= set(names(made, 2))
    widths = sorted(area(made, name) / 6 for name in PIECES)
    assert widths == pytest.approx([1, 2, 2, 2], rel=1e-12)


def test_cells_and_sheets() -> None:
    made = mesh().grouped(volumes="cells", sheets=True)
    assert len(names(made, 3)) == len(made.all_parts.cells) > 3
    sheets = [g for g in made.groups if g.kind is GroupKind.SHEET]
    assert sheets
    assert np.isin(made.triangle_tags, [g.tag for g in sheets]).any()
    assert np.array_equal(made.tet_tags, made.cell_data["cell"])
    again = made.grouped()
    assert again.groups == mesh().groups
    assert np.array_equal(again.triangle_tags, mesh().triangle_tags)


def test_materials() -> None:
    made = mesh().grouped(volumes="materials")
    assert names(made, 3) == ["metal", "chip"]
    metal = made.group("metal")
    assert metal.members == ("sink", "lid")
    assert metal.volume == pytest.approx(60 + 36 + 4, rel=1e-12)
    assert metal.regions == ("sink", "lid")
    # a name for one of the regions is above its material
    named = mesh().grouped(volumes="materials", groups={"heater": ["chip", "lid"]})
    assert names(named, 3) == ["metal", "heater"]


def test_names_of_ones_own() -> None:
    made = mesh().grouped(groups={"tips": "fin*.zmax", "hot": ["chip/*.x*", "lid/*.x*"]})
    assert area(made, "tips") == pytest.approx(3 * 6, rel=1e-12)
    assert area(made, "hot") == pytest.approx(4 * 2, rel=1e-12)
    assert made.group("hot").regions == ("chip", "lid")
    assert "sink/fin#1.zmax" not in names(made, 2)
    pressed = mesh().grouped(groups={"pressed": "chip/*.zmax"})
    assert area(pressed, "pressed") == pytest.approx(4, rel=1e-12)
    top = mesh().grouped(groups={"first": "sink/base.zmax@2"})
    assert len(top.group("sink/base.zmax").members) == 3


def test_edges_and_vertices() -> None:
    made = mesh().grouped(edges=True)

    def ends(name: str) -> np.ndarray:
        return made.points[made.lines[made.line_tags == made.group(name, 1).tag][:, :2]]

    lengths = np.linalg.norm(np.diff(ends("lid/lid.xmin&lid.ymin"), axis=1), axis=2)
    assert lengths.sum() == pytest.approx(1, rel=1e-12)
    along = ends("sink/base.zmax&fin#1.xmin")
    assert along[..., 0] == pytest.approx(1, abs=1e-12)
    assert along[..., 2] == pytest.approx(1, abs=1e-12)
    # the chip's rim is an edge of two regions
    rim = made.select("chip/chip.z*&chip.x*", 1)
    assert [group.name for group in rim if "sink" in group.regions] == [
        "sink/base.zmin|chip/chip.xmax&chip.zmax",
        "sink/base.zmin|chip/chip.xmin&chip.zmax",
    ]
    corner = made.group("sink/base.xmin&base.ymin&base.zmin", 0)
    assert made.points[made.nodes[made.node_tags == corner.tag]].tolist() == [[0, 0, 0]]
    # 3 fins of 4 upper corners and 4 feet each, 8 of the base, 12 of chip and lid
    assert len(made.nodes) == 3 * 8 + 8 + 12
    only = mesh().grouped(groups={"feet": "base.zmax&fin*.*"})
    assert names(only, 1) == ["feet"]
    assert names(only, 0) == []
    both = only.points[only.lines]
    assert np.linalg.norm(both[:, 1] - both[:, 0], axis=1).sum() == pytest.approx(36, rel=1e-12)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("kind", KINDS)
def test_files(kind: str, order: int, tmp_path: Path) -> None:
    """What Gmsh reads is what was chosen, and the check looks at cells and single faces."""
    path = tmp_path / "sink.msh"
    given = mesh() if order == 1 else quadratic_sink()
    made = given.grouped(groups={"tips": "fin*.zmax", "metal": ["sink", "lid"]}, edges=True)
    made.write(path, **KINDS[kind])
    with opened(path) as gmsh:
        found = named_sizes(gmsh)
    tags = (made.node_tags, made.line_tags, made.triangle_tags, made.tet_tags)
    assert found == {
        (g.dimension, g.name): int((tags[g.dimension] == g.tag).sum()) for g in made.groups
    }
    read = read_msh(path)
    assert set(np.unique(read.cell_data["cell"]).tolist()) == set(
        np.unique(made.cell_data["cell"]).tolist()
    )
    result = check(sink(), path)
    assert result.shortcomings == ()
    assert result.groups == len(made.groups)


@cache
def quadratic_sink() -> TetMesh:
    return clean(2, 3)


@pytest.mark.parametrize("suffix", [".vtu", ".xdmf", ".msh"])
def test_meshio_reads_lines_and_points(suffix: str, tmp_path: Path) -> None:
    made = mesh().grouped(groups={"tips": "fin*.zmax"}, edges=True)
    path = tmp_path / f"sink{suffix}"
    made.write(path)
    read = meshio.read(path)
    tag = "group" if suffix == ".vtu" else "gmsh:physical"
    for kind, own in (
        *([] if suffix == ".xdmf" else [("vertex", made.node_tags)]),
        ("line", made.line_tags),
        ("triangle", made.triangle_tags),
        ("tetra", made.tet_tags),
    ):
        assert sorted(read.cell_data_dict[tag][kind].tolist()) == sorted(own.tolist())
    if suffix == ".vtu":
        grid = pyvista.read(path)
        assert grid.field_data["curve lid/lid.xmin&lid.ymin"].tolist() == [
            made.group("lid/lid.xmin&lid.ymin").tag
        ]
        assert sorted(read.cell_data_dict["cell"]["tetra"]) == sorted(made.cell_data["cell"])
    own = made.to_meshio()
    assert [len(rows) for rows in own.cell_sets["tips"]] == [
        0,
        0,
        int((made.triangle_tags == made.group("tips").tag).sum()),
        0,
    ]


def test_abaqus_and_medit(tmp_path: Path) -> None:
    made = mesh().grouped(groups={"tips": "fin*.zmax", "foot": "base.zmax&fin#1.xmin"}, edges=True)
    for name in ("sink.inp", "sink.mesh"):
        made.write(tmp_path / name)
    text = (tmp_path / "sink.inp").read_text()
    assert "** NSET, SURFACE TIPS: tips\n" in text
    start = text.index("*NSET, NSET=FOOT\n") + len("*NSET, NSET=FOOT\n")
    listed = text[start : text.index("*", start)].replace("\n", ",")
    nodes = {int(word) - 1 for word in listed.split(",") if word.strip()}
    assert nodes == set(np.unique(made.lines[made.line_tags == made.group("foot").tag]).tolist())
    lines = (tmp_path / "sink.mesh").read_text().splitlines()
    at = lines.index("Edges")
    assert int(lines[at + 1]) == len(made.lines)
    read = meshio.read(tmp_path / "sink.mesh")
    assert (read.cell_data_dict["medit:ref"]["line"] == made.line_tags).all()
    assert (read.point_data["medit:ref"] > 0).sum() == len(made.nodes)


def test_solvers_read_the_same_groups(tmp_path: Path) -> None:
    made = mesh().grouped(groups={"tips": "fin*.zmax", "metal": ["sink", "lid"]}, edges=True)
    made.write(tmp_path / "sink.msh", version="2.2")
    sizes = {
        name: int((made.triangle_tags == made.group(name, 2).tag).sum()) for name in names(made, 2)
    }
    given = made.to_skfem()
    assert {name: len(own) for name, own in given.boundaries.items()} == sizes
    assert set(given.subdomains) == {"metal", "chip", "sink", "lid"}
    volume = skfem.Basis(given, skfem.ElementTetP0(), elements="metal")
    assert float(volume.dx.sum()) == pytest.approx(100, rel=1e-12)
    netgen = pytest.importorskip("netgen.read_gmsh").ReadGmsh(str(tmp_path / "sink.msh"))
    walls = [netgen.GetBCName(element.index - 1) for element in netgen.Elements2D()]
    assert {name: walls.count(name) for name in set(walls)} == sizes
    mfem = pytest.importorskip("mfem.ser")
    read = mfem.Mesh(str(tmp_path / "sink.msh"))
    assert sorted(read.attribute_sets.GetAttributeSetNames()) == ["chip", "metal"]
    assert set(read.bdr_attribute_sets.GetAttributeSetNames()) == set(sizes)
    (tips,) = read.bdr_attribute_sets.GetAttributeSet("tips").ToList()
    own = [read.GetBdrAttribute(k) for k in range(read.GetNBE())]
    assert own.count(tips) == sizes["tips"]


FAULTS = {
    "nothing": ({"tips": "fun*.zmax"}, "'fun*.zmax' of group 'tips' stands for none of the faces"),
    "near": ({"a": "sink/bse.zmax"}, "did you mean 'sink/base.zmax'"),
    "no region": ({"a": "sinc"}, "none of the regions; did you mean 'sink'?"),
    "twice": (
        {"a": "fin*.zmax", "b": "fin#1.*"},
        "sink/fin#1.zmax would be in two groups, 'a' and 'b'",
    ),
    "unlike": ({"a": ["sink", "base.zmax"]}, "group 'a' would join regions and faces"),
    "no edge": (
        {"a": "base.zmax&fin#1.zmax"},
        "none of the edges; did you mean 'sink/base.zmax&fin",
    ),
    "no interface": ({"a": "sink/*|chop/*.zmax"}, "'chop/*.zmax' of group 'a' stands"),
    "taken": (
        {"sink/base.zmin": "fin*.zmax"},
        "'sink/base.zmin' cannot be the name of a group of sink/fin#",
    ),
    "no list": ({"a": 5}, "group 'a' must have a pattern or a list of some"),
    "no name": ({" ": "sink"}, "a group's name must be a text and not empty"),
    "no dictionary": (["a"], "groups must be patterns by name"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_what_cannot_be(fault: str) -> None:
    """Told before a mesh is made, and by one that is there."""
    groups, said = FAULTS[fault]
    with pytest.raises(InputError) as caught:
        mesh().grouped(groups=groups)  # type: ignore[arg-type]
    if fault != "no interface":
        assert said in str(caught.value)
    told: list[str] = []
    with pytest.raises(InputError) as caught:
        decomp.mesh(sink(), size=1.5, groups=groups, progress=lambda what, _: told.append(what))  # type: ignore[arg-type]
    assert said in str(caught.value)
    assert fault == "taken" or not told


def test_pieces_of_a_plane() -> None:
    """A plane's face is called as the plane is; here a trench parts it into two."""
    low = decomp.HalfSpace((0, 0, 1), (0, 0, 1), name="top")
    box = decomp.Block((0, 0, 0), (3, 2, 2), name="box")
    trench = decomp.Block((1, -1, 0.5), (1, 4, 2), name="trench")
    part = decomp.Geometry({"part": (box & low) - trench})
    made = decomp.mesh(part, size=1, cells="none")
    assert made.group("part/top").members == ("part/top", "part/top@2")
    assert area(made, "part/top") == pytest.approx(4, rel=1e-12)
    assert check(part, made).shortcomings == ()
    assert area(made.grouped(groups={"lid": "*/top"}), "lid") == pytest.approx(4, rel=1e-12)
    with pytest.raises(InputError, match=r"none of the regions; '\*/top' stands for faces"):
        made.grouped(groups={"lid": "top"})


def test_what_a_mesh_without_cells_has_not() -> None:
    block = decomp.Block((0, 0, 0), (1, 1, 1))
    for options in ({"volumes": "cells"}, {"sheets": True}):
        with pytest.raises(InputError, match="a mesh without cells has none"):
            decomp.mesh(block, cells="none", **options)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="volumes of materials are wanted, and no region has one"):
        decomp.mesh(block, volumes="materials")


def test_names_that_are_none() -> None:
    made = mesh()
    for error in (KeyError, InputError):
        with pytest.raises(error, match=r"no group 'sink/base.zmx'; did you mean 'sink/base.zmax'"):
            made.group("sink/base.zmx")
    with pytest.raises(InputError, match=r"no volume 'sink/base.zmax', but a surface of that name"):
        made.group("sink/base.zmax", 3)
    with pytest.raises(InputError, match=r"'nut\*' stands for no group; there are sink, chip, lid"):
        made.select("nut*")
    cells = made.grouped(volumes="cells")
    (name,) = {n for n in names(cells, 3) if n == "lid/lid.zmin"}
    with pytest.raises(InputError, match=r"a volume .dimension 3. and a surface .dimension 2."):
        cells.group(name)
    assert {g.dimension for g in cells.select(name)} == {2, 3}


def test_a_wrong_group_is_found(tmp_path: Path) -> None:
    """A triangle or tetrahedron in another group than its part's, and a group without parts."""
    path = tmp_path / "sink.msh"
    made = mesh().grouped(groups={"tips": "fin*.zmax"})
    made.write(path, version="2.2")
    head, _, rest = path.read_text().partition("$Elements\n")
    count, *lines = rest.splitlines()
    wrong = made.group("sink/base.xmin").tag
    for what, kind, tag, new, said in (
        (
            "triangle",
            "2",
            made.group("tips").tag,
            wrong,
            "surface sink/base.xmin holds elements",
        ),
        ("tetrahedron", "4", 1, 2, "volume chip holds elements of sink/"),
    ):
        row = next(k for k, x in enumerate(lines) if x.split()[1:4] == [kind, "2", str(tag)])
        words = lines[row].split()
        words[3] = str(new)
        spoiled = "\n".join([count, *lines[:row], " ".join(words), *lines[row + 1 :], ""])
        path.write_text(f"{head}$Elements\n{spoiled}")
        found = check(sink(), path).shortcomings
        assert any(line.startswith(said) for line in found), (what, found)
    path.write_text(f"{head}$Elements\n{rest}".replace('"tips"', '"tops"', 1))
    assert "1 surfaces that the model has not: tops" in check(sink(), path).shortcomings


def test_wrong_edges_are_found(tmp_path: Path) -> None:
    """A line on another edge, one inside a face, and a point that is no vertex."""
    path = tmp_path / "sink.msh"
    mesh().grouped(edges=True).write(path)
    read = read_msh(path)
    assert check(sink(), read).shortcomings == ()
    foot, tip = (
        next(tag for (d, tag), name in read.names.items() if (d, name) == (1, wanted))
        for wanted in ("sink/base.zmax&fin#1.xmin", "sink/fin#1.xmin&fin#1.zmax")
    )
    swapped = np.where(read.line_tags == foot, tip, read.line_tags)
    count = int((read.line_tags == foot).sum())
    expected = [
        f"{count} elements of curve sink/fin#1.xmin&fin#1.zmax are not where the faces meet that "
        "it is named for"
    ]
    assert list(check(sink(), replace(read, line_tags=swapped)).shortcomings) == expected
    lines, nodes = read.lines.copy(), read.nodes.copy()
    inside = np.setdiff1d(read.tets, read.triangles)[0]
    around = read.tets[(read.tets == inside).any(axis=1)][0]
    lines[0] = [inside, around[around != inside][0]]
    nodes[0] = np.setdiff1d(np.unique(read.lines), read.nodes)[0]
    found = check(sink(), replace(read, lines=lines, nodes=nodes)).shortcomings
    assert [line.split(" of ")[0] for line in found] == ["1 elements"] * 2


def test_a_wrong_cell_is_found(tmp_path: Path) -> None:
    made = mesh()
    cell = made.cell_data["cell"].copy()
    centre = made.points[made.tets].mean(axis=1)
    deep = int(np.argmin(np.linalg.norm(centre - [0.4, 0.4, 0.5], axis=1)))
    far = int(np.argmax(centre[:, 0] * (centre[:, 2] < 1)))
    cell[deep] = cell[far]
    assert cell[deep] != made.cell_data["cell"][deep]
    path = tmp_path / "sink.msh"
    replace(made, cell_data={"cell": cell}).write(path)
    lines = check(sink(), path).shortcomings
    assert any("into a cell that is not theirs" in line for line in lines)


def test_others_files_are_known_by_their_names(tmp_path: Path) -> None:
    """Gmsh drops fields, and others comments: pieces of a face are found by the face's name."""
    path, again = tmp_path / "sink.msh", tmp_path / "again.msh"
    mesh().write(path)
    with opened(path) as gmsh:
        gmsh.write(str(again))
    read = read_msh(again)
    assert read.cell_data == {}
    assert check(sink(), again).shortcomings == ()
    assert check(sink(), replace(read, about=None)).shortcomings == ()
    moved = read.points.copy()
    moved[(moved == [0, 0, 1]).all(axis=1)] += [0, 0, 0.1]
    lines = check(sink(), replace(read, about=None, points=moved)).shortcomings
    assert any("1 nodes are off their exact surfaces, by up to 0.1 at" in line for line in lines)


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    Path("two.geo").write_text(
        "algebraic3d\nsolid box = orthobrick (0,0,0; 2,1,1);\n"
        "solid left = plane (1,0,0; 1,0,0);\nsolid a = box and left;\n"
        "solid b = box and not left;\ntlo a -material=iron;\ntlo b -material=iron;\n"
    )
    Path("names.toml").write_text('ends = "box.x*"\n"long side" = ["a/box.ymin", "b/box.ymin"]\n')
    words = ["mesh", "two.geo", "--size", "0.5", "--volumes", "materials", "--quiet"]
    assert main([*words, "--groups", "names.toml", "--group", "top=*/box.zmax"]) == 0
    found = read_msh("two.msh")
    assert {"iron", "ends", "long side", "top"} <= set(found.names.values())
    assert main(["check", "two.geo", "two.msh", "--quiet"]) == 0
    capsys.readouterr()
    for text, said in (
        ("a = [1]", "'a' must have a pattern or a list of some"),
        ("a =", "names.toml: this is no TOML: "),
        ("[a]\nb='c'", "names.toml: 'a' must have a pattern"),
        ("a = 'box.ymn'", "'box.ymn' of group 'a' stands for none of the faces"),
    ):
        Path("names.toml").write_text(text)
        assert main([*words, "-o", "new.msh", "--groups", "names.toml"]) == 2
        assert said in capsys.readouterr().err
    assert main([*words, "--groups", "none.toml", "-o", "new.msh"]) == 2
    assert "none.toml: cannot be read: No such file" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main([*words, "--group", "top"])
    assert "must be NAME=PATTERN" in capsys.readouterr().err
    assert not Path("new.msh").exists()
