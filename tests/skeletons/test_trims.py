"""Trims end exactly where the far foot passes to another site; their surfaces do not fold."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

import decomp
from decomp import Block, Cone, Cylinder
from decomp.complex.model import LineKind
from decomp.curves.hyperbola import Hyperbola
from decomp.sites.site import SiteKind
from decomp.skeletons.curves.curve_elements import SeamCurve, TrimCurve
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.curves.trim_changes import change
from decomp.skeletons.drafts import traced
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.skeletons.sheets.trim_surfaces import strip
from decomp.vectors import Array, Ints, norm


def curves_of(solid: decomp.Solid) -> RegionCurves:
    (curves,) = traced(decomp.Geometry(solid), 500, lambda what, done: None)
    return curves


def stepped(a: float, b: float, h: float) -> decomp.Solid:
    """A block with a step, cut from below by a slot that ends under the step's edge."""
    hall = Block((0, 0, 0), (4, 4, h), name="hall")
    shaft = Block((a, b, 0), (4 - a, 4 - b, h + 1), name="shaft")
    plate = Block((a - 0.5, b + 0.3, -1), (1.5, 0.7, h + 0.6), name="plate")
    return (hall | shaft) - plate


def test_trims_that_cross_meet_in_one_node() -> None:
    """Two trims cross on the sheet between the faces above and below; all pieces end there."""
    a, b, h = 0.8066110542, 1.1253080957, 1.3651022309
    curves = curves_of(stepped(a, b, h))
    crossing = np.array([a + 1.0, b + 0.4, h])
    gaps = norm(curves.nodes - crossing)
    (at,) = np.flatnonzero(gaps < 1e-3)
    assert gaps[at] <= 1e-10
    assert sum(at in (piece.ends or ()) for piece in curves.pieces) == 4


def test_no_trim_of_planes_lies_on_a_locus() -> None:
    """Balls over the edge of length 0.03 are small; their two feet have not run together."""
    base = Block((0, 0, 0), (4, 2, 1), name="base")
    curves = curves_of(base | Block((1, 1, 0.97), (1, 2, 1), name="boss"))
    assert curves.runs == curves.reflexive == ()
    short = [n for n, c in enumerate(curves.over) if c.end - c.start == pytest.approx(0.03)]
    assert short
    for number in short:
        assert any(number in piece.over for piece in curves.pieces)


def leaning(x: float) -> decomp.Solid:
    """A plate with a boss that leans over and a step below it, whose edge is under the boss.

    The boss' ellipse has its centre in (3.5, 2, 2), and 1 and hypot(1, 1/2) as semi-axes.
    """
    plate = Block((0, 0, 0), (7, 4, 2), name="plate")
    boss = Cylinder((3, 2, 1), (5.5, 2, 6), 1, name="boss")
    return (plate | boss) - Block((-1, -1, -1), (x + 1, 6, 1.5), name="step")


@pytest.mark.parametrize("x", [3.5, 3.45])
def test_trims_have_a_node_where_their_far_foot_jumps_along_one_edge(x: float) -> None:
    """Over the middle of the step's edge both sides of the boss' ellipse are as near."""
    curves = curves_of(leaning(x))
    # the places of the ellipse x = 3.5 + a cos t, y = 2 + sin t that are nearest to (x, 2)
    a2 = 1.25
    cosine = (x - 3.5) * np.sqrt(a2) / (a2 - 1)
    square = (3.5 + np.sqrt(a2) * cosine - x) ** 2 + 1 - cosine**2
    # a ball on the step's edge, 1.5 below the ellipse: r^2 = square + (1.5 - r)^2
    centre = np.array([x, 2, 0.5 + (square + 2.25) / 3])
    gaps = norm(curves.nodes - centre)
    at = int(np.argmin(gaps))
    assert gaps[at] <= 1e-10
    ending = [p for p in curves.pieces if at in (p.ends or ()) and p.kind is LineKind.TRIM]
    assert len(ending) == 2


@pytest.mark.slow
def test_sheets_beside_trims_that_jump_are_certified() -> None:
    (region,) = decomp.skeleton(leaning(3.5)).regions
    assert region.certificate.euler == 1


def test_points_beside_a_seam_go_to_the_part_whose_foot_is_nearer() -> None:
    """Both parts of the sheet between a wall and a slanted rod's ellipse meet in a crease."""
    rod = Cone((2.03, -0.59, 2.26), 0.6, (2.92, 4.35, -1.38), 0.24, name="rod")
    incidence = curves_of(Block((0, 0, 0), (3.14, 4.17, 2.97), name="base") | rod).incidence
    number = {site.name: k for k, site in enumerate(incidence.sites) if site.region == 0}
    pair = number["base.xmax"], number["base.zmin|rod.side@2"]
    known = np.array([[2.611, 2.5998, 0.3973], [2.5926, 2.5296, 0.4039]])
    surface = SheetSurface(incidence, pair, known, incidence.feet(pair, known))
    beside = np.array([2.6015, 2.5683, 0.4089])
    points = beside + np.random.default_rng(1).uniform(-0.03, 0.03, (300, 3))
    placed = surface.place(points)
    site = incidence.sites[pair[1]]
    edge = incidence.boundary.edges[site.index].curve
    ring = edge.point(np.linspace(*edge.domain, 2001))
    nearest = norm(placed[:, None] - ring).min(axis=1)
    assert 3.14 - placed[:, 0] == pytest.approx(nearest, abs=1e-5)
    assert norm(surface.place(placed) - placed).max() <= 1e-12


