"""Special positions are found: what is called general has an equation that does not factor."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import product

import pytest

from decomp.errors import InputError
from decomp.voronoi import CarrierSite, ConeSite, CylinderSite, Kind, Parity, TorusSite, surface
from tests.voronoi.instances import ANGLES

UP = (0, 0, 1)
RING = TorusSite((0, 0, 0), UP, 2, 0)
TUBE = TorusSite((0, 0, 0), UP, 2, 1)
PLACES = [(0, 0, 0), (2, 0, 0), (1, 0, 0), (3, 0, 0), (0, 0, 1), (2, 0, "3/2"), ("3/2", 0, 0)]
"""Centre, spine, inner and outer equator, axis, above the spine, in its plane."""
WAYS = [UP, (1, 0, 0), (0, 1, 0), (3, 0, 4)]
"""Along the axis, out from it, around it, oblique."""


def others(kind: str) -> Iterator[CarrierSite]:
    for p, way in product(PLACES, WAYS):
        if kind == "cylinder":
            yield from (CylinderSite(p, way, r) for r in (0, 1, 2))
        elif kind == "cone":
            yield from (ConeSite(p, way, *angle) for angle in ANGLES[:2])
        else:
            for major, minor in ((2, 1), (2, 0), (1, 0), ("3/2", "1/2"), (3, 1), ("5/2", "3/2")):
                yield TorusSite(p, way, Fraction(major), Fraction(minor))


SITES = {
    "ring": RING,
    "tube": TUBE,
    "line": CylinderSite((0, 0, 0), UP, 0),
    "cylinder": CylinderSite((0, 0, 0), UP, 1),
    "cone": ConeSite((0, 0, 0), UP, *ANGLES[0]),
}
CROSSING = (Fraction(5, 2), Fraction(3, 2))
"""Radii of a torus whose hole the tube fills and that crosses it, too: a plane and a quartic."""


@pytest.mark.parametrize("one", SITES)
@pytest.mark.parametrize("two", ["cylinder", "cone", "torus"])
def test_general_surfaces_do_not_factor(one: str, two: str) -> None:
    f, seen = SITES[one], 0
    for g in others(two):
        for parity in Parity if f.two_sided or g.two_sided else [Parity.EVEN]:
            try:
                found = surface(f, g, parity, exists=True)
            except InputError:
                continue
            if found.kind is not Kind.GENERAL:
                continue
            assert found.polynomial is not None
            _, factors = found.polynomial.raw.factor()
            if isinstance(g, TorusSite) and (g.major, g.minor) == CROSSING and len(factors) > 1:
                assert one == "tube" and parity is Parity.ODD and found.degree == 5
                continue
            if len(factors) > 1:
                # nothing but a point of contact at a cone's apex
                assert surface(f, g, parity).kind is Kind.POINT
            seen += 1
    assert seen > 20
