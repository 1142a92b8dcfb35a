"""Nearest sites on the shared table of solids and on models with several regions."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest
from hypothesis import given, reject, settings
from scipy.spatial import cKDTree

import decomp
from decomp.csg.primitives import Block, Cone, Cylinder, Sphere
from decomp.csg.solid import Solid
from decomp.errors import GeometryError, InputError
from decomp.geometry import Geometry
from decomp.similarity import rotation
from decomp.sites import SiteKind
from decomp.vectors import Array, norm
from tests.sites.random_solids import solids
from tests.sites.reference import boundary_samples, labels, nearest_distance
from tests.solids import SOLIDS


def plates() -> dict[str, Solid]:
    """Two regions that touch, one with a ball inside."""
    ball = Sphere((1, 1, 0.5), 0.3, name="ball")
    lower = Block((0, 0, 0), (2, 2, 1), name="lower")
    upper = Cylinder((1, 1, 1), (1, 1, 2), 0.6, name="upper")
    return {"lower": lower - ball, "ball": ball, "upper": upper}


@cache
def geometry(name: str) -> Geometry:
    return decomp.Geometry(plates() if name == "plates" else SOLIDS[name].make())


def cloud(part: Geometry, count: int, seed: int = 0, margin: float = 0.3) -> Array:
    low = np.min([r.bounds[0] for r in part.regions], axis=0)
    high = np.max([r.bounds[1] for r in part.regions], axis=0)
    pad = margin * (high - low).max()
    return np.random.default_rng(seed).uniform(low - pad, high + pad, (count, 3))


NAMES = [*SOLIDS, "plates"]


@pytest.mark.parametrize("name", NAMES)
def test_nearest_equals_brute_force(name: str) -> None:
    part = geometry(name)
    form, size = part.boundaries.form, part.diagonal
    points = cloud(part, 500)
    found = part.nearest(points)
    np.testing.assert_array_equal(found.region, labels(form, points))
    np.testing.assert_allclose(norm(points - found.foot), found.distance, atol=1e-12 * size)
    rng = np.random.default_rng(1)
    for label in range(-1, len(part.regions)):
        mine = np.flatnonzero(found.region == label)
        if not len(mine):
            continue
        boundary = part.index.boundary(label)
        slow = nearest_distance(form, boundary, label, points[mine])
        np.testing.assert_allclose(found.distance[mine], slow, atol=1e-10 * size)
        samples = boundary_samples(form, label, boundary.bounds, 1000, rng)
        assert (cKDTree(samples).query(points[mine])[0] >= found.distance[mine] - 1e-11).all()


@settings(max_examples=15, deadline=None)
@given(solids)
def test_nearest_equals_brute_force_on_random_solids(solid: Solid) -> None:
    try:
        part = decomp.Geometry(solid)
    except GeometryError:  # empty, or touches itself
        reject()
    form = part.boundaries.form
    points = cloud(part, 200)
    found = part.nearest(points)
    np.testing.assert_array_equal(found.region, labels(form, points))
    for label in (-1, 0):
        mine = found.region == label
        slow = nearest_distance(form, part.index.boundary(label), label, points[mine])
        np.testing.assert_allclose(found.distance[mine], slow, atol=1e-9 * part.diagonal)


@pytest.mark.parametrize("name", NAMES)
def test_the_site_holds_the_foot(name: str) -> None:
    part = geometry(name)
    points = cloud(part, 1000, 2)
    found = part.nearest(points)
    tolerance = 1e-9 * part.diagonal
    for number in np.unique(found.site):
        mine = np.flatnonzero(found.site == number)
        site, feet = part.sites[number], found.foot[mine]
        assert (found.region[mine] == site.region).all()
        boundary = part.index.boundary(site.region)
        if site.kind is SiteKind.FACE:
            face = boundary.faces[site.index]
            assert site.name == face.name
            gaps = np.abs(boundary.carriers[face.carrier].signed_distance(feet))
            there = part.boundaries.face_at(site.region, face.carrier, feet)
            assert (there == site.index).all()
        elif site.kind is SiteKind.EDGE:
            edge = boundary.edges[site.index]
            a, b = (boundary.carriers[c] for c in edge.carriers)
            gaps = np.maximum(np.abs(a.signed_distance(feet)), np.abs(b.signed_distance(feet)))
        else:
            gaps = norm(feet - boundary.vertices[site.index].point)
        assert gaps.max() <= tolerance


@pytest.mark.parametrize("name", NAMES)
def test_feet_are_on_the_boundary(name: str) -> None:
    part = geometry(name)
    points = cloud(part, 1000, 3)
    feet = part.nearest(points).foot
    assert np.abs(part.distance(feet)).max() <= 1e-11 * part.diagonal


@pytest.mark.parametrize("name", NAMES)
def test_distance_is_lipschitz(name: str) -> None:
    part = geometry(name)
    points = cloud(part, 1000, 4)
    steps = np.random.default_rng(5).normal(size=points.shape) * 0.05 * part.diagonal
    change = np.abs(part.distance(points + steps) - part.distance(points))
    if len(part.regions) > 1:  # inside both sides of an interface the sign is negative
        change = np.abs(np.abs(part.distance(points + steps)) - np.abs(part.distance(points)))
    assert (change <= norm(steps) + 1e-11 * part.diagonal).all()


@pytest.mark.parametrize("name", ["through hole", "bracket", "fichera", "plates"])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_covariant_under_similarities(name: str, scale: float) -> None:
    part = geometry(name)
    turn = rotation((1, 2, 3), 37.0, (0.3, 0.1, 0.2))
    regions = {
        region.name: region.solid.rotate((1, 2, 3), 37.0, (0.3, 0.1, 0.2)).scale(scale)
        for region in part.model.regions
    }
    moved = decomp.Geometry(regions)
    points = cloud(part, 1000, 6)
    a, b = part.nearest(points), moved.nearest(scale * turn.points(points))
    tolerance = 1e-10 * part.diagonal
    np.testing.assert_array_equal(a.region, b.region)
    np.testing.assert_allclose(b.distance / scale, a.distance, atol=tolerance)
    clear = a.distance > 0  # feet may differ where two are equally near: almost nowhere
    gaps = norm(turn.points(a.foot) - b.foot / scale)[clear]
    assert (gaps > tolerance).mean() < 0.01


@pytest.mark.parametrize("name", ["through hole", "plates", "fichera"])
def test_far_away(name: str) -> None:
    part = geometry(name)
    away = np.random.default_rng(7).normal(size=(300, 3))
    away *= 1e3 * part.diagonal / norm(away)[:, None]
    found = part.nearest(away)
    assert (found.region == -1).all()
    slow = nearest_distance(part.boundaries.form, part.index.boundary(-1), -1, away)
    np.testing.assert_allclose(found.distance, slow, rtol=1e-9)
    np.testing.assert_array_equal(part.distance(away) > 0, True)


def test_ties_go_to_faces_then_edges() -> None:
    part = geometry("bracket")
    (edge,) = [s for s in part.sites if s.region == 0 and s.kind is SiteKind.EDGE]
    assert "|" in edge.name
    # the reentrant edge is x = 1, y = 1; straight below it the foot of the face is on the edge
    found = part.nearest([[0.9, 0.999999999999999999, 1.0], [0.95, 0.95, 1.0], [0.95, 1.0, 1.0]])
    kinds = [part.sites[k].kind for k in found.site]
    assert kinds == [SiteKind.FACE, SiteKind.EDGE, SiteKind.FACE]


def test_a_reentrant_vertex_wins_beyond_its_edges() -> None:
    part = geometry("fichera")
    found = part.nearest([[-0.1, -0.1, -0.1], [-0.1, -0.1, 0.1], [-0.1, 0.1, 0.1]])
    kinds = [part.sites[k].kind for k in found.site]
    assert kinds == [SiteKind.VERTEX, SiteKind.EDGE, SiteKind.FACE]
    np.testing.assert_allclose(found.distance, 0.1 * np.sqrt([3.0, 2, 1]), rtol=1e-14)


def test_points_on_a_skew_axis() -> None:
    base, along = np.array([0.3, -0.2, 0.1]), np.array([1.0, 2, 2])
    part = decomp.Geometry(Cylinder(base, base + 2 * along, 0.7, name="bar"))
    points = base + np.outer([0.5, 0.7, 1.1, 1.3], along)
    found = part.nearest(points)
    np.testing.assert_allclose(found.distance, 0.7, rtol=1e-14)
    np.testing.assert_allclose(norm(points - found.foot), 0.7, rtol=1e-14)
    assert {part.sites[k].name for k in found.site} == {"bar.side"}


def test_one_point_and_none() -> None:
    part = geometry("bracket")
    assert part.nearest([[0.5, 0.5, 1.0]]).foot.shape == (1, 3)
    for nothing in ([], np.empty((0, 3))):
        found = part.nearest(nothing)
        assert found.site.shape == found.distance.shape == (0,)
        assert found.foot.shape == (0, 3)
        assert part.contains(nothing).shape == (0,)
        assert part.distance(nothing).shape == (0,)


@pytest.mark.parametrize(
    "points",
    [
        [[0.0, 0.0, np.nan]],
        [[0.0, 0.0, np.inf]],
        [0.0, 0.0, 0.0],
        [[0.0, 0.0]],
        np.zeros((2, 2, 3)),
        [["a", "b", "c"]],
        None,
        5.0,
    ],
)
def test_bad_points_are_refused(points: object) -> None:
    part = geometry("bracket")
    for query in (part.nearest, part.distance, part.contains, part.region_of):
        with pytest.raises(InputError, match="points must be"):
            query(points)


def test_integers_and_strided_arrays_are_taken() -> None:
    part = geometry("bracket")
    points = np.array([[0, 1, 1], [5, 1, 1], [0, 3, 1]], dtype=np.int64)
    wide = np.repeat(points.astype(float), 2, axis=1)[:, ::2]
    np.testing.assert_array_equal(part.distance(points), part.distance(wide))


def test_points_are_left_alone() -> None:
    part = geometry("bracket")
    points = cloud(part, 100)
    points.setflags(write=False)
    assert part.nearest(points).foot.shape == (100, 3)


def test_threads_do_not_disturb_each_other() -> None:
    part = geometry("plates")
    clouds = [cloud(part, 20_000, seed) for seed in range(8)]
    alone = [part.nearest(points) for points in clouds]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(part.nearest, clouds))
    for a, b in zip(alone, together, strict=True):
        np.testing.assert_array_equal(a.site, b.site)
        np.testing.assert_array_equal(a.foot, b.foot)


@pytest.mark.parametrize("name", ["cone in a wall", "cone beside a wall"])
def test_feet_of_points_about_which_an_edge_is_bent_most(name: str) -> None:
    """Points of a cone's axis are as near to a hyperbola's two arms as to the cone.

    The apex between them is a sample of the edge in one of the models and between two in the other.
    """
    reach = {"cone in a wall": 5.0, "cone beside a wall": 4.83}[name]
    cone = Cone((4.5, -0.1, 1.2), 0.8, (4.5, 2.9, 1.2), 0.3, name="cone")
    part = decomp.Geometry(Block((0, 0, 0), (reach, 4, 2.4), name="block") | cone)
    slope = 0.5 / 3
    apex_side = 0.8 / slope - 0.1
    sine = slope / np.hypot(1, slope)
    nearest = (reach - 4.5) / slope  # of the hyperbola's apex, along the axis from the cone's
    along = nearest * (1 + slope**2) * (1 + np.geomspace(1e-7, 0.05, 60))
    points = np.stack([np.full(60, 4.5), apex_side - along, np.full(60, 1.2)], axis=1)
    found = part.nearest(points)
    np.testing.assert_allclose(found.distance, along * sine, rtol=0, atol=1e-13 * part.diagonal)
