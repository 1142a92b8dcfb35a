"""Where surfaces of revolution of a conic meet their axis: spindle and parabolic torus."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from decomp.vectors import norm
from decomp.voronoi import (
    ConeSite,
    CylinderSite,
    Kind,
    PlaneSite,
    SphereSite,
    TorusSite,
    VoronoiSurface,
    surface,
)
from decomp.voronoi.exact import Vector, floats, unit
from tests.voronoi.instances import ANGLES, FEW, at, numbers, points, radii, ways


def tips_of(found: VoronoiSurface, p: Vector, way: Vector) -> int:
    """How many tips there are; each is on the axis and on the canonical equation."""
    assert found.shape is not None
    tips = found.shape.tips
    off = tips - floats(p)
    z = unit(way)
    assert norm(off - (off @ z)[:, None] * z).max(initial=0.0) <= 1e-12 * found.size
    assert found.shape.deviation(tips).max(initial=0.0) <= 1e-9 * found.size
    return len(tips)


@FEW
@given(points, ways, radii, radii, radii)
def test_cylinder_and_torus(
    p: Vector, way: Vector, r: Fraction, more: Fraction, s: Fraction
) -> None:
    """Theorem 4.8 (iii): a spindle, odd, where the cylinder is wider than the torus's hole."""
    f, g = CylinderSite(p, way, s), TorusSite(p, way, r + more, r)
    for parity in ("even", "odd"):
        found = surface(f, g, parity)
        if found.kind is not Kind.REVOLVED_PARABOLA:
            continue
        assert found.shape is not None
        wide = parity == "odd" and s > more
        assert found.shape.spindle == wide
        count = tips_of(found, p, way)
        if wide:
            # where the distances are hypot(major, z) - r and s
            high = np.sqrt(float((s + r) ** 2 - g.major**2))
            tips = found.shape.tips - floats(p)
            assert np.allclose(tips @ unit(way), [-high, high], atol=1e-9)
            assert count == 2 and found.contains(found.shape.tips).all()


@FEW
@given(points, ways, radii, radii)
def test_cylinder_about_a_sphere(p: Vector, way: Vector, r: Fraction, s: Fraction) -> None:
    """Theorem 4.7 (ii), figure 14: about the latus rectum the odd one is closed at two tips."""
    f, g = CylinderSite(p, way, s), SphereSite(p, r)
    odd = surface(f, g, "odd")
    if odd.kind is Kind.REVOLVED_PARABOLA:
        assert odd.shape is not None and odd.shape.spindle and tips_of(odd, p, way) == 2
        assert odd.contains(odd.shape.tips).all()
    even = surface(f, g, "even")
    if even.kind is Kind.REVOLVED_PARABOLA:
        assert even.shape is not None and not even.shape.spindle


@FEW
@given(points, ways, radii, radii, numbers, st.sampled_from([0, "1/8"]))
def test_plane_and_torus(
    p: Vector, way: Vector, r: Fraction, more: Fraction, h: Fraction, tube: str
) -> None:
    """Theorem 4.6 (v), the parabolic torus: its parabola's axis is parallel, with one tip."""
    f, g = PlaneSite(at(p, way, h), way), TorusSite(p, way, r + more, tube)
    for parity in ("even", "odd"):
        found = surface(f, g, parity)
        if found.kind is not Kind.REVOLVED_PARABOLA:
            continue
        assert found.shape is not None and not found.shape.spindle
        assert tips_of(found, p, way) == 1
        assert abs(np.sin(found.shape.parameters["tilt"])) <= 1e-12
        assert found.contains(found.shape.tips).all()


@FEW
@given(points, ways, st.sampled_from(ANGLES), radii, radii, numbers)
def test_cone_and_torus(
    p: Vector,
    way: Vector,
    angle: tuple[Fraction, Fraction],
    r: Fraction,
    more: Fraction,
    h: Fraction,
) -> None:
    """Theorem 4.9 (ii): an oblique parabola; a spindle only where it opens towards the axis."""
    f, g = ConeSite(p, way, *angle), TorusSite(at(p, way, h), way, r + more, r)
    for parity in ("even", "odd"):
        found = surface(f, g, parity, exists=True)
        if found.kind is not Kind.REVOLVED_PARABOLA:
            continue
        assert found.shape is not None
        count = tips_of(found, p, way)
        assert found.shape.spindle == (count == 2 and parity == "odd")
