"""A mesh named by patterns has the same groups, of the same size, in every program that reads it.

The heat sink of `test_groups`: all its faces are plane, so lengths, areas and volumes are exact.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import skfem

from decomp.meshes.files.inp import valid_names
from decomp.meshes.model import TetMesh
from tests.meshes.opened import opened
from tests.meshes.other_pythons import said_by
from tests.meshes.test_groups import mesh

PATTERNS = {
    "metal": ["sink", "lid"],
    "tips": "fin*.zmax",
    "warm": ["chip/*.x*", "chip/*.y*", "lid/*.x*"],
    "pressed": "chip/*.zmax",
    "feet": "base.zmax&fin*.*",
}
EXACT = {
    (3, "metal"): 60 + 36 + 4,
    (3, "chip"): 4,
    (2, "tips"): 3 * 6,
    (2, "warm"): 6 * 2,
    (2, "pressed"): 4,
    (2, "sink/base.zmax"): 7 * 6,
    (1, "feet"): 3 * 2 * 6,
}
"""By dimension and name: volumes, areas, lengths."""
Sizes = dict[tuple[int, str], float]


@cache
def named() -> TetMesh:
    return mesh().grouped(groups=PATTERNS)


@cache
def sizes() -> Sizes:
    """Of all groups, as the mesh's arrays have them."""
    made, found = named(), {}
    for group in made.groups:
        elements, tags = {
            3: (made.tets, made.tet_tags),
            2: (made.triangles, made.triangle_tags),
            1: (made.lines, made.line_tags),
        }[group.dimension]
        corners = made.points[elements[tags == group.tag]]
        sides = corners[:, 1:] - corners[:, :1]
        gram = np.linalg.det(sides @ sides.transpose(0, 2, 1))
        scale = {3: 6, 2: 2, 1: 1}[group.dimension]
        found[group.dimension, group.name] = float(np.sqrt(gram).sum() / scale)
    return found


def assert_same(found: Sizes, least: int) -> None:
    """All groups from a dimension on, and no others, have their sizes."""
    wanted = {key: size for key, size in sizes().items() if key[0] >= least}
    assert found == pytest.approx(wanted, rel=1e-9)


def test_what_is_known() -> None:
    assert {key: sizes()[key] for key in EXACT} == pytest.approx(EXACT, rel=1e-12)
    assert {name for _, name in EXACT} > set(PATTERNS)


@pytest.mark.parametrize("version", ["4.1", "2.2"])
def test_gmsh(version: str, tmp_path: Path) -> None:
    path = tmp_path / "sink.msh"
    named().write(path, version=version)
    found: Sizes = {}
    with opened(path) as gmsh:
        for dimension, tag in gmsh.model.getPhysicalGroups():
            size = 0.0
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
                for elements in gmsh.model.mesh.getElements(dimension, entity)[1]:
                    size += gmsh.model.mesh.getElementQualities(elements, "volume").sum()
            found[dimension, gmsh.model.getPhysicalName(dimension, tag)] = float(size)
    assert_same(found, 1)


def test_scikit_fem() -> None:
    made, element = named().to_skfem(), skfem.ElementTetP1()
    found: Sizes = {
        (2, name): float(skfem.FacetBasis(made, element, facets=name).dx.sum())
        for name in made.boundaries
    }
    volumes = {
        name: float(skfem.Basis(made, element, elements=name).dx.sum()) for name in made.subdomains
    }
    # regions keep their names beside the group that joins them
    assert volumes.pop("sink") + volumes.pop("lid") == pytest.approx(EXACT[3, "metal"])
    assert_same(found | {(3, name): volume for name, volume in volumes.items()}, 2)


def test_mfem(tmp_path: Path) -> None:
    mfem = pytest.importorskip("mfem.ser")
    named().write(tmp_path / "sink.msh", version="2.2")
    read = mfem.Mesh(str(tmp_path / "sink.msh"))
    space = mfem.FiniteElementSpace(read, mfem.H1_FECollection(1, 3))
    one = mfem.ConstantCoefficient(1.0)
    found: Sizes = {}
    for dimension, sets in ((3, read.attribute_sets), (2, read.bdr_attribute_sets)):
        for name in sets.GetAttributeSetNames():
            form, marker = mfem.LinearForm(space), sets.GetAttributeSetMarker(name)
            if dimension == 3:
                form.AddDomainIntegrator(mfem.DomainLFIntegrator(one), marker)
            else:
                form.AddBoundaryIntegrator(mfem.BoundaryLFIntegrator(one), marker)
            form.Assemble()
            found[dimension, name] = float(form.Sum())
    assert_same(found, 2)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
