"""Sizes: curvature, gradation, thickness, the file's own; epsilon from the smallest feature."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import griddata  # type: ignore[import-untyped]
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

import decomp
from decomp.carriers import Cone, Cylinder, Plane, Sphere, Torus
from decomp.csg.solid import Solid
from decomp.meshing.sizing.expected import expected_tets
from decomp.meshing.sizing.features import fitting_tolerance, least_thickness, usual_tolerance
from decomp.meshing.sizing.field import (
    CELL_WIDTH,
    OUTSIDE_SLOPE,
    is_uniform,
    octree_corners,
    sizing,
)
from decomp.meshing.sizing.sizes import Wanted, curvatures, region_sizes, wishes
from decomp.meshing.sizing.wishes import SLOPE, UNKNOWN, joined
from decomp.meshing.surface.surface import MeshSurface, SurfaceMaker
from decomp.vectors import direction, vector
from tests.solids import SOLIDS

UP = direction((0, 0, 1), "axis")
ORIGIN = vector((0, 0, 0), "origin")


def surface_of(solid: Solid) -> tuple[decomp.Geometry, MeshSurface]:
    geometry = decomp.Geometry(solid)
    return geometry, SurfaceMaker(geometry, lambda *_: None).made(2e-3 * geometry.diagonal, False)


def test_principal_curvatures() -> None:
    points = np.random.default_rng(0).normal(size=(50, 3)) + np.array([3, 0, 0.2])
    for carrier, expected in (
        (Plane(ORIGIN, UP), (0.0, 0.0)),
        (Sphere(ORIGIN, 2.0), (0.5, 0.5)),
        (Cylinder(ORIGIN, UP, 0.25), (0.0, 4.0)),
    ):
        low, high = curvatures(carrier, points)
        assert low == pytest.approx(np.full(50, expected[0]), abs=1e-12)
        assert high == pytest.approx(np.full(50, expected[1]), abs=1e-12)
    low, high = curvatures(Torus(ORIGIN, UP, 2.0, 0.5), np.array([[2.5, 0, 0], [1.5, 0, 0]]))
    assert high == pytest.approx([2, 2])
    assert low == pytest.approx([1 / 2.5, -1 / 1.5])


def test_a_cone_has_no_curvature_at_its_apex() -> None:
    low, high = curvatures(Cone(ORIGIN, UP, 0.3), np.array([[0.0, 0, 0], [0.5, 0.1, 1.0]]))
    assert np.isfinite(low).all()
    assert np.isfinite(high).all()


def test_lengths_grow_by_a_slope() -> None:
    random = np.random.default_rng(0)
    given = random.uniform(size=(200, 3)), random.uniform(0.01, 0.5, size=200)
    wish = joined([(*given, UNKNOWN)])
    a, b = random.uniform(-1, 2, size=(2, 500, 3))
    gap = np.linalg.norm(a - b, axis=1)
    assert (np.abs(wish.at(a) - wish.at(b)) <= SLOPE * gap + 1e-12).all()
    assert (wish.at(wish.points) <= wish.lengths).all()
    near = wish.at(wish.points) >= wish.lengths.min() * (1 - 1e-12)
    assert near.all()


def test_the_background_has_the_lengths_wanted_and_covers_the_model() -> None:
    geometry, surface = surface_of(SOLIDS["cylinder"].make())
    wanted = Wanted()
    wish, sizes = wishes(geometry, surface, wanted), region_sizes(geometry, wanted)
    _, field = sizing(geometry, wish, sizes)
    assert field is not None
    low, high = np.array(geometry.regions[0].bounds)
    volume = np.abs(
        np.linalg.det(field.points[field.tets[:, 1:]] - field.points[field.tets[:, :1]])
    )
    assert volume.sum() / 6 > np.prod(high - low)
    places = np.random.default_rng(0).uniform(low, high, size=(2000, 3))
    found = griddata(field.points, field.sizes, places)
    inside = geometry.index.region_of(places) == 0
    exact = np.minimum(wish.at(places), np.where(inside, sizes[0], np.inf))
    away = np.maximum(geometry.index.nearest(places).distance - exact, 0)
    exact += np.where(inside, 0, (OUTSIDE_SLOPE - SLOPE) * away)
    assert (found > 0.6 * exact).all()
    assert (found < 1.7 * exact).all()


def test_cells_are_small_where_lengths_are() -> None:
    wish = joined([(np.array([[0.0, 0, 0], [10, 0, 0]]), np.array([0.1, 2.0]), UNKNOWN)])
    corners = octree_corners(np.full(3, -2.0), 14.0, wish.at, 0.1)
    assert corners.min() == pytest.approx(-2, abs=0.01)
    assert corners.max() == pytest.approx(12, abs=0.01)
    near, far = (
        np.diff(np.sort(np.linalg.norm(corners - at, axis=1))[:2])[0]
        for at in corners[cKDTree(corners).query([[0, 0, 0], [10, 0, 0]])[1]]
    )
    assert 0.03 < near < CELL_WIDTH * 0.1 * 1.1
    assert near < 0.3 * far


def test_a_field_finds_a_slender_model() -> None:
    """The middle of its box is far from a bar along one of the box's edges, as from a flat one."""
    for size in ((600, 8, 1), (600, 8, 40)):
        bar = decomp.Block((-300, -4, 0), size, name="bar")
        geometry, surface = surface_of(bar)
        wanted = Wanted(size=2.0)
        wish = wishes(geometry, surface, wanted)
        _, field = sizing(geometry, wish, region_sizes(geometry, wanted))
        assert field is not None
        places = (-300, -4, 0) + np.random.default_rng(0).uniform(size=(500, 3)) * size
        found = griddata(field.points, field.sizes, places)
        assert (found < 1.7 * wish.at(places)).all()


