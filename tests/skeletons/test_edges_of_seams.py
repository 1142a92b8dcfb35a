"""Seams and sheets all of whose feet are on edges, and feet on the right part of an edge."""

from __future__ import annotations

import numpy as np

import decomp
from decomp.boundary.topology import Convexity
from decomp.csg.primitives import Block, Cone, Cylinder
from decomp.curves import Line
from decomp.sites import SiteKind
from decomp.skeletons.balls.queries import region_queries
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.pieces import middle_row
from decomp.skeletons.curves.sampling import sampled
from decomp.skeletons.seams.edge_seeds import edge_jumps
from decomp.skeletons.seams.graph import seam_graph
from decomp.vectors import Array, norm


def test_seams_between_straight_edges_are_seen_from_these() -> None:
    """In a narrow joint of two blocks a seam has its three feet on the joint's edges."""
    post = Block((0, 0, 0), (4.8, 2.2, 4.8), name="post")
    part = decomp.Geometry(post | Block((-0.6, -0.7, 1.4), (0.62, 0.81, 0.9), name="arm"))
    boundary = part.regions[0]
    edges = [e for e in boundary.edges if e.convexity is Convexity.REENTRANT]
    assert all(isinstance(edge.curve, Line) for edge in edges)
    points, feet = edge_jumps(
        boundary, region_queries(part.index, 0), 20000, np.random.default_rng(0)
    )
    # equally far from the edges along x and y at z = 1.4 and from the one along z at x = 0.02
    seam = (np.abs(points[:, 0] - points[:, 1]) < 1e-4) & (
        np.abs(0.02 - points[:, 0] - (points[:, 2] - 1.4)) < 1e-4
    )
    inside = (points[:, 0] > 1e-3) & (points[:, 0] < 0.019)
    assert (seam & inside).any()
    gaps = norm(points[:, None] - feet)
    assert np.ptp(gaps[seam & inside], axis=1).max() < 1e-4


def test_seams_between_vertices_are_seen_from_these() -> None:
    """Around the middle of three rods that cross eight vertices are nearer than all else."""
    rod = Cylinder((0, 0, -3), (0, 0, 3), 1)
    part = decomp.Geometry(rod | rod.rotate((1, 0, 0), 90) | rod.rotate((0, 1, 0), 90))
    queries = region_queries(part.index, 0)
    points, feet = edge_jumps(part.regions[0], queries, 2000, np.random.default_rng(0))
    middle = norm(points) < 0.7
    off = np.sort(np.abs(points[middle]), axis=1)[:, 1]
    assert middle.any() and off.max() < 1e-4
    assert np.abs(np.abs(feet[middle]) - np.sqrt(0.5)).max() < 1e-12
    seams = seam_graph(RegionContext(part.index, 0), samples=2000).seams
    ends = np.array([[seam.points[0], seam.points[-1]] for seam in seams])
    assert len(seams) == 6
    assert np.allclose(norm(ends).max(axis=1), np.sqrt(0.5), atol=1e-9)
    assert np.allclose(norm(ends).min(axis=1), 0, atol=1e-9)


def test_feet_are_not_looked_for_past_an_edges_end() -> None:
    """The end of an arm of a hyperbola is as near as a point inside its other arm, almost."""
    cone = Cone((4.5, -0.1, 1.2), 0.8, (4.5, 2.9, 1.2), 0.3, name="cone")
    block = Block((0, 0, 0), (5, 4, 2.4), name="block") - Block((4, 0, -1), (2, 3, 2), name="cut")
    part = decomp.Geometry(block | cone)
    boundary = part.regions[0]
    incidence = Incidence(RegionContext(part.index, 0))
    rng = np.random.default_rng(3)
    points = rng.uniform(*boundary.bounds, (4000, 3))
    found = part.nearest(points)
    asked = 0
    for number, site in enumerate(part.sites):
        rows = np.flatnonzero((found.site == number) & (found.region == 0))
        if site.kind is not SiteKind.EDGE or not len(rows):
            continue
        asked += len(rows)
        feet = incidence.feet((number,), points[rows])[:, 0]
        np.testing.assert_allclose(
            norm(feet - points[rows]), found.distance[rows], atol=1e-9 * part.diagonal
        )
    assert asked > 50


def test_the_middle_of_points_that_crowd_at_an_end() -> None:
    points = np.zeros((40, 3))
    points[:, 0] = np.concatenate([np.linspace(0, 1, 8), 1 + np.linspace(1e-9, 1e-7, 32)])
    assert 0.3 < points[middle_row(points), 0] < 0.7
    assert middle_row(points[:3]) == 1


class Blurred:
    """A straight line along x whose places close to its end are lost."""

    def place(self, points: Array) -> Array:
        found = points * [1, 0, 0]
        found[np.abs(points[:, 0] - 1) < 1e-6, 0] = 5
        return found


def test_chords_shorter_than_the_tolerance_are_not_cut() -> None:
    points = np.zeros((5, 3))
    points[:, 0] = [0, 0.5, 1 - 1e-7, 1 - 1e-8, 1]
    found = sampled(Blurred(), points, 1e-3, least=4)
    assert (np.diff(found[:, 0]) > 0).all()
    assert found[-1, 0] == 1
