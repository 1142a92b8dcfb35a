"""Seams and junctions: local structure from contacts, exact counts and places."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

import decomp
from decomp.tracing.contacts import contacts
from decomp.tracing.graph import SeamGraph, seam_graph
from decomp.tracing.local import seam_rays
from decomp.vectors import norm
from tests.solids import SOLIDS

CUBE = decomp.Block((0, 0, 0), (2, 2, 2), name="cube")
BAR = decomp.Block((0, 0, 0), (2, 1, 1), name="bar")


def graph_of(solid: decomp.Solid) -> tuple[decomp.Geometry, SeamGraph]:
    geometry = decomp.Geometry(solid)
    return geometry, seam_graph(geometry.index, geometry.regions[0], 0, samples=1000)


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
    found = contacts(geometry.index, geometry.regions[0], 0, np.array(point, float), 1e-9)
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
        assert len(contacts(geometry.index, geometry.regions[0], 0, middle, 1e-9 * size).feet) >= 3


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
