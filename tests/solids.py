"""One table of solids with exact references, shared by all tests.

Volumes and areas are closed forms or one-dimensional integrals; counts were derived by hand.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import acos, cos, pi, radians, sin, sqrt, tan

from scipy.integrate import quad

from decomp.csg.primitives import (
    Block,
    Cone,
    Cylinder,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    Sphere,
    Torus,
)
from decomp.csg.solid import Solid

CONVEX, REENTRANT, SMOOTH, SADDLE = "convex", "reentrant", "smooth", "saddle"


@dataclass(frozen=True)
class Case:
    """A solid and what is known of it.

    Args:
        make: makes the solid.
        volume, area: exact values, None where no independent reference is at hand.
        euler: Euler characteristic of the solid.
        faces: number of faces by carrier kind.
        edges: number of edges by (curve kind, convexity).
        vertices: number of vertices by convexity.
        length: total length of edges by convexity.
    """

    make: Callable[[], Solid]
    volume: float | None
    euler: int
    faces: dict[str, int]
    edges: dict[tuple[str, str], int] = field(default_factory=dict)
    vertices: dict[str, int] = field(default_factory=dict)
    area: float | None = None
    length: dict[str, float] = field(default_factory=dict)


def integral(f: Callable[[float], float], a: float, b: float) -> float:
    """A one-dimensional integral to about 1e-13."""
    return float(quad(f, a, b, epsabs=1e-13, epsrel=1e-13, limit=400)[0])


def crossing_volume(r: float, s: float) -> float:
    """Volume common to two cylinders of radii r <= s whose axes cross at right angles."""
    return integral(lambda t: 8 * r**2 * cos(t) ** 2 * sqrt(s**2 - (r * sin(t)) ** 2), 0, pi / 2)


def disc_below(rho: float, c: float) -> float:
    """Area of the part x < c of a disc of radius rho about the origin."""
    if c >= rho:
        return pi * rho**2
    if c <= -rho:
        return 0.0
    return rho**2 * (pi - acos(c / rho)) + c * sqrt(rho**2 - c**2)


def torus_below(major: float, minor: float, c: float) -> float:
    """Volume of the part x < c of a torus about the z axis."""

    def ring(t: float) -> float:
        w = minor * cos(t)
        return (disc_below(major + w, c) - disc_below(major - w, c)) * w

    kink = acos(abs(major - c) / minor) if abs(major - c) < minor else 0.0
    value = quad(ring, -pi / 2, pi / 2, epsabs=1e-12, epsrel=1e-12, limit=400, points=[-kink, kink])
    return float(value[0])


def crossing_length(r: float, s: float) -> float:
    """Length of one of the two curves in which cylinders of radii r < s cross at right angles."""

    def speed(t: float) -> float:
        return sqrt(r**2 + (r**2 * sin(t) * cos(t)) ** 2 / (s**2 - (r * sin(t)) ** 2))

    return integral(speed, 0, 2 * pi)


def ellipse_length(a: float, b: float) -> float:
    """Circumference of an ellipse."""
    return integral(lambda t: sqrt((a * sin(t)) ** 2 + (b * cos(t)) ** 2), 0, 2 * pi)


def spiric_length(major: float, minor: float, c: float) -> float:
    """Length of one of the two ovals in which the plane x = c < major - minor cuts a torus."""

    def speed(t: float) -> float:
        rho = major + minor * cos(t)
        slope = -minor * sin(t) * rho / sqrt(rho**2 - c**2)
        return sqrt(slope**2 + (minor * cos(t)) ** 2)

    return integral(speed, 0, 2 * pi)


def cap(r: float, h: float) -> float:
    """Volume of a spherical cap of height h."""
    return pi * h**2 * (3 * r - h) / 3


def block() -> Solid:
    return Block((0, 0, 0), (4, 3, 2), name="block")


def through_hole(x: float = 2.0) -> Solid:
    return Block((0, 0, 0), (4, 4, 2), name="plate") - InfiniteCylinder(
        (x, 2, 0), (0, 0, 1), 1, name="hole"
    )


def blind_hole() -> Solid:
    return Block((0, 0, 0), (4, 4, 2), name="plate") - Cylinder(
        (2, 2, 1), (2, 2, 3), 1, name="hole"
    )


def bracket() -> Solid:
    return Block((0, 0, 0), (3, 1, 2), name="foot") | Block((0, 0, 0), (1, 4, 2), name="leg")


def cross_drilled(r: float) -> Solid:
    bores = InfiniteCylinder((0, 0, 0), (0, 0, 1), 1, name="down") | InfiniteCylinder(
        (0, 0, 0), (1, 0, 0), r, name="across"
    )
    return Block((-2, -2, -2), (4, 4, 4), name="block") - bores


def tee(r: float) -> Solid:
    return Cylinder((-3, 0, 0), (3, 0, 0), 1, name="run") | Cylinder(
        (0, 0, 0), (0, 0, 2), r, name="branch"
    )


def ball_bite(at: tuple[float, float, float], r: float) -> Solid:
    return Block((0, 0, 0), (2, 2, 2), name="block") - Sphere(at, r, name="bite")


def cut_torus(c: float) -> Solid:
    return Torus((0, 0, 0), (0, 0, 1), 2, 0.5, name="ring") & HalfSpace((c, 0, 0), (1, 0, 0), "cut")


def fichera() -> Solid:
    return Block((-1, -1, -1), (2, 2, 2), name="cube") - Block((0, 0, 0), (2, 2, 2), name="corner")


def pocket() -> Solid:
    return Block((0, 0, 0), (4, 4, 2), name="plate") - Block((1, 1, 1), (2, 2, 2), name="pocket")


def lens() -> Solid:
    return Sphere((0, 0, 0), 1, name="left") & Sphere((1, 0, 0), 1, name="right")


def oblique_cone() -> Solid:
    bore = InfiniteCone((0, 0, 6), (sin(radians(15)), 0, -cos(radians(15))), 5, name="bore")
    return Block((-3, -3, 0), (8, 6, 2), name="plate") - bore


def oblique_cone_section() -> tuple[float, float]:
    """Semi-axes of the elliptic section of the bore at depth 1 below its apex."""
    tilt, half = radians(15), radians(5)
    low, high = tan(tilt - half), tan(tilt + half)
    a = (high - low) / 2
    middle = (high + low) / 2
    # width across, where the line z = -1, x = middle meets the cone
    along = middle * sin(tilt) + cos(tilt)
    b = sqrt((along / cos(half)) ** 2 - middle**2 - 1)
    return a, b


def oblique_cone_volume() -> float:
    """The sections at depths 4 to 6 below the apex grow in proportion to the depth."""
    a, b = oblique_cone_section()
    return 8 * 6 * 2 - pi * a * b * (6**3 - 4**3) / 3


def oblique_cone_edges() -> float:
    """Length of the two ellipses in which the bore meets the plate's faces."""
    return (6 + 4) * ellipse_length(*oblique_cone_section())


