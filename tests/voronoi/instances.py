"""Random sites with small rational parameters, for Hypothesis."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from hypothesis import Phase, assume, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from decomp.errors import InputError
from decomp.voronoi import (
    CarrierSite,
    ConeSite,
    CylinderSite,
    Parity,
    PlaneSite,
    SphereSite,
    TorusSite,
    VoronoiSurface,
    surface,
)
from decomp.voronoi.exact import Vector

FEW = settings(
    max_examples=12, deadline=None, derandomize=True, phases=[Phase.explicit, Phase.generate]
)

WAYS: list[Vector] = [
    (Fraction(x), Fraction(y), Fraction(z))
    for x, y, z in [
        (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 3, 4), (-3, 0, 4), (1, 2, 2), (2, -1, 2), (-2, 3, 6),
        (6, 2, -3), (1, 4, 8), (4, -4, 7), (2, 6, 9),
    ]
]  # fmt: skip
"""Directions of rational length."""
ANGLES = [(Fraction(3, 5), Fraction(4, 5)), (Fraction(4, 5), Fraction(3, 5)),
          (Fraction(5, 13), Fraction(12, 13)), (Fraction(8, 17), Fraction(15, 17))]  # fmt: skip
"""Rational sines and cosines."""

numbers: SearchStrategy[Fraction] = st.integers(-12, 12).map(lambda k: Fraction(k, 4))
radii: SearchStrategy[Fraction] = st.integers(1, 12).map(lambda k: Fraction(k, 4))
ways: SearchStrategy[Vector] = st.sampled_from(WAYS)
points: SearchStrategy[Vector] = st.tuples(numbers, numbers, numbers)
angles: SearchStrategy[tuple[Fraction, Fraction]] = st.sampled_from(ANGLES)

planes = st.builds(PlaneSite, points, ways)
spheres = st.builds(SphereSite, points, radii)
cylinders = st.builds(CylinderSite, points, ways, radii)
cones = st.builds(lambda p, w, a: ConeSite(p, w, *a), points, ways, angles)
tori = st.builds(lambda p, w, r, more: TorusSite(p, w, r + more, r), points, ways, radii, radii)
dots = st.builds(lambda p: SphereSite(p, 0), points)
lines = st.builds(lambda p, w: CylinderSite(p, w, 0), points, ways)
circles = st.builds(lambda p, w, r: TorusSite(p, w, r, 0), points, ways, radii)

SITES = {
    "plane": planes,
    "sphere": spheres,
    "cylinder": cylinders,
    "cone": cones,
    "torus": tori,
    "point": dots,
    "line": lines,
    "circle": circles,
}


def surfaces_of(f: CarrierSite, g: CarrierSite) -> Iterator[VoronoiSurface]:
    """Vor(f, g), even and, where a site has two sides, odd; a pair that is refused is not used."""
    for parity in Parity if f.two_sided or g.two_sided else [Parity.EVEN]:
        try:
            found = surface(f, g, parity)
        except InputError:
            assume(False)
        yield found


def on(point: Vector, way: Vector, t: Fraction) -> Vector:
    """point + t way."""
    return (point[0] + t * way[0], point[1] + t * way[1], point[2] + t * way[2])


def across(way: Vector) -> tuple[Vector, Vector]:
    """Two directions at right angles to `way` and to each other, of rational lengths."""
    x, y, z = way
    table = {
        (0, 0, 1): ((1, 0, 0), (0, 1, 0)),
        (1, 0, 0): ((0, 1, 0), (0, 0, 1)),
        (0, 1, 0): ((0, 0, 1), (1, 0, 0)),
        (0, 3, 4): ((1, 0, 0), (0, 4, -3)),
        (-3, 0, 4): ((0, 1, 0), (-4, 0, -3)),
        (1, 2, 2): ((2, 1, -2), (2, -2, 1)),
        (2, -1, 2): ((2, 2, -1), (-1, 2, 2)),
        (-2, 3, 6): ((6, -2, 3), (3, 6, -2)),
        (6, 2, -3): ((2, 3, 6), (3, -6, 2)),
        (1, 4, 8): ((8, -4, 1), (4, 7, -4)),
        (4, -4, 7): ((1, 8, 4), (8, 1, -4)),
        (2, 6, 9): ((6, 7, -6), (9, -6, 2)),
    }  # fmt: skip
    one, two = table[int(x), int(y), int(z)]
    return (
        (Fraction(one[0]), Fraction(one[1]), Fraction(one[2])),
        (Fraction(two[0]), Fraction(two[1]), Fraction(two[2])),
    )


def at(point: Vector, way: Vector, t: Fraction) -> Vector:
    """The point at distance t from `point` along `way`, whose length is rational."""
    size = Fraction(round(float(sum(x * x for x in way)) ** 0.5))
    return on(point, way, t / size)
