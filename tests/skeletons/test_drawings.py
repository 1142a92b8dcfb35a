"""Where sheets and curves are drawn: about a ball's centre, at vertices, around a node."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import decomp
from decomp.complex.model import LineKind
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.curve_elements import RayCurve
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.leaving_together import matched
from decomp.skeletons.curves.pieces import CurvePiece, network
from decomp.skeletons.sheets.about_centre import about_centre
from decomp.skeletons.sheets.sheet_family import SheetFamily
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.vectors import Array, norm


class Drawn:
    """A curve that places points half as far from the origin, as beside a locus it can."""

    def place(self, points: Array) -> Array:
        return np.asarray(points / 2)


def test_points_about_a_balls_centre_are_told_apart() -> None:
    """The normal from a vertex to the centre has one foot, and the centre has all of an edge."""
    block = decomp.Block((-2, -2, -2), (4, 4, 2.5))
    boundary = decomp.Geometry(block | decomp.Sphere((0, 0, 0), 1)).regions[0]
    (edge,) = (e for e in boundary.edges if e.convexity.name == "REENTRANT")
    turns = np.linspace(0, 1, 9)[:-1] * 2 * np.pi
    circle = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1) * np.sqrt(0.75)
    feet = np.concatenate([circle, circle, circle[:1]]) + np.array([0, 0, 0.5])
    points = np.concatenate([0.5 * feet[:8], 0.1 * feet[8:16], np.zeros((1, 3))])
    uv = about_centre(boundary, edge, points, feet, 1e-9)
    assert uv is not None
    assert norm(uv) == pytest.approx([0.5] * 8 + [0.1] * 8 + [0.0], abs=1e-12)
    apart = norm(uv[:, None] - uv[None])[np.triu_indices(len(uv), 1)]
    assert apart.min() > 0.07
    # not if the centre is none of the points
    assert about_centre(boundary, edge, points[:-1], feet[:-1], 1e-9) is None


@pytest.mark.parametrize("rounding", [0.0, 1e-16, 3e-16])
def test_a_vertex_has_no_direction_from_its_edges(rounding: float) -> None:
    """Sheets between two edges that meet turn by their other points there."""
    post = decomp.Block((-1, 1, -3), (1.25, 2, 5), name="post")
    geometry = decomp.Geometry(decomp.Block((0, 0, 0), (4, 4, 4), name="base") | post)
    incidence = Incidence(RegionContext(geometry.index, 0))
    names = [site.name for site in geometry.sites]
    one, other = (names.index(f"base.zmin|post.{side}") for side in ("xmax", "ymin"))
    vertex, beside = np.array([0.25, 1.0, 0.0]), np.array([0.05, 1.2, 0.0])
    known = np.stack([beside, vertex])
    feet = np.array([[[0.25, 1.2, 0], [0.05, 1, 0]], [vertex, vertex]])
    surface = SheetSurface(incidence, (one, other), known, feet)
    asked = vertex[None] + rounding * np.array([[1.0, -2.0, 0.5]])
    assert surface.normal(asked) == pytest.approx(surface.normal(beside[None]), abs=1e-12)
    assert abs(surface.normal(beside[None])[0]) == pytest.approx([0.5**0.5, 0.5**0.5, 0])
    good = SheetFamily(incidence, [(one, other)]).normal(np.array([0]), asked)[1]
    assert not good.any()


def test_a_curve_that_comes_back_at_once_is_its_node() -> None:
    """A seam back at its start within rounding bounds no sheet."""
    x = np.array([1.0, 0.0, 0.0])

    def piece(points: Array) -> CurvePiece:
        feet = np.zeros((3, 3))
        return CurvePiece(LineKind.SEAM, ((0,), (1,), (2,)), RayCurve(0 * x, x), points, feet)

    line = piece(np.linspace(0, 1, 5)[:, None] * x)
    hook = piece(np.array([0.0, 1, 2, 1, 0])[:, None] * 1e-8 * x)
    found = network(1.0, np.empty((0, 3)), [line, hook])
    assert len(found.pieces) == 1
    assert all(float(norm(b - a)) > 0 for a, b in pairwise(found.pieces[0].points))


def test_samples_of_curves_that_leave_together_stay_in_order() -> None:
    """Also where a curve places a sample far from where it was asked for."""
    ways = np.array([[1.0, 0.0, 0.0], [1.0, 0.01, 0.0]])
    dense = np.linspace(0, 1, 21)[:, None]
    pieces = [
        CurvePiece(LineKind.TRIM, ((0,), (1,)), Drawn(), dense * way, np.zeros((2, 3)), (0, end))
        for end, way in enumerate(ways, 1)
    ]
    samples = [np.array([[0.0], [t], [1.0]]) * way for t, way in zip((0.4, 0.5), ways, strict=True)]
    found = matched(pieces, samples)
    assert [len(each) for each in found] == [4, 4]
    for each in found:
        assert (np.diff(norm(each)) > 0).all()