def test_calculix(tmp_path: Path) -> None:
    """Volumes of element sets, areas of surfaces, and the nodes of each set of nodes."""
    made = named()
    made.write(tmp_path / "sink.inp")
    volumes = [group for group in made.groups if group.dimension == 3]
    others = [group for group in made.groups if group.dimension < 3]
    own = dict(zip(valid_names(group.name for group in volumes), volumes, strict=True))
    outer = dict(zip(valid_names(group.name for group in others), others, strict=True))
    lines = ["*INCLUDE, INPUT=sink.inp", "*MATERIAL, NAME=ANY", "*ELASTIC", "1., 0."]
    lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=ANY" for name in own]
    lines += ["*STEP", "*STATIC", "*BOUNDARY", "NALL, 1, 3"]
    for name in own:
        lines += [f"*EL PRINT, ELSET={name}, TOTALS=ONLY", "EVOL"]
    for name, group in outer.items():
        lines += [f"*NODE PRINT, NSET={name}", "U"]
        if group.dimension == 2:
            lines += [f"*SECTION PRINT, SURFACE={name}, NAME=OF_IT", "SOF"]
    (tmp_path / "ask.inp").write_text("\n".join([*lines, "*END STEP", ""]))
    run = subprocess.run(
        ["ccx", "ask"], cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False
    )
    assert "*ERROR" not in run.stdout, run.stdout[-2000:]
    said = (tmp_path / "ask.dat").read_text()
    volume = re.findall(r"total volume for set (\S+) .*\n\n +(\S+)", said)
    area = re.findall(r"for surface set (\S+) and(?s:.*?)\n +area, .*\n\n +(\S+)", said)
    found = {(3, own[name].name): float(size) for name, size in volume}
    found |= {(2, outer[name].name): float(size) for name, size in area}
    wanted = {key: size for key, size in sizes().items() if key[0] >= 2}
    assert found == pytest.approx(wanted, rel=1e-6)  # it prints seven digits
    listed = re.findall(r"displacements .* for set (\S+) and.*\n\n((?: +\d+ .*\n)+)", said)
    held = {name: {int(row.split()[0]) for row in rows.splitlines()} for name, rows in listed}
    elements = {2: (made.triangles, made.triangle_tags), 1: (made.lines, made.line_tags)}
    for name, group in outer.items():
        rows, tags = elements[group.dimension]
        assert held[name] == set((rows[tags == group.tag] + 1).ravel().tolist()), name


DOLFINX = """
import json

import gmsh
from dolfinx import fem
from mpi4py import MPI
from petsc4py.PETSc import ScalarType
from ufl import Measure

try:
    from dolfinx.io.gmsh import model_to_mesh
except ImportError:
    from dolfinx.io.gmshio import model_to_mesh

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.open("sink.msh")
mesh, cells, facets = model_to_mesh(gmsh.model, MPI.COMM_WORLD, 0, gdim=3)[:3]
one = fem.Constant(mesh, ScalarType(1))
inside = Measure("dx", mesh, subdomain_data=cells)
outer = Measure("ds", mesh, subdomain_data=facets)
inner = Measure("dS", mesh, subdomain_data=facets)
found = []
for dimension, tag in gmsh.model.getPhysicalGroups():
    if dimension >= 2:
        parts = [inside(tag)] if dimension == 3 else [outer(tag), inner(tag)]
        size = sum(fem.assemble_scalar(fem.form(one * part)) for part in parts)
        found.append([dimension, gmsh.model.getPhysicalName(dimension, tag), float(size.real)])
gmsh.finalize()
print("found", json.dumps(found))
"""
"""Before version 0.10 there are three results, and another module."""


@pytest.mark.slow
def test_dolfinx(tmp_path: Path) -> None:
    named().write(tmp_path / "sink.msh")
    said = said_by(DOLFINX, "dolfinx, gmsh", tmp_path).split("found ")[-1]
    assert_same({(dimension, name): size for dimension, name, size in json.loads(said)}, 2)