def capsule() -> Solid:
    bar = Cylinder((0, 0, 0), (2, 0, 0), 0.5, name="bar")
    return bar | Sphere((0, 0, 0), 0.5, name="left") | Sphere((2, 0, 0), 0.5, name="right")


def slot() -> Solid:
    """A plate with a slot whose round ends meet its flat sides tangentially."""
    middle = Block((1, 1, -1), (2, 1, 3), name="middle")
    ends = Cylinder((1, 1.5, -1), (1, 1.5, 2), 0.5, name="left") | Cylinder(
        (3, 1.5, -1), (3, 1.5, 2), 0.5, name="right"
    )
    return Block((0, 0, 0), (4, 3, 1), name="plate") - (middle | ends)


def elbow() -> Solid:
    """A pipe bend: a quarter torus that goes on tangentially into straight bars."""
    quarter = (
        Torus((0, 0, 0), (0, 0, 1), 2, 0.5, name="bend")
        & HalfSpace((0, 0, 0), (-1, 0, 0), "joint")
        & HalfSpace((0, 0, 0), (0, -1, 0), "joint2")
    )
    bar = Cylinder((0, 2, 0), (-3, 2, 0), 0.5, name="bar")
    return quarter | bar


def countersink() -> Solid:
    sink = Cone((0, 0, 0), 0.5, (0, 0, 1), 0.5 + tan(radians(26)), name="sink")
    return Block((-3, -3, 0), (6, 6, 1), name="plate") - sink


