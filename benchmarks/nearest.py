"""Exact nearest-site queries next to libigl's signed distance to a triangle mesh.

Run: python benchmarks/nearest.py [--points 1000000] [--large 10000000]

Both solve the same solid in the same run on one core: `decomp` on the exact carriers, libigl on a
tessellation of about 50,000 triangles. The points are uniform in the
solid's bounding box. The deviation is the largest difference of the two signed distances: the
error of the facets.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

import decomp
from decomp.csg.solid import Solid

HOLES = 20
GOALS = {"block with a hole": 1e6, "manyholes2": 2e5}
GIGABYTE = 1e9


def block_with_hole() -> Solid:
    """Nine carriers before merging: a block and a cylinder with its ends."""
    return decomp.Block((0, 0, 0), (4, 3, 2)) - decomp.Cylinder((1.5, 1.5, -1), (1.5, 1.5, 3), 0.5)


def manyholes() -> Solid:
    """Netgen's `manyholes2.geo`: a plate with 20 x 20 holes, 406 carriers."""
    hole = decomp.InfiniteCylinder((0.5, 0.5, -1), (0, 0, 1), 0.2, name="hole")
    rows = hole.linear_copies((1, 0, 0), HOLES).linear_copies((0, 1, 0), HOLES)
    return decomp.Block((0, 0, 0), (HOLES, HOLES, 1), name="plate") - rows


def mesh_of_block() -> tuple[Any, Any]:
    """Vertices (n, 3) and triangles (m, 3), normals outwards, by Netgen's CSG mesher."""
    from netgen.csg import CSGeometry, Cylinder, OrthoBrick, Pnt
    from netgen.meshing import MeshingStep

    hole = Cylinder(Pnt(1.5, 1.5, -1), Pnt(1.5, 1.5, 3), 0.5)
    geometry = CSGeometry()
    geometry.Add(OrthoBrick(Pnt(0, 0, 0), Pnt(4, 3, 2)) - hole)
    mesh = geometry.GenerateMesh(maxh=0.05, perfstepsend=MeshingStep.MESHSURFACE)
    vertices = np.array([p.p for p in mesh.Points()])
    triangles = []
    for element in mesh.Elements2D():
        corners = [v.nr - 1 for v in element.vertices]
        outwards = mesh.FaceDescriptor(element.index).domin > 0
        triangles.append(corners if outwards else corners[::-1])
    return vertices, np.array(triangles)


