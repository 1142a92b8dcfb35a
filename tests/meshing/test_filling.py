"""Sharp edges that were cut off: the edge x = y = 0 of the quarter space x, y > 0."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.meshes.faces import faces_of, least_dihedral, volumes
from decomp.meshing.repairs.filling import filled
from decomp.meshing.repairs.separating import separated
from decomp.meshing.surface.cells import OUTSIDE
from decomp.vectors import Array, Ints

ON_X, ON_Y, LOW, HIGH = 0, 1, 2, 3
POINTS = np.array(
    [[0, 0.2, 0.5], [0.2, 0, 0.5], [0, 0, 0], [0, 0, 1], [0.3, 0.3, 0.2], [0.3, 0.3, 0.8]]
)
CUT_OFF = np.array([[4, 5, 1, 0], [4, 0, 2, 1], [0, 1, 5, 3]])
"""Nodes of the two faces are joined, in place of the two on the edge."""


def positive(tets: Ints) -> Ints:
    turned = volumes(POINTS, tets) < 0
    return np.where(turned[:, None], tets[:, [0, 1, 3, 2]], tets)


def parts_at(places: Array) -> Ints:
    """Nearer to the face x = 0 or y = 0; on these, no region's inside."""
    part = np.where(places[:, 0] < places[:, 1], 0, 1)
    return np.where((places[:, :2] > 0).all(axis=1), part, OUTSIDE)


def test_a_notch_is_filled_and_the_sheet_comes_to_the_edge() -> None:
    tets = positive(CUT_OFF)
    notch = volumes(POINTS, np.array([[ON_X, ON_Y, LOW, HIGH]]))
    found = filled(POINTS, tets, np.array([0, 0, 1]), np.array([ON_X]), parts_at)
    assert found is not None
    new, part = found
    assert least_dihedral(POINTS, new).min() > 10
    assert volumes(POINTS, new).sum() == pytest.approx(
        volumes(POINTS, tets).sum() + abs(notch[0]), rel=1e-12
    )
    faces = faces_of(new)
    inner = faces.tets[:, 1] >= 0
    sheet = inner & (part[faces.tets[:, 0]] != part[faces.tets[:, 1]])
    assert np.unique(faces.triangles[sheet]).tolist() == [LOW, HIGH, 4, 5]
    assert filled(POINTS, new, part, np.array([ON_X]), parts_at) is None


def test_nothing_is_filled_outside_the_solid() -> None:
    def nowhere(places: Array) -> Ints:
        return np.full(len(places), OUTSIDE)

    assert filled(POINTS, positive(CUT_OFF), np.zeros(3, int), np.array([ON_X]), nowhere) is None


def test_nothing_is_filled_at_other_nodes() -> None:
    assert filled(POINTS, positive(CUT_OFF), np.zeros(3, int), np.array([HIGH]), parts_at) is None


def test_an_edge_on_the_face_is_not_cut_when_its_tetrahedra_change_cells() -> None:
    """The tetrahedra at a node of x = 0 are of the other cell up to the solid's edge."""
    beyond = POINTS + np.outer([0, 0, 0, 0, 1, 1], [0.1, -0.1, 0])
    tets = positive(np.array([[ON_X, LOW, HIGH, 4], [ON_X, HIGH, 4, 5]]))
    owner = np.zeros(1, dtype=np.int64)
    found = separated(beyond, tets, np.ones(2, dtype=np.int64), np.array([ON_X]), owner, parts_at)
    assert found is not None
    points, same, part = found
    assert len(points) == len(POINTS) + 2, "only edges to the nodes inside are cut"
    assert not (np.isin(same, [ON_X]).any(axis=1) & (part != 0)).any()
    along = (same == ON_X).any(axis=1) & (same == LOW).any(axis=1) & (same == HIGH).any(axis=1)
    assert along.any(), "the triangle on the face is whole"
