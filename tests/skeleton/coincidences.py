"""Parts whose features meet, touch or tie by design, each with its volume and Euler characteristic.

Each stands for a way in which a skeleton can be led astray, told beside it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import asin, cos, pi, sin, sqrt

from scipy.integrate import dblquad, quad  # type: ignore[import-untyped]

from decomp.csg.primitives import Block, Cylinder, HalfSpace, InfiniteCylinder, Sphere, Torus
from decomp.csg.solid import Solid


@dataclass(frozen=True)
class Coincidence:
    """A part.

    Args:
        make: it; several regions as a dict.
        volume: of each region.
        euler: of each region.
    """

    make: Callable[[], Solid | dict[str, Solid]]
    volume: tuple[float, ...]
    euler: tuple[int, ...]


def long_bored_plate() -> Solid:
    """Chords across the parabola between floor and bore have their middles above its focus."""
    return Block((0, 0, 0), (50, 30, 9)) - Cylinder((-1, 14, 4), (51, 14, 4), 1.5)


def cross_in_air() -> Solid:
    """Nodes far off a trim are tried for lying on it."""
    bars = Block((-15, -1, -0.5), (30, 2, 1)) | Block((-1, -15, -0.5), (2, 30, 1))
    return Block((-900, -900, -900), (1800, 1800, 1800)) - bars


def notched_bar_in_air() -> Solid:
    """The notch parts one line into two edges that one step along a seam leads across."""
    bar = Block((0, 0, 0), (2, 1, 1)) - Block((0.8, -1, 0.5), (0.4, 3, 1))
    return Block((-90, -90, -90), (180, 180, 180)) - bar


def sunk_plate() -> Solid:
    """The hole is as deep as its radius, and its bottom as thick: contacts tie in a point."""
    return Block((0, 0, 0), (60, 48, 8)) - Cylinder((40, 12, 4), (40, 12, 9), 4)


def chisel() -> Solid:
    """A seam crosses the rod's axis."""
    rod = Cylinder((0, 0, 0), (0, 0, 10), 1.5)
    return rod & HalfSpace((0.2, 0, 10), (6, 0, 1)) & HalfSpace((-0.2, 0, 10), (-6, 0, 1))


def rod_with_eye() -> Solid:
    """A closed seam comes back to the node at which it starts."""
    eye = Cylinder((50, 0, 0), (50, 0, 8), 10) | Block((0, -6, 2), (50, 12, 4))
    return eye - Cylinder((50, 0, -1), (50, 0, 9), 5)


def ribbed_plate() -> Solid:
    """Two seams leave a node with one tangent and one curvature."""
    plate = Block((0, 0, 0), (50, 40, 10)) | Block((12, 18, 10), (26, 4, 26))
    for y in (10, 30):
        plate = plate - Cylinder((40, y, -1), (40, y, 11), 5)
    return plate


def tray_with_socket() -> Solid:
    """A third contact joins a seam in the fourth order."""
    tray = Block((0, 0, 0), (60, 40, 24)) - Block((4, 4, 4), (52, 32, 24))
    return tray - Cylinder((4, 4, 12), (4, 4, 20), 2)


def keyed_shaft() -> Solid:
    """Where a slot's side goes on into its round end, an edge's line stays close to the arc."""
    shaft = Cylinder((0, 0, 0), (20, 0, 0), 13) | Cylinder((20, 0, 0), (40, 0, 0), 9)
    slot = Block((8, -3, 10.5), (4, 6, 10))
    for x in (8, 12):
        slot = slot | Cylinder((x, 0, 10.5), (x, 0, 20.5), 3)
    return shaft - slot


def rounded_block_with_pocket() -> Solid:
    """The pocket's corner is over the line in which the rounding goes on into a side."""
    block = Block((4, 0, 0), (8, 10, 16)) | Block((0, 4, 0), (12, 6, 16))
    rounded = block | Cylinder((4, 4, 0), (4, 4, 16), 4)
    return rounded - Block((6, 4, 10), (4, 4, 9))


def tray_with_posts() -> Solid:
    """Balls over circles change what they touch where the circles' parameters start, or by a touch.

    Posts are as much wider than their sockets as the walls are thick, and what is above these is as
    high as they are wide.
    """
    outside = Block((0, 0, 0), (70, 40, 20))
    tray: Solid = outside - Block((3, 3, 3), (64, 34, 20))
    for x in (3, 67):
        for y in (3, 37):
            tray = tray | (Cylinder((x, y, 3), (x, y, 15), 5) & outside)
            tray = tray - Cylinder((x, y, 8), (x, y, 16), 2)
    return tray


def equal_tee() -> Solid:
    """Outsides and bores both are tangent where their edges cross, in two points each."""
    outside = Cylinder((-9, 0, 0), (9, 0, 0), 3) | Cylinder((0, 0, 0), (0, 0, 7), 3)
    bores = Cylinder((-10, 0, 0), (10, 0, 0), 2.5) | Cylinder((0, 0, 0), (0, 0, 8), 2.5)
    return outside - bores