def test_a_seam_that_comes_back_to_its_node_has_other_feet_there() -> None:
    """A point beside the node is on the branch whose chord it is nearer to."""
    t = np.linspace(0, 2 * pi, 9)
    points = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    points[-1] = points[0]
    feet = np.arange(27.0).reshape(9, 3, 1).repeat(3, axis=2)
    curve = SeamCurve(curves_of(Block((0, 0, 0), (1, 1, 1))).incidence, (0, 1, 2), points, feet)
    leaving, coming = points[0] + 0.1 * (points[[1, -2]] - points[0])
    assert (curve.feet_near(np.stack([leaving, coming])) == feet[[0, -1]]).all()


def area(lower: Array, upper: Array, triangles: Ints) -> Array:
    """Twice the areas of triangles between polylines (k, 2) with vertices counted on."""
    corners = np.concatenate([lower, upper])[triangles]
    (ux, uy), (vx, vy) = (corners[:, k].T - corners[:, 0].T for k in (1, 2))
    found: Array = ux * vy - uy * vx
    return found


@pytest.mark.parametrize("peaks", [(1.0,), (2.0, 0.1, 2.0), (0.1, 3.0, 0.2, 2.0, 0.5, 0.4)])
def test_strips_with_hollows_do_not_fold(peaks: tuple[float, ...]) -> None:
    lower = np.array([[0.0, 0.0], [3.0, 0.0]])
    upper = np.stack([np.linspace(0, 3, len(peaks) + 2), [0.5, *peaks, 0.5]], axis=1)
    numbers = np.arange(2, 2 + len(upper))
    triangles = strip(np.array([0, 1]), lower[:, 0], numbers, *upper.T)
    found = area(lower, upper, triangles)
    assert (found > 0).all()
    assert found.sum() / 2 == pytest.approx(np.trapezoid(upper[:, 1], upper[:, 0]))
    assert len(triangles) == len(upper)


def test_strips_whose_ends_are_points_of_the_edge() -> None:
    lower, upper = np.array([0.0, 4.0]), np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    height = np.array([0.0, 1.0, 0.1, 1.0, 0.0])
    triangles = strip(np.array([0, 1]), lower, np.array([0, 2, 3, 4, 1]), upper, height)
    points = np.stack([[0.0, 4.0, 1.0, 2.0, 3.0], [0.0, 0.0, 1.0, 0.1, 1.0]], axis=1)
    found = area(points[:2], points[2:], triangles)
    assert (found > 0).all()
    assert found.sum() / 2 == pytest.approx(np.trapezoid(height, upper))


@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_double_roots_are_placed(turn: float) -> None:
    """From a change that tolerances put beside the touch; `turn` makes it lopsided."""
    at = 1.2

    def touch(s: float) -> float:
        return 4 - 4 * cos(s - at) + turn * (s - at) ** 3

    assert change(touch, at - 1.1e-5, at - 1.1e-5 + 1e-12, 6.28, 10.0) == pytest.approx(
        at, abs=1e-8
    )


def test_single_roots_stay() -> None:
    """Even where another one is near."""

    def two(s: float) -> float:
        return (s - 1.0) * (s - 1.002)

    assert change(two, 1.0 - 1e-9, 1.0 + 1e-9, 6.28, 10.0) == pytest.approx(1.0, abs=1e-12)
    assert change(sin, 3.14159, 3.1416, 6.28, 10.0) == pytest.approx(pi, abs=1e-12)


def test_trims_touch_the_nearer_leg() -> None:
    """A cone laid into a block's floor: a ball between the legs of its edge touches the nearer."""
    block = Block((0, 0, 0), (3, 4, 3), name="base")
    curves = curves_of(block | decomp.Cone((-0.6, 1.9, 0.45), 0.6, (5.6, 1.9, 0.45), 0.24))
    trims = [p.element for p in curves.pieces if isinstance(p.element, TrimCurve)]
    edges = curves.incidence.boundary.edges
    checked = 0
    for trim in trims:
        site = curves.incidence.sites[trim.far]
        if site.kind is not SiteKind.EDGE or not isinstance(edges[site.index].curve, Hyperbola):
            continue
        s = trim.start + (trim.end - trim.start) * np.linspace(0.0, 1.0, 202)[1:-1]
        centres = trim.at(s, np.full(len(s), norm(trim.points - trim.feet).mean()))
        edge = edges[site.index]
        places = edge.curve.point(np.linspace(edge.start, edge.end, 20_001))
        nearest = norm(centres[:, None] - places).min(axis=1)
        assert norm(centres - trim.over.feet(s)) == pytest.approx(nearest, abs=1e-6)
        checked += 1
    assert checked
