"""Solids with elliptic cylinders: exact areas and volumes, curves with every other carrier."""

from __future__ import annotations

from itertools import pairwise
from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipe

import decomp
from decomp import similarity
from decomp.csg.solid import Solid, Transformed
from decomp.errors import InputError

POST = decomp.EllipticCylinder((0, 0, 0), (0, 0, 5), (3, 0, 0), 2, name="post")
AROUND = 4 * 3 * ellipe(1 - 4 / 9)
"""Length of the ellipse with semi-axes 3 and 2."""


def region(solid: Solid) -> decomp.RegionBoundary:
    return decomp.Geometry(solid).regions[0]


@pytest.mark.parametrize(
    "move",
    [
        similarity.translation((0, 0, 0)),
        similarity.rotation((1, 2, 3), 77, (5, 1, -2)),
        similarity.reflection((1, 1, 0), (1, 2, 3)),
        similarity.translation((1e6, -2e6, 3e6)),
    ],
    ids=["as it is", "turned", "mirrored", "far"],
)
def test_a_post(move: similarity.Similarity) -> None:
    found = region(Transformed(POST, move))
    assert found.volume == pytest.approx(30 * pi, rel=1e-14)
    assert found.area == pytest.approx(5 * AROUND + 12 * pi, rel=1e-14)
    assert abs(found.volume - 30 * pi) <= found.volume_error
    assert [found.carriers[f.carrier].kind for f in found.faces] == [
        "elliptic cylinder",
        "plane",
        "plane",
    ]
    assert sorted(edge.curve.kind for edge in found.edges) == ["ellipse", "ellipse"]
    assert found.euler == 1


def test_its_box_is_exact() -> None:
    turned = POST.rotate((0, 0, 1), 30)
    wide, deep = sqrt(9 * 0.75 + 4 * 0.25), sqrt(9 * 0.25 + 4 * 0.75)
    assert region(turned).bounds == pytest.approx(
        np.array([[-wide, -deep, 0], [wide, deep, 5]]), abs=1e-14
    )


def test_a_slanted_cut() -> None:
    # the mean height over the ellipse is that above its centre
    cut = POST & decomp.HalfSpace((0, 0, 3), (0.2, 0.3, 1))
    assert region(cut).volume == pytest.approx(18 * pi, rel=1e-13)


def test_cut_along_its_axis() -> None:
    cut = region(POST & decomp.HalfSpace((1, 0, 0), (1, 0, 0)))
    # of the ellipse left of x = 1: that of the unit circle left of 1/3, times 6
    part = pi - np.arccos(1 / 3) + sqrt(8) / 9
    assert cut.volume == pytest.approx(5 * 6 * part, rel=1e-13)
    assert len(cut.edges) == 6
    assert len(cut.vertices) == 4


def test_a_plate_with_an_elliptic_bore() -> None:
    bore = decomp.InfiniteEllipticCylinder((15, 15, 0), (6, 3, 0), (-1.5, 3, 0), name="bore")
    plate = decomp.Block((0, 0, 0), (40, 30, 5), name="plate") - bore
    found = decomp.Geometry(plate)
    a, b = sqrt(45), sqrt(11.25)
    assert found.regions[0].volume == pytest.approx(6000 - 5 * pi * a * b, rel=1e-13)
    sides = {face.name: face.area for face in found.regions[0].faces}
    assert sides["bore.side"] == pytest.approx(5 * 4 * a * ellipe(1 - (b / a) ** 2), rel=1e-13)
    assert found.regions[0].euler == 0
    # from beside the end of the major axis, by (6, 3) from the centre
    near = found.nearest([(15 + 6.2, 15 + 3.1, 2.5), (15, 15, 2.5)])
    assert [found.sites[k].name for k in near.site] == ["bore.side"] * 2
    assert near.distance == pytest.approx([sqrt(0.05), b], rel=1e-12)
    assert near.foot[0] == pytest.approx([21, 18, 2.5], abs=1e-12)


def test_common_part_with_a_ball_by_quadrature() -> None:
    tube = decomp.InfiniteEllipticCylinder((0, 0, 0), (1.5, 0, 0), (0, 0.8, 0))
    common = region(tube & decomp.Sphere((0.4, 0.2, 0), 1.2))

    def strip(x: float) -> float:
        """The integral over y of the ball's height inside the ellipse, in closed form."""
        r2 = max(1.44 - (x - 0.4) ** 2, 0.0)
        end = 0.8 * sqrt(max(1 - (x / 1.5) ** 2, 0.0))
        low, high = max(-end - 0.2, -sqrt(r2)), min(end - 0.2, sqrt(r2))
        if high <= low:
            return 0.0
        return sum(
            s * (t * sqrt(max(r2 - t * t, 0.0)) + r2 * np.arcsin(np.clip(t / sqrt(r2), -1, 1)))
            for s, t in ((1, high), (-1, low))
        )

    kinks = np.linspace(-0.8, 1.5, 200)
    exact = sum(quad(strip, a, b, epsabs=1e-13)[0] for a, b in pairwise(kinks))
    assert common.volume == pytest.approx(exact, rel=1e-8)