def test_what_is_empty_is_coarse() -> None:
    shell = decomp.Sphere((0, 0, 0), 1, name="outer") - decomp.Sphere((0, 0, 0), 0.9, name="inner")
    geometry, surface = surface_of(shell)
    wanted = Wanted(size=0.05)
    wish, sizes = wishes(geometry, surface, wanted), region_sizes(geometry, wanted)
    assert is_uniform(wish)
    first, field = sizing(geometry, wish, sizes)
    assert field is not None
    assert first > 4 * 0.05
    radius = np.linalg.norm(field.points, axis=1)
    assert field.sizes[(radius > 0.9) & (radius < 1)].max() <= 0.05
    assert field.sizes[np.argmin(radius)] > 0.2


def test_uniform_wishes_need_no_field() -> None:
    geometry, surface = surface_of(SOLIDS["block"].make())
    wanted = Wanted(size=0.5)
    wish = wishes(geometry, surface, wanted)
    assert (wish.lengths == 0.5).all()
    assert sizing(geometry, wish, region_sizes(geometry, wanted)) == (0.5, None)


def test_lengths_beside_a_slender_model_are_no_longer_than_half_of_it() -> None:
    """The cube around a bar is mostly empty: lengths grew to more than the bar there."""
    bar = decomp.Block((0, 0, 0), (500, 1, 1), name="bar") - decomp.Cylinder(
        (250, 0.5, -1), (250, 0.5, 2), 0.2, name="hole"
    )
    geometry, surface = surface_of(bar)
    wanted = Wanted(size=1.0)
    wish = wishes(geometry, surface, wanted)
    first, field = sizing(geometry, wish, region_sizes(geometry, wanted))
    assert field is not None
    assert max(first, field.sizes.max()) <= 0.5 * geometry.diagonal


def test_edges_around_a_circle() -> None:
    geometry, surface = surface_of(SOLIDS["cylinder"].make())
    wish = wishes(geometry, surface, Wanted(size=0.5, per_circle=40))
    on_side = np.isclose(np.hypot(wish.points[:, 0], wish.points[:, 1]), 1, atol=0.05)
    assert wish.lengths[on_side].min() == pytest.approx(2 * np.pi / 40, rel=1e-9)
    assert wish.lengths.max() == 0.5


