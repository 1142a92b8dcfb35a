"""Parts whose features meet, touch or tie by design, each with its volume and Euler characteristic.

Each stands for a way in which a skeleton can be led astray, told beside it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, asin, cos, pi, sin, sqrt

from scipy.integrate import dblquad, quad  # type: ignore[import-untyped]

from decomp.csg.primitives import (
    Block,
    Cone,
    Cylinder,
    HalfSpace,
    InfiniteCylinder,
    Sphere,
    Torus,
)
from decomp.csg.solid import Solid
from tests.skeletons.machine_parts import ROUND, rounded_box


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


def angle_in_wide_air() -> Solid:
    """Beyond its end a trim goes on as one of the line that an edge is a part of."""
    angle = Block((-2, -3, -1), (2, 6, 2)) | Block((0, -3, -1), (2, 2, 2))
    return Sphere((0, 0, 0), 150) - angle


def flattened_rod() -> dict[str, Solid]:
    """Planes almost touch the rod: ellipses with sharp tips, sheets steep over their footprint."""
    rod = Cylinder((0, 0, 0), (0, 0, 40), 3, name="rod")
    rod = rod & HalfSpace((0, 2.4, 40), (0, 15, 1)) & HalfSpace((0, -2.4, 40), (0, -15, 1))
    return {"rod": rod, "air": Block((-400, -400, -400), (800, 800, 800), name="far") - rod}


def ball_through_faces() -> Solid:
    """Seams come to the ball's centre, where rounding tells on which side of it they end."""
    return Block((-3, -3, -3), (6, 6, 6)) | Sphere((0, 0, 0), 3.75)


def slotted_plate_in_air() -> dict[str, Solid]:
    """The slot's round end goes on smoothly into its sides; its axis reaches far into the air."""
    slot = Block((30, 4, -1), (12, 4, 3)) | Cylinder((30, 6, -1), (30, 6, 2), 2)
    plate = Block((0, 0, 0), (40, 12, 1), name="plate") - slot
    air = Block((-300, -300, -300), (600, 600, 600), name="far") - plate
    return {"plate": plate, "air": air}


def nearly_a_cube() -> Solid:
    """Two junctions lie a few millionths of their radius apart."""
    return Block((0, 0, 0), (10, 10, 10.00002))


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


def bored_tee() -> Solid:
    """A branch has the radius of the pipe's bore: both have one normal at two points."""
    pipe = Cylinder((-30, 0, 0), (30, 0, 0), 10) - Cylinder((-31, 0, 0), (31, 0, 0), 9)
    return pipe - Cylinder((0, 0, 0), (0, 0, 26), 9)


def grooved_piston() -> Solid:
    """The groove is as far from the bore as it is deep: points of a seam are moved along it."""
    piston = Cylinder((0, 0, 0), (0, 0, 44), 30) - Cylinder((0, 0, -1), (0, 0, 33), 25)
    ring = Cylinder((0, 0, 35), (0, 0, 37), 40) - Cylinder((0, 0, 34), (0, 0, 38), 28)
    return piston - ring


def slotted_disk_in_air() -> Solid:
    """The slot's block ends in a plane that is tangent to the disk, and has no point outside it."""
    disk = Cylinder((0, 0, -0.5), (0, 0, 0.5), 3) - Block((-1, -1, -0.6), (4, 2, 1.2))
    return Sphere((0, 0, 0), 11) - disk


def turned_rounded_box() -> Solid:
    """All radii equal, no axis along a coordinate: whole patches are as near to eight centres."""
    return rounded_box().rotate((0.3, -0.31, -0.11), 78.7)


def low_rounded_box() -> Solid:
    """Its height is three radii: where two edges' cylinders meet, the corner's sphere osculates."""
    return rounded_box((4, 3, 3 * ROUND))


def stepped_shaft() -> Solid:
    """Beyond the step the keyway's edge is once as far from the neck's axis as the neck is."""
    neck = Cylinder((0, 0, 0), (12, 0, 0), 5, name="neck")
    body = Cylinder((12, 0, 0), (30, 0, 0), 6, name="body")
    return (neck | body) - Block((14.25, -1, 4.5), (8, 2, 4), name="key")


def pinned_rod() -> Solid:
    """The hole begins a diameter from the end: one point of the axis is as near to end and hole."""
    hole = Cylinder((2.6, -2, 0), (2.6, 2, 0), 0.6)
    return (Cylinder((0, 0, 0), (7, 0, 0), 1) - hole).rotate((0.2, 0.3, 0.4), 31)


def cross_of_rods() -> Solid:
    """About its middle the vertices alone are near: no face or edge sees the seams there."""
    rod = Cylinder((0, 0, -3), (0, 0, 3), 1)
    return rod | rod.rotate((1, 0, 0), 90) | rod.rotate((0, 1, 0), 90)


