"""Junctions so close to each other that points known less well would be one."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

import decomp
from decomp.vectors import Array


def junctions(found: decomp.Skeleton) -> Array:
    """The places (k, 3) inside the solid at which seams end."""
    inside = [each.vertex for each in found.regions[0].junctions if each.radius > 0]
    return np.asarray(found.complex.points[inside])


def prism(corners: list[tuple[float, float]], height: float) -> decomp.Solid:
    """A prism over a convex polygon, its corners anticlockwise."""
    solid: decomp.Solid = decomp.Block((-9, -9, 0), (18, 18, height), name="prism")
    for (x, y), (u, v) in zip(corners, [*corners[1:], corners[0]], strict=True):
        solid = solid & decomp.HalfSpace((x, y, 0), (v - y, x - u, 0))
    return solid


@pytest.mark.parametrize("more", [1e-5, 1e-6, 1e-7])
def test_a_block_that_is_nearly_a_cube(more: float) -> None:
    """The middle rectangle has the sides that the block has more than the least one."""
    found = decomp.skeleton(decomp.Block((0, 0, 0), (10, 10 + more, 10 + 3 * more)))
    inside = junctions(found)
    assert len(inside) == 4
    assert inside[:, 0] == pytest.approx(5, abs=1e-14)
    spread = inside.max(axis=0) - inside.min(axis=0)
    assert spread == pytest.approx([0, more, 3 * more], rel=1e-6, abs=1e-14)
    assert len(found.regions[0].sheets) == 13
    assert found.regions[0].certificate.euler == 1


@pytest.mark.parametrize("more", [1e-6, 1e-7])
def test_a_bar_that_is_nearly_a_cube(more: float) -> None:
    """Two junctions, at the ends of the axis between both pyramids."""
    found = decomp.skeleton(decomp.Block((0, 0, 0), (10, 10, 10 + more)))
    inside = junctions(found)
    assert len(inside) == 2
    assert abs(inside[1] - inside[0]) == pytest.approx([0, 0, more], rel=1e-6, abs=1e-14)
    assert len(found.regions[0].sheets) == 12


@pytest.mark.parametrize("digits", range(3, 8))
def test_a_hexagon_with_few_digits(digits: int) -> None:
    """Seven sheets nearly meet in a point below the top, and above the base."""
    angles = [k * pi / 3 for k in range(6)]
    corners = [(round(2 * cos(a), digits), round(2 * sin(a), digits)) for a in angles]
    found = decomp.skeleton(prism(corners, 9))
    inside = junctions(found)
    near = np.abs(inside - [0, 0, 4.5]) <= [10.0**-digits, 10.0**-digits, np.inf]
    assert near.all()
    assert sorted(np.abs(inside[:, 2] - 4.5)) == pytest.approx(
        [4.5 - 3**0.5] * len(inside), abs=10.0**-digits
    )
    assert len(inside) in (4, 6)
    assert found.regions[0].certificate.euler == 1


def test_a_seam_passes_a_straight_one_closely() -> None:
    """The middle sheet has a neck between a circle and a line, which gets short chords too."""
    hole = decomp.Cylinder((0.2 - 1e-8, 0, -1), (0.2 - 1e-8, 0, 2), 0.8, name="hole")
    found = decomp.skeleton(decomp.Block((-2, -2, 0), (4, 4, 1), name="plate") - hole)
    names = [{found.sites[k].name for k in sheet.sites} for sheet in found.regions[0].sheets]
    assert names.count({"plate.zmin", "plate.zmax"}) == 1
    assert {"plate.xmax", "hole.side"} not in names
    assert found.regions[0].certificate.euler == 0