def test_by_default_curved_faces_keep_their_volume() -> None:
    geometry, surface = surface_of(SOLIDS["sphere"].make())
    wish = wishes(geometry, surface, Wanted())
    assert wish.lengths.min() < 0.12 * 2
    assert wish.lengths.max() <= geometry.diagonal / 20


def test_the_files_own_sizes() -> None:
    block = decomp.Block((0, 0, 0), (1, 1, 1))
    far = decomp.Block((5, 0, 0), (1, 1, 1))
    model = decomp.model(
        [decomp.Region("fine", block, {"maxh": 0.05}), decomp.Region("usual", far)]
    )
    sizes = region_sizes(decomp.Geometry(model), Wanted(size=0.2))
    assert sizes.tolist() == [0.05, 0.2]


def test_layers_count_across_walls_and_not_at_corners() -> None:
    geometry, surface = surface_of(decomp.Block((0, 0, 0), (8, 6, 1), name="plate"))
    assert least_thickness(geometry, surface, 0) == pytest.approx(1, rel=1e-4)
    wish = wishes(geometry, surface, Wanted(size=0.9, layers=4))
    assert wish.lengths.min() == pytest.approx(0.25, rel=1e-4)


def test_epsilon_is_taken_from_the_smallest_object() -> None:
    ball = decomp.Sphere((0.3, 0.2, 0.1), 1, name="ball")
    box = decomp.Block((-100, -100, -100), (200, 200, 200), name="box")
    geometry = decomp.Geometry({"ball": ball, "air": box - ball})
    sizes = region_sizes(geometry, Wanted())
    assert sizes[0] < 0.5
    assert sizes[1] > 10
    assert usual_tolerance(geometry, float(sizes.min())) < 0.02


def test_epsilon_fits_walls_and_gaps() -> None:
    geometry, surface = surface_of(SOLIDS["thin wall"].make())
    assert fitting_tolerance(geometry, surface, 0.05, 0.3) <= 0.15 * 0.01 * (1 + 1e-9)
    slit = decomp.Block((0, 0, 0), (4, 4, 4)) - decomp.Block((2, -1, 1), (0.04, 6, 5))
    geometry, surface = surface_of(slit)
    assert fitting_tolerance(geometry, surface, 0.05, 0.3) < 0.02
    geometry, surface = surface_of(SOLIDS["block"].make())
    assert fitting_tolerance(geometry, surface, 0.01, 0.3) == 0.01


@pytest.mark.parametrize("between", [0.3, 0.01, 1e-3])
def test_the_narrowest_place_between_balls_is_found(between: float) -> None:
    way = np.array([0.48, -0.6, 0.64])  # a unit vector that no sample lies on
    solid = decomp.Sphere((0, 0, 0), 1) - decomp.Sphere(tuple((0.6 - between) * way), 0.4)
    assert least_thickness(*surface_of(solid), 0) == pytest.approx(between, rel=0.02)


def test_walls_as_thick_as_edges_get_shorter_ones() -> None:
    solid = decomp.Sphere((0, 0, 0), 1) - decomp.Sphere((0, 0, 0), 0.9)
    geometry, surface = surface_of(solid)
    for size, least in ((0.2, 0.2), (0.11, 0.085), (0.1, 0.085), (0.08, 0.08)):
        found = wishes(geometry, surface, Wanted(size=size)).lengths
        assert found.min() == pytest.approx(least, rel=0.01)


def test_the_number_of_tetrahedra_is_known_before() -> None:
    block = decomp.Block((0, 0, 0), (4, 3, 2), name="block")
    geometry, surface = surface_of(block)
    wanted = Wanted(size=0.25)
    sizes = region_sizes(geometry, wanted)
    expected = expected_tets(geometry, wishes(geometry, surface, wanted), sizes)
    assert expected == pytest.approx(24 * 6 * 2**0.5 / 0.25**3, rel=0.01)
    assert expected / 2 < len(decomp.mesh(geometry, size=0.25).tets) < 2 * expected