def round_boss() -> Solid:
    return Block((0, 0, 0), (4, 4, 1), name="plate") | Cylinder(
        (2, 2, 0.5), (2, 2, 2), 0.7, name="boss"
    )


def square_boss() -> Solid:
    return Block((0, 0, 0), (4, 4, 1), name="plate") | Block((1, 1, 0.5), (2, 2, 1.5), name="boss")


def oval_ring() -> Solid:
    return Torus((0, 0, 0), (0, 0, 1), 3, 1, name="inner") & Torus(
        (0, 0, 0), (0, 0, 1), 3.8, 1, name="outer"
    )


def oval_ring_volume() -> float:
    """Pappus: the lens of two unit circles 0.8 apart, its centroid at radius 3.4."""
    lens_area = 2 * acos(0.4) - 0.8 * sqrt(1 - 0.16)
    return 2 * pi * 3.4 * lens_area


def thin_wall() -> Solid:
    return Block((0, 0, 0), (4, 3, 2), name="block") - Block((0.01, 1, -1), (1, 1, 4), name="slit")


LINES = ("line", CONVEX)
CIRCLES = ("circle", CONVEX)

SOLIDS: dict[str, Case] = {
    "block": Case(block, 24, 1, {"plane": 6}, {LINES: 12}, {CONVEX: 8}, 52, {CONVEX: 36}),
    "cylinder": Case(
        lambda: Cylinder((0, 0, 0), (0, 0, 3), 1),
        3 * pi,
        1,
        {"plane": 2, "cylinder": 1},
        {CIRCLES: 2},
        area=8 * pi,
        length={CONVEX: 4 * pi},
    ),
    "cone": Case(
        lambda: Cone((0, 0, 0), 1, (0, 0, 2)),
        2 * pi / 3,
        1,
        {"plane": 1, "cone": 1},
        {CIRCLES: 1},
        {CONVEX: 1},
        area=pi * (1 + sqrt(5)),
        length={CONVEX: 2 * pi},
    ),
    "frustum": Case(
        lambda: Cone((0, 0, 0), 1, (0, 0, 2), 0.5),
        pi * 2 / 3 * (1 + 0.5 + 0.25),
        1,
        {"plane": 2, "cone": 1},
        {CIRCLES: 2},
        area=pi * (1.25 + 1.5 * sqrt(4.25)),
        length={CONVEX: 3 * pi},
    ),
    "conical pit": Case(
        lambda: Block((-2, -2, 0), (4, 4, 2)) - Cone((0, 0, 0.5), 0, (0, 0, 2.5), 1),
        32 - pi * 0.75**2 * 1.5 / 3,
        1,
        {"plane": 6, "cone": 1},
        {LINES: 12, CIRCLES: 1},
        {CONVEX: 8, REENTRANT: 1},
        length={CONVEX: 40 + 1.5 * pi},
    ),
    "sphere": Case(lambda: Sphere((1, 2, 3), 2), 32 * pi / 3, 1, {"sphere": 1}, area=16 * pi),
    "torus": Case(
        lambda: Torus((0, 0, 0), (0, 0, 1), 2, 0.5), pi**2, 0, {"torus": 1}, area=4 * pi**2
    ),
    "hollow sphere": Case(
        lambda: Sphere((0, 0, 0), 1) - Sphere((0, 0, 0), 0.98),
        4 / 3 * pi * (1 - 0.98**3),
        2,
        {"sphere": 2},
        area=4 * pi * (1 + 0.98**2),
    ),
    "through hole": Case(
        through_hole,
        32 - 2 * pi,
        0,
        {"plane": 6, "cylinder": 1},
        {LINES: 12, CIRCLES: 2},
        {CONVEX: 8},
        64 - 2 * pi + 4 * pi,
        {CONVEX: 40 + 4 * pi},
    ),
    "eccentric hole": Case(
        lambda: through_hole(1.3),
        32 - 2 * pi,
        0,
        {"plane": 6, "cylinder": 1},
        {LINES: 12, CIRCLES: 2},
        {CONVEX: 8},
        length={CONVEX: 40 + 4 * pi},
    ),
    "blind hole": Case(
        blind_hole,
        32 - pi,
        1,
        {"plane": 7, "cylinder": 1},
        {LINES: 12, CIRCLES: 1, ("circle", REENTRANT): 1},
        {CONVEX: 8},
        64 + 2 * pi,
        {CONVEX: 40 + 2 * pi, REENTRANT: 2 * pi},
    ),
    "bracket": Case(
        bracket,
        12,
        1,
        {"plane": 8},
        {LINES: 17, ("line", REENTRANT): 1},
        {CONVEX: 10, SADDLE: 2},
        40,
        length={CONVEX: 38, REENTRANT: 2},
    ),
    "cross-drilled block": Case(
        lambda: cross_drilled(0.7),
        64 - 4 * pi - 4 * pi * 0.49 + crossing_volume(0.7, 1),
        -2,
        {"plane": 6, "cylinder": 3},
        {LINES: 12, CIRCLES: 4, ("curve", CONVEX): 2},
        {CONVEX: 8},
        length={CONVEX: 48 + 4 * pi * 1.7 + 2 * crossing_length(0.7, 1)},
    ),
    "equally cross-drilled block": Case(
        lambda: cross_drilled(1.0),
        64 - 8 * pi + 16 / 3,
        -2,
        {"plane": 6, "cylinder": 4},
        {LINES: 12, CIRCLES: 4, ("ellipse", CONVEX): 4},
        {CONVEX: 10},
        length={CONVEX: 48 + 8 * pi + 2 * ellipse_length(1, sqrt(2))},
    ),
    "unequal tee": Case(
        lambda: tee(0.6),
        6 * pi + 2 * pi * 0.36 - crossing_volume(0.6, 1) / 2,
        1,
        {"plane": 3, "cylinder": 2},
        {CIRCLES: 3, ("curve", REENTRANT): 1},
        length={CONVEX: 5.2 * pi, REENTRANT: crossing_length(0.6, 1)},
    ),
    "equal tee": Case(
        lambda: tee(1.0),
        8 * pi - 8 / 3,
        1,
        {"plane": 3, "cylinder": 2},
        {CIRCLES: 3, ("ellipse", REENTRANT): 2},
        {REENTRANT: 2},
        length={CONVEX: 6 * pi, REENTRANT: ellipse_length(1, sqrt(2))},
    ),
    "bite in a face": Case(
        lambda: ball_bite((2, 1, 1), 0.5),
        8 - pi / 12,
        1,
        {"plane": 6, "sphere": 1},
        {LINES: 12, CIRCLES: 1},
        {CONVEX: 8},
        24 + pi / 4,
        length={CONVEX: 24 + pi},
    ),
    "bite in a corner": Case(
        lambda: ball_bite((2, 2, 2), 1),
        8 - pi / 6,
        1,
        {"plane": 6, "sphere": 1},
        {LINES: 12, CIRCLES: 3},
        {CONVEX: 10},
        24 - 3 * pi / 4 + pi / 2,
        {CONVEX: 9 * 2 + 3 + 1.5 * pi},
    ),
    "torus cut in two ovals": Case(
        lambda: cut_torus(1.0),
        torus_below(2, 0.5, 1.0),
        1,
        {"torus": 1, "plane": 2},
        {("curve", CONVEX): 2},
        length={CONVEX: 2 * spiric_length(2, 0.5, 1)},
    ),
    "torus cut in one oval": Case(
        lambda: cut_torus(1.8),
        torus_below(2, 0.5, 1.8),
        0,
        {"torus": 1, "plane": 1},
        {("curve", CONVEX): 1},
    ),
    "half torus": Case(
        lambda: cut_torus(0.0),
        pi**2 / 2,
        1,
        {"torus": 1, "plane": 2},
        {CIRCLES: 2},
        area=2 * pi**2 + pi / 2,
        length={CONVEX: 2 * pi},
    ),
    "fichera": Case(
        fichera,
        7,
        1,
        {"plane": 9},
        {LINES: 18, ("line", REENTRANT): 3},
        {CONVEX: 10, SADDLE: 3, REENTRANT: 1},
        24,
        length={CONVEX: 27, REENTRANT: 3},
    ),
    "pocket": Case(
        pocket,
        28,
        1,
        {"plane": 11},
        {LINES: 16, ("line", REENTRANT): 8},
        {CONVEX: 8, SADDLE: 4, REENTRANT: 4},
        64 + 8,
        length={CONVEX: 48, REENTRANT: 12},
    ),
    "lens": Case(
        lens,
        2 * cap(1, 0.5),
        1,
        {"sphere": 2},
        {CIRCLES: 1},
        area=2 * pi,
        length={CONVEX: pi * sqrt(3)},
    ),
    "oblique cone": Case(
        oblique_cone,
        oblique_cone_volume(),
        0,
        {"plane": 6, "cone": 1},
        {LINES: 12, ("ellipse", CONVEX): 2},
        {CONVEX: 8},
        length={CONVEX: 8 * 4 + 6 * 4 + 2 * 4 + oblique_cone_edges()},
    ),
    "capsule": Case(
        capsule,
        pi / 2 + pi / 6,
        1,
        {"sphere": 2, "cylinder": 1},
        {("circle", SMOOTH): 2},
        area=2 * pi + pi,
        length={SMOOTH: 2 * pi},
    ),
    "slot": Case(
        slot,
        12 - 2 - pi / 4,
        0,
        {"plane": 8, "cylinder": 2},
        {LINES: 16, CIRCLES: 4, ("line", SMOOTH): 4},
        {CONVEX: 16},
        38 - 4 - pi / 2 + 4 + pi,
        length={CONVEX: 40 + 2 * pi, SMOOTH: 4},
    ),
    "pipe elbow": Case(
        elbow,
        pi**2 / 4 + 0.75 * pi,
        1,
        {"plane": 2, "torus": 1, "cylinder": 1},
        {CIRCLES: 2, ("circle", SMOOTH): 1},
        area=pi**2 + 3 * pi + pi / 2,
        length={CONVEX: 2 * pi, SMOOTH: pi},
    ),
    "countersink": Case(
        countersink,
        36 - pi / 3 * (0.25 + 0.5 * (0.5 + tan(radians(26))) + (0.5 + tan(radians(26))) ** 2),
        0,
        {"plane": 6, "cone": 1},
        {LINES: 12, CIRCLES: 2},
        {CONVEX: 8},
        length={CONVEX: 52 + 2 * pi * (1 + tan(radians(26)))},
    ),
    "round boss": Case(
        round_boss,
        16 + 0.49 * pi,
        1,
        {"plane": 7, "cylinder": 1},
        {LINES: 12, CIRCLES: 1, ("circle", REENTRANT): 1},
        {CONVEX: 8},
        length={CONVEX: 36 + 1.4 * pi, REENTRANT: 1.4 * pi},
    ),
    "square boss": Case(
        square_boss,
        20,
        1,
        {"plane": 11},
        {LINES: 20, ("line", REENTRANT): 4},
        {CONVEX: 12, SADDLE: 4},
        length={CONVEX: 48, REENTRANT: 8},
    ),
    "oval ring": Case(
        oval_ring, oval_ring_volume(), 0, {"torus": 2}, {CIRCLES: 2}, length={CONVEX: 2 * pi * 6.8}
    ),
    "thin wall": Case(
        thin_wall,
        24 - 2,
        0,
        {"plane": 10},
        {LINES: 20, ("line", REENTRANT): 4},
        {CONVEX: 8, SADDLE: 8},
        length={CONVEX: 44, REENTRANT: 8},
    ),
}
