"""How fast the volumes of meshes converge with the size of their elements.

Run: python -m benchmarks.mesh_convergence

For sphere, cylinder and torus: the relative error of the mesh's volume at ever smaller sizes, and
the order, the slope of its logarithm over that of the mean edge of the curved faces, from the
last two sizes. Volumes of 10-node tetrahedra are integrated over the curved elements.
"""

from __future__ import annotations

import math

import numpy as np
from rich.console import Console
from rich.table import Table

import decomp
from decomp.carriers import Plane
from decomp.geometry import Geometry
from decomp.meshes.model import TetMesh
from decomp.meshes.quality import volumes
from decomp.vectors import norm
from tests.solids import SOLIDS

PARTS = {"sphere": (20, 30, 45), "cylinder": (20, 30, 45), "torus": (40, 55, 75)}
"""Sizes are these parts of the diagonal; those of the torus because its tube is thin."""


def error_and_edge(name: str, part: int, order: int) -> tuple[int, float, float]:
    """Tetrahedra, relative error of the volume, and mean edge of its curved faces."""
    geometry = Geometry(SOLIDS[name].make())
    mesh: TetMesh = decomp.mesh(geometry, size=geometry.diagonal / part, order=order)
    (region,) = geometry.regions
    error = abs(float(volumes(mesh.points, mesh.tets).sum()) / region.volume - 1)
    curved = [
        mesh.group(f"{region.name}/{face.name}", 2).tag
        for face in region.faces
        if not isinstance(region.carriers[face.carrier], Plane)
    ]
    corners = mesh.points[mesh.triangles[np.isin(mesh.triangle_tags, curved), :3]]
    edge = float(norm(corners - np.roll(corners, 1, axis=1)).mean())
    return len(mesh.tets), error, edge


def main() -> None:
    table = Table("solid", "order", "size: error (tetrahedra)", "slope")
    for name, parts in PARTS.items():
        for order in (1, 2):
            found = [error_and_edge(name, part, order) for part in parts]
            (_, first, coarse), (_, last, fine) = found[-2:]
            slope = math.log(first / last) / math.log(coarse / fine)
            cells = [
                f"1/{part}: {error:.1e} ({tets:,})"
                for part, (tets, error, _) in zip(parts, found, strict=True)
            ]
            table.add_row(name, str(order), ", ".join(cells), f"{slope:.2f}")
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
