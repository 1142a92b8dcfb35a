"""Boolean algebra on membership, at random points away from all carriers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from decomp import similarity
from decomp.csg.halfspaces import half_space_form
from decomp.csg.model import model
from decomp.csg.solid import Solid
from decomp.vectors import Array
from tests.formats.membership import contains
from tests.laws.effort import examples
from tests.laws.strategies import directions, generic, points, trees

POINTS = np.random.default_rng(7).uniform(-2.5, 2.5, (400, 3))
CLEAR = 1e-9

ANY = st.one_of(trees(), trees(special=True))


def memberships(*solids: Solid) -> Array:
    """Membership (n, k) of clear points in each of k solids."""
    form = half_space_form(model({f"s{k}": s for k, s in enumerate(solids)}))
    clear = (np.abs(form.signed_distances(POINTS)) > CLEAR).all(axis=1)
    return np.asarray(form.regions_at(POINTS[clear]))


def same(first: Solid, second: Solid) -> None:
    found = memberships(first, second)
    assert len(found) > 200
    assert (found[:, 0] == found[:, 1]).all()


@examples(180)
@given(ANY)
def test_half_space_form_agrees_with_the_tree(a: Solid) -> None:
    form = half_space_form(model(a))
    clear = (np.abs(form.signed_distances(POINTS)) > CLEAR).all(axis=1)
    assert (form.regions_at(POINTS)[:, 0] == contains(a, POINTS))[clear].all()


@examples(90)
@given(ANY, ANY)
def test_de_morgan(a: Solid, b: Solid) -> None:
    same(~(a | b), ~a & ~b)
    same(~(a & b), ~a | ~b)


@examples(90)
@given(ANY)
def test_idempotence(a: Solid) -> None:
    same(a | a, a)
    same(a & a, a)
    assert not memberships(a - a).any()


@examples(90)
@given(ANY, ANY)
def test_commutativity(a: Solid, b: Solid) -> None:
    same(a | b, b | a)
    same(a & b, b & a)


@examples(90)
@given(ANY, ANY, ANY)
def test_associativity(a: Solid, b: Solid, c: Solid) -> None:
    same((a | b) | c, a | (b | c))
    same((a & b) & c, a & (b & c))


@examples(90)
@given(ANY, ANY, ANY)
def test_distributivity(a: Solid, b: Solid, c: Solid) -> None:
    same(a & (b | c), (a & b) | (a & c))
    same(a | (b & c), (a | b) & (a | c))


@examples(90)
@given(ANY, ANY)
def test_absorption(a: Solid, b: Solid) -> None:
    same(a | (a & b), a)
    same(a & (a | b), a)


@examples(90)
@given(ANY)
def test_double_complement(a: Solid) -> None:
    same(~~a, a)
    found = memberships(a, ~a)
    assert (found[:, 0] != found[:, 1]).all()


@examples(90)
@given(ANY, ANY)
def test_difference_is_and_not(a: Solid, b: Solid) -> None:
    same(a - b, a & ~b)


@examples(120)
@given(ANY, directions(False), generic(0, 360), points(generic(-1, 1)), generic(0.3, 3))
def test_similarities_carry_points_along(
    a: Solid, axis: Array, angle: float, offset: Array, factor: float
) -> None:
    by = similarity.translation(offset).after(
        similarity.rotation(axis, angle).after(
            similarity.reflection(axis).after(similarity.scaling(factor))
        )
    )
    image = a.scale(factor).mirror(axis).rotate(axis, angle).translate(offset)
    form, there = half_space_form(model(a)), half_space_form(model(image))
    clear = (np.abs(form.signed_distances(POINTS)) > CLEAR).all(axis=1)
    assert (form.regions_at(POINTS) == there.regions_at(by.points(POINTS)))[clear].all()


@examples(90)
@given(ANY, points(generic(-1, 1)), st.integers(1, 4))
def test_linear_copies_are_a_union(a: Solid, step: Array, count: int) -> None:
    plain = a
    for k in range(1, count):
        plain = plain | a.translate(k * np.array(step))
    same(a.linear_copies(step, count), plain)


@examples(90)
@given(ANY, directions(False), points(generic(-1, 1)), st.integers(1, 5))
def test_polar_copies_are_a_union(a: Solid, axis: Array, centre: Array, count: int) -> None:
    plain = a
    for k in range(1, count):
        plain = plain | a.rotate(axis, 360 * k / count, centre)
    same(a.polar_copies(axis, count, centre=centre), plain)


@pytest.mark.parametrize("special", [False, True])
def test_random_trees_are_neither_empty_nor_full(special: bool) -> None:
    """Else the laws would hold for nothing."""
    shares = []

    @examples(200)
    @given(trees(special))
    def collect(a: Solid) -> None:
        shares.append(memberships(a).mean())

    collect()
    assert np.mean([0.001 < share < 0.999 for share in shares]) > 0.5
