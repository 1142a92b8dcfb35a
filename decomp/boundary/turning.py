"""How much the boundary of a face turns, which must agree with what kind of face it is said to be.

By Gauss and Bonnet the integral of the Gaussian curvature over a face, that of the geodesic
curvature along its loops and the exterior angles at its corners make 2 pi times its Euler
characteristic. Both integrals are known from a field of frames on the carrier: the curvature is
how a frame turns along the loops, and the geodesic curvature how the tangent turns with it. So what
is left is how the tangent turns against the frame, in full turns, and the frame's own singular
points inside the face:

    plane       any fixed frame
    cylinder    ruling and circle
    cone        ruling and circle; the apex counts 1
    sphere      stereographic coordinates about a pole; the pole counts 2
    torus       circle of the tube and circle around

An interior angle is pi less the exterior one, and all corners of one carrier's faces at a vertex
have to fit around it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from decomp.boundary.edges import RawEdge
from decomp.boundary.faces import RawFace
from decomp.boundary.integrals import Track
from decomp.boundary.loops import HalfEdge
from decomp.carriers import Carrier
from decomp.vectors import Array, norm

BOLD = 1.0
"""A tangent that turns by more than this angle between two samples is sampled more finely."""
FINE_SAMPLES = 513
CUSP_ANGLE = 1e-3
"""A corner with an interior angle so close to 0 or 2 pi may have either."""


Sampler = Callable[[int], tuple[Array, Array]]


class Corner(NamedTuple):
    """A corner of a face: a vertex, and the interior angle there (nan at cusps)."""

    vertex: int
    angle: float


@dataclass(frozen=True)
class Turning:
    """How a face's loops turn.

    Args:
        turns: full turns of the tangent against the frame, corners included; cusps are taken as
            angles of 0.
        cusps: how many corners may have an angle of 2 pi instead, a turn less each.
        corners: where edges meet.
    """

    turns: int
    cusps: int
    corners: tuple[Corner, ...]


def sampler(edges: Sequence[RawEdge], track_of: Callable[[int], Track]) -> Sampler:
    """Points and tangents (n, 3) from the start to the end of an edge by index, each made once."""

    @cache
    def samples(index: int) -> tuple[Array, Array]:
        edge, track = edges[index], track_of(index)
        ends = edge.curve.wrapped(np.array([edge.start, edge.end]))
        tips, ways = edge.curve.point(ends), edge.curve.derivative(ends)
        if edge.curve.kind == "line":
            return tips, ways
        return (
            np.concatenate([tips[:1], track.points, tips[1:]]),
            np.concatenate([ways[:1], track.steps, ways[1:]]),
        )

    return samples


def turning(
    face: RawFace,
    carrier: Carrier,
    edges: Sequence[RawEdge],
    samples: Sampler,
    pole: Array | None,
    near: float,
) -> Turning | None:
    """How the loops of a face turn; None if samples of an edge do not tell.

    Args:
        face: the face.
        carrier: its carrier.
        edges: the region's edges.
        samples: see `sampler`.
        pole: on a sphere, a unit direction away from the edges.
        near: points closer than this to a cone's apex are it.
    """
    halves = [half for loop in face.loops for half in loop]
    sides = _angles(halves, face, carrier, edges, samples, pole, near)
    total, cusps, first = 0.0, 0, 0
    corners: list[Corner] = []
    for loop in face.loops:
        own = sides[first : first + len(loop)]
        first += len(loop)
        for half, side, following in zip(loop, own, own[1:] + own[:1], strict=True):
            steps = _wrapped(np.diff(side))
            if np.abs(steps).max(initial=0.0) > BOLD:
                return None
            total += float(steps.sum())
            turn = float(_wrapped(following[0] - side[-1]))
            edge = edges[half.edge]
            if edge.ends is None:
                total += turn
                continue
            vertex = edge.ends[1 if half.direction > 0 else 0]
            tip = samples(half.edge)[0][-1 if half.direction > 0 else 0]
            if carrier.tip is not None and float(norm(tip - carrier.tip)) <= near:
                total += np.pi  # from one ruling to the other, past the apex
            elif abs(turn) > np.pi - CUSP_ANGLE:
                total += abs(turn)
                cusps += 1
                corners.append(Corner(vertex, np.nan))
            else:
                total += turn
                corners.append(Corner(vertex, np.pi - turn))
    return Turning(round(total / (2 * np.pi)), cusps, tuple(corners))


def _angles(
    halves: Sequence[HalfEdge],
    face: RawFace,
    carrier: Carrier,
    edges: Sequence[RawEdge],
    samples: Sampler,
    pole: Array | None,
    near: float,
) -> list[Array]:
    """For each half-edge the angles (n,) of the tangent against the frame, as the face runs."""
    found = [samples(half.edge) for half in halves]
    ends = np.cumsum([len(points) for points, _ in found])[:-1]
    points = np.concatenate([points for points, _ in found])
    tangents = np.concatenate([tangents for _, tangents in found])
    one, other = carrier.in_frames(points, tangents, pole)
    parts = zip(np.split(one, ends), np.split(other, ends), strict=True)
    result = []
    for half, (along, across), (where, _) in zip(halves, parts, found, strict=True):
        angles = np.arctan2(half.direction * face.outward * across, half.direction * along)
        if np.abs(_wrapped(np.diff(angles))).max(initial=0.0) > BOLD:
            edge = edges[half.edge]
            t = edge.curve.wrapped(np.linspace(edge.start, edge.end, FINE_SAMPLES))
            where = edge.curve.point(t)
            along, across = carrier.in_frames(where, edge.curve.derivative(t), pole)
            angles = np.arctan2(half.direction * face.outward * across, half.direction * along)
        if carrier.tip is not None:  # where there is no frame
            angles = angles[norm(where - carrier.tip) > near]
        result.append(angles if half.direction > 0 else angles[::-1])
    return result


def _wrapped(angle: Array | float) -> Array:
    """Angles brought to [-pi, pi)."""
    return np.asarray(np.mod(np.asarray(angle) + np.pi, 2 * np.pi) - np.pi)
