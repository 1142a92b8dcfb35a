"""Flips: the other diagonal where two triangles of a patch meet.

A flip is made when it unfolds, else when it leaves less of the area folded, else when it brings the
chord error closer to the limit, else when the error stays within the limit and the least angle
grows. No measure gets worse for the sake of a later one, but leaning, by less than LEVEL, where a
fold shrinks; after ROUNDS flipping ends in any case.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.refining.changing_mesh import BITS, PAIR, Mesh, found, pair_keys
from decomp.complex.refining.choose import independent, ranks
from decomp.complex.refining.errors_of import edge_errors, triangle_errors
from decomp.vectors import Array, Bools, Ints, cross, dot, norm

UPRIGHT = 0.2
"""A triangle is upright enough where its normal and the surface's have this inner product."""

LEANING_ALIKE = 0.02
"""Changes of leaning by less than this do not count where the folded area shrinks."""

THINNEST = 1e-6
"""Triangles with a smaller angle, in radians, are none: their vertices lie on a straight line."""

FLIPPING_ROUNDS = 60


def flip(mesh: Mesh) -> int:
    """Flip edges until no flip improves anything; the number of flips.

    Only edges of triangles that are fresh are looked at; afterwards none is.
    """
    total = 0
    for _ in range(FLIPPING_ROUNDS):
        mesh.measure()
        count = _round(mesh)
        if count == 0:
            break
        total += count
    mesh.fresh[:] = False
    return total


def excess(error: Array) -> Array:
    """By how much errors exceed what is allowed, in units of that."""
    return np.asarray(np.maximum(error - 1.0, 0.0))


def leaning(upright: Array) -> Array:
    """By how much triangles lean more than they may."""
    return np.asarray(np.maximum(UPRIGHT - upright, 0.0))


def twins(mesh: Mesh) -> Bools:
    """Which edges inside a patch join vertices that another patch or a line joins too."""
    pairs = mesh.edges.keys & PAIR
    order = np.argsort(pairs, kind="stable")
    same = pairs[order[1:]] == pairs[order[:-1]]
    twin = np.zeros(len(pairs), dtype=bool)
    twin[order[1:][same]] = True
    twin[order[:-1][same]] = True
    return twin & (mesh.edges.owner >= 0)


def least_angles(corners: Array) -> Array:
    """The least angle (k,) in radians of triangles (k, 3, 3)."""
    side = np.roll(corners, -1, axis=1) - corners
    back = -np.roll(side, 1, axis=1)
    sine, cosine = norm(cross(side, back)), dot(side, back)
    return np.asarray(np.arctan2(sine, cosine).min(axis=1))


