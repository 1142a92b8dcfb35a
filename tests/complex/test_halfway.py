"""The middle of an edge, on the way along its surface."""

from __future__ import annotations

import numpy as np
import pytest

from decomp.complex.halfway import MIDDLE, halfway
from decomp.complex.many_elements import Elements
from decomp.complex.model import Complex, Patch, PatchKind
from decomp.vectors import Array, Ints, norm

TURN = np.radians([170.0, 100.0, 20.0])


class Pipe:
    """A cylinder of radius 1 about the z axis."""

    def place(self, points: Array) -> Array:
        moved = np.array(points)
        moved[:, :2] /= norm(points[:, :2])[:, None]
        return moved

    def normal(self, points: Array) -> Array:
        return self.place(points) * [1, 1, 0]


@pytest.fixture
def pipe() -> Elements:
    points = np.array([[1.0, 0, 0], [0, 1, 0], [0, 1, 1]])
    triangles: Ints = np.array([[0, 1, 2]])
    return Elements(Complex(points, (Patch(PatchKind.FACE, Pipe(), triangles),), ()))


def test_the_middle_is_on_the_surface_and_as_far_from_both_ends(pipe: Elements) -> None:
    """Also where the ends are so far apart that the chord passes close to the axis."""
    ends = np.zeros((len(TURN), 2, 3))
    ends[:, 0, 0] = 1
    ends[:, 1] = np.stack([np.cos(TURN), np.sin(TURN), np.full(len(TURN), 0.3)], axis=1)
    found = halfway(pipe, np.zeros(len(TURN), dtype=np.int64), ends)
    assert norm(found[:, :2]) == pytest.approx(1, abs=1e-15)
    to_one, to_other = norm(found - ends[:, 0]), norm(found - ends[:, 1])
    length = norm(ends[:, 1] - ends[:, 0])
    assert (np.abs(to_one - to_other) <= MIDDLE * length).all()
    # on the short way round
    assert np.arctan2(found[:, 1], found[:, 0]) == pytest.approx(TURN / 2, abs=0.1)


def test_where_no_way_leads_there_is_no_middle(pipe: Elements) -> None:
    """The other end is straight across: no direction on the surface leads there."""
    ends = np.array([[[1.0, 0, 0], [-1.0, 0, 0]]])
    assert np.isnan(halfway(pipe, np.zeros(1, dtype=np.int64), ends)).all()
