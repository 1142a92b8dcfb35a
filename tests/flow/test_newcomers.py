"""What a newcomer meets reads like help: docs/limits.md holds every message word by word."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path

import pytest

from decomp.cli.main import main
from decomp.csg.primitives import Block
from decomp.errors import DecompError, InputError
from decomp.geometry import Geometry
from decomp.meshing.sizing import memory
from decomp.meshing.sizing.expected import least_tets
from decomp.meshing.sizing.sizes import Wanted, region_sizes
from decomp.ways.mesh import mesh
from tests import pages
from tests.meshes.shapes import bar, cube

PAGE = (Path(__file__).parent.parent.parent / "docs" / "limits.md").read_text()
GEO = "algebraic3d\n"
PART = GEO + "solid part = orthobrick (0,0,0; 40,30,5);\ntlo part;\n"
FILES = {
    "part.geo": PART,
    "same.json": PART,
    "index.json": PART,
    "part.stl": "solid part\n",
    "part.step": "ISO-10303-21;\n",
    "part.vtu": "<VTKFile/>\n",
    "part.scad": "x = 3;\ncube([x, 1, 1]);\n",
    "of_gmsh.geo": 'SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 1, 1, 1};\n',
    "empty.geo": "\n",
    "egg.geo": GEO + "solid egg = ellipsoid (0,0,0; 1,0,0; 0,2,0; 0,0,3);\ntlo egg;\n",
    "oval.geo": GEO
    + "solid oval = ellipticcylinder (0,0,0; 2,0,0; 0,1,0) and plane (0,0,0; 0,0,-1)\n"
    "  and plane (0,0,3; 0,0,1);\ntlo oval;\n",
    "profile.csg": "linear_extrude(height = 3) { square(size = [1, 2]); }\n",
    "stretched.csg": "multmatrix([[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { sphere(r = 1); }\n",
    "apart.geo": GEO + "solid apart = sphere (0,0,0; 1) and sphere (5,0,0; 1);\ntlo apart;\n",
    "endless.geo": GEO + "solid endless = plane (0,0,0; 0,0,1);\ntlo endless;\n",
    "far.geo": GEO + "solid far = sphere (1e308,0,0; 1);\ntlo far;\n",
    "many.geo": GEO
    + "solid ball = sphere (0,0,0; 0.1);\nsolid row = multitranslate (1,0,0; 999; ball);\n"
    + "solid many = multitranslate (0,1,0; 999; row);\ntlo many;\n",
    "twice.geo": GEO + "solid twice = sphere (0,0,0; 1);\nsolid twice = sphere (0,0,0; 2);\n",
    "tube.geo": GEO + "solid tube = sphere (0,0,0; 1);\n",
    "kiss.geo": GEO
    + "solid one = sphere (0,0,0; 1);\nsolid two = sphere (2,0,0; 1);\nsolid kiss = one or two;\n"
    "tlo kiss;\n",
    "tangled.geo": GEO
    + "solid a = sphere (0,0,0; 1);\nsolid b = sphere (1,0,0; 1);\ntlo a;\ntlo b;\n",
}
FREE = 16 * 10**9


def said() -> list[tuple[str, str]]:
    """The page's commands and what they answer."""
    blocks = [text for language, _, text in pages.blocks("docs/limits.md") if language == "console"]
    pairs = [re.findall(r"\$ (decomp .*)\n(decomp: error: .*)\n", block) for block in blocks]
    assert all(
        2 * len(found) == block.count("\n") for found, block in zip(pairs, blocks, strict=True)
    )
    return [pair for found in pairs for pair in found]


SAID = said()


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with the files, on a machine with 16 GB free and no pyvista."""
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    cube().write(tmp_path / "part.msh", text=True)
    (tmp_path / "linked.json").symlink_to("part.geo")
    (tmp_path / "closed.msh").touch(0o444)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(memory, "available_memory", lambda: FREE)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    return tmp_path


@pytest.mark.parametrize(("command", "answer"), SAID, ids=[command for command, _ in SAID])
def test_errors_are_those_of_the_page(
    command: str, answer: str, place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = {path.name for path in place.iterdir()}
    code = main(shlex.split(command)[1:])
    pattern = re.escape(f"{answer}\n").replace(r"\(\.\.\.\)", r"\([-+.e\d, ]+\)")
    assert re.fullmatch(pattern, capsys.readouterr().err)
    assert code == (3 if answer.startswith("decomp: error: region") else 2)
    assert {path.name for path in place.iterdir()} == before


def test_a_directory_is_no_model(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["mesh", "."]) == 2
    assert "this is a directory; give the name of a model file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("package", "method"),
    [("skfem", "to_skfem"), ("meshio", "to_meshio"), ("pyvista", "to_pyvista")],
)
def test_missing_packages(package: str, method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    (promised,) = re.findall(rf"mesh\.{method}\(\) +# (.*)", PAGE)
    for kind in (ImportError, InputError):
        with pytest.raises(kind) as raised:
            getattr(bar(), method)()
        assert str(raised.value) == promised


def test_a_package_that_is_broken_is_not_called_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from decomp.optional import needed

    (tmp_path / "broken_package.py").write_text("import what_it_needs_and_has_not\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(ModuleNotFoundError, match="what_it_needs_and_has_not") as raised:
        needed("broken_package", "broken-package", "this")
    assert not isinstance(raised.value, DecompError)


def test_what_the_memory_error_promises_fits() -> None:
    geometry = Geometry(Block((0, 0, 0), (40, 30, 5)))

    def tets(size: float) -> float:
        return least_tets(geometry, region_sizes(geometry, Wanted(size)))

    for size in (1e-7, 1e-3, 0.02):
        with pytest.raises(InputError) as raised:
            memory.check_memory(tets(size), size, FREE)
        (found,) = re.findall(r"a size of (\S+) makes", str(raised.value))
        memory.check_memory(tets(float(found)), float(found), FREE)
        with pytest.raises(InputError):
            memory.check_memory(tets(0.85 * float(found)), 0.85 * float(found), FREE)


def test_what_layers_add_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The largest edges alone would fit; the layers do not."""
    block = Geometry(Block((0, 0, 0), (4, 3, 2)))
    coarse = least_tets(block, region_sizes(block, Wanted(1.0)))
    free = int(10 * coarse * memory.BYTES_PER_TET)
    monkeypatch.setattr(memory, "available_memory", lambda: free)
    with pytest.raises(InputError, match="GB are free: longer edges or fewer layers"):
        mesh(block, size=1.0, layers=8)


def test_memory_is_told() -> None:
    free = memory.available_memory()
    assert free is None or 10**7 < free < 10**14


def test_the_limit_of_a_container_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "CGROUP", tmp_path)
    unlimited = memory.available_memory()
    (tmp_path / "memory.max").write_text("max\n")
    (tmp_path / "memory.current").write_text("1000\n")
    assert (memory.available_memory() is None) == (unlimited is None)
    (tmp_path / "memory.max").write_text("5000\n")
    assert memory.available_memory() == 4000
