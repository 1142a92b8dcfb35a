"""What a seam with constant sites is followed with."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.kernels.compiled import inner
from decomp.kernels.records import Record
from decomp.skeletons.balls.probing import Probe
from decomp.skeletons.balls.supports import SupportTable
from decomp.skeletons.seams.steps.stepping import Track
from decomp.vectors import Array

AWAY = 3
"""So many steps lead away from home before one can lead back."""
BESIDE = 0.01
"""Home is beside a step by less than this part of its length, squared."""
ALIKE = 0.9
"""Cosine of the largest angle between tangents at home."""


@dataclass(frozen=True, eq=False)
class Course(Record):
    """A seam to follow from row 0 of a track.

    Args:
        table: of supports.
        probe: queries.
        track: filled in, as long as nothing changes.
        longest: step.
        home: first point and tangent (6,) of the whole seam.
        closable: 1 if the seam has the same sites as at `home`, else 0.
        made: steps since `home` that are not in the track.
        latest: an intruder that is as near for longer than this has joined before.
    """

    table: SupportTable
    probe: Probe
    track: Track
    longest: float
    home: Array
    closable: int
    made: int
    latest: float


@inner
def returns(course: Course, row: int) -> bool:
    """Whether the step to a row passes the seam's first point."""
    track, home = course.track, course.home
    if course.closable == 0 or row + course.made <= AWAY:
        return False
    wx = track.points[row, 0] - track.points[row - 1, 0]
    wy = track.points[row, 1] - track.points[row - 1, 1]
    wz = track.points[row, 2] - track.points[row - 1, 2]
    hx = home[0] - track.points[row - 1, 0]
    hy = home[1] - track.points[row - 1, 1]
    hz = home[2] - track.points[row - 1, 2]
    square = wx * wx + wy * wy + wz * wz
    along = (hx * wx + hy * wy + hz * wz) / square
    ox, oy, oz = hx - along * wx, hy - along * wy, hz - along * wz
    same = (
        track.tangents[row, 0] * home[3]
        + track.tangents[row, 1] * home[4]
        + track.tangents[row, 2] * home[5]
    )
    off = ox * ox + oy * oy + oz * oz
    return bool(0.0 < along <= 1.0 and off <= BESIDE * square and same > ALIKE)
