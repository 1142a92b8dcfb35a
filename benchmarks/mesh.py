"""Meshes by decomp next to what else makes tetrahedra of CSG solids.

Run: python -m benchmarks.mesh [--only NAME ...] [--limit 300]

Each route runs in a process of its own, with a time limit, from the model (a solid in memory or a
Netgen file) to tetrahedra in memory; imports and, for decomp, the loading of compiled kernels come
before. Times are wall seconds and CPU seconds of all threads and child processes.

- decomp: `decomp.mesh` with a largest edge of 1/20 of the model's diagonal (left to itself it makes
  edges shorter where curved faces need it for their volume, which the facets' route cannot).
- facets: manifold3d's booleans of primitives tessellated to the same chord error, then pytetwild
  with its defaults at the same absolute edge length and epsilon that decomp gives it.
- Gmsh: its OpenCASCADE kernel, with a largest edge that gives about as many tetrahedra.
- Netgen: its CSG kernel, likewise.

Volume errors are relative to the exact volume, from corner nodes. `names` counts the named volumes
and surfaces that come with the mesh. The last lines give decomp's time over that of the facets,
geometric mean over all models.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.csg_peers import Facets, Kernel, Netgen
from decomp.csg.solid import Solid
from decomp.formats import load
from decomp.geometry import Geometry
from decomp.meshes.quality import dihedral_angles, volumes
from tests.corpus.files import FILES
from tests.solids import SOLIDS

ROOT = Path(__file__).parents[1]
MODELS = {
    "block": "block",
    "cylinder": "cylinder",
    "hole": "through hole",
    "blind hole": "blind hole",
    "tee": "unequal tee",
    "sculpture": "netgen/sculpture.geo",
    "shaft": "netgen/shaft.geo",
    "torus": "torus",
    "manyholes": "netgen/manyholes.geo",
}
ROUTES = ("decomp", "facets", "Gmsh", "Netgen")
EDGES = 20.0
CHORD = 0.5
"""Chord error of decomp's complex and of the facets, in epsilons."""
CLOSE = 0.1
"""Peers' numbers of tetrahedra are within so much of decomp's, or what five tries come to."""
TRIES = 5


def source_of(name: str) -> Solid | Path:
    """A solid or a model file."""
    key = MODELS[name]
    return SOLIDS[key].make() if key in SOLIDS else FILES[key]


def solid_of(name: str) -> Solid:
    """The solid of a model's one region."""
    source = source_of(name)
    if isinstance(source, Solid):
        return source
    (region,) = load(source).regions
    return region.solid


class Clock:
    """Wall seconds, and CPU seconds of this process and its children."""

    def __init__(self) -> None:
        self._wall, self._cpu = time.perf_counter(), self._used()

    def spent(self) -> dict[str, float]:
        return {"wall": time.perf_counter() - self._wall, "cpu": self._used() - self._cpu}

    @staticmethod
    def _used() -> float:
        both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        return sum(sum(resource.getrusage(who)[:2]) for who in both)


def figures(points: Any, tets: Any, exact: float) -> dict[str, float]:
    """Of tetrahedra (m, 4)."""
    least = dihedral_angles(points, tets).min(axis=1)
    return {
        "tets": len(tets),
        "least": float(least.min()),
        "mean": float(least.mean()),
        "error": float(abs(volumes(points, tets)).sum() / exact - 1),
    }


def by_decomp(name: str, given: dict[str, float]) -> dict[str, float]:
    """The whole way; tells the edge length and epsilon that TetWild was given, too."""
    from decomp.meshing.backends.base import Tetrahedra
    from decomp.meshing.backends.tetwild import mesher
    from decomp.ways import mesh as meshing

    meshing.mesh(SOLIDS["conical pit"].make())  # loads the kernels
    asked: list[Any] = []
    tetwild = mesher.MESHER

    def recording(task: Any, *rest: Any) -> Tetrahedra:
        asked.append(task)
        return tetwild.run(task, *rest)

    mesher.MESHER = replace(tetwild, run=recording)
    source = source_of(name)
    geometry = Geometry(source)
    size = geometry.diagonal / EDGES
    clock = Clock()
    made = meshing.mesh(source, size=size, volumes="cells", sheets=True)
    spent = clock.spent()
    exact = geometry.regions[0].volume
    names = {"names": float(len(made.groups)), "unprojected": float(len(made.unprojected))}
    told = {
        "edge": asked[-1].length,
        "epsilon": asked[-1].tolerance,
        "exact": exact,
    }
    return spent | figures(made.points, made.tets[:, :4], exact) | names | told


def by_facets(name: str, given: dict[str, float]) -> dict[str, float]:
    """Booleans of facets, then TetWild with its defaults."""
    import manifold3d  # noqa: F401
    import pytetwild

    bounds = np.array(Geometry(source_of(name)).regions[0].bounds)
    node = solid_of(name)
    diagonal = float(np.linalg.norm(bounds[1] - bounds[0]))
    clock = Clock()
    surface = Facets(bounds, CHORD * given["epsilon"]).build(node).to_mesh64()
    points, tets = pytetwild.tetrahedralize(
        np.array(surface.vert_properties[:, :3], dtype=np.float64),
        np.array(surface.tri_verts, dtype=np.int32),
        edge_length_abs=given["edge"],
        epsilon=given["epsilon"] / diagonal,
    )
    return clock.spent() | figures(points, tets, given["exact"]) | {"names": 0.0}


