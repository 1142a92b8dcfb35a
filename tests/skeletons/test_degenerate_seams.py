"""Seams that part tangentially, feet that cross edges, seams that end inside the solid."""

from __future__ import annotations

from collections import Counter
from math import sqrt

import numpy as np
import pytest

import decomp
from decomp import Cylinder
from decomp.errors import GeometryError
from decomp.skeletons.balls.equidistance import equidistant
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.graph import SeamGraph, missed_seams, seam_graph
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.vectors import norm
from tests.skeletons.shapes import washer
from tests.solids import SOLIDS

ELL = decomp.Block((0, 0, 0), (2, 2, 1), name="whole") - decomp.Block(
    (1, 1, -1), (2, 2, 3), name="corner"
)
"""An L whose arms are as wide as it is thick: the seam of four sheets in each arm splits."""


def graph_of(solid: decomp.Solid, samples: int = 500) -> tuple[decomp.Geometry, SeamGraph]:
    geometry = decomp.Geometry(solid)
    return geometry, seam_graph(RegionContext(geometry.index, 0), samples=samples)


def random_blocks(seed: int) -> decomp.Solid:
    """Blocks with small integer corners, added and taken away."""
    rng = np.random.default_rng(seed)
    solid: decomp.Solid = decomp.Block((0, 0, 0), (4, 4, 4), name="base")
    for number in range(2):
        corner, size = rng.integers(0, 4, 3), rng.integers(1, 4, 3)
        block = decomp.Block(tuple(corner), tuple(size), name=f"part{number}")
        solid = solid - block if rng.random() < 0.6 else solid | block
    return solid


@pytest.mark.parametrize(
    ("solid", "nodes", "seams"),
    [
        # 10 corners; the ends of the arms, their elbow and two splits; 10 seams from corners, one
        # in each arm, from each split one to the elbow, and one around the reentrant edge
        (ELL, 15, 15),
        # 8 corners, the four beside them, four splits, four junctions of four sites at the ends
        (SOLIDS["slot"].make(), 20, 26),
        # 12 corners, one node beside each of the plate's, the boss' apex, and four fins
        (SOLIDS["square boss"].make(), 21, 20),
        (SOLIDS["bracket"].make(), 16, 17),
        (SOLIDS["thin wall"].make(), 16, 20),
    ],
)
def test_counts(solid: decomp.Solid, nodes: int, seams: int) -> None:
    _, graph = graph_of(solid)
    assert (len(graph.nodes), len(graph.seams)) == (nodes, seams)


def test_the_arms_of_an_ell_split_where_the_foot_passes_the_edge() -> None:
    _, graph = graph_of(ELL)
    splits = [
        node for node in graph.nodes if sorted(len(ray.contacts) for ray in node.rays) == [3, 3, 4]
    ]
    places = sorted(tuple(node.point.round(12)) for node in splits)
    assert places == [(0.5, 1.0, 0.5), (1.0, 0.5, 0.5)]


def test_fins_end_below_the_corners_of_a_boss() -> None:
    """The sheet between two edges of the boss' base ends on the line below their corner."""
    geometry, graph = graph_of(SOLIDS["square boss"].make())
    fins = [node for node in graph.nodes if node.radius > 0 and len(node.feet) == 2]
    assert len(fins) == 4
    for node in fins:
        assert np.abs(np.abs(node.point[:2] - 2) - 1).max() <= 1e-14 * geometry.diagonal
        assert node.point[2] == pytest.approx(0.5, abs=1e-14)