def cone_on_an_edge() -> Solid:
    """Where the block's edge enters the cone two trims lead to one node, each in one chord."""
    return Block((0, 0, 0), (4.4, 4.4, 3.5)) | Cone((4.3, 0.7, 1.3), 1.15, (4.3, 7.4, 1.3), 0.46)


def sunk_roller() -> Solid:
    """A seam would come down to the roller's axis, but that is nearer to its end there."""
    return Block((0, 0, 0), (4, 4.7, 4.3)) | Cylinder((2, -0.8, 4.7), (2, 6.1, 4.7), 1.54)


def ball_through_two_faces() -> Solid:
    """The ball's centre is inside the sheet between both circles: no curve leads to it."""
    return Block((0, 0, 0), (2.4, 3.5, 3.8)) | Sphere((1.7, 1.8, 3.35), 0.8)


def ball_in_wide_air() -> dict[str, Solid]:
    """The ball's volume asks for chords a thousand times shorter than the air's."""
    ball = Sphere((0, 0, 0), 1, name="ball")
    return {"air": Sphere((0, 0, 0), 300, name="far") - ball, "ball": ball}


def boss_as_high_as_a_hole_is_far() -> Solid:
    """The trim over the boss's rim touches that over the hole's from outside it, in one point."""
    plate = Cylinder((0, 0, 0), (0, 0, 3), 12, name="plate")
    boss = Cylinder((0, 0, 1), (0, 0, 7), 3, name="boss")
    x, y = 5.5 * cos(0.3), 5.5 * sin(0.3)
    hole = Cylinder((x, y, -1), (x, y, 4), 1.5, name="hole")
    return Sphere((0, 0, 3), 30, name="far") - ((plate | boss) - hole)


def flange_on_gasket() -> dict[str, Solid]:
    """The flange is as thick as the way from its rim to its holes: seams touch in four points."""
    bore = Cylinder((0, 0, -1), (0, 0, 7), 8, name="bore")
    flange = Cylinder((0, 0, 1), (0, 0, 5), 20, name="disc") - bore
    for k in range(4):
        x, y = 14.5 * cos(0.3 + pi * k / 2), 14.5 * sin(0.3 + pi * k / 2)
        flange = flange - Cylinder((x, y, -1), (x, y, 7), 1.5, name="bolt")
    return {"flange": flange, "gasket": Cylinder((0, 0, 0), (0, 0, 1), 13, name="ring") - bore}


def hole_in_a_corner() -> Solid:
    """The plate is as thick as the way from the hole to two sides: the middle falls into two."""
    return Block((0, 0, 0), (40, 20, 4), name="plate") - Cylinder(
        (7, 7, -1), (7, 7, 5), 3, name="hole"
    )


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


def _flattened_volume() -> float:
    def rest(z: float) -> float:
        return 4 * _half(min(3.0, 2.4 + (40 - z) / 15), 3)

    return 31 * pi * 9 + float(quad(rest, 31, 40, epsabs=1e-12, epsrel=1e-13)[0])


def _keyed_volume() -> float:
    def depth(y: float) -> float:
        return (sqrt(169 - y * y) - 10.5) * (4 + 2 * sqrt(9 - y * y))

    return 20 * pi * (169 + 81) - float(quad(depth, -3, 3, epsabs=1e-12, epsrel=1e-13)[0])


def _branch_volume(outer: float, inner: float) -> float:
    """What a branch of the inner radius takes out of one wall of a pipe."""

    def depth(y: float) -> float:
        wide = sqrt(inner**2 - y * y)
        return 2 * wide * (sqrt(outer**2 - y * y) - wide)

    return float(quad(depth, -inner, inner, epsabs=1e-12, epsrel=1e-13)[0])


def _hole_volume(rod: float, hole: float) -> float:
    """What a hole through a rod's axis takes out of it."""

    def depth(z: float) -> float:
        return 4 * sqrt(hole**2 - z**2) * sqrt(rod**2 - z**2)

    return float(quad(depth, -hole, hole, epsabs=1e-12, epsrel=1e-13)[0])


def _segment(radius: float, off: float) -> float:
    """The area of a circle beyond a chord that far from its centre."""
    return radius**2 * acos(off / radius) - off * sqrt(radius**2 - off**2)


def _coned_volume() -> float:
    def radius(y: float) -> float:
        return 1.15 - 0.69 * (y - 0.7) / 6.7

    r = radius(4.4)
    beside = float(quad(lambda y: _segment(radius(y), 0.1), 0.7, 4.4, epsabs=1e-13)[0])
    return 4.4 * 4.4 * 3.5 + beside + pi * 3 * (r * r + 0.46 * r + 0.46**2) / 3


