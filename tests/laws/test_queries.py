"""Laws on nearest-site queries of random models."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import currently_in_test_context, given, note, reject
from hypothesis import strategies as st

import decomp
from decomp import similarity
from decomp.csg.primitives import Block
from decomp.csg.solid import Solid
from decomp.errors import ContactError, EmptyRegionError
from decomp.vectors import Array, norm
from tests.laws.effort import examples
from tests.laws.strategies import directions, generic, points, solids, text
from tests.solids import SOLIDS

ANY = st.one_of(solids(leaves=3), solids(special=True, leaves=3))
STEP = 1e-7
SOME = ("bracket", "conical pit", "torus cut in one oval", "fichera")


def geometry(source: Solid | dict[str, Solid]) -> decomp.Geometry:
    """Queries on a model; the example is dropped if it is empty or touches itself."""
    if currently_in_test_context():
        note(str(text(source) if isinstance(source, Solid) else [*map(text, source.values())]))
    try:
        return decomp.Geometry(source)
    except (EmptyRegionError, ContactError):
        reject()


def around(g: decomp.Geometry, count: int, seed: int = 1) -> Array:
    """Random points in and around a model."""
    low = np.min([r.bounds[0] for r in g.regions], axis=0)
    high = np.max([r.bounds[1] for r in g.regions], axis=0)
    margin = 0.2 * (high - low)
    return np.random.default_rng(seed).uniform(low - margin, high + margin, (count, 3))


def boundary_samples(g: decomp.Geometry, count: int, seed: int = 2) -> Array:
    """Random points moved to each carrier, kept where a step across it enters or leaves."""
    form, step = g.boundaries.form, STEP * g.diagonal
    found = []
    for carrier in form.carriers:
        feet = carrier.project(around(g, count, seed))
        normal = step * carrier.normal(feet)
        crossed = form.regions_at(feet + normal) != form.regions_at(feet - normal)
        away = np.abs(form.signed_distances(feet))
        clear = (away > 3 * step).sum(axis=1) == len(form.carriers) - 1
        found.append(feet[crossed.any(axis=1) & clear])
    return np.concatenate(found)


@examples(3)
@given(ANY)
def test_distance_is_1_lipschitz(a: Solid) -> None:
    g = geometry(a)
    p = around(g, 3000)
    steps = np.random.default_rng(3).normal(size=p.shape) * g.diagonal
    for size in (1e-6, 1e-3, 0.1):
        q = p + size * steps
        change = np.abs(g.distance(p) - g.distance(q))
        assert (change <= norm(p - q) + 1e-9 * g.diagonal).all()


@examples(3)
@given(ANY)
def test_distance_is_zero_on_the_boundary(a: Solid) -> None:
    g = geometry(a)
    samples = boundary_samples(g, 500)
    assert len(samples)
    assert np.abs(g.distance(samples)).max() <= 1e-9 * g.diagonal


@examples(3)
@given(ANY)
def test_sign_of_distance_agrees_with_membership(a: Solid) -> None:
    g = geometry(a)
    p = around(g, 5000)
    clear = (np.abs(g.boundaries.form.signed_distances(p)) > 1e-9).all(axis=1)
    inside = g.boundaries.form.regions_at(p)[:, 0]
    assert (g.contains(p) == inside)[clear].all()
    assert ((g.distance(p) < 0) == inside)[clear].all()


@examples(3)
@given(ANY)
def test_distance_is_the_least_to_many_boundary_samples(a: Solid) -> None:
    """Never above it, and below it by no more than the gaps between samples."""
    from scipy.spatial import cKDTree

    g = geometry(a)
    count = 100_000 // len(g.boundaries.form.carriers)
    samples = boundary_samples(g, count)
    tree = cKDTree(samples)
    p = around(g, 1000)
    found = g.nearest(p)
    least, _ = tree.query(p)
    assert (found.distance <= least + 1e-9 * g.diagonal).all()
    gaps, _ = tree.query(found.foot)
    assert (least <= found.distance + gaps + 1e-9 * g.diagonal).all()
    # the feet are on the boundary, so samples are near them
    assert np.quantile(gaps, 0.99) < 0.1 * g.diagonal


@examples(3)
@given(ANY)
def test_feet_lie_at_their_distance_on_the_boundary(a: Solid) -> None:
    g = geometry(a)
    p = around(g, 2000)
    found = g.nearest(p)
    assert np.allclose(norm(p - found.foot), found.distance, atol=1e-9 * g.diagonal)
    assert np.abs(g.distance(found.foot)).max() <= 1e-9 * g.diagonal


@examples(3)
@given(ANY, directions(False), generic(0, 360), points(generic(-1, 1)), generic(0.3, 3))
def test_similarities_carry_the_nearest_site_along(
    a: Solid, axis: Array, angle: float, offset: Array, factor: float
) -> None:
    by = similarity.translation(offset).after(
        similarity.rotation(axis, angle).after(
            similarity.reflection((1, 2, -2)).after(similarity.scaling(factor))
        )
    )
    g = geometry(a)
    image = geometry(a.scale(factor).mirror((1, 2, -2)).rotate(axis, angle).translate(offset))
    p = around(g, 1000)
    here, there = g.nearest(p), image.nearest(by.points(p))
    assert np.allclose(there.distance, factor * here.distance, atol=1e-9 * image.diagonal)
    # where two sites are equally near, either may be given
    unique = norm(by.points(here.foot) - there.foot) < 1e-6 * image.diagonal
    assert unique.mean() > 0.98
    names = [
        [frozenset(x.sites[k].name.split("|")) for k in n.site]
        for x, n in ((g, here), (image, there))
    ]
    same = np.array([u == v for u, v in zip(*names, strict=True)])
    assert same[unique].mean() > 0.98


@examples(3)
@given(ANY)
def test_of_several_regions_the_nearest_site_is_of_ones_own(a: Solid) -> None:
    cast = geometry(a).regions[0]
    low, high = cast.bounds + 0.21 * cast.diagonal * np.array([[-1], [1]])
    g = geometry({"cast": a, "mould": Block.between(low, high) - a})
    p = around(g, 2000)
    clear = (np.abs(g.boundaries.form.signed_distances(p)) > 1e-9).all(axis=1)
    held = g.boundaries.form.regions_at(p)
    own = np.where(held.any(axis=1), held.argmax(axis=1), -1)
    found = g.nearest(p)
    assert (found.region == own)[clear].all()
    owners = np.array([s.region for s in g.sites])[found.site]
    assert (owners == own)[clear].all()
    # inside the cast it is the cast alone that matters
    alone = geometry(a)
    inside = clear & (own == 0)
    assert np.allclose(alone.distance(p[inside]), -found.distance[inside], atol=1e-9 * g.diagonal)


@pytest.mark.parametrize("name", SOME)
def test_laws_hold_on_the_shared_solids(name: str) -> None:
    for law in (
        test_distance_is_1_lipschitz,
        test_distance_is_zero_on_the_boundary,
        test_sign_of_distance_agrees_with_membership,
        test_distance_is_the_least_to_many_boundary_samples,
        test_feet_lie_at_their_distance_on_the_boundary,
        test_of_several_regions_the_nearest_site_is_of_ones_own,
    ):
        law.hypothesis.inner_test(SOLIDS[name].make())
