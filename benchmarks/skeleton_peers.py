"""Exact skeletons next to what a Voronoi filter finds from 20,000 boundary samples.

Run: python -m benchmarks.skeleton_peers [--samples 20000] [--angle 40]

The filter is the usual one: of the Voronoi diagram of samples of the boundary (scipy, Qhull) keep
the facets that lie inside the solid and whose two samples are seen from all of their corners under
at least an angle, and at least three times as far apart as samples are. Its samples lie exactly on
the boundary, so its errors are its own.

Errors are relative to the model's diagonal. The reference is decomp's skeleton at a chord tolerance
of 1e-4, whose certificate bounds its own error. `to exact` is the largest distance from the output
to the exact skeleton, `from exact` the largest distance from the exact skeleton to the output
(20,000 points); of decomp at its default tolerance they are measured in the same way.
Times are CPU seconds, kernels compiled.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.spatial import Voronoi

import decomp
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.skeletons.certificate.coverage import boundary_samples, random_points, skeleton_tree
from decomp.skeletons.certificate.distance import triangle_distance, triangle_tree
from decomp.skeletons.certificate.evidence import Evidence

REFERENCE = 1e-4
APART = 3.0
PROBES = 20_000


def block_with_boss() -> Solid:
    """A block with a cylindrical boss."""
    boss = decomp.Cylinder((1, 0.5, 0.25), (1, 0.5, 0.9), 0.3, name="boss")
    return decomp.Block((0, 0, 0), (2, 1, 0.5), name="block") | boss


MODELS: dict[str, Callable[[], Solid]] = {
    "block": lambda: decomp.Block((0, 0, 0), (2, 1, 0.5)),
    "block+boss": block_with_boss,
    "cone": lambda: decomp.Cone((0, 0, 0), 1, (0, 0, 2)),
    "torus": lambda: decomp.Torus((0, 0, 0), (0, 0, 1), 2, 0.5),
    "cylinder": lambda: decomp.Cylinder((0, 0, 0), (0, 0, 3), 1),
}


def filtered(geometry: decomp.Geometry, samples: Any, area: float, angle: float) -> Any:
    """Points (n, 3) and polygons of the Voronoi facets that are kept.

    Args:
        geometry: the solid, to tell inside.
        samples: (k, 3) on its boundary.
        area: of the boundary.
        angle: in degrees.
    """
    diagram = Voronoi(samples)
    corners = diagram.vertices
    inside = geometry.nearest(corners).region >= 0
    pair = diagram.ridge_points
    apart = np.linalg.norm(samples[pair[:, 0]] - samples[pair[:, 1]], axis=1)
    wide = np.flatnonzero(apart >= APART * np.sqrt(area / len(samples)))
    limit = np.sin(np.radians(angle) / 2)
    kept = []
    for k in wide:
        ring = np.array(diagram.ridge_vertices[k])
        if (ring >= 0).all() and inside[ring].all():
            reach = np.linalg.norm(corners[ring] - samples[pair[k, 0]], axis=1)
            if (apart[k] >= 2 * limit * reach).all():
                kept.append(ring)
    return corners, kept


def euler_of(polygons: list[Any]) -> int:
    """Vertices - edges + facets."""
    sides = [np.stack([ring, np.roll(ring, -1)], axis=1) for ring in polygons]
    edges = np.unique(np.sort(np.concatenate(sides), axis=1), axis=0)
    return len(np.unique(np.concatenate(polygons))) - len(edges) + len(polygons)


def fans(polygons: list[Any]) -> Any:
    """Triangles (m, 3) of convex polygons."""
    return np.concatenate(
        [np.stack([np.repeat(p[0], len(p) - 2), p[1:-1], p[2:]], axis=1) for p in polygons]
    )


def evidence_of(skeleton: Any, geometry: decomp.Geometry) -> Evidence:
    """Of the only region."""
    return Evidence.of(skeleton, geometry.index, 0)


def probes(evidence: Evidence, rng: np.random.Generator) -> Any:
    """Points on a skeleton: random ones on its triangles and curves, and all its vertices."""
    points = evidence.complex.points
    found = [points[evidence.skeleton_vertices()]]
    triangles, segments = evidence.sheet_triangles(), evidence.reflexive_segments()
    if len(triangles):
        found.append(random_points(points, triangles, PROBES, rng))
    if len(segments):
        share = np.linspace(0, 1, 50)[:, None, None]
        ends = points[segments]
        found.append(((1 - share) * ends[:, 0] + share * ends[:, 1]).reshape(-1, 3))
    return np.concatenate(found)


def rows_of(name: str, count: int, angle: float) -> list[list[str]]:
    """A row for decomp and one for the filter."""
    rng = np.random.default_rng(0)
    start = time.process_time()
    geometry = decomp.Geometry(MODELS[name]())
    ours = decomp.skeleton(geometry)
    seconds = time.process_time() - start
    exact = evidence_of(decomp.skeleton(geometry, REFERENCE), geometry)
    reference, on_exact = skeleton_tree(exact), probes(exact, rng)
    mine = evidence_of(ours, geometry)
    certificate = ours.regions[0].certificate
    due = certificate.expected_euler

    def row(tool: str, seconds: float, count: int, euler: int, there: Any, back: Any) -> list[str]:
        errors = [f"{there.max() / ours.diagonal:.1e}", f"{back.max() / ours.diagonal:.1e}"]
        marked = f"{euler} of {due}{'' if euler == due else ' !'}"
        return [name, tool, f"{seconds:.2f}", f"{count:,}", *errors, marked]

    rows = [
        row(
            "decomp",
            seconds,
            len(mine.sheet_triangles()),
            certificate.euler,
            triangle_distance(reference, probes(mine, rng)),
            triangle_distance(skeleton_tree(mine), on_exact),
        )
    ]
    samples = np.concatenate([points for points, _ in boundary_samples(exact, count, rng)])
    area = geometry.regions[0].area
    start = time.process_time()
    corners, polygons = filtered(geometry, samples, area, angle)
    seconds = time.process_time() - start
    if not polygons:
        return [*rows, [name, "Voronoi filter", f"{seconds:.2f}", "0", "", "", "nothing kept"]]
    triangles = fans(polygons)
    on_theirs = np.concatenate(
        [corners[np.unique(triangles)], random_points(corners, triangles, PROBES, rng)]
    )
    tree = triangle_tree(corners[triangles])
    rows.append(
        row(
            "Voronoi filter",
            seconds,
            len(triangles),
            euler_of(polygons),
            triangle_distance(reference, on_theirs),
            triangle_distance(tree, on_exact),
        )
    )
    return rows


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int, default=20_000)
    parser.add_argument("--angle", type=float, default=40.0, help="degrees")
    parser.add_argument("--only", nargs="+", choices=MODELS, default=list(MODELS), metavar="NAME")
    options = parser.parse_args()
    decomp.skeleton(decomp.Block((0, 0, 0), (1, 2, 3)))  # loads the kernels
    table = Table(title=f"skeletons from {options.samples:,} samples, angle {options.angle:g}°")
    for heading in ("model", "tool", "CPU s", "triangles", "to exact", "from exact", "Euler"):
        table.add_column(heading, justify="left" if heading in ("model", "tool") else "right")
    for name in options.only:
        try:
            rows = rows_of(name, options.samples, options.angle)
        except GeometryError as error:
            rows = [[name, "decomp", str(error)]]
        for row in rows:
            table.add_row(*row)
            print(" | ".join(row), flush=True)
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
