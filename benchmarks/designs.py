"""Designs put together at random: a block with one to three parts added or cut out.

Parts are blocks, cylinders, spheres and cones at random places, through faces, edges and corners
alike. Their axes are parallel to the block's edges, or not all of them.
"""

from __future__ import annotations

import numpy as np

import decomp
from decomp.csg.solid import Solid
from decomp.vectors import Array


def design(seed: int, oblique: bool = False) -> Solid:
    """A solid of its own for every seed."""
    rng = np.random.default_rng(seed)
    sides = rng.uniform(2, 5, 3)
    solid: Solid = decomp.Block((0, 0, 0), sides, name="base")
    for k in range(int(rng.integers(1, 4))):
        part = _part(rng, sides, oblique, f"part{k}")
        solid = solid | part if rng.random() < 0.5 else solid - part
    return solid


def _part(rng: np.random.Generator, sides: Array, oblique: bool, name: str) -> Solid:
    kind = rng.choice(["block", "cylinder", "cylinder", "sphere", "cone"])
    centre = rng.uniform(-0.1, 1.1, 3) * sides
    radius, length = rng.uniform(0.2, 0.45) * sides.min(), rng.uniform(0.6, 2.5) * sides.min()
    axis = np.eye(3)[rng.integers(3)]
    turn, angle = rng.normal(size=3), 0.0
    if oblique and rng.random() < 0.5:
        axis, angle = turn / np.linalg.norm(turn), float(rng.uniform(0, 360))
    start, end = centre - axis * length / 2, centre + axis * length / 2
    if kind == "sphere":
        return decomp.Sphere(centre, radius, name=name)
    if kind == "cylinder":
        return decomp.Cylinder(start, end, radius, name=name)
    if kind == "cone":
        return decomp.Cone(start, radius, end, 0.4 * radius, name=name)
    half = np.array([radius, 1.3 * radius, length / 2])
    return decomp.Block(-half, half, name=name).rotate(turn, angle).translate(centre)