def _round(mesh: Mesh) -> int:
    """One batch of flips that touch different triangles."""
    edges = mesh.edges
    able = np.flatnonzero((edges.owner >= 0) & (edges.sides == 2))
    h1, h2 = edges.halves[edges.starts[able]], edges.halves[edges.starts[able] + 1]
    use = mesh.fresh[h1 // 3] | mesh.fresh[h2 // 3]
    able, h1, h2 = able[use], h1[use], h2[use]
    flat = mesh.triangles.ravel()
    a, b = flat[h1], flat[next_half(h1)]
    c, d = flat[next_half(next_half(h1))], flat[next_half(next_half(h2))]
    pairs = pair_keys(c, d)
    _, exists = found(edges.pairs, pairs)
    use = (flat[h2] == b) & (c != d) & ~exists
    able, h1, h2, a, b, c, d, pairs = (x[use] for x in (able, h1, h2, a, b, c, d, pairs))
    if len(able) == 0:
        return 0

    # what is, and what would be
    t1, t2 = h1 // 3, h2 // 3
    lean = leaning(mesh.upright[t1]) + leaning(mesh.upright[t2])
    over = excess(edges.error[able]) + excess(mesh.error[t1])
    over += excess(mesh.error[t2]) + twins(mesh)[able]
    new1, new2 = np.stack([a, d, c], axis=1), np.stack([d, b, c], axis=1)
    old_angle = np.minimum(*(least_angles(mesh.points[mesh.triangles[t]]) for t in (t1, t2)))
    new_angle = np.minimum(*(least_angles(mesh.points[new]) for new in (new1, new2)))
    better = (lean > 0) | (_convex(mesh.points, a, b, c, d))
    better &= (lean > 0) | (over > 0) | (new_angle > old_angle + 1e-2)
    better &= new_angle > THINNEST

    # the cheap part of the new error first
    k = np.flatnonzero(better)
    element = mesh.surface[t1[k]]
    ends = mesh.points[np.stack([c[k], d[k]], axis=1)]
    allowed = mesh.allowed[t1[k]]
    error, middle = edge_errors(mesh.elements, element, ends, allowed)
    error = error / allowed
    some = _promising(error, lean[k], over[k])
    k, error, middle, element = k[some], error[some], middle[some], element[some]
    allowed = allowed[some]
    centres = [mesh.points[new[k]].mean(axis=1) for new in (new1, new2)]
    gap = mesh.elements.gap(np.tile(element, 2), np.concatenate(centres)).reshape(2, -1)
    some = _promising(np.stack([error, *(gap / allowed)]), lean[k], over[k])
    k, error, middle, element = k[some], error[some], middle[some], element[some]
    allowed = allowed[some]
    if len(k) == 0:
        return 0
    error1, upright1 = triangle_errors(mesh.elements, element, mesh.points[new1[k]])
    error2, upright2 = triangle_errors(mesh.elements, element, mesh.points[new2[k]])
    error1, error2 = error1 / allowed, error2 / allowed
    lean_gain = lean[k] - leaning(upright1) - leaning(upright2)
    over_gain = over[k] - sum(excess(e) for e in (error, error1, error2))
    angle_gain = new_angle[k] - old_angle[k]
    fold_gain = sum(_folded(mesh, mesh.triangles[t[k]], mesh.upright[t[k]]) for t in (t1, t2))
    fold_gain = fold_gain - _folded(mesh, new1[k], upright1) - _folded(mesh, new2[k], upright2)
    good = (lean_gain > 1e-3) | ((fold_gain > 0) & (lean_gain > -LEANING_ALIKE))
    good |= (
        (lean_gain >= 0)
        & ((over_gain > 1e-3) | ((over_gain >= 0) & (angle_gain > 1e-2)))
        & (fold_gain >= 0)
    )
    j = np.flatnonzero(good)
    waiting = np.concatenate([t1[k[j]], t2[k[j]]])
    rank = ranks(-lean_gain[j], -over_gain[j], -angle_gain[j])
    _, made = np.unique(pairs[k[j]], return_inverse=True)
    things = np.concatenate([t1[k[j]], t2[k[j]], made + len(mesh.triangles)])
    j = j[independent(len(j), np.tile(np.arange(len(j)), 3), things, rank)]
    if len(j) == 0:
        return 0

    # do it
    k = k[j]
    patch = mesh.patch[t1[k]]
    mesh.fresh[:] = False
    mesh.fresh[waiting] = True
    for t, new, e, u in ((t1, new1, error1, upright1), (t2, new2, error2, upright2)):
        mesh.set_triangles(t[k], new[k])
        mesh.error[t[k]], mesh.upright[t[k]] = e[j], u[j]
    mesh.connect()
    at, _ = found(mesh.edges.keys, ((patch + 1) << 2 * BITS) | pair_keys(c[k], d[k]))
    mesh.edges.error[at], mesh.edges.middle[at] = error[j], middle[j]
    return len(k)


def _folded(mesh: Mesh, triangles: Ints, upright: Array) -> Array:
    """Twice the areas (k,) of triangles that lie on their backs, else 0.

    A fold can reach over many triangles; flips inside it take it to its end step by step.
    """
    a, b, c = (mesh.points[triangles[:, k]] for k in range(3))
    return np.asarray(np.where(upright < 0, norm(cross(b - a, c - a)), 0.0))


def next_half(half: Ints) -> Ints:
    """The next side of the same triangle."""
    return np.asarray(np.where(half % 3 == 2, half - 2, half + 1))


def _promising(errors: Array, lean: Array, over: Array) -> Bools:
    """Whether a flip can be good for all that is known of its errors (j, k)."""
    new = excess(np.atleast_2d(errors)).sum(axis=0)
    return np.asarray((lean > 0) | (new < over) | (new == 0))


def _convex(points: Array, a: Ints, b: Ints, c: Ints, d: Ints) -> Bools:
    """Whether a, d, b, c go round a convex quadrilateral, seen along its mean normal."""
    p, q, r, s = points[a], points[b], points[c], points[d]
    normal = cross(q - p, r - p) + cross(p - q, s - q)
    one, two = cross(s - p, r - p), cross(q - s, r - s)
    return np.asarray((dot(one, normal) > 0) & (dot(two, normal) > 0))
