"""Whether points lie on seams that are already known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.tracing.equidistance import balanced
from decomp.tracing.seam_graph_model import Seam
from decomp.tracing.supports import SupportTable
from decomp.vectors import Array, Bools, Ints, dot, norm

ASIDE = 0.2
"""How far a seam may stand out from its chord, as a part of the chord."""
NEAR = 1e-5
"""Points nearer to a seam than this part of the size may lie on it."""
FEET = 1e-2
"""Feet nearer to each other than this part of the radius may be the same."""


def on_seams(
    table: SupportTable, size: float, seams: Sequence[Seam], points: Array, feet: Array
) -> Bools:
    """Whether points (k, 3) with some feet (k, j, 3) lie on one of some seams.

    Chords near a point are looked for first; then it is put onto the seam exactly, whose feet there
    must be among its own.
    """
    known = np.zeros(len(points), dtype=np.bool_)
    if not len(points) or not seams:
        return known
    tasks: dict[int, list[tuple[int, tuple[int, ...], Array]]] = {}
    for seam in seams:
        line, at = seam.points, seam.feet
        if seam.ends is None:
            line, at = np.concatenate([line, line[:1]]), np.concatenate([at, at[:1]])
        way = np.diff(line, axis=0)
        chord = norm(way)
        room = ASIDE * chord.max() + NEAR * size
        within = np.all(
            (points >= line.min(axis=0) - room) & (points <= line.max(axis=0) + room), axis=1
        )
        for k in np.flatnonzero(within & ~known):
            along = dot(points[k] - line[:-1], way) / np.maximum(chord**2, 1e-300)
            along = np.clip(along, 0, 1)
            gap = norm(points[k] - line[:-1] - along[:, None] * way)
            close = np.flatnonzero(gap <= ASIDE * chord + NEAR * size)
            for i in close[np.argsort(gap[close])][:2]:
                sites = seam.sites[int(i)]
                spot = at[i] + along[i] * (at[i + 1] - at[i])
                tasks.setdefault(len(sites), []).append((int(k), sites, spot))
    for listed in tasks.values():
        rows: Ints = np.array([k for k, _, _ in listed])
        which = np.array([sites for _, sites, _ in listed])
        found = balanced(table, size, which, points[rows], np.array([f for _, _, f in listed]))
        apart = norm(feet[rows][:, :, None] - found.feet[:, None]).min(axis=2)
        same = (apart <= FEET * found.radius[:, None] + NEAR * size).all(axis=1)
        same &= found.converged & (norm(found.points - points[rows]) <= NEAR * size)
        known[rows[same]] = True
    return known
