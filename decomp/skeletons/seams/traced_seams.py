"""Seams of a graph out of traces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from decomp.skeletons.seams.seam_graph_model import Node, Seam
from decomp.skeletons.seams.steps.states import Traced
from decomp.tolerance import AT_END, TINY
from decomp.vectors import Array, Bools, dot, norm


def seam_between(
    traced: Traced, ends: tuple[int, int], first: Node, last: Node, size: float
) -> Seam:
    """A seam with its nodes' points put at its ends."""
    plain = seam_of(traced, ends)
    half = _on_first_half(plain.points)
    clear = np.concatenate(
        [
            _before(plain.points[:half][::-1], first, size)[::-1],
            _before(plain.points[half:], last, size),
        ]
    )
    inner = np.flatnonzero(clear)
    if not len(inner) and first is not last:
        plain = _halfway(plain, first.point, last.point)
        inner = np.array([0])
    if not len(inner):
        inner = np.array([min(half, len(plain.points) - 1)])
    a, b = inner[0], inner[-1]
    return Seam(
        np.concatenate([first.point[None], plain.points[inner], last.point[None]]),
        np.concatenate([[first.radius], plain.radius[inner], [last.radius]]),
        (plain.sites[a], *(plain.sites[k] for k in inner), plain.sites[b]),
        np.concatenate(
            [
                _feet_at(first, plain.feet[a])[None],
                plain.feet[inner],
                _feet_at(last, plain.feet[b])[None],
            ]
        ),
        ends,
    )


def _halfway(seam: Seam, first: Array, last: Array) -> Seam:
    """The point of a seam half way between its nodes, where all others are at one of them.

    A chord so short is the seam to rounding.
    """
    row = len(seam.points) // 2
    point = (first + last) / 2
    radius = seam.radius[row : row + 1]
    return Seam(point[None], radius, (seam.sites[row],), seam.feet[row : row + 1], seam.ends)


def _on_first_half(points: Array) -> int:
    """How many of points (k, 3) along a curve are on its first half, by length.

    They crowd at an end beside which steps become short.
    """
    along = np.concatenate([[0.0], np.cumsum(norm(np.diff(points, axis=0)))])
    return int(np.count_nonzero(2 * along <= along[-1]))


def _before(points: Array, node: Node, size: float) -> Bools:
    """Which points (k, 3) of a seam come before the node at its end.

    Where contacts run together a seam is followed past its end a little, or rounding moves it to
    and fro beside the node. A step can lead past the node, too.
    """
    near = norm(points - node.point) <= AT_END * size
    way, before = np.diff(points, axis=0), node.point - points[:-1]
    part = dot(before, way) / np.maximum(dot(way, way), TINY)
    off = norm(before - part[:, None] * way)
    near[1:] |= (part > 0) & (part <= 1) & (off <= AT_END * size)
    return np.asarray(np.cumsum(near) == 0)


def joined(back: Traced, forward: Traced) -> Traced:
    """One trace out of two that start at the same point."""
    turned = [
        replace(run, points=run.points[::-1], radius=run.radius[::-1], feet=run.feet[::-1])
        for run in reversed(back.runs)
    ]
    meeting, start = turned[-1], forward.runs[0]
    middle = replace(
        start,
        points=np.concatenate([meeting.points, start.points[1:]]),
        radius=np.concatenate([meeting.radius, start.radius[1:]]),
        feet=np.concatenate([meeting.feet, start.feet[1:]]),
    )
    return replace(forward, runs=(*turned[:-1], middle, *forward.runs[1:]))


def seam_of(traced: Traced, ends: tuple[int, int] | None) -> Seam:
    """A seam of all runs."""
    runs = [run for run in traced.runs if len(run.points)]
    points = np.concatenate([run.points for run in runs])
    radius = np.concatenate([run.radius for run in runs])
    feet = np.concatenate([run.feet for run in runs])
    sites = tuple(run.sites for run in runs for _ in range(len(run.points)))
    # two runs with the same sites share a point that need not stand twice
    keep = np.ones(len(points), dtype=np.bool_)
    for k in range(1, len(points)):
        keep[k] = sites[k] != sites[k - 1] or bool((points[k] != points[k - 1]).any())
    rows = np.flatnonzero(keep)
    return Seam(points[rows], radius[rows], tuple(sites[k] for k in rows), feet[rows], ends)


def _feet_at(node: Node, feet: Array) -> Array:
    """The feet (m, 3) at a node that continue those of a seam."""
    return np.asarray(node.feet[np.argmin(norm(feet[:, None] - node.feet[None]), axis=1)])
