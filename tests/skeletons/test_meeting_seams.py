"""Where seams touch, or cross unnoticed: a disc about as thick as its web beside a hole."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.graph import seam_graph
from decomp.skeletons.seams.meeting_seams import Meeting, SeamMeetings
from decomp.skeletons.seams.seam_graph_model import SeamGraph
from decomp.vectors import Array, norm
from tests.skeletons.computed import at_most


def disc(radius: float) -> decomp.Solid:
    """A disc of radius 20 and height 4, with a hole about 14 from its axis, turned by 1 radian."""
    at = 14 * np.cos(1.0), 14 * np.sin(1.0)
    hole = decomp.Cylinder((*at, -1), (*at, 5), radius, name="hole")
    return decomp.Cylinder((0, 0, 0), (0, 0, 4), 20, name="disc") - hole


def traced(solid: decomp.Solid) -> tuple[SeamGraph, list[Meeting]]:
    geometry = decomp.Geometry(solid)
    graph = seam_graph(RegionContext(geometry.index, 0))
    runs = [run for seam in graph.seams for run in seam.runs]
    return graph, SeamMeetings(RegionContext(geometry.index, 0)).of(runs)


def test_seams_that_touch_meet_in_a_point() -> None:
    graph, (meeting,) = traced(disc(2))
    assert not graph.nodes
    assert meeting.point == pytest.approx([18 * np.cos(1.0), 18 * np.sin(1.0), 2], abs=1e-6)
    assert meeting.dip <= 1e-12


@pytest.mark.parametrize("radius", [1.99, 1.0])
def test_seams_with_a_gap_do_not_meet(radius: float) -> None:
    graph, meetings = traced(disc(radius))
    assert not meetings
    assert not graph.nodes


@pytest.mark.parametrize("over", [1e-3, 1e-4])
def test_seams_that_cross_end_there(over: float) -> None:
    """Two circles in the middle plane cross in two points, which one step can lead across."""
    graph, meetings = traced(disc(2 + over))
    assert not meetings
    along = (18**2 - (4 + over) ** 2 + 14**2) / 28
    aside = np.sqrt(18**2 - along**2) * np.array([1, -1])
    x, y = np.array([np.cos(1.0), np.sin(1.0)]), np.array([-np.sin(1.0), np.cos(1.0)])
    places = along * x + aside[:, None] * y
    assert len(graph.nodes) == 2
    for place in places:
        assert min(norm(node.point - [*place, 2]) for node in graph.nodes) <= 1e-9
    # one around either circle, and two between the nodes, above and below the web's own sheet
    assert len(graph.seams) == 4


def test_the_sheet_between_is_found() -> None:
    """Where the web is thinner than the disc is thick, its own sheet parts it."""
    found = decomp.skeleton(disc(2.0001))
    names = [{found.sites[k].name for k in sheet.sites} for sheet in found.regions[0].sheets]
    assert names.count({"disc.side", "hole.side"}) == 1
    assert len(names) == 6
    assert found.regions[0].certificate.euler == 0


@pytest.mark.parametrize("over", [1e-5, 1e-6, 1e-7])
def test_seams_that_cross_by_little_end_there(over: float) -> None:
    """The seams overlap by less than chords stand out from them, on a stretch of its root."""
    found = decomp.skeleton(disc(2 + over))
    along = (18**2 - (4 + over) ** 2 + 14**2) / 28
    places = [np.sqrt(18**2 - along**2) * sign for sign in (1, -1)]
    aside = [float(at @ [-np.sin(1.0), np.cos(1.0), 0]) for at in junctions(found)]
    assert sorted(aside) == pytest.approx(sorted(places), rel=1e-4)
    names = [{found.sites[k].name for k in sheet.sites} for sheet in found.regions[0].sheets]
    assert names.count({"disc.side", "hole.side"}) == 1
    assert len(names) == 6
    assert found.regions[0].certificate.euler == 0


@pytest.mark.parametrize("gap", [1e-4, 1e-6, 1e-8])
def test_seams_that_pass_closely_stay_apart(gap: float) -> None:
    """The middle sheet is a ring with a neck as wide as the gap."""
    found = decomp.skeleton(disc(2 - gap))
    assert not junctions(found)
    assert len(found.regions[0].sheets) == 5
    assert found.regions[0].certificate.euler == 0


def test_an_overlap_below_the_tolerance_is_a_touch() -> None:
    found = decomp.skeleton(disc(2 + 1e-9))
    (junction,) = junctions(found)
    assert junction == pytest.approx([18 * np.cos(1.0), 18 * np.sin(1.0), 2], abs=1e-3)
    assert len(found.regions[0].sheets) == 5


def junctions(found: decomp.Skeleton) -> list[Array]:
    """The places at which seams end."""
    return [found.complex.points[junction.vertex] for junction in found.regions[0].junctions]


@pytest.mark.parametrize("digits", range(4, 10))
def test_places_with_few_digits(digits: int) -> None:
    """Holes as near to the rim as the disc is thick, to so many digits."""
    solid: decomp.Solid = decomp.Cylinder((0, 0, 0), (0, 0, 4), 20, name="disc")
    for k in range(5):
        angle = 0.3 + 2 * k * np.pi / 5
        x, y = round(14 * np.cos(angle), digits), round(14 * np.sin(angle), digits)
        solid = solid - decomp.Cylinder((x, y, -1), (x, y, 5), 2, name="hole")
    geometry = decomp.Geometry(solid)
    with at_most(60):
        found = decomp.skeleton(geometry)
    assert geometry.regions[0].volume == pytest.approx(4 * np.pi * (20**2 - 5 * 2**2), rel=1e-9)
    assert found.regions[0].certificate.euler == -4
