"""Parts as people draw them: tangent faces, equal sizes, several features of one height."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from math import cos, pi, sin

import numpy as np

from decomp.csg.primitives import Block, Cone, Cylinder, HalfSpace, Sphere, Torus
from decomp.csg.solid import Solid

ROUND = 0.5
"""Radius of the rounded box's edges."""


def hexagon(height: float, apothem: float) -> Solid:
    solid: Solid = Block((-5, -5, 0), (10, 10, height), name="ends")
    for k in range(6):
        way = (cos(k * pi / 3), sin(k * pi / 3), 0.0)
        point = (apothem * way[0], apothem * way[1], 0.0)
        solid = solid & HalfSpace(point, way, name=f"flat{k}")
    return solid


def bolt() -> Solid:
    """The chamfer's cone, end and shank are equally far from one point of the axis."""
    shank = Cylinder((0, 0, -4), (0, 0, 0.1), 0.6, name="shank")
    return hexagon(0.8, 1.1) | shank | Cone((0, 0, -4), 0.6, (0, 0, -4.4), 0.3, name="chamfer")


def nut() -> Solid:
    return hexagon(1, 1.2) - Cylinder((0, 0, -1), (0, 0, 2), 0.6, name="bore")


def rounded_box(size: tuple[float, float, float] = (4, 3, 2)) -> Solid:
    """All faces go on into one another: planes, cylinders along edges, spheres at corners."""
    low, high = np.full(3, ROUND), np.array(size) - ROUND
    solid: Solid | None = None
    for axis in range(3):
        start, extent = low.copy(), high - low
        start[axis], extent[axis] = 0, extent[axis] + 2 * ROUND
        slab = Block(start, extent, name="xyz"[axis])
        solid = slab if solid is None else solid | slab
    assert solid is not None
    ends = np.stack([low, high])
    for axis, one, two in product(range(3), (0, 1), (0, 1)):
        start, end = low.copy(), high.copy()
        for other, side in zip([k for k in range(3) if k != axis], (one, two), strict=True):
            start[other] = end[other] = ends[side, other]
        solid = solid | Cylinder(start, end, ROUND, name="edge")
    for corner in product((0, 1), repeat=3):
        solid = solid | Sphere(ends[list(corner), range(3)], ROUND, name="corner")
    return solid


def drilled_plate() -> Solid:
    """Twice as thick as its corners' radius: their axes are points of the skeleton."""
    solid = Block((ROUND, 0, 0), (3, 3, 1), name="x") | Block((0, ROUND, 0), (4, 2, 1), name="y")
    for x, y in product((ROUND, 4 - ROUND), (ROUND, 3 - ROUND)):
        solid = solid | Cylinder((x, y, 0), (x, y, 1), ROUND, name="corner")
    return solid - Cylinder((2, 1.5, -1), (2, 1.5, 2), 0.6, name="hole")


def bull_nose() -> Solid:
    """A disc whose rim is half a torus, with one curve of centres all around."""
    disc = Cylinder((0, 0, 0), (0, 0, 1), 2, name="disc")
    return disc | Torus((0, 0, 0.5), (0, 0, 1), 2, 0.5, name="rim")


def obround_pocket() -> Solid:
    ends = [Cylinder((x, 2, 0.8), (x, 2, 3), 1, name=f"end{x}") for x in (2, 4)]
    pocket = ends[0] | ends[1] | Block((2, 1, 0.8), (2, 2, 3), name="slot")
    return Block((0, 0, 0), (6, 4, 2), name="plate") - pocket


def crossing_pipes() -> Solid:
    """Equal pipes: all edges on two pairs of carriers, which touch where the edges cross."""
    ends = (((-4, 0, 0), (4, 0, 0)), ((0, -4, 0), (0, 4, 0)))
    outer, inner = (
        [Cylinder(a, b, radius, name=f"{name}{k}") for k, (a, b) in enumerate(ends)]
        for name, radius in (("out", 1), ("in", 0.7))
    )
    return (outer[0] | outer[1]) - inner[0] - inner[1]


def ribbed_box() -> Solid:
    """Ribs cut the edges along the floor into parts, with short gaps between."""
    solid = Block((0, 0, 0), (6, 4, 3), name="box") - Block(
        (0.3, 0.3, 0.3), (5.4, 3.4, 3), name="room"
    )
    for x in (2, 4):
        solid = solid | Block((x, 0.3, 0.3), (0.2, 3.4, 1.5), name=f"rib{x}")
    return solid


def ball_on_a_post() -> Solid:
    """On a plate as thick as the post's radius: the sheet in it ends where the post begins."""
    plate = Block((0, 0, 0), (4, 4, 0.5), name="plate")
    post = Cylinder((2, 2, 0.5), (2, 2, 2), 0.5, name="post")
    return plate | post | Sphere((2, 2, 2), 0.7, name="ball")


def three_arms() -> Solid:
    sizes = np.ones((3, 3)) + 2 * np.eye(3)
    one, two, three = (Block((0, 0, 0), size, name=f"arm{k}") for k, size in enumerate(sizes))
    return one | two | three


def pulley() -> Solid:
    wheel = Cylinder((0, 0, 0), (0, 0, 1.4), 3, name="wheel")
    groove = Torus((0, 0, 0.7), (0, 0, 1), 3, 0.5, name="groove")
    return wheel - groove - Cylinder((0, 0, -1), (0, 0, 2), 0.7, name="bore")


def hinge() -> Solid:
    leaf = Block((0, 0, 0), (3, 4, 0.4), name="leaf")
    knuckles = [
        Cylinder((3, y, 0.2), (3, y + 1.2, 0.2), 0.5, name=f"knuckle{k}")
        for k, y in enumerate((0, 2.8))
    ]
    return (leaf | knuckles[0] | knuckles[1]) - Cylinder(
        (3, -1, 0.2), (3, 5, 0.2), 0.25, name="pin"
    )


def gusset() -> Solid:
    angle = Block((0, 0, 0), (6, 4, 0.8), name="foot") | Block((0, 0, 0), (0.8, 4, 5), name="back")
    web = Block((0.8, 1.7, 0.8), (2.5, 0.6, 2.5), name="web")
    return angle | (web & HalfSpace((3.3, 0, 0.8), (1, 0, 1), name="slope"))


PARTS: dict[str, Callable[[], Solid]] = {
    "bolt": bolt,
    "nut": nut,
    "rounded box": rounded_box,
    "drilled plate": drilled_plate,
    "bull nose": bull_nose,
    "obround pocket": obround_pocket,
    "crossing pipes": crossing_pipes,
    "ribbed box": ribbed_box,
    "ball on a post": ball_on_a_post,
    "three arms": three_arms,
    "pulley": pulley,
    "hinge": hinge,
    "gusset": gusset,
}
