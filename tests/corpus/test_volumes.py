"""Volumes of real files, from their raw text by sampling and from Netgen's own mesher."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterable
from functools import cache
from math import pi

import pytest

import decomp
from decomp.boundary.topology import RegionBoundary
from tests.corpus import files, oracle
from tests.corpus.files import FILES
from tests.corpus.geo_text import read

ACCURACY = 3e-5
AGREEMENT = 1e-4
LONG = ("netgen/shell.geo", "netgen/manyholes2.geo")
MINUTE = "netgen/cubemsphere.geo"
EULER = {
    "netgen/manyholes.geo": [-99],
    "netgen/manyholes2.geo": [-399],
    "netgen/shell.geo": [2],
    "netgen/torus.geo": [0],
    "netgen/sphere.geo": [1],
    "netgen/fichera.geo": [1],
    "netgen/sphereincube.geo": [2, 1],
    "netgen/matrix.geo": [3, 4],
    "netgen/cubemcyl.geo": [0],
    "elmer/BallsInBall.geo": [4, 5],
}
PLANAR = (
    "netgen/cube.geo",
    "netgen/fichera.geo",
    "netgen/lshape3d.geo",
    "netgen/ortho.geo",
    "netgen/twobricks.geo",
    "netgen/twocubes.geo",
    "netgen/boundarycondition.geo",
    "ngsolve/beam.geo",
)
CURVED = {
    "netgen/cylinder.geo": 0.08,
    "netgen/cone.geo": 0.12,
    "netgen/twocyl.geo": 0.08,
    "netgen/cylsphere.geo": 0.1,
    "netgen/sphere.geo": 0.12,
}

NETGEN = """
import json, sys
import numpy as np
from netgen.csg import CSGeometry

mesh = CSGeometry(sys.argv[1]).GenerateMesh(maxh=float(sys.argv[2]))
points = np.array([p.p for p in mesh.Points()])
volumes = {}
for tet in mesh.Elements3D():
    corners = points[[v.nr - 1 for v in tet.vertices]]
    size = abs(np.linalg.det(corners[1:] - corners[0])) / 6
    volumes[tet.index] = volumes.get(tet.index, 0.0) + size
print("VOLUMES", json.dumps([volumes[k] for k in sorted(volumes)]))
"""


def present(names: Iterable[str]) -> list[str]:
    """Those of the named files that are at hand."""
    return [name for name in names if name in FILES]


@cache
def regions(name: str) -> tuple[RegionBoundary, ...]:
    return decomp.Geometry(FILES[name]).regions


def netgen_volumes(name: str, size: float) -> list[float]:
    """Volumes of Netgen's mesh of a file, in a process of its own as Netgen may crash."""
    run = subprocess.run(
        [sys.executable, "-c", NETGEN, str(FILES[name]), str(size)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    lines = [line for line in run.stdout.splitlines() if line.startswith("VOLUMES")]
    assert lines, run.stderr[-2000:]
    return list(json.loads(lines[0].removeprefix("VOLUMES")))


def test_there_are_files() -> None:
    assert len(FILES) >= 25
    assert set(EULER) - set(FILES) <= {"elmer/BallsInBall.geo"} | {
        f"netgen/{p}.geo" for p in ("matrix", "cylsphere")
    }


def test_files_that_netgen_ships_are_found() -> None:
    """They stand in when the corpus is not at hand."""
    assert len(files.shipped()) >= 25


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] if n in LONG else []) for n in FILES]
)
def test_volume_agrees_with_sampling_of_the_raw_text(name: str) -> None:
    nodes = read(FILES[name])
    assert [r.name for r in regions(name)] == list(nodes)
    for region in regions(name):
        found = oracle.volume(nodes[region.name], 1e-12 if name == MINUTE else ACCURACY)
        assert found.error <= ACCURACY * found.volume
        assert abs(region.volume - found.volume) <= AGREEMENT * found.volume, found
        # the same random numbers every time, so five standard errors never fail by chance
        assert abs(region.volume - found.volume) <= 5 * found.error + 1e-12 * found.volume, found
        assert region.volume_error <= 1e-9 * region.volume


def test_a_minute_bite_is_seen() -> None:
    """A ball of radius 0.001 on a face of the unit cube takes away half its volume."""
    (region,) = regions(MINUTE)
    bite = 2 / 3 * pi * 1e-9
    assert 1 - region.volume == pytest.approx(bite, rel=1e-5)
    found = oracle.volume(read(FILES[MINUTE])["main"], 1e-12)
    assert 1 - found.volume == pytest.approx(bite, rel=5e-3)


@pytest.mark.parametrize("name", present(EULER))
def test_euler_characteristic(name: str) -> None:
    assert [r.euler for r in regions(name)] == EULER[name]


def test_regions_of_the_transformer_fill_its_box() -> None:
    found = regions("netgen/trafo.geo")
    assert [r.name for r in found] == ["coil1", "coil2", "coil3", "air", "core"]
    assert sum(r.volume for r in found) == pytest.approx(24 * 16 * 10, rel=1e-12)


@pytest.mark.parametrize("name", present(PLANAR))
def test_planar_solids_have_the_volume_of_netgens_mesh(name: str) -> None:
    pytest.importorskip("netgen")
    exact = netgen_volumes(name, 100.0)
    assert [r.volume for r in regions(name)] == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize("name", present(CURVED))
def test_curved_solids_have_the_volume_of_netgens_mesh_within_its_chords(name: str) -> None:
    pytest.importorskip("netgen")
    coarse = netgen_volumes(name, CURVED[name])
    assert [r.volume for r in regions(name)] == pytest.approx(coarse, rel=1e-2)