def drilled_ring() -> Solid:
    """The sheets between ring and bore have no border along which the ring's footprint closes."""
    return Torus((0, 0, 0), (0, 0, 1), 6, 2.5) - InfiniteCylinder((0, 0, 0), (1, 0, 0), 0.6)


def bored_block() -> Solid:
    """Two equal bores cross: at two points both have one normal, in which sheets end."""
    block = Block((0, 0, 0), (40, 40, 30))
    block = block - Cylinder((-1, 20, 15), (41, 20, 15), 6)
    return block - Cylinder((20, -1, 15), (20, 41, 15), 6)


def ball_in_wide_air() -> dict[str, Solid]:
    """The ball's volume asks for chords a thousand times shorter than the air's."""
    ball = Sphere((0, 0, 0), 1, name="ball")
    return {"air": Sphere((0, 0, 0), 300, name="far") - ball, "ball": ball}


def ring_in_wide_air() -> dict[str, Solid]:
    """The closed sheet around the ring is pointed where the ring's axis ends in it."""
    ring = Torus((0, 0, 0), (0, 0, 1), 2, 0.5, name="ring")
    return {"air": Sphere((0, 0, 0), 60, name="far") - ring, "ring": ring}


def _half(x: float, radius: float) -> float:
    """The area under a circle from its axis to x."""
    return (x * sqrt(radius**2 - x**2) + radius**2 * asin(x / radius)) / 2


def _chisel_volume() -> float:
    def moment(x: float) -> float:
        return -((1.5**2 - x**2) ** 1.5) / 3

    flat = 2 * 2 * 10 * _half(0.2, 1.5)
    area = _half(1.5, 1.5) - _half(0.2, 1.5)
    return flat + 4 * (11.2 * area - 6 * (moment(1.5) - moment(0.2)))


def _keyed_volume() -> float:
    def depth(y: float) -> float:
        return (sqrt(169 - y * y) - 10.5) * (4 + 2 * sqrt(9 - y * y))

    return 20 * pi * (169 + 81) - float(quad(depth, -3, 3, epsabs=1e-12, epsrel=1e-13)[0])


def _drilled_volume() -> float:
    def chords(s: float, angle: float) -> float:
        y, half = s * cos(angle), sqrt(2.5**2 - (s * sin(angle)) ** 2)
        return 2 * s * (sqrt((6 + half) ** 2 - y * y) - sqrt((6 - half) ** 2 - y * y))

    bore = dblquad(chords, 0, 2 * pi, 0, 0.6, epsabs=1e-11, epsrel=1e-12)[0]
    return 2 * pi**2 * 6 * 2.5**2 - float(bore)


COINCIDENCES: dict[str, Coincidence] = {
    "long bored plate": Coincidence(long_bored_plate, (13500 - 50 * pi * 2.25,), (0,)),
    "cross in air": Coincidence(cross_in_air, (1800.0**3 - 116,), (2,)),
    "notched bar in air": Coincidence(notched_bar_in_air, (180.0**3 - 1.8,), (2,)),
    "sunk plate": Coincidence(sunk_plate, (60 * 48 * 8 - 64 * pi,), (1,)),
    "chisel": Coincidence(chisel, (_chisel_volume(),), (1,)),
    "rod with eye": Coincidence(rod_with_eye, (600 * pi + 4 * (552 - 100 * asin(0.6)),), (0,)),
    "ribbed plate": Coincidence(ribbed_plate, (20000 + 26 * 4 * 26 - 500 * pi,), (-1,)),
    "tray with socket": Coincidence(tray_with_socket, (57600 - 33280 - 24 * pi,), (1,)),
    "keyed shaft": Coincidence(keyed_shaft, (_keyed_volume(),), (1,)),
    "rounded block with pocket": Coincidence(
        rounded_block_with_pocket, (1920 - (16 - 4 * pi) * 16 - 96,), (1,)
    ),
    "tray with posts": Coincidence(tray_with_posts, (19008 + 176 * pi,), (1,)),
    # half of what two cylinders have in common is there once
    "equal tee": Coincidence(equal_tee, (25 * pi * (9 - 6.25) - 8 / 3 * (27 - 2.5**3),), (-1,)),
    "drilled ring": Coincidence(drilled_ring, (_drilled_volume(),), (-2,)),
    # two bores of radius r have 16 r^3 / 3 in common
    "bored block": Coincidence(bored_block, (48000 - 80 * 36 * pi + 16 * 6**3 / 3,), (-2,)),
    "ball in wide air": Coincidence(
        ball_in_wide_air, (4 / 3 * pi * (300.0**3 - 1), 4 / 3 * pi), (2, 1)
    ),
    "ring in wide air": Coincidence(
        ring_in_wide_air, (4 / 3 * pi * 60.0**3 - pi**2, pi**2), (1, 0)
    ),
}
