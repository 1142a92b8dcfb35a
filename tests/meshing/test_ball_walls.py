"""Thickness from balls on faces: exact, and what the sheets of the skeleton tell."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.csg.solid import Solid
from decomp.meshing.sizing.features import fitting_tolerance, least_thickness, thickness
from decomp.meshing.sizing.sizes import Wanted, region_sizes, wishes
from decomp.meshing.surface.boundary_surface import boundary_surface
from decomp.meshing.surface.surface import MeshSurface, SurfaceMaker
from tests.solids import SOLIDS


def surface_of(solid: Solid) -> tuple[decomp.Geometry, MeshSurface]:
    geometry = decomp.Geometry(solid)
    sizes = region_sizes(geometry, Wanted())
    return geometry, boundary_surface(geometry, sizes, 2e-3 * geometry.diagonal)


def pipe(wall: float) -> Solid:
    bore = decomp.Cylinder((0, 0, -1), (0, 0, 6), 1 - wall)
    return decomp.Cylinder((0, 0, 0), (0, 0, 5), 1) - bore


@pytest.mark.parametrize(
    ("solid", "exact"),
    [
        (decomp.Block((0, 0, 0), (8, 6, 1)), 1.0),
        (pipe(0.01), 0.01),
        (decomp.Cylinder((0, 0, 0), (0, 0, 5), 1), 2.0),
        (decomp.Torus((0, 0, 0), (0, 0, 1), 2, 0.3), 0.6),
        (decomp.Sphere((1, 2, 3), 2), 4.0),
        (SOLIDS["thin wall"].make(), 0.01),
        (SOLIDS["blind hole"].make(), 1.0),
    ],
)
def test_the_least_thickness(solid: Solid, exact: float) -> None:
    assert least_thickness(*surface_of(solid), 0) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("between", [0.3, 0.01, 1e-3])
def test_the_narrowest_place_between_balls_is_found(between: float) -> None:
    way = np.array([0.48, -0.6, 0.64])  # a unit vector that no sample lies on
    solid = decomp.Sphere((0, 0, 0), 1) - decomp.Sphere(tuple((0.6 - between) * way), 0.4)
    assert least_thickness(*surface_of(solid), 0) == pytest.approx(between, rel=0.02)


def test_the_tip_of_a_cone_is_a_corner() -> None:
    """The ball in the cone has a radius of 5 / (1 + sqrt(26)); half of it counts."""
    solid = decomp.Cone((0, 0, 0), 1, (0, 0, 5), 0)
    ball = 5 / (1 + np.sqrt(26))
    assert 0.9 * ball < least_thickness(*surface_of(solid), 0) < 2 * ball


def test_a_wedge_is_no_wall() -> None:
    """Two planes meet at 20 degrees; the prism is as thick as it is long."""
    angle = np.radians(20)
    slope = decomp.HalfSpace((0, 0, 0), (-np.sin(angle), 0, np.cos(angle)))
    prism = decomp.Block((0, 0, 0), (8, 3, 4)) & slope
    assert least_thickness(*surface_of(prism), 0) > 2.9


def test_fillets_are_no_walls() -> None:
    """A ball that rolls in a rounded edge has nothing across from it."""
    edge = decomp.Block((3, -1, 3), (2, 12, 2)) - decomp.Cylinder((3, -1, 3), (3, 11, 3), 1)
    solid = decomp.Block((0, 0, 0), (4, 10, 4)) - edge
    assert least_thickness(*surface_of(solid), 0) > 3


@pytest.mark.parametrize("name", ["unequal tee", "slot", "round boss", "bracket"])
def test_balls_and_sheets_tell_the_same(name: str) -> None:
    geometry, surface = surface_of(SOLIDS[name].make())
    sheets = SurfaceMaker(geometry, lambda *_: None).made(2e-3 * geometry.diagonal, False)
    by_sheets = least_thickness(geometry, sheets, 0)
    assert least_thickness(geometry, surface, 0) == pytest.approx(by_sheets, rel=0.02)


def test_places_are_on_both_sides_of_walls_and_inside() -> None:
    geometry, surface = surface_of(pipe(0.1))
    points, thick = thickness(geometry, surface, 0, 0.5)
    radius = np.hypot(points[:, 0], points[:, 1])
    wall = thick < 0.1 * (1 + 1e-6)
    assert {0.9, 0.95, 1.0} == set(np.round(radius[wall], 6).tolist())


def test_layers_count_across_walls() -> None:
    geometry, surface = surface_of(decomp.Block((0, 0, 0), (8, 6, 1), name="plate"))
    wish = wishes(geometry, surface, Wanted(size=0.9, layers=4))
    assert wish.lengths.min() == pytest.approx(0.25, rel=1e-6)


def test_epsilon_fits_walls_and_gaps() -> None:
    geometry, surface = surface_of(SOLIDS["thin wall"].make())
    assert fitting_tolerance(geometry, surface, 0.05, 0.3) <= 0.15 * 0.01 * (1 + 1e-9)
    slit = decomp.Block((0, 0, 0), (4, 4, 4)) - decomp.Block((2, -1, 1), (0.04, 6, 5))
    assert fitting_tolerance(*surface_of(slit), 0.05, 0.3) < 0.02
    assert fitting_tolerance(*surface_of(SOLIDS["block"].make()), 0.01, 0.3) == 0.01