OTHERS = {
    "sphere": decomp.Sphere((1, 1, 1), 1.1),
    "torus": decomp.Torus((0.5, 1, 1.5), (1, 0, 3), 2, 0.5),
    "cylinder": decomp.Cylinder((-3, 0, 1), (4, 2, 2), 0.6),
    "cone": decomp.Cone((-3, 0, 1), 1, (4, 2, 2)),
    "elliptic": decomp.EllipticCylinder((-3, 0, 1), (4, 2, 2), (-0.2, 0.7, 0), 0.4),
    "parallel": decomp.EllipticCylinder((1, 0, -1), (2, 2, 2), (2, -1, 0), 0.5),
    "parallel round": decomp.Cylinder((1, 0, -1), (2, 2, 2), 0.9),
}


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS)
def test_parts_add_up_and_agree_with_samples(other: Solid) -> None:
    post = decomp.EllipticCylinder((0, 0, 0), (1, 2, 3), (2, -1, 0), 1.2, name="post")
    common, less = region(post & other), region(post - other)
    assert common.volume + less.volume == pytest.approx(region(post).volume, rel=1e-12)
    form = decomp.Geometry(post - other).boundaries.form
    low, high = less.bounds
    points = low + (high - low) * np.random.default_rng(0).random((100_000, 3))
    share = form.regions_at(points)[:, 0].mean()
    error = sqrt(share * (1 - share) / len(points))
    assert less.volume / np.prod(high - low) == pytest.approx(share, abs=4 * error)


def test_a_ball_as_wide_as_the_major_axis_cuts_in_two_circles() -> None:
    # the sphere about the axis meets the cylinder where z = +- y sqrt(a^2 - b^2) / b
    ball = decomp.Sphere((0, 0, 0), 1.5)
    tube = decomp.InfiniteEllipticCylinder((0, 0, 0), (1.5, 0, 0), (0, 0.9, 0))
    common = region(ball & tube)

    # z up to sqrt(2.25 - x^2 - y^2) over the ellipse
    def strip(x: float) -> float:
        r2, end = 2.25 - x * x, 0.6 * sqrt(2.25 - x * x)
        return 2 * (end * sqrt(r2 - end * end) + r2 * np.arcsin(end / sqrt(r2)))

    assert common.volume == pytest.approx(quad(strip, -1.5, 1.5, epsabs=1e-12)[0], rel=1e-9)


def test_equal_semi_axes_are_a_cylinder() -> None:
    rod = decomp.EllipticCylinder((0, 0, 0), (0, 0, 5), (1.2, 1.6, 0), 2)
    assert [region(rod).carriers[0].kind, region(rod).volume] == [
        "cylinder",
        pytest.approx(20 * pi, rel=1e-14),
    ]
    whole = region(rod | decomp.Cylinder((0, 0, 3), (0, 0, 8), 2))
    assert whole.volume == pytest.approx(32 * pi, rel=1e-14)
    assert len(whole.faces) == 3


def test_coincident_sides_are_one() -> None:
    other = decomp.EllipticCylinder((0, 0, 5), (0, 0, 7), (0, 2, 0), 3)
    whole = region(POST | other)
    assert whole.volume == pytest.approx(42 * pi, rel=1e-14)
    assert len(whole.faces) == 3


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: decomp.EllipticCylinder((0, 0, 0), (0, 0, 5), (3, 0, 1), 2),
            r"first semi-axis \(3, 0, 1\) must be at right angles to the axis, but the angle is 71",
        ),
        (
            lambda: decomp.InfiniteEllipticCylinder((0, 0, 0), (3, 0, 1), (3, 1, 0)),
            r"must be at right angles to the other, \(3, 1, 0\), but the angle is 25",
        ),
        (
            lambda: decomp.EllipticCylinder((0, 0, 0), (0, 0, 0), (3, 0, 0), 2),
            "axis .* must not be the zero vector",
        ),
        (
            lambda: decomp.EllipticCylinder((0, 0, 0), (0, 0, 1), (0, 0, 0), 2),
            "first semi-axis must not be the zero vector",
        ),
        (
            lambda: decomp.EllipticCylinder((0, 0, 0), (0, 0, 1), (1, 0, 0), -2),
            "second semi-axis must be positive, got -2",
        ),
        (
            lambda: decomp.InfiniteEllipticCylinder((0, 0, 0), (1, 0, 0), (0, 0, 0)),
            "second semi-axis must not be the zero vector",
        ),
        (
            lambda: decomp.InfiniteEllipticCylinder((0, 0, 0), (1, 0, 0), (0, float("nan"), 0)),
            "must be finite",
        ),
    ],
)
def test_bad_axes_are_refused(make: object, message: str) -> None:
    assert callable(make)
    with pytest.raises(InputError, match=message):
        make()


def test_unbounded_ones_are_told_of() -> None:
    with pytest.raises(decomp.GeometryError, match="is unbounded: it reaches infinity"):
        decomp.Geometry(decomp.InfiniteEllipticCylinder((0, 0, 0), (1, 0, 0), (0, 2, 0)))
