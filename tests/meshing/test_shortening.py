"""Edges longer than asked are cut; what they belong to stays as it is."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.meshes.faces import EDGES, edges_of, faces_of, least_dihedral, volumes
from decomp.meshing.naming.tagging import Tagged
from decomp.meshing.repairs.shortening import CUT, TIGHTER, Lengths, shortened, tightened
from decomp.vectors import Array, Ints
from tests.meshing.test_parts import grid


def longest(points: Array, cells: Ints, pairs: Ints) -> float:
    ends, _ = edges_of(cells, pairs)
    return float(np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).max())


def on_top(points: Array, tets: Ints) -> Ints:
    triangles = faces_of(tets).triangles
    return np.asarray(triangles[(points[triangles][:, :, 2] == 1).all(axis=1)])


def tagged(triangles: Ints) -> Tagged:
    zero = np.zeros(len(triangles), dtype=np.int64)
    return Tagged(triangles, np.stack([zero, zero - 1], axis=1), zero)


def test_edges_are_cut_until_none_is_too_long() -> None:
    points, tets = grid(2)
    part = (points[tets].mean(axis=1)[:, 0] > 0.5).astype(np.int64)
    asked = Lengths(np.array([0.2, 0.6]), np.array([np.inf]), np.arange(2))
    more, cut, parts = shortened(points, tets, part, tagged(on_top(points, tets)), asked)
    assert (more[: len(points)] == points).all()
    assert (volumes(more, cut) > 0).all()
    for number, length in enumerate((0.2, 0.6)):
        own = cut[parts == number]
        assert longest(more, own, EDGES) <= CUT * length
        assert volumes(more, own).sum() == pytest.approx(0.5)
        assert (more[own].mean(axis=1)[:, 0] > 0.5).all() == bool(number)
    faces = faces_of(cut)  # raises if a face is in three
    hull = faces.triangles[faces.tets[:, 1] < 0]
    corners = more[hull]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    assert area.sum() / 2 == pytest.approx(6)
    assert least_dihedral(more, cut).min() > 5


def test_a_face_asks_for_its_own_length() -> None:
    points, tets = grid(2)
    part = np.zeros(len(tets), dtype=np.int64)
    asked = Lengths(np.array([10.0]), np.array([0.1]), np.zeros(1, dtype=np.int64))
    more, cut, _ = shortened(points, tets, part, tagged(on_top(points, tets)), asked)
    assert longest(more, on_top(more, cut), np.array([[0, 1], [1, 2], [2, 0]])) <= CUT * 0.1
    below = (more[cut][:, :, 2] == 0).sum(axis=1) == 3
    assert longest(more, cut[below], EDGES) > 0.5


def test_short_edges_stay() -> None:
    points, tets = grid(2)
    part = np.zeros(len(tets), dtype=np.int64)
    asked = Lengths(np.array([1.0]), np.array([1.0]), np.zeros(1, dtype=np.int64))
    same, cut, _ = shortened(points, tets, part, tagged(on_top(points, tets)), asked)
    assert np.array_equal(same, points)
    assert np.array_equal(cut, tets)


def test_where_the_mean_is_too_long_more_is_cut() -> None:
    points, tets = grid(2)
    part = np.zeros(len(tets), dtype=np.int64)
    top = tagged(on_top(points, tets))
    zero = np.zeros(1, dtype=np.int64)
    asked = Lengths(np.array([1.0]), np.array([0.5]), zero)
    # half of the edges on top are 0.5 long, the others, diagonals, 0.71
    found = tightened(points, tets, part, top, asked, asked)
    assert found is not None
    assert found.of_patch == pytest.approx([0.5 * TIGHTER])
    assert found.of_part == pytest.approx([1.0])
    assert (
        tightened(points, tets, part, top, Lengths(asked.of_part, asked.of_part, zero), asked)
        is None
    )
    short = Lengths(np.array([0.5]), np.array([1.0]), zero)
    found = tightened(points, tets, part, top, short, short)
    assert found is not None
    assert found.of_part == pytest.approx([0.5 * TIGHTER])
