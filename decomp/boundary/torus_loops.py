"""How loops wind on a torus.

Angles: `around` its axis and `tube` in the tube; along the outward normal (around, tube) is a
right-handed pair. Loops are unwrapped along their samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.edges import RawEdge
from decomp.boundary.loops import HalfEdge
from decomp.carriers import Torus
from decomp.carriers.axial import axial_split
from decomp.vectors import Array, dot, frame

SAMPLES_PER_EDGE = 129


@dataclass(frozen=True, eq=False)
class Winding:
    """A loop unwrapped in the torus's two angles.

    Args:
        angles: (n, 2) unwrapped (around, tube) of samples; the first and last are one point.
        turns: full turns (around, tube) that the loop makes.
    """

    angles: Array
    turns: tuple[int, int]


def torus_angles(torus: Torus, points: Array) -> Array:
    """Angles (n, 2) around the axis and in the tube of points on a torus."""
    x, y = frame(torus.axis)
    z, rho, radial = axial_split(points, torus.centre, torus.axis)
    around = np.arctan2(dot(radial, y), dot(radial, x))
    return np.stack([around, np.arctan2(z, rho - torus.major)], axis=-1)


def winding(
    torus: Torus, edges: Sequence[RawEdge], loop: Sequence[HalfEdge], outward: int
) -> Winding:
    """Unwrap a loop; it runs so that its face is on the left along the torus's own normal."""
    pieces = []
    for half in loop:
        points = edges[half.edge].sampled(SAMPLES_PER_EDGE)
        pieces.append(points if half.direction > 0 else points[::-1])
    if outward < 0:
        pieces = [piece[::-1] for piece in reversed(pieces)]
    angles = np.unwrap(torus_angles(torus, np.concatenate(pieces)), axis=0)
    around, tube = np.rint((angles[-1] - angles[0]) / (2 * np.pi)).astype(int)
    return Winding(angles, (int(around), int(tube)))


def encloses_nothing(loop: Winding) -> bool:
    """Whether a loop can be shrunk to a point only through what is not its face."""
    if loop.turns != (0, 0):
        return False
    u, v = loop.angles.T
    signed_area = float(np.sum(u * np.roll(v, -1) - v * np.roll(u, -1))) / 2
    return signed_area < 0


def genus(loops: Sequence[Winding]) -> int:
    """Genus of the face bounded by some loops on a torus: 1 if it holds both ways around."""
    return int(all(encloses_nothing(loop) for loop in loops))
