"""Solids far from the origin are placed about a point near them, with every difference exact."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp import similarity
from decomp.carriers.base import ROW
from decomp.csg.placing import AT_ORIGIN, Placing, placing_of
from decomp.exact import careful_difference, difference
from decomp.similarity import Similarity
from decomp.vectors import Array, frozen

FAR = np.array([1e6, -3e6, 2e5])
Z = (0, 0, 1)


def bounds(solid: decomp.Solid) -> tuple[Array, Array]:
    """Where computing has its origin, and the box from there."""
    local = decomp.Geometry(solid).local.boundaries
    return local.offset, local.box


def test_a_difference_is_that_of_the_decimals() -> None:
    a, b = np.array([1000000.1, 0.3, 5.0]), np.array([1e6, 0.1, 5.0])
    assert difference(a, b).tolist() == [0.1, 0.2, 0.0]
    assert (a - b)[0] != 0.1
    # where nothing is lost the plain difference stays
    assert careful_difference(a, b).tolist() == [0.1, 0.3 - 0.1, 0.0]


@pytest.mark.parametrize("away", [0.0, 1.0, 7.0])
def test_models_near_the_origin_stay_there(away: float) -> None:
    block = decomp.Block((away * np.sqrt(3), 0, 0), (1, 1, 1))
    geometry = decomp.Geometry(block)
    assert geometry.local is geometry
    assert geometry.offset.tolist() == [0, 0, 0]
    assert placing_of(*geometry.regions[0].bounds) is AT_ORIGIN


def test_centres_have_few_digits() -> None:
    found = placing_of(FAR + 0.123, FAR + np.array([0.423, 0.223, 0.323]))
    assert found.grid == 0.25
    assert (found.offset % found.grid == 0).all()
    assert np.abs(found.offset - FAR).max() < 0.5


def test_numbers_in_far_primitives_are_taken_as_written() -> None:
    x = 1000000.1
    part = decomp.Block((x, -3e6, 0), (0.2, 0.5, 1)) - decomp.Cylinder(
        (1000000.2, -2999999.75, -1), (1000000.2, -2999999.75, 2), 0.05
    )
    offset, box = bounds(part)
    assert (box[0] + offset).tolist() == [x, -3e6, 0]
    # as if it had been drawn here: 0.1 is 0.1, and not what is left of 1000000.1
    assert (box - [1000000 - offset[0], -3e6 - offset[1], 0]).tolist() == [
        [0.1, 0, 0],
        pytest.approx([0.3, 0.5, 1], abs=2e-16),
    ]


@pytest.mark.parametrize(
    "there",
    [
        lambda solid: solid.translate(FAR),
        lambda solid: solid.translate(FAR / 3).translate(2 * FAR / 3),
        lambda solid: solid.rotate(Z, 180).translate(FAR * (-1, -1, 1)).rotate(Z, 180),
        lambda solid: solid.scale(0.1).translate(FAR / 10).scale(10),
        lambda solid: (
            solid.translate(FAR)
            .rotate((1, 2, 3), 90, centre=FAR + 0.1)
            .rotate((1, 2, 3), -90, centre=FAR + 0.1)
        ),
        lambda solid: solid.translate(FAR).scale(7, centre=FAR).scale(1 / 7, centre=FAR),
        lambda solid: solid.translate(FAR).mirror((1, 1, 0), FAR).mirror((1, 1, 0), FAR),
    ],
    ids=["one", "two", "turns", "scaled", "turned", "scaled there", "mirrored there"],
)
def test_moves_do_not_round(there: object) -> None:
    """The lengths of a part that comes to the same place by several moves are the same."""
    part = decomp.Block((0.1, 0.2, 0.3), (1, 2, 3)) | decomp.Sphere((0.4, 0.5, 3.3), 0.7)
    assert callable(there)
    offset, box = bounds(there(part))
    assert np.abs(offset - FAR).max() < 8
    plain = decomp.Geometry(part).regions[0].bounds
    moved = box + (offset - FAR)
    # moves of the whole are rounded once; what is in it, not at all
    assert (moved[1] - moved[0]) == pytest.approx(plain[1] - plain[0], abs=4e-15)
    assert moved == pytest.approx(plain, abs=2e-9)


def test_copies_about_a_far_centre_fit_together() -> None:
    """A ring of holes about a bore a million away is the one about the origin."""

    def flange(x: float) -> decomp.Solid:
        disc = decomp.Cylinder((x, 0, 0), (x, 0, 2), 5, name="disc")
        hole = decomp.Cylinder((x + 3.5, 0, -1), (x + 3.5, 0, 3), 0.4, name="hole")
        return disc - hole.polar_copies((0, 0, 1), 7, centre=(x, 0, 0))

    here, there = (decomp.Geometry(flange(x)).local.boundaries for x in (0.0, 1e6))
    carriers = zip(here.form.carriers, there.form.carriers, strict=True)
    for one, other in carriers:
        step = np.append(there.offset - [1e6, 0, 0], np.zeros(ROW - 3))
        assert other.packed() + step == pytest.approx(one.packed(), abs=3e-15)


def test_a_cone_through_far_points() -> None:
    cone = decomp.InfiniteCone.through((1000000.1, 0, 0), 1, (1000000.4, 0, 0), 1.3)
    solid = cone & decomp.Block((1000000.1, -5, -5), (0.3, 10, 10))
    _, box = bounds(solid)
    assert box[1] - box[0] == pytest.approx([0.3, 2.6, 2.6], abs=2e-15)


def test_placing_follows_similarities() -> None:
    """With moves that can be computed in floating point too, it gives the same points."""
    turn = similarity.rotation((1, -2, 0.5), 33, (4, 5, 6))
    steps = [turn, similarity.scaling(3, (1, 1, 0)), similarity.translation((300, 20, 7))]
    plain = steps[2].after(steps[1]).after(steps[0])
    start = Placing(similarity.IDENTITY, frozen(np.array([304.0, 24, 12])), 4.0)
    placing = start.after(steps[2]).after(steps[1]).after(steps[0])
    assert placing.pivot is not None
    points = np.random.default_rng(1).uniform(-2, 2, (20, 3))
    expected = plain.points(points) - start.offset
    assert placing.by.points(points - placing.pivot) == pytest.approx(expected, abs=1e-12)


def test_a_fixed_point_is_one() -> None:
    centre = np.array([1e7, 3.0, -2.0])
    for by in (
        similarity.rotation((1, 1, 2), 50, centre),
        similarity.scaling(0.3, centre),
        similarity.reflection((1, 1, 2), centre),
    ):
        assert isinstance(by, Similarity)
        assert by.fixed is not None
        assert by.fixed.tolist() == centre.tolist()
        assert by.points(centre) == pytest.approx(centre, abs=1e-8)
        assert by.after(by).fixed is None
