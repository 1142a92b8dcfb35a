"""Seams and junctions: local structure from contacts, exact counts and places."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

import decomp
from decomp.skeletons.balls.contacts import contacts
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.curves_of_region import seam_pieces
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.touching import touching_points
from decomp.skeletons.seams.graph import Seam, SeamGraph, seam_graph
from decomp.skeletons.seams.leaving.local import seam_rays
from decomp.skeletons.seams.seams import SeamTracer
from decomp.skeletons.seams.seeds import Seeds
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import Run, SeamEnd, State, Traced
from decomp.skeletons.seams.traced_seams import seam_between
from decomp.vectors import Array, norm
from tests.solids import SOLIDS

CUBE = decomp.Block((0, 0, 0), (2, 2, 2), name="cube")
BAR = decomp.Block((0, 0, 0), (2, 1, 1), name="bar")


def graph_of(solid: decomp.Solid) -> tuple[decomp.Geometry, SeamGraph]:
    geometry = decomp.Geometry(solid)
    return geometry, seam_graph(RegionContext(geometry.index, 0), samples=1000)


@pytest.mark.parametrize(
    ("solid", "point", "touching", "leaving"),
    [
        (SOLIDS["block"].make(), (2, 1.5, 1), 2, 0),  # inside a sheet
        (SOLIDS["block"].make(), (0.5, 0.5, 0.5), 3, 2),  # inside a seam
        (SOLIDS["block"].make(), (1, 1, 1), 4, 4),  # a junction
        (CUBE, (1, 1, 1), 6, 8),  # all six sides at once: an octahedron's facets
        (BAR, (1, 0.5, 0.5), 4, 2),  # inside a seam of four sheets
        (BAR, (0.5, 0.5, 0.5), 5, 5),  # where it ends: a pyramid's facets
    ],
)
def test_contacts_tell_the_local_structure(
    solid: decomp.Solid, point: tuple[float, float, float], touching: int, leaving: int
) -> None:
    geometry = decomp.Geometry(solid)
    found = contacts(RegionContext(geometry.index, 0), np.array(point, float), 1e-9)
    assert len(found.feet) == touching
    assert len(seam_rays(found.gradients)) == leaving


@pytest.mark.parametrize(
    ("solid", "nodes", "seams"),
    [
        (SOLIDS["block"].make(), 12, 12),  # 12 junctions with the corners, 24 curves with the edges
        (CUBE, 9, 8),
        (BAR, 10, 9),
        (SOLIDS["through hole"].make(), 16, 20),  # 34 curves with 14 edges
        (SOLIDS["eccentric hole"].make(), 16, 20),
        (SOLIDS["cylinder"].make(), 0, 0),
        (SOLIDS["oval ring"].make(), 0, 0),
    ],
)
def test_counts(solid: decomp.Solid, nodes: int, seams: int) -> None:
    _, graph = graph_of(solid)
    assert (len(graph.nodes), len(graph.seams)) == (nodes, seams)


def test_junctions_of_the_block_are_exact() -> None:
    _, graph = graph_of(SOLIDS["block"].make())
    inner = sorted(tuple(node.point.round(14)) for node in graph.nodes if node.radius > 0)
    assert inner == [(1, 1, 1), (1, 2, 1), (3, 1, 1), (3, 2, 1)]
    lengths = sorted(seam.length for seam in graph.seams)
    assert lengths == pytest.approx([1, 1, *[sqrt(3)] * 8, 2, 2])


@pytest.mark.parametrize("name", ["block", "through hole", "bracket", "blind hole", "pocket"])
def test_seams_lie_in_the_middle_of_their_contacts(name: str) -> None:
    """Every seam point has three contacts at one distance, and nothing is nearer."""
    geometry, graph = graph_of(SOLIDS[name].make())
    size = geometry.diagonal
    for seam in graph.seams:
        inner = slice(1, -1)
        reach = geometry.nearest(seam.points[inner]).distance
        assert np.abs(reach - seam.radius[inner]).max() <= 2e-10 * size
        middle = seam.points[len(seam.points) // 2]
        assert len(contacts(RegionContext(geometry.index, 0), middle, 1e-9 * size).feet) >= 3


def test_every_ray_of_every_node_is_one_end_of_a_seam() -> None:
    for name in ("block", "through hole", "bracket", "blind hole", "fichera"):
        _, graph = graph_of(SOLIDS[name].make())
        ends = [end for seam in graph.seams for end in seam.ends or ()]
        assert [ends.count(k) for k in range(len(graph.nodes))] == [
            len(node.rays) for node in graph.nodes
        ]


def test_a_closed_seam_is_found_from_the_footprint() -> None:
    """In a round plate with a round hole the seam of hole, bottom and top is a circle."""
    disc = decomp.Cylinder((0, 0, 0), (0, 0, 1), 5, name="disc")
    bore = decomp.InfiniteCylinder((0, 0, 0), (0, 0, 1), 1, name="bore")
    _, graph = graph_of(disc - bore)
    assert not graph.nodes
    inner, outer = sorted(graph.seams, key=lambda seam: seam.length)
    for seam, radius in ((inner, 1.5), (outer, 4.5)):
        assert seam.ends is None
        assert np.abs(norm(seam.points[:, :2]) - radius).max() <= 1e-12
        assert np.abs(seam.points[:, 2] - 0.5).max() <= 1e-12
        assert seam.length == pytest.approx(2 * pi * radius, rel=1e-3)


def test_closed_seams_close_wherever_they_begin() -> None:
    """Also just before a change of their sites, up to which the last step is a short one."""
    shaft = decomp.Cylinder((0, 0, 0), (22, 0, 0), 13) | decomp.Cylinder((22, 0, 0), (40, 0, 0), 9)
    slot: decomp.Solid = decomp.Block((8, -3, 10.5), (4, 6, 10))
    for x in (8, 12):
        slot = slot | decomp.Cylinder((x, 0, 10.5), (x, 0, 20.5), 3)
    geometry, graph = graph_of(shaft - slot)
    points = SeamPoints(RegionContext(geometry.index, 0))
    tracer = SeamTracer(points, 0.05)
    begun = 0
    for seam in graph.seams:
        sites = seam.sites
        for k in range(1, len(sites) - 1) if seam.ends is None else ():
            if sites[k - 1] != sites[k] or sites[k] == sites[k + 1]:
                continue
            way = seam.points[k] - seam.points[k - 1]
            at = seam.points[k] - 0.1 * way
            start = points.state(sites[k], at, seam.feet[k - 1], way / norm(way))
            assert start is not None
            assert tracer.trace(start).end is SeamEnd.CLOSED
            begun += 1
    assert begun > 3


def test_a_seam_that_touches_a_trim_in_its_middle_only() -> None:
    """A slot's round end is as far from the rod's end as its bottom is from the rod's side."""
    rod = decomp.Cylinder((0, 0, 0), (6, 0, 0), 5, name="rod")
    slot = decomp.Block((-1.2, -1.2, 3), (2, 2.4, 9), name="slot")
    end = decomp.Cylinder((0.8, 0, 3), (0.8, 0, 9), 1.2, name="end")
    geometry, graph = graph_of(rod - (slot | end))
    touch = np.array([[4.0, 0.0, 3.0]])
    (seam,) = (s for s in graph.seams if np.abs(s.points - touch).max(axis=1).min() < 0.1)
    # half of it and its mirror image: the touch is the middle point
    half = seam.points[:, 1] > 1e-3
    mirror = np.array([1.0, -1.0, 1.0])
    points, feet = seam.points[half], seam.feet[half]
    order = np.argsort(-points[:, 1])
    points, feet = points[order], feet[order]
    at_touch = np.array([[[2.0, 0, 3], [6.0, 0, 3], [4.0, 0, 5]]])
    names = [geometry.sites[k].name for k in seam.sites[len(seam.sites) // 2]]
    assert names == ["end.side|slot.zmin", "rod.top", "rod.side"]
    whole = Seam(
        np.concatenate([points, touch, (points * mirror)[::-1]]),
        np.full(2 * len(points) + 1, np.nan),
        (seam.sites[len(seam.sites) // 2],) * (2 * len(points) + 1),
        np.concatenate([feet, at_touch, (feet * mirror)[::-1]]),
        (0, 1),
    )
    incidence = Incidence(RegionContext(geometry.index, 0))
    (piece,) = seam_pieces(incidence, [whole])
    assert np.abs(piece.middle - touch).max() <= 1e-12
    assert [len(contact) for contact in piece.contacts] == [1, 1, 1]
    (found,) = touching_points(incidence, [piece])
    assert np.abs(found - touch).max() <= 1e-6


def test_seeds_on_trims_are_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a vertex takes over from its edge both are as near, to rounding: no seam is there."""
    block = decomp.Block((0, 0, 0), (10, 10, 12), name="b") - decomp.Block(
        (5, 4, 6), (9, 9, 9), name="c"
    )
    geometry, graph = graph_of(block)
    names = ["b.xmin", "c.xmin|c.zmin", "c.xmin|c.ymin|c.zmin"]
    sites = tuple(next(k for k, s in enumerate(geometry.sites) if s.name == n) for n in names)
    y = 4 + 3e-7
    point, feet = np.array([2.6, y, 5]), np.array([[0, y, 5], [5, y, 6], [5, 4, 6]])
    way = np.array([1.0, 0.0, 2.6]) / sqrt(1 + 2.6**2)
    state = State(point, 2.6, sites, feet, way, 0.0)
    settled = SeamPoints.settled

    def on_trim(points: SeamPoints, near: Array, known: Array, along: Array) -> State | None:
        return state if (near == point).all() else settled(points, near, known, along)

    monkeypatch.setattr(SeamPoints, "settled", on_trim)
    monkeypatch.setattr(
        "decomp.skeletons.seams.graph.seam_seeds", lambda *_: Seeds(point[None], feet[None])
    )
    assert len(seam_graph(RegionContext(geometry.index, 0)).seams) == len(graph.seams)


def test_seams_end_at_their_nodes_also_between_two_points() -> None:
    """A step that leads past the node is no part of the seam."""
    _, graph = graph_of(SOLIDS["block"].make())
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1e-9, 0], [5, 0, 0]])
    start, end = (replace(graph.nodes[0], point=np.array([x, 0.0, 0.0])) for x in (0.4, 4.0))
    feet = np.zeros((5, 3, 3))
    run = Run((0, 1, 2), points, np.ones(5), feet)
    last = State(points[-1], 1.0, (0, 1, 2), feet[-1], np.array([1.0, 0, 0]), 0.0)
    traced = Traced((run,), last, SeamEnd.SPLIT, -1, np.zeros(3))
    seam = seam_between(traced, (0, 1), start, end, 1.0)
    assert seam.points[:, 0].tolist() == [0.4, 1.0, 2.0, 3.0, 4.0]


def test_seams_end_at_their_nodes_however_many_points_are_beside_them() -> None:
    """Rounding led seven of nine points past the node, by less than a millionth of the size."""
    _, graph = graph_of(SOLIDS["block"].make())
    x = np.concatenate([[0.0, 1.0], 2.0 + 1e-7 * np.arange(1, 8)])
    points = np.stack([x, 0 * x, 0 * x], axis=1)
    start, end = (replace(graph.nodes[0], point=np.array([x, 0.0, 0.0])) for x in (-1.0, 2.0))
    run = Run((0, 1, 2), points, np.ones(9), np.zeros((9, 3, 3)))
    last = State(points[-1], 1.0, (0, 1, 2), run.feet[-1], np.array([1.0, 0, 0]), 0.0)
    traced = Traced((run,), last, SeamEnd.SPLIT, -1, np.zeros(3))
    seam = seam_between(traced, (0, 1), start, end, 1.0)
    assert seam.points[:, 0].tolist() == [-1.0, 0.0, 1.0, 2.0]


def test_similar_solids_have_similar_graphs() -> None:
    _, plain = graph_of(SOLIDS["through hole"].make())
    _, moved = graph_of(
        SOLIDS["through hole"].make().rotate((1, 2, 3), 40).mirror((1, 0, 0)).scale(0.1)
    )
    assert len(moved.nodes) == len(plain.nodes)
    assert sorted(10 * s.length for s in moved.seams) == pytest.approx(
        sorted(s.length for s in plain.seams), rel=1e-3
    )


def test_feet_that_run_together_fast_are_followed_to_where_they_meet() -> None:
    """Where a slanted rod leaves a block, balls that touch its ellipse twice osculate it soon."""
    rod = decomp.Cylinder((4, 2.3, 2.1), (-2.7, 3.7, 1.6), 1.07)
    _, graph = graph_of(decomp.Block((0, 0, 0), (3, 5, 3)) | rod)
    met = 0
    for seam in graph.seams:
        for k in (0, -1):
            gaps = norm(seam.feet[k][:, None] - seam.feet[k][None])
            nearest = gaps[np.triu_indices(len(gaps), 1)].min()
            met += bool(nearest == 0 and len(set(seam.sites[k])) < len(seam.sites[k]))
            if seam.sites[k] and nearest < 1e-2:
                assert nearest == 0  # none ends before
    assert met == 3
