"""Solids for tests of skeletons that the shared table does not have."""

from __future__ import annotations

from collections.abc import Callable

from decomp.csg.primitives import Block, Cone, Cylinder, InfiniteCylinder, Sphere, Torus
from decomp.csg.solid import Solid


def angle(long: float, thick: float) -> Solid:
    """An L, 2 high: a foot along x that is 1 thick and a leg along y of its own thickness."""
    foot = Block((0, 0, 0), (3, 1, 2), name="foot")
    return foot | Block((0, 0, 0), (thick, long, 2), name="leg")


def washer() -> Solid:
    return Cylinder((0, 0, 0), (0, 0, 1), 5, name="disc") - InfiniteCylinder(
        (0, 0, 0), (0, 0, 1), 1, name="bore"
    )


def walled() -> Solid:
    """A block of 4 x 3 x 2 with a wall of 1/1000 of its diagonal beside a slot."""
    wall = 29**0.5 / 1000
    slot = Block((wall, 1, -1), (1, 1, 4), name="slot")
    return Block((0, 0, 0), (4, 3, 2), name="block") - slot


Point = tuple[float, float, float]


def branched(branch: Solid) -> Solid:
    """A pipe along x with something that leaves it."""
    return Cylinder((-5, 0, 0), (5, 0, 0), 1, name="run") | branch


def offset_tee(beside: float, radius: float) -> Solid:
    """A pipe with a branch whose axis passes beside the pipe's."""
    return Cylinder((-3, 0, 0), (3, 0, 0), 1, name="run") | Cylinder(
        (0, beside, 0), (0, beside, 3), radius, name="branch"
    )


def bulge() -> Solid:
    """A bar with a ball on it whose centre is beside the bar's axis."""
    return Cylinder((-2, 0, 0), (2, 0, 0), 0.5, name="bar") | Sphere((0, 0.2, 0), 0.8, name="ball")


def spoke() -> Solid:
    return Torus((0, 0, 0), (0, 0, 1), 2, 0.5, name="rim") | Cylinder(
        (0, 0, 0), (2, 0, 0), 0.3, name="spoke"
    )


def grooved() -> Solid:
    """A shaft with a round groove: both faces' reflexive loci are the axis."""
    ring = Torus((0, 0, 2), (0, 0, 1), 1.2, 0.4, name="groove")
    return Cylinder((0, 0, 0), (0, 0, 4), 1, name="shaft") - ring


def with_boss(base: float, height: float, start: Point, end: Point, radius: float) -> Solid:
    """A block with a round boss that breaks through its edges."""
    return Block((0, 0, 0), (4, base, height), name="base") | Cylinder(
        start, end, radius, name="boss"
    )


def with_ball(centre: Point) -> Solid:
    """A block with a ball that breaks through its faces."""
    return Block((0, 0, 0), (4, 3, 2.2), name="base") | Sphere(centre, 0.7, name="ball")


def rod_and_rib() -> Solid:
    """A rod that sticks out of a block through three faces, and a rib that passes through both."""
    rod = Cylinder((0.5, 0.35, 1.4), (4.6, 0.35, 1.4), 0.8, name="rod")
    rib = Block((2, -0.4, 0), (2.7, 1.4, 1.1), name="rib")
    return Block((0, 0, 0), (4.2, 2, 2.1), name="block") | rod | rib


def bored_corner() -> Solid:
    """A ball on an edge of a block and over the mouth of a tapered bore."""
    bore = Cone((0.5, 2.6, -2.3), 0.7, (0.5, 2.6, 1.9), 0.3, name="bore")
    block = Block((0, 0, 0), (4, 3.3, 3.6), name="block")
    return (block - bore) | Sphere((-0.1, 3.4, -0.3), 0.9, name="ball")


def cone_in_a_wall() -> Solid:
    """A cone half out of a block, its axis in the block's mid-plane: its edges are hyperbolas."""
    return Block((0, 0, 0), (5, 4, 2.4), name="block") | Cone(
        (4.5, -0.1, 1.2), 0.8, (4.5, 2.9, 1.2), 0.3, name="cone"
    )


def ledge() -> Solid:
    """A square boss under a block, next to its side, from which a narrow ledge is left."""
    return Block((0, 0, 0), (3.910885, 2.80936, 2.122921), name="block") | Block(
        (2.613889, 1.7409, -0.40013), (0.81175, 1.055275, 1.733245), name="boss"
    )


def joint() -> Solid:
    """A post and an arm that overlap in a narrow joint, smaller than the post by two orders."""
    return Block((0, 0, 0), (4.758807, 2.214868, 4.769244), name="post") | Block(
        (-0.626982, -0.73319, 1.375161), (0.650615, 0.845799, 0.881841), name="arm"
    )


def crossing_blocks() -> Solid:
    """A block through the side and below the floor of another, along whose edge a seam runs."""
    return Block((0, 0, 0), (3.910885, 2.80936, 2.122921), name="block") | Block(
        (2.613889, 1.7409, -0.40013), (3.425639, 2.796175, 1.333115), name="boss"
    )


SHAPES: dict[str, Callable[[], Solid]] = {
    "cube": lambda: Block((0, 0, 0), (2, 2, 2), name="cube"),
    "bar": lambda: Block((0, 0, 0), (2, 1, 1), name="bar"),
    "square cylinder": lambda: Cylinder((0, 0, 0), (0, 0, 2), 1, name="rod"),
    "disc": lambda: Cylinder((0, 0, 0), (0, 0, 1), 1, name="disc"),
    "equal angle": lambda: angle(3, 1),
    "unequal angle": lambda: angle(3, 0.6),
    "half angle": lambda: angle(3, 0.5),
    "washer": washer,
    "walled block": walled,
    "oblique tee": lambda: branched(Cylinder((0, 0, 0), (2, 0, 4), 0.5, name="branch")),
    "wye": lambda: branched(Cylinder((0, 0, 0), (3, 0, 3), 1, name="branch")),
    "tapered tee": lambda: branched(Cone((0, 0, 0), 0.6, (0, 0, 3), 0.3, name="branch")),
    "offset tee": lambda: offset_tee(0.3, 0.5),
    "wide offset tee": lambda: offset_tee(0.2, 0.7),
    "bulge": bulge,
    "spoke": spoke,
    "ridge": lambda: with_boss(3, 3, (2.2, -0.5, 2.4), (2.2, 3.2, 2.4), 1),
    "boss on a wall": lambda: with_boss(3, 2.2, (0.1, 1.5, -0.5), (0.1, 1.5, 1.8), 0.5),
    "boss on a corner": lambda: with_boss(2.5, 4, (1.3, 2.3, 2.4), (1.3, 2.3, 5), 0.5),
    "ball on a corner": lambda: with_ball((3.8, 2.7, 2)),
    "ball on an edge": lambda: with_ball((2, 2.7, 2)),
    "bar in a wall": lambda: with_boss(3, 2.2, (-1, 1.2, 0.3), (5, 1.2, 0.3), 0.6),
    "grooved shaft": grooved,
    "rod and rib": rod_and_rib,
    "bored corner": bored_corner,
    "cone in a wall": cone_in_a_wall,
    "boss at a ledge": ledge,
    "narrow joint": joint,
    "crossing blocks": crossing_blocks,
}