def mesh_of_manyholes() -> tuple[Any, Any]:
    """The same for the plate: 20 chords around each hole, one layer from top to bottom.

    Netgen needs four times as many triangles for this solid, or leaves the holes square.
    """
    around = 20
    turn = np.arange(around) * 2 * np.pi / around - 0.75 * np.pi
    circle = 0.2 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    side = np.linspace(-0.5, 0.5, around // 4, endpoint=False)
    rest = np.full_like(side, 0.5)
    square = np.concatenate(
        [
            np.stack(pair, axis=1)
            for pair in ((side, -rest), (rest, side), (-side, rest), (-rest, -side))
        ]
    )
    k, n = np.arange(around), (np.arange(around) + 1) % around
    inner, outer, below = 0, around, 2 * around  # where the four rings of vertices begin
    top = [(outer + k, outer + n, inner + n), (outer + k, inner + n, inner + k)]
    bottom = [(below + c, below + b, below + a) for a, b, c in top]
    wall = [(inner + k, inner + n, below + n), (inner + k, below + n, below + k)]
    edge = [(outer + k, below + outer + n, outer + n)]
    edge += [(outer + k, below + outer + k, below + outer + n)]
    cell = np.concatenate([np.stack(t, axis=1) for t in (*top, *bottom, *wall)])
    rim = np.concatenate([np.stack(t, axis=1) for t in edge])
    ring = np.concatenate([circle, square]) + 0.5
    flat = np.concatenate([np.c_[ring, np.ones(len(ring))], np.c_[ring, np.zeros(len(ring))]])
    vertices, triangles = [], []
    for i in range(HOLES):
        for j in range(HOLES):
            here = flat + np.array([i, j, 0])
            middle = here[rim][:, :, :2].mean(axis=1)
            outermost = (np.abs(middle - HOLES / 2) > HOLES / 2 - 1e-9).any(axis=1)
            triangles.append(np.concatenate([cell, rim[outermost]]) + len(flat) * len(vertices))
            vertices.append(here)
    points, numbers = np.unique(np.round(np.concatenate(vertices), 12), axis=0, return_inverse=True)
    return points, numbers.ravel()[np.concatenate(triangles)]


MODELS: dict[str, tuple[Callable[[], Solid], Callable[[], tuple[Any, Any]]]] = {
    "block with a hole": (block_with_hole, mesh_of_block),
    "manyholes2": (manyholes, mesh_of_manyholes),
}


def best_of(runs: int, task: Callable[[], Any]) -> tuple[float, Any]:
    """Least CPU time of some runs (of all threads together), and the result."""
    times = []
    for _ in range(runs):
        start = time.process_time()
        result = task()
        times.append(time.process_time() - start)
    return min(times), result


def libigl_distance(points: Any, vertices: Any, triangles: Any) -> Any:
    """Signed distance to a triangle mesh."""
    import igl

    sign = igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
    return igl.signed_distance(points, vertices, triangles, sign)[0]


def memory_of(name: str, count: int) -> float:
    """Peak memory in bytes of a process that asks for `count` points, and nothing else."""
    command = [sys.executable, __file__, "--memory-of", name, "--large", str(count)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return float(done.stdout)


def ask(name: str, count: int) -> None:
    """The process of `memory_of`: the points and the answer are part of the peak."""
    part = decomp.Geometry(MODELS[name][0]())
    points = np.random.default_rng(0).random((count, 3))
    points *= part.regions[0].bounds[1]
    part.nearest(points)
    print(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def main() -> int:
    """Print the table; the exit code is 1 if a goal is missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--large", type=int, default=10_000_000)
    parser.add_argument("--memory-of", choices=MODELS, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.memory_of:
        ask(arguments.memory_of, arguments.large)
        return 0

    table = Table(title=f"nearest, {arguments.points:,} points, one core")
    for heading in (
        "solid",
        "carriers",
        "build s",
        "points/s",
        "goal",
        "triangles",
        "libigl points/s",
        "ratio",
        "max deviation",
        f"peak MB at {arguments.large:,}",
    ):
        table.add_column(heading, justify="right")
    missed = False
    for name, (make, mesh_of) in MODELS.items():
        part = decomp.Geometry(make())
        low, high = part.regions[0].bounds
        points = np.random.default_rng(0).uniform(low, high, (arguments.points, 3))
        part.nearest(points[:1000])  # compile
        fresh = decomp.Geometry(part.model)
        build, _ = best_of(1, lambda fresh=fresh, some=points[:1000]: fresh.nearest(some))
        ours, found = best_of(3, lambda part=part, points=points: part.nearest(points))
        signed = np.where(found.region >= 0, -found.distance, found.distance)

        vertices, triangles = mesh_of()
        theirs, facets = best_of(
            1, lambda v=vertices, t=triangles, p=points: libigl_distance(p, v, t)
        )
        rate, other = len(points) / ours, len(points) / theirs
        peak = memory_of(name, arguments.large)
        missed |= rate < GOALS[name] or peak > GIGABYTE
        table.add_row(
            name,
            str(len(part.boundaries.form.carriers)),
            f"{build:.2f}",
            f"{rate:,.0f}",
            f"{GOALS[name]:,.0f}",
            f"{len(triangles):,}",
            f"{other:,.0f}",
            f"{rate / other:.1f}",
            f"{np.abs(signed - facets).max():.1e}",
            f"{peak / 1e6:,.0f}",
        )
    Console(width=150).print(table)
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
