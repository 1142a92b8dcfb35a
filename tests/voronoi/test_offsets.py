"""Table 1 of the paper: the offsets of the five carriers."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp.voronoi import ConeSite, CylinderSite, PlaneSite, SphereSite, TorusSite
from decomp.voronoi.polynomial import D, X, Y, Z, rational
from tests.voronoi.instances import FEW, SITES, angles, radii

ORIGIN, UP = (0, 0, 0), (0, 0, 1)


def test_plane() -> None:
    assert PlaneSite(ORIGIN, UP).offset(1) == Z - D


@FEW
@given(radii)
def test_sphere_and_cylinder(r: Fraction) -> None:
    grown = (rational(r) + D) ** 2
    assert SphereSite(ORIGIN, r).offset(1) == X**2 + Y**2 + Z**2 - grown
    assert CylinderSite(ORIGIN, UP, r).offset(1) == X**2 + Y**2 - grown


@FEW
@given(angles)
def test_cone(sine_cosine: tuple[Fraction, Fraction]) -> None:
    sine, cosine = map(rational, sine_cosine)
    table = X**2 + Y**2 - (Z + D / sine) ** 2 * (sine / cosine) ** 2
    assert ConeSite(ORIGIN, UP, *sine_cosine).offset(1) == cosine**2 * table


@FEW
@given(radii, radii)
def test_torus(r: Fraction, more: Fraction) -> None:
    c, tube = rational(r + more), (rational(r) + D) ** 2
    table = (X**2 + Y**2 + Z**2 - tube) ** 2 + 2 * c**2 * (Z**2 - (X**2 + Y**2 + tube)) + c**4
    assert TorusSite(ORIGIN, UP, r + more, r).offset(1) == table


@pytest.mark.parametrize("kind", SITES)
@FEW
@given(st.data())
def test_offset_vanishes_at_its_distance(kind: str, data: st.DataObject) -> None:
    """Inside (odd, with the sign of d changed) and outside."""
    site = data.draw(SITES[kind])
    p = np.random.default_rng(1).uniform(-4, 4, size=(20, 3))
    s = site.signed_distance(p)
    if isinstance(site, ConeSite):
        clear = np.linalg.norm(site.foot(p) - site.carrier.apex, axis=1) > 1e-9
        p, s = p[clear], s[clear]
    for e in (1, -1):
        terms = site.offset(e).to_dict()
        parts = np.array(
            [
                float(Fraction(int(c.p), int(c.q)))
                * np.prod(np.column_stack([p, e * s]) ** np.array([int(n) for n in powers]), axis=1)
                for powers, c in terms.items()
            ]
        )
        assert np.all(np.abs(parts.sum(axis=0)) <= 1e-11 * np.abs(parts).sum(axis=0))