def test_fins_end_where_an_edge_is_osculated() -> None:
    """A rod across a column, near the floor: the sheet of their edge with itself ends in fins.

    Its two feet run together at the rod's lowest line, in a centre of curvature of the edge, and at
    its highest, on the column's axis, where a whole circle of the column is as near.
    """
    column = Cylinder((0, 0, 0), (0, 0, 1), 0.3, name="column")
    rod = Cylinder((-0.5, 0, 0.2), (0.5, 0, 0.2), 0.1, name="rod")
    _, graph = graph_of(column | rod)
    assert len(graph.seams) == 2
    # a / 0.3 + b / 0.1 = 1 in the plane of curvature, and the floor as far: (b + 0.1)^2 = a^2 + b^2
    a = (sqrt(1 / 225 + 0.12) - 1 / 15) / 2
    b = 0.1 * (1 - a / 0.3)
    expected = [(a - 0.3, 0, b + 0.1), (0, 0, 0.3), (0.3 - a, 0, b + 0.1)]
    fins = sorted(tuple(node.point) for node in graph.nodes)
    assert fins == [pytest.approx(p, abs=1e-10) for p in expected]
    for seam in graph.seams:
        assert (np.diff(seam.points[:, 2]) < 0).all() or (np.diff(seam.points[:, 2]) > 0).all()


@pytest.mark.parametrize("name", ["bracket", "blind hole", "fichera", "countersink", "slot"])
def test_feet_are_on_both_sites_where_they_pass_from_one_to_the_other(name: str) -> None:
    geometry, graph = graph_of(SOLIDS[name].make())
    size = geometry.diagonal
    for seam in graph.seams:
        assert [p.sites for p in seam.pieces] == [seam.sites[p.start] for p in seam.pieces]
        for k in seam.switches:
            assert (seam.points[k] == seam.points[k - 1]).all() or seam.ends is None
            for sites in (seam.sites[k - 1], seam.sites[k]):
                found = equidistant(
                    RegionContext(geometry.index, 0),
                    np.array([sites]),
                    seam.points[k][None],
                    seam.feet[k][None],
                )
                assert found.converged[0]
                assert norm(found.points[0] - seam.points[k]) <= 1e-12 * size
                assert norm(found.feet[0] - seam.feet[k]).max() <= 1e-11 * size


@pytest.mark.parametrize("seed", range(12))
def test_blocks_on_a_grid_have_whole_graphs(seed: int) -> None:
    """Every ray is one end of a seam, and none is missed."""
    geometry, graph = graph_of(random_blocks(seed), samples=300)
    ends = Counter(end for seam in graph.seams for end in seam.ends or ())
    assert [ends[k] for k in range(len(graph.nodes))] == [len(n.rays) for n in graph.nodes]
    assert not len(missed_seams(RegionContext(geometry.index, 0), graph, 1000, 99))


def test_a_seam_that_is_left_out_is_missed() -> None:
    geometry, graph = graph_of(SOLIDS["through hole"].make())
    assert not len(missed_seams(RegionContext(geometry.index, 0), graph, 2000, 99))
    fewer = SeamGraph(graph.nodes, graph.seams[1:])
    missed = missed_seams(RegionContext(geometry.index, 0), fewer, 2000, 99)
    assert len(missed)
    line = graph.seams[0].points
    assert norm(missed[:, None] - line[None]).min(axis=1).max() <= 0.05 * geometry.diagonal


def test_a_seam_that_cannot_be_settled_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """The closed seams of a washer are found from seeds alone: those must not go unnoticed."""
    monkeypatch.setattr(SeamPoints, "settled", lambda *_: None)
    with pytest.raises(GeometryError, match="cannot be found exactly"):
        graph_of(washer())


def test_a_seam_that_misses_the_corner_of_its_face_is_traced_again() -> None:
    """The foot on boss.ymax crosses the corner (4.3, 3.5) of what the base takes from that face."""
    solid = (
        decomp.Block((0, 0, 0), (4.3, 3.55, 3.5), name="base")
        | decomp.Block((1.65, 1.87, 0), (3.65, 1.4, 3.93), name="boss")
    ) - decomp.Block((-1, 1.2, 1.93), (4.84, 3, 2.07), name="cut")
    _, graph = graph_of(solid)
    near = [n for n in graph.nodes if norm(n.point - (4.285, 2.82525, 3.485)) < 0.01]
    assert [len(node.rays) for node in near] == [4]
