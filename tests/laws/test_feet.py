"""Every foot lies on the boundary, and is the nearest, of solids whose surfaces touch.

They are judged by the primitives' own inequalities and numbers.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial import cKDTree

import decomp
from benchmarks.membership import held
from decomp.boundary.arcs import arrange
from decomp.csg.primitives import Block, Cylinder
from decomp.csg.solid import Solid, union
from decomp.errors import GeometryError
from decomp.vectors import Array, Bools, norm
from tests.laws import plain
from tests.laws.effort import FACTOR
from tests.laws.tangent import KINDS

SEEDS = range(max(1, int(FACTOR)))
OFFSETS, MANY = 200, 20_000
"""Directions from a foot, and where a sliver's tip may be missed by them."""


def queried(g: decomp.Geometry, rng: np.random.Generator) -> Array:
    """Points at random, on a lattice of round numbers, and straight above boundary points."""
    low, high = g.regions[0].bounds
    margin = 0.2 * (high - low)
    anywhere = rng.uniform(low - margin, high + margin, (1500, 3))
    lattice = np.round(4 * rng.uniform(low - margin, high + margin, (1500, 3))) / 4
    carriers = g.boundaries.form.carriers
    lifted = [c.project(lattice[:200]) for c in carriers]
    above = np.concatenate(
        [q + h * c.normal(q) for c, q in zip(carriers, lifted, strict=True) for h in (-0.25, 0.5)]
    )
    # straight above the places where two surfaces touch or cross
    arrangement = arrange(g.boundaries.form, 2 * g.diagonal)
    for arc in arrangement.arcs:
        curve = arrangement.curves[arc.curve]
        q = curve.point(curve.wrapped(np.linspace(arc.start, arc.end, 7)))
        for k in arrangement.carriers[arc.curve]:
            above = np.concatenate([above, *(q + h * carriers[k].normal(q) for h in (-0.3, 0.4))])
    kept = np.abs(above - (low + high) / 2).max(axis=1) < g.diagonal
    return np.concatenate([anywhere, lattice, above[kept]])


def directions(count: int, rng: np.random.Generator) -> Array:
    ways = rng.normal(size=(count, 3))
    return np.asarray(ways / norm(ways)[:, None])


def two_sided(solid: Solid, feet: Array, ways: Array, size: float) -> Bools:
    """Whether points inside and outside are found at small distances from feet (n, 3)."""
    inner, outer = np.zeros(len(feet), bool), np.zeros(len(feet), bool)
    for way, reach in zip(ways, np.resize([1e-2, 3e-3, 1e-3, 1e-4], len(ways)), strict=True):
        inside = held(solid, feet + reach * size * way)
        inner, outer = inner | inside, outer | ~inside
    return inner & outer


def check(solid: Solid, rng: np.random.Generator) -> None:
    g = decomp.Geometry(solid)
    size = g.diagonal
    p = queried(g, rng)
    found = g.nearest(p)
    # the region is that of the expression, wherever a little step does not change it
    steps = 1e-9 * size * np.concatenate([np.eye(3), -np.eye(3)])
    around = np.array([held(solid, p + step) for step in steps])
    clear = (around == around[0]).all(axis=0)
    assert (g.contains(p) == around[0])[clear].all()
    # feet stand where their distance says
    assert np.allclose(norm(p - found.foot), found.distance, rtol=0, atol=1e-9 * size)
    # both sides of the boundary are close to every foot
    feet = np.unique(np.round(found.foot, 9), axis=0)
    normals = [carrier.normal(feet) for carrier in g.boundaries.form.carriers]
    for ways in (directions(OFFSETS, rng), directions(MANY, rng)):
        if len(feet):
            bad = ~two_sided(solid, feet, ways, size)
            for normal in normals:
                for reach in (1e-2, 1e-4, 1e-6, 1e-8):
                    sides = [held(solid, feet + s * reach * size * normal) for s in (1, -1)]
                    bad &= sides[0] == sides[1]
            feet, normals = feet[bad], [normal[bad] for normal in normals]
    assert not len(feet), feet[:3].tolist()
    # no sample of the boundary is nearer, and one is as near as samples are to the foot
    samples = plain.boundary_samples(solid, 20_000, rng, 1e-7 * size)
    tree = cKDTree(samples)
    least = tree.query(p)[0]
    too_far = found.distance - least
    assert too_far.max() <= 1e-6 * size, (p[too_far.argmax()].tolist(), too_far.max())
    gaps = tree.query(found.foot)[0]
    assert (found.distance >= least - gaps - 1e-6 * size).all()
    assert gaps.max() < 0.05 * size


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_feet_on_solids_that_touch(kind: Callable[[np.random.Generator], Solid], seed: int) -> None:
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    checked = 0
    for _ in range(12):
        try:
            check(kind(rng), rng)
            checked += 1
        except GeometryError:
            continue  # refused, as where parts touch from outside
        if checked == 3:
            break
    assert checked


def test_a_foot_on_a_tangent_plane_is_none() -> None:
    disc = Cylinder((0, 0, -0.5), (0, 0, 0.5), 2)
    g = decomp.Geometry(disc - Block.between((-0.7, -0.75, -0.6), (2, 0.75, 0.6)))
    found = g.nearest([(4.868, 0, -0.5), (3, 0, 0), (2.5, 0, 0.5)])
    rim = np.array([np.sqrt(4 - 0.75**2), 0.75])
    expected = [np.hypot(x - rim[0], rim[1]) for x in (4.868, 3, 2.5)]
    assert np.allclose(found.distance, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("axis", "corner", "times"),
    [((0, 1, 0), (0, -1, 0), 1), ((1, 2, 3), (0, 0, 0), 1), ((1, 2, 3), (0, 0, 0), 3)],
    ids=["edge", "corner", "many planes"],
)
def test_blocks_that_meet_in_an_edge_or_a_corner_have_nothing_in_common(
    axis: tuple[float, float, float], corner: tuple[float, float, float], times: int
) -> None:
    """Inside all planes through the place there is no point, though a program would have one."""
    one = Block(corner, (1, 1, 1))
    below = Block((-1, corner[1] - (corner[1] == 0), -1), (1, 1, 1))
    other = union([below.rotate(axis, 20 - 13 * k) for k in range(times)])
    far = Block((-4, -1, -1), (1, 2, 2))
    g = decomp.Geometry((one & other) | far)
    p = np.concatenate([[(0.1, 0.1, 0.3)], np.random.default_rng(5).uniform(-0.3, 0.3, (200, 3))])
    # straight above the place, over each of the planes
    p = np.concatenate([p, *(0.2 * c.normal(np.zeros((1, 3))) for c in g.boundaries.form.carriers)])
    found = g.nearest(p)
    assert np.allclose(found.distance, p[:, 0] + 3, rtol=0, atol=1e-12)
    assert np.allclose(found.foot, p * (0, 1, 1) - (3, 0, 0), rtol=0, atol=1e-12)