def by_gmsh(name: str, given: dict[str, float]) -> dict[str, float]:
    """OpenCASCADE's shapes, Gmsh's tetrahedra."""
    import gmsh

    bounds = np.array(Geometry(source_of(name)).regions[0].bounds)
    node = solid_of(name)

    def run(size: float) -> tuple[dict[str, float], Any, Any, int]:
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        clock = Clock()
        kept = Kernel(bounds, 0.0).build(node)
        gmsh.model.occ.synchronize()
        every = gmsh.model.getEntities(3)
        gmsh.model.occ.remove([entity for entity in every if entity not in kept], recursive=True)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.model.mesh.generate(3)
        spent = clock.spent()
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        _, nodes = gmsh.model.mesh.getElementsByType(4)
        place = np.zeros(int(tags.max()) + 1, dtype=np.int64)
        place[tags] = np.arange(len(tags))
        names = sum(bool(gmsh.model.getPhysicalName(*g)) for g in gmsh.model.getPhysicalGroups())
        gmsh.finalize()
        return spent, coordinates.reshape(-1, 3), place[nodes.reshape(-1, 4)], names

    return alike(run, given)


def by_netgen(name: str, given: dict[str, float]) -> dict[str, float]:
    """Netgen's CSG."""
    from netgen import csg, meshing

    source = source_of(name)
    bounds = np.array(Geometry(source).regions[0].bounds)

    def run(size: float) -> tuple[dict[str, float], Any, Any, int]:
        clock = Clock()
        if isinstance(source, Solid):
            geometry = csg.CSGeometry()
            geometry.Add(Netgen(bounds, 0.0).build(source))
        else:
            geometry = csg.CSGeometry(str(source))
        made = geometry.GenerateMesh(mp=meshing.MeshingParameters(maxh=size))
        spent = clock.spent()
        points = np.array(made.Coordinates())  # a copy: it is a view of the mesh
        tets = made.Elements3D().NumPy()["nodes"][:, :4].astype(np.int64) - 1
        return spent, points, tets, 0

    return alike(run, given)


def alike(run: Any, given: dict[str, float]) -> dict[str, float]:
    """The run whose number of tetrahedra is nearest to what is asked for."""
    size, best = given["edge"], None
    for _ in range(TRIES):
        spent, points, tets, names = run(size)
        ratio = len(tets) / given["tets"]
        if best is None or abs(math.log(ratio)) < abs(math.log(best[0])):
            best = ratio, spent | figures(points, tets, given["exact"]) | {"names": float(names)}
        if abs(ratio - 1) < CLOSE:
            break
        size *= ratio ** (1 / 3)
    assert best is not None
    return best[1]


def child(route: str, name: str, given: dict[str, float], limit: float) -> dict[str, Any]:
    """What a process prints, or why it printed nothing."""
    command = [sys.executable, "-m", "benchmarks.mesh", "--child", route, name, json.dumps(given)]
    try:
        with tempfile.TemporaryDirectory() as folder:  # pytetwild leaves files where it runs
            done = subprocess.run(
                command,
                capture_output=True,
                text=True,
                timeout=limit,
                check=False,
                cwd=folder,
                env={**os.environ, "PYTHONPATH": str(ROOT)},
            )
    except subprocess.TimeoutExpired:
        return {"failure": f"over {limit:.0f} s"}
    lines = done.stdout.strip().splitlines()
    if done.returncode == 0 and lines:
        found: dict[str, Any] = json.loads(lines[-1])
        return found
    last = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
    return {"failure": last[:60]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="*", default=list(MODELS), metavar="NAME")
    parser.add_argument("--limit", type=float, default=300.0, metavar="S")
    parser.add_argument("--child", nargs=3, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        route, name, given = options.child
        work = {"decomp": by_decomp, "facets": by_facets, "Gmsh": by_gmsh, "Netgen": by_netgen}
        print(json.dumps(work[route](name, json.loads(given))))
        return
    table = Table("model", "route", "s", "CPU s", "tets", "least", "mean least", "volume", "names")
    for column in table.columns[2:]:
        column.justify = "right"
    ratios = {"wall": [], "cpu": []}
    for name in options.only:
        found = {"decomp": child("decomp", name, {}, options.limit)}
        own = found["decomp"]
        for route in ROUTES[1:]:
            if "failure" not in own:
                found[route] = child(route, name, own, options.limit)
        for route, row in found.items():
            table.add_row(name if route == "decomp" else "", route, *_cells(row))
        table.add_section()
        if not any("failure" in found.get(route, {"failure": ""}) for route in ROUTES[:2]):
            for key, kept in ratios.items():
                kept.append(own[key] / found["facets"][key])
    console = Console(width=110)
    console.print(table)
    for key, kept in ratios.items():
        if kept:
            mean = math.exp(sum(map(math.log, kept)) / len(kept))
            console.print(f"decomp / facets, {key}: {mean:.2f} over {len(kept)} models")


def _cells(row: dict[str, Any]) -> tuple[str, ...]:
    if "failure" in row:
        return (row["failure"],)
    return (
        f"{row['wall']:.1f}",
        f"{row['cpu']:.1f}",
        f"{row['tets']:.0f}",
        f"{row['least']:.1f}",
        f"{row['mean']:.1f}",
        f"{row['error']:+.1e}",
        f"{row['names']:.0f}",
    )


if __name__ == "__main__":
    sys.exit(main())
