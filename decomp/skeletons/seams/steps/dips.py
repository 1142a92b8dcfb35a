"""What comes nearer than a seam's own sites on a short stretch in the middle of a step, compiled.

How much farther another site is than the seam's own falls and grows again along the step. Where
two seams overlap by a small d this gap is below zero on a stretch of the order of the root of d,
which a step leads across with nothing to be seen at its ends but the gap's slopes. Where d is
below the tolerance both touch: along either the other's site counts as never nearer.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from decomp.kernels.compiled import inner, spliced
from decomp.sites.octree import locate
from decomp.skeletons.balls.probing import APART, Probe, candidate_foot, inside, nearest
from decomp.skeletons.balls.supports import SupportTable
from decomp.skeletons.seams.steps.stepping import Track, advance
from decomp.tolerance import TOLERANCE

PLACES = 4
"""Candidates are those of the leaves at so many places along the step, with its ends."""
ROUNDS = 60
"""Most places at which the least gap is looked for."""
INWARDS = 0.05
"""The next place is at least this part of the interval inside it."""
FARTHEST = 2.0
"""How fast a gap can change along a seam."""


class Dip(NamedTuple):
    """A step on which a candidate's gap may fall and grow again.

    Args:
        candidate: its number.
        length: of the step.
        gap, slope: where it begins.
        far_gap, far_slope: where it ends.
    """

    candidate: int
    length: float
    gap: float
    slope: float
    far_gap: float
    far_slope: float


@inner
def dip_on(
    table: SupportTable, probe: Probe, track: Track, here: int, row: int, length: float
) -> float:
    """Where, on a step, something is nearer than the seam's sites though it is at neither end.

    Args:
        table: supports.
        probe: queries.
        track: holds the seam's points; the row behind `row` is overwritten.
        here: row in which the step begins.
        row: in which it ends, behind that.
        length: of the step.

    Returns:
        A length of a step from row `here` at whose end something is nearer, 0 if there is none.
    """
    before = -1
    for place in range(PLACES):
        u = place / (PLACES - 1.0)
        leaf = locate(
            probe.candidates.tree,
            track.points[here, 0] + u * (track.points[row, 0] - track.points[here, 0]),
            track.points[here, 1] + u * (track.points[row, 1] - track.points[here, 1]),
            track.points[here, 2] + u * (track.points[row, 2] - track.points[here, 2]),
        )
        if leaf < 0 or leaf == before:
            continue
        before = leaf
        for m in range(probe.candidates.first[leaf], probe.candidates.first[leaf + 1]):
            k = probe.candidates.items[m]
            known, gap, slope = gap_to(probe, k, track, here)
            if known or slope >= 0.0 or gap > FARTHEST * length:
                continue
            known, far_gap, far_slope = gap_to(probe, k, track, row)
            if known or far_slope <= 0.0:
                continue
            dip = Dip(k, length, gap, slope, far_gap, far_slope)
            found = _nearer(table, probe, track, here, row + 1, dip)
            if found > 0.0:
                return found
    return 0.0


@inner
def gap_to(probe: Probe, k: int, track: Track, row: int) -> tuple[bool, float, float]:
    """How much farther candidate k is than the sites of the seam's point in a row.

    Returns:
        Whether its foot is one of the point's own; the gap; and its slope along the seam.
    """
    x, y, z = track.points[row, 0], track.points[row, 1], track.points[row, 2]
    qx, qy, qz = candidate_foot(probe, k, x, y, z)
    radius, feet, count = track.radius[row], track.contacts.feet, track.contacts.count
    for c in range(row * count, row * count + count):
        dx, dy, dz = qx - feet[c, 0], qy - feet[c, 1], qz - feet[c, 2]
        if dx * dx + dy * dy + dz * dz <= (APART * radius) ** 2:
            return True, 0.0, 0.0
    wx, wy, wz = x - qx, y - qy, z - qz
    away = sqrt(wx * wx + wy * wy + wz * wz)
    along = wx * track.tangents[row, 0] + wy * track.tangents[row, 1] + wz * track.tangents[row, 2]
    if away <= 0.0:
        return True, 0.0, 0.0
    return False, away - radius, along / away - track.slopes[row]


@spliced
def only_touches(probe: Probe, track: Track, here: int, row: int, length: float) -> bool:
    """Whether what is nearer at a row than the seam's sites is so by no more than the tolerance.

    All along the dip, whose depth is that of a parabola: its gap is known in the row, and its
    slopes there and a length before, in row `here`.
    """
    x, y, z = track.points[row, 0], track.points[row, 1], track.points[row, 2]
    hit, zero = nearest(probe, x, y, z), TOLERANCE * track.contacts.size
    if hit.distance < track.radius[row] - zero:
        return False
    before, _, slope = gap_to(probe, hit.candidate, track, here)
    known, gap, far_slope = gap_to(probe, hit.candidate, track, row)
    if before or known:
        return False
    bend = (far_slope - slope) / length
    return bool(bend > 0.0 and gap - far_slope**2 / (2.0 * bend) >= -zero)


@spliced
def _nearer(
    table: SupportTable, probe: Probe, track: Track, here: int, spare: int, dip: Dip
) -> float:
    """The length of a step at whose end a candidate is nearer than the seam's sites, 0 if none.

    Args:
        table, probe, track, here: as above.
        spare: a row for points in between.
        dip: of the candidate; its gap falls where the step begins and grows where it ends.
    """
    low, high = 0.0, dip.length
    gap, slope, far_gap, far_slope = dip.gap, dip.slope, dip.far_gap, dip.far_slope
    zero = TOLERANCE * track.contacts.size
    for _ in range(ROUNDS):
        # where the tangents at both ends meet; a gap that bends upwards is above them
        way = high - low
        bound = gap + slope * (far_gap - gap - far_slope * way) / (slope - far_slope)
        if bound > -zero:
            return 0.0
        share = slope / (slope - far_slope)
        middle = low + min(max(share, INWARDS), 1.0 - INWARDS) * way
        if not low < middle < high:
            return 0.0
        if not advance(table, track, here, spare, middle, True):
            return 0.0
        known, least, turn = gap_to(probe, dip.candidate, track, spare)
        if known:
            return 0.0
        if least < -zero:
            x, y, z = track.points[spare, 0], track.points[spare, 1], track.points[spare, 2]
            if not inside(probe, x, y, z):
                return 0.0
            nearer = nearest(probe, x, y, z).distance < track.radius[spare] - zero
            return middle if nearer else 0.0
        if turn < 0.0:
            low, gap, slope = middle, least, turn
        else:
            high, far_gap, far_slope = middle, least, turn
    return 0.0
