"""Tetrahedra with small angles give way to better ones of the same space."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay  # type: ignore[import-untyped]

from decomp.meshes.faces import faces_of, is_complex, least_dihedral, volumes
from decomp.meshing.repairs.flipping import WANTED, flipped
from decomp.meshing.repairs.rings import LARGEST_RING
from decomp.vectors import Array, Ints

NO_TRIANGLES = np.empty((0, 3), dtype=np.int64)


def scattered(seed: int, count: int = 40) -> tuple[Array, Ints]:
    """Random points and their Delaunay tetrahedra, most of which are bad."""
    points = np.random.default_rng(seed).random((count, 3))
    tets = Delaunay(points).simplices.astype(np.int64)
    turned = volumes(points, tets) < 0
    tets[turned] = tets[turned][:, [1, 0, 2, 3]]
    return points, tets[np.abs(volumes(points, tets)) > 1e-12]


def around_an_edge(count: int) -> tuple[Array, Ints]:
    """Tetrahedra around an edge along z that passes close to a side of its ring."""
    turn = 2 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    near = 0.98 * ring[:2].mean(axis=0)
    up = np.array([0.0, 0.0, 1.0])
    points = np.concatenate([[near - up, near + up], ring])
    k = np.arange(count)
    zero = np.zeros(count, dtype=np.int64)
    return points, np.stack([zero, zero + 1, 2 + k, 2 + (k + 1) % count], axis=1)


def keys(triangles: Ints) -> set[tuple[int, ...]]:
    return {tuple(row) for row in np.sort(triangles, axis=1).tolist()}


def hull(tets: Ints) -> set[tuple[int, ...]]:
    faces = faces_of(tets)
    return keys(faces.triangles[faces.tets[:, 1] < 0])


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6))
def test_space_hull_and_kept_triangles_stay_and_angles_get_better(seed: int) -> None:
    points, tets = scattered(seed)
    faces = faces_of(tets)
    part = (points[tets].mean(axis=1)[:, 0] > 0.5).astype(np.int64)
    sides = part[faces.tets]
    kept = faces.triangles[(faces.tets[:, 1] < 0) | (sides[:, 0] != sides[:, 1])]
    found = flipped(points, tets, part, kept)
    if found is None:
        return
    new, new_part = found
    assert (volumes(points, new) > 0).all()
    assert hull(new) == hull(tets)
    assert keys(kept) <= keys(faces_of(new).triangles)
    for number in (0, 1):
        before = volumes(points, tets[part == number]).sum()
        after = volumes(points, new[new_part == number]).sum()
        assert after == pytest.approx(before, rel=1e-12)
    old_angles = least_dihedral(points, tets)
    assert least_dihedral(points, new).min() >= old_angles.min()


def test_some_scattered_tetrahedra_are_exchanged() -> None:
    points, tets = scattered(1)
    part = np.zeros(len(tets), dtype=np.int64)
    found = flipped(points, tets, part, NO_TRIANGLES)
    assert found is not None
    before, after = (np.count_nonzero(least_dihedral(points, t) < WANTED) for t in (tets, found[0]))
    assert after < before


@pytest.mark.parametrize("count", [3, 4, 5, 6, LARGEST_RING])
def test_an_edge_goes_that_passes_close_to_its_ring(count: int) -> None:
    points, tets = around_an_edge(count)
    part = np.zeros(count, dtype=np.int64)
    found = flipped(points, tets, part, NO_TRIANGLES)
    assert found is not None
    assert len(found[0]) == 2 * (count - 2)
    assert not ((found[0] == 0).any(axis=1) & (found[0] == 1).any(axis=1)).any()
    assert least_dihedral(points, tets).min() < 3 < 20 < least_dihedral(points, found[0]).min()


@pytest.mark.parametrize("count", [3, LARGEST_RING])
def test_an_edge_on_a_patch_stays(count: int) -> None:
    points, tets = around_an_edge(count)
    assert flipped(points, tets, np.zeros(count, dtype=np.int64), tets[:1, :3]) is None


def test_an_edge_between_parts_stays() -> None:
    points, tets = around_an_edge(4)
    assert flipped(points, tets, np.array([0, 0, 1, 1]), NO_TRIANGLES) is None


def test_no_triangle_comes_twice_where_tetrahedra_lie_over_each_other() -> None:
    """Two flat ones give way to three around an edge, unless that has a triangle elsewhere."""
    turn = 2 * np.pi * np.arange(3) / 3
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    points = np.concatenate([ring, [[0, 0, -0.05], [0, 0, 0.05], [0.5, 1, 1]]])
    flat = np.array([[0, 2, 1, 3], [0, 1, 2, 4]])
    other = np.array([[3, 4, 0, 5]])
    for tets, exchanged in ((flat, True), (np.concatenate([flat, other]), False)):
        sound = np.where((volumes(points, tets) > 0)[:, None], tets, tets[:, [1, 0, 2, 3]])
        part = np.zeros(len(sound), dtype=np.int64)
        found = flipped(points, sound, part, NO_TRIANGLES)
        assert (found is not None) == exchanged
        assert is_complex(sound if found is None else found[0])