def _cap(radius: float, height: float) -> float:
    return pi * height**2 * (3 * radius - height) / 3


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
    "angle in wide air": Coincidence(angle_in_wide_air, (4.5e6 * pi - 32,), (2,)),
    "flattened rod": Coincidence(
        flattened_rod, (_flattened_volume(), 800.0**3 - _flattened_volume()), (1, 2)
    ),
    # caps of height 0.75
    "ball through faces": Coincidence(
        ball_through_faces, (216 + 6 * pi * 0.75**2 * (3.75 - 0.25),), (1,)
    ),
    "slotted plate in air": Coincidence(
        slotted_plate_in_air, (440 - 2 * pi, 600.0**3 - 440 + 2 * pi), (1, 2)
    ),
    "nearly a cube": Coincidence(nearly_a_cube, (1000.002,), (1,)),
    "sunk plate": Coincidence(sunk_plate, (60 * 48 * 8 - 64 * pi,), (1,)),
    "chisel": Coincidence(chisel, (_chisel_volume(),), (1,)),
    "rod with eye": Coincidence(rod_with_eye, (600 * pi + 4 * (552 - 100 * asin(0.6)),), (0,)),
    "ribbed plate": Coincidence(ribbed_plate, (20000 + 26 * 4 * 26 - 500 * pi,), (-1,)),
    "tray with socket": Coincidence(tray_with_socket, (57600 - 33280 - 24 * pi,), (1,)),
    "keyed shaft": Coincidence(keyed_shaft, (_keyed_volume(),), (1,)),
    "rounded block with pocket": Coincidence(
        rounded_block_with_pocket, (1920 - (16 - 4 * pi) * 16 - 96,), (1,)
    ),
    "cone on an edge": Coincidence(cone_on_an_edge, (_coned_volume(),), (1,)),
    "sunk roller": Coincidence(
        sunk_roller, (4 * 4.7 * 4.3 + 6.9 * pi * 1.54**2 - 4.7 * _segment(1.54, 0.4),), (1,)
    ),
    "tray with posts": Coincidence(tray_with_posts, (19008 + 176 * pi,), (1,)),
    "ball through two faces": Coincidence(
        ball_through_two_faces, (2.4 * 3.5 * 3.8 + _cap(0.8, 0.1) + _cap(0.8, 0.35),), (1,)
    ),
    # half of what two cylinders have in common is there once
    "equal tee": Coincidence(equal_tee, (25 * pi * (9 - 6.25) - 8 / 3 * (27 - 2.5**3),), (-1,)),
    "drilled ring": Coincidence(drilled_ring, (_drilled_volume(),), (-2,)),
    # two bores of radius r have 16 r^3 / 3 in common
    "bored block": Coincidence(bored_block, (48000 - 80 * 36 * pi + 16 * 6**3 / 3,), (-2,)),
    "bored tee": Coincidence(bored_tee, (60 * pi * 19 - _branch_volume(10, 9),), (-1,)),
    "grooved piston": Coincidence(
        grooved_piston, (pi * (44 * 30**2 - 33 * 25**2 - 2 * (30**2 - 28**2)),), (1,)
    ),
    # the slot is open where the block's end touches the disk's side
    "slotted disk in air": Coincidence(
        slotted_disk_in_air, (4 / 3 * pi * 11**3 - 9 * pi + 2 + 2 * _half(1, 3),), (2,)
    ),
    "turned rounded box": Coincidence(
        turned_rounded_box,
        (6 + 2 * (6 + 2 + 3) * ROUND + pi * 6 * ROUND**2 + 4 / 3 * pi * ROUND**3,),
        (1,),
    ),
    # between the centres of its corners there are 3 x 2 x 0.5
    "low rounded box": Coincidence(
        low_rounded_box,
        (3 + 2 * (6 + 1 + 1.5) * ROUND + pi * 5.5 * ROUND**2 + 4 / 3 * pi * ROUND**3,),
        (1,),
    ),
    "stepped shaft": Coincidence(
        stepped_shaft, (948 * pi - 8 * (sqrt(35) + 36 * asin(1 / 6) - 9),), (1,)
    ),
    "pinned rod": Coincidence(pinned_rod, (7 * pi - _hole_volume(1, 0.6),), (0,)),
    # two rods have 16 r^3 / 3 in common, all three 8 (2 - sqrt(2)) r^3
    "cross of rods": Coincidence(cross_of_rods, (18 * pi - 8 * sqrt(2),), (1,)),
    "ball in wide air": Coincidence(
        ball_in_wide_air, (4 / 3 * pi * (300.0**3 - 1), 4 / 3 * pi), (2, 1)
    ),
    "boss as high as a hole is far": Coincidence(
        boss_as_high_as_a_hole_is_far, (pi * (4 / 3 * 30**3 - 3 * 144 - 4 * 9 + 3 * 2.25),), (1,)
    ),
    "flange on gasket": Coincidence(
        flange_on_gasket, (4 * pi * (400 - 64 - 4 * 2.25), pi * (169 - 64)), (-4, 0)
    ),
    "hole in a corner": Coincidence(hole_in_a_corner, (3200 - 36 * pi,), (0,)),
    "ring in wide air": Coincidence(
        ring_in_wide_air, (4 / 3 * pi * 60.0**3 - pi**2, pi**2), (1, 0)
    ),
}
