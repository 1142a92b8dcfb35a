"""Maximal inscribed balls, and the Voronoi elements that their centres lie on."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.skeletons.balls.balls import inscribed_balls, largest_gap
from decomp.skeletons.balls.equidistance import equidistant
from decomp.skeletons.balls.region_context import RegionContext
from decomp.vectors import norm
from tests.skeletons.sampling import boundary_points
from tests.solids import SOLIDS

NAMES = (
    "block",
    "cylinder",
    "torus",
    "through hole",
    "blind hole",
    "bracket",
    "fichera",
    "unequal tee",
    "countersink",
    "oval ring",
)


@pytest.mark.parametrize("name", NAMES)
def test_balls_are_inscribed_and_touch_twice(name: str) -> None:
    geometry = decomp.Geometry(SOLIDS[name].make())
    size = geometry.diagonal
    q, inward = boundary_points(geometry, 200)
    balls = inscribed_balls(RegionContext(geometry.index, 0), q, inward)
    assert largest_gap(geometry.index, 0, balls.centre, balls.radius) <= 1e-11 * size
    assert np.abs(norm(balls.centre - q) - balls.radius).max() <= 1e-14 * size
    assert np.abs(norm(balls.centre - balls.foot) - balls.radius).max() <= 1e-11 * size


@pytest.mark.parametrize("name", NAMES)
def test_no_larger_ball_is_inscribed(name: str) -> None:
    geometry = decomp.Geometry(SOLIDS[name].make())
    q, inward = boundary_points(geometry, 100)
    balls = inscribed_balls(RegionContext(geometry.index, 0), q, inward)
    radius = 1.01 * balls.radius + 1e-3 * geometry.diagonal
    centre = q + radius[:, None] * inward
    assert (-geometry.distance(centre) < radius * (1 - 1e-9)).all()


def test_the_skeleton_of_a_block_has_thirteen_sheets() -> None:
    geometry = decomp.Geometry(SOLIDS["block"].make())
    q, inward = boundary_points(geometry, 2000)
    balls = inscribed_balls(RegionContext(geometry.index, 0), q, inward)
    own = geometry.nearest(q + 1e-3 * balls.radius[:, None] * inward).site
    pairs = {tuple(sorted(pair)) for pair in zip(own.tolist(), balls.site.tolist(), strict=True)}
    assert len(pairs) == 13


def test_a_cylinder_ends_in_two_cones_and_an_axis() -> None:
    geometry = decomp.Geometry(SOLIDS["cylinder"].make())  # radius 1, height 3
    q, inward = boundary_points(geometry, 1000)
    balls = inscribed_balls(RegionContext(geometry.index, 0), q, inward)
    rho, z = np.hypot(*balls.centre.T[:2]), balls.centre[:, 2]
    exact = np.where(z <= 1, np.abs(rho - (1 - z)), np.where(z >= 2, np.abs(rho - (z - 2)), rho))
    assert exact.max() <= 1e-11


def test_a_torus_shrinks_to_its_spine() -> None:
    geometry = decomp.Geometry(SOLIDS["torus"].make())  # 2 and 0.5
    q, inward = boundary_points(geometry, 1000)
    balls = inscribed_balls(RegionContext(geometry.index, 0), q, inward)
    assert np.abs(balls.radius - 0.5).max() <= 1e-12
    assert np.abs(np.hypot(*balls.centre.T[:2]) - 2).max() <= 1e-12


@pytest.mark.parametrize("name", ["block", "through hole", "bracket", "unequal tee", "oval ring"])
def test_centres_are_brought_to_equal_distance(name: str) -> None:
    """Centres between two different sites, pushed off, come back to a residual of rounding."""
    geometry = decomp.Geometry(SOLIDS[name].make())
    size = geometry.diagonal
    q, inward = boundary_points(geometry, 200)
    balls = inscribed_balls(RegionContext(geometry.index, 0), q, inward)
    own = geometry.nearest(q + 1e-3 * balls.radius[:, None] * inward)
    two = np.flatnonzero((own.site != balls.site) & (balls.radius > 1e-3 * size))
    which = np.stack([own.site[two], balls.site[two]], axis=1)
    feet = np.stack([q[two], balls.foot[two]], axis=1)
    pushed = balls.centre[two] + 1e-5 * size * np.random.default_rng(0).normal(size=(len(two), 3))
    found = equidistant(RegionContext(geometry.index, 0), which, pushed, feet)
    assert found.converged.all()
    assert found.residual.max() <= 1e-14 * size
    assert norm(found.points - balls.centre[two]).max() <= 1e-3 * size


def test_three_sites_give_a_seam_and_four_a_junction() -> None:
    """In the block 4 x 3 x 2 the seam of x = 0, y = 0, z = 0 runs along x = y = z, and the planes
    z = 0, z = 2, x = 0, y = 0 meet in (1, 1, 1)."""
    geometry = decomp.Geometry(SOLIDS["block"].make())
    name = {site.name: k for k, site in enumerate(geometry.sites) if site.region == 0}
    x0, y0, z0, z2 = (name[f"block.{side}"] for side in ("xmin", "ymin", "zmin", "zmax"))
    start = np.array([[0.5, 0.6, 0.4]])
    seam = equidistant(
        RegionContext(geometry.index, 0),
        np.array([[x0, y0, z0]]),
        start,
        np.repeat(start[:, None], 3, axis=1),
    )
    assert np.ptp(seam.points) <= 1e-15
    assert seam.points.mean() == pytest.approx(0.5)  # the step is the shortest one
    junction = equidistant(
        RegionContext(geometry.index, 0),
        np.array([[x0, y0, z0, z2]]),
        start,
        np.repeat(start[:, None], 4, axis=1),
    )
    assert np.allclose(junction.points, [[1, 1, 1]], atol=1e-15)
    assert junction.radius[0] == pytest.approx(1)
