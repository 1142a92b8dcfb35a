"""Walls between labels are closed, whatever the labels; tetrahedra are halved without gaps."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import Delaunay  # type: ignore[import-untyped]

from decomp.sampled.contracting import Contractor
from decomp.sampled.marching import walls
from decomp.skeletons.cells.surface import open_edges
from decomp.vectors import Array, Ints


def tetrahedra(count: int, seed: int) -> tuple[Array, Ints, Ints]:
    """Random points, positively oriented tetrahedra, and the nodes of their hull."""
    points = np.random.default_rng(seed).random((count, 3))
    made = Delaunay(points)
    tets = made.simplices.astype(np.int64)
    a, b, c, d = np.moveaxis(points[tets], 1, 0)
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[turned] = tets[turned][:, [1, 0, 2, 3]]
    return points, tets, np.unique(made.convex_hull)


@pytest.mark.parametrize("labels", [2, 3, 7])
def test_the_walls_around_a_label_are_closed(labels: int) -> None:
    points, tets, hull = tetrahedra(200, seed=labels)
    label = np.random.default_rng(0).integers(1, labels + 1, len(points))
    label[hull] = 0
    found = walls(tets, label)
    for own in range(1, labels + 1):
        ahead, behind = (found.between[:, k] == own for k in (0, 1))
        around = np.concatenate([found.triangles[ahead], found.triangles[behind][:, ::-1]])
        assert len(around) and not len(open_edges(around))


def test_walls_enclose_their_label_and_face_away_from_the_lower_one() -> None:
    points, tets, hull = tetrahedra(200, seed=1)
    label: Ints = np.ones(len(points), dtype=np.int64)
    label[hull] = 2
    found = walls(tets, label)
    places = np.array([points[row[row >= 0]].mean(axis=0) for row in found.corners])
    a, b, c = np.moveaxis(places[found.triangles], 1, 0)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert 0 < volume < 1


def never(vertex: int, a: int, b: int, sheet: bool) -> bool:
    """No vertex lies on walls other than those of its own sites."""
    return False


def test_a_strip_without_width_is_contracted_and_the_rest_stays() -> None:
    """A square whose diagonal is a strip of no width between two copies of the same points."""
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.4, 0.4, 0], [0.4, 0.4, 0]])
    triangles = np.array([[0, 1, 4], [4, 1, 2], [0, 5, 3], [5, 2, 3], [0, 4, 5], [4, 2, 5]])
    wanted = np.array([False] * 4 + [True] * 2)
    fixed = np.array([True] * 4 + [False] * 2)
    sites: list[tuple[int, ...]] = [(1, 2, 3)] * 6
    none = np.empty((0, 2), dtype=np.int64)
    pairs = np.tile([1, 2], (6, 1))
    sheet = np.ones(6, dtype=np.bool_)
    become = Contractor(
        points, sites, triangles, fixed, wanted, sheet, none, 1e-9, pairs, never
    ).run()
    left = become[triangles]
    proper = left[[len(set(row)) == 3 for row in left.tolist()]]
    assert len(proper) == 4
    assert len(np.unique(proper)) == 5


def test_what_would_close_a_hole_is_not_contracted() -> None:
    """A band around a hole: an edge across it may go, the three around the hole may not all."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 3, 0], [-3, 0, 0], [0, -3, 0]])
    inner, outer = (0, 1, 2), (5, 3, 4)
    rows = []
    for k in range(3):
        a, b, c, d = inner[k], inner[(k + 1) % 3], outer[k], outer[(k + 1) % 3]
        rows += [(a, c, b), (b, c, d)]
    triangles = np.array(rows)
    edges = np.array([[0, 1], [1, 2], [0, 2]])
    fixed = np.zeros(6, dtype=np.bool_)
    wanted, sheet = np.zeros(6, dtype=np.bool_), np.ones(6, dtype=np.bool_)
    sites: list[tuple[int, ...]] = [(1, 2)] * 6
    pairs = np.tile([1, 2], (6, 1))
    become = Contractor(
        points.astype(float), sites, triangles, fixed, wanted, sheet, edges, 0, pairs, never
    ).run()
    assert (become == np.arange(6)).all()


@pytest.mark.parametrize("on", [True, False])
def test_a_vertex_becomes_one_with_another_only_if_that_lies_on_all_walls_left(on: bool) -> None:
    """Vertex 3, in the middle of a triangle, is a junction of sites that its neighbours lack."""
    points = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0], [1, 1, 0]])
    triangles = np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3]])
    sites: list[tuple[int, ...]] = [(1, 2), (1, 2), (1, 2), (1, 4)]
    between = np.tile([1, 4], (3, 1))
    asked: list[tuple[int, int, int, bool]] = []

    def holds(vertex: int, a: int, b: int, sheet: bool) -> bool:
        asked.append((vertex, a, b, sheet))
        return on

    fixed, wanted = np.array([True] * 3 + [False]), np.zeros(3, dtype=np.bool_)
    sheet, short = np.ones(3, dtype=np.bool_), np.array([[0, 3]])
    become = Contractor(
        points, sites, triangles, fixed, wanted, sheet, short, 1e-9, between, holds
    ).run()
    assert become.tolist() == [0, 1, 2, 0 if on else 3]
    assert set(asked) == {(0, 1, 4, True)}
