"""Removing vertices inside patches while error, normals and topology allow.

A vertex v is moved onto a neighbour u: the two triangles that they share vanish, the others of v
get u as their corner. The link condition keeps the patch what it is: u and v have just two common
neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.complex.refining.changing_mesh import Mesh, found, pair_keys
from decomp.complex.refining.choose import independent, ranks
from decomp.complex.refining.errors_of import edge_errors, triangle_errors
from decomp.complex.refining.flips import UPRIGHT, flip, next_half
from decomp.complex.refining.split import spans
from decomp.vectors import Array, Bools, Ints, cross, dot

NEIGHBOURS_TRIED = 3
"""So many neighbours, the most promising ones, are tried for each vertex."""

COLLAPSING_ROUNDS = 2000
UNDER_EDGE = 1e-9
"""A corner lies beyond the edge opposite only if it does by more than this part of the area."""


@dataclass(frozen=True, eq=False)
class Moves:
    """Moves of vertices v (n,) onto neighbours u (n,), and the triangles that they make.

    Args:
        move: (k,) the move that makes a triangle.
        old: (k,) the triangle whose place it takes.
        w, x: (k,) its corners besides u.
        height: (n,) distance of v from the new triangle over or under it, infinite where the move
            is not allowed.
    """

    v: Ints
    u: Ints
    move: Ints
    old: Ints
    w: Ints
    x: Ints
    height: Array


def collapse(mesh: Mesh) -> int:
    """Remove vertices until none can go, flipping edges in between; how many went."""
    tried = np.zeros(len(mesh.points), dtype=np.int64)
    around = np.zeros(len(mesh.points), dtype=np.int64)
    total = 0
    for _ in range(COLLAPSING_ROUNDS):
        order, starts = stars(mesh)
        now = _signatures(mesh, order, starts)
        tried[now != around] = 0
        around = now
        able = inner_vertices(mesh, starts) & (tried < NEIGHBOURS_TRIED)
        if not able.any():
            break
        count = _round(mesh, able, tried, order, starts)
        total += count
        if count:
            flip(mesh)
    return total


def stars(mesh: Mesh) -> tuple[Ints, Ints]:
    """Half-edges grouped by the vertex that they leave, and where each vertex's group begins."""
    flat = mesh.triangles.ravel()
    order = np.argsort(flat, kind="stable")
    return order, np.searchsorted(flat[order], np.arange(len(mesh.points) + 1))


def inner_vertices(mesh: Mesh, starts: Ints) -> Bools:
    """Which vertices have a full ring of triangles of one patch around them, and no line."""
    edges = mesh.edges
    inner = starts[1:] > starts[:-1]
    odd = (edges.owner < 0) | (edges.sides != 2)
    inner[edges.ends[odd]] = False
    inner[mesh.path] = False
    degree = np.bincount(edges.ends.ravel(), minlength=len(mesh.points))
    return np.asarray(inner & (degree == starts[1:] - starts[:-1]))


def _signatures(mesh: Mesh, order: Ints, starts: Ints) -> Ints:
    """A number for each vertex that changes when its triangles do."""
    mixed = np.sort(mesh.triangles, axis=1) @ np.array([0x9E3779B97F4A7, 0xC2B2AE3D27D4F, 1])
    mixed ^= mixed >> 23
    sums = np.concatenate([[0], np.cumsum(mixed[order // 3])])
    return np.asarray(sums[starts[1:]] - sums[starts[:-1]])


def _round(mesh: Mesh, able: Bools, tried: Ints, order: Ints, starts: Ints) -> int:
    """Try the next neighbour of each able vertex; make the moves that are good and apart."""
    moves = _moves(mesh, able, order, starts)
    by = np.lexsort((moves.height, moves.v))
    place = np.arange(len(by)) - np.searchsorted(moves.v[by], moves.v[by])
    pick = by[place == tried[moves.v[by]]]
    hopeless = ~np.isfinite(moves.height[pick])
    tried[moves.v[pick[hopeless]]] = NEIGHBOURS_TRIED
    pick = pick[~hopeless]

    # of vertices whose stars touch only one can go
    sizes = starts[moves.v[pick] + 1] - starts[moves.v[pick]]
    item = np.repeat(np.arange(len(pick)), sizes)
    ring = mesh.triangles.ravel()[next_half(order[spans(starts[moves.v[pick]], sizes)])]
    items = np.concatenate([np.arange(len(pick)), item])
    things = np.concatenate([moves.v[pick], ring])
    rank = ranks(moves.height[pick], pick)
    pick = pick[independent(len(pick), items, things, rank)]
    worst, error, upright = _judge(mesh, moves, pick)
    good = worst <= 1.0
    tried[moves.v[pick[~good]]] += 1
    pick = pick[good]
    if len(pick) == 0:
        return 0
    made = np.zeros(len(moves.v), dtype=bool)
    made[pick] = True
    k = np.flatnonzero(made[moves.move])
    mesh.set_triangles(moves.old[k], np.stack([moves.u[moves.move], moves.w, moves.x], axis=1)[k])
    mesh.error[moves.old[k]], mesh.upright[moves.old[k]] = error[k], upright[k]
    gone = np.zeros(len(mesh.points), dtype=bool)
    gone[moves.v[pick]] = True
    mesh.drop_triangles(np.flatnonzero(gone[mesh.triangles].any(axis=1)))
    mesh.connect()
    return len(pick)


def _moves(mesh: Mesh, able: Bools, order: Ints, starts: Ints) -> Moves:
    """All moves of able vertices onto neighbours."""
    flat = mesh.triangles.ravel()
    half = np.flatnonzero(able[flat])
    v, u = flat[half], flat[next_half(half)]
    sizes = starts[v + 1] - starts[v]
    move = np.repeat(np.arange(len(v)), sizes)
    out = order[spans(starts[v], sizes)]
    w, x = flat[next_half(out)], flat[next_half(next_half(out))]
    _, joined = found(mesh.edges.pairs, pair_keys(u[move], w))
    common = np.bincount(move[joined & (w != u[move])], minlength=len(v))
    stays = (w != u[move]) & (x != u[move]) & (common == 2)[move]
    move, out, w, x = move[stays], out[stays], w[stays], x[stays]

    # the line through v along its mean normal meets one of the new triangles
    p = mesh.points
    normals = cross(p[flat[next_half(half)]] - p[v], p[flat[next_half(next_half(half))]] - p[v])
    mean = np.zeros_like(p)
    np.add.at(mean, v, normals)
    n, a = mean[v[move]], p[v[move]]
    b, c, d = p[u[move]] - a, p[w] - a, p[x] - a
    area = dot(cross(c - b, d - b), n)
    least = np.minimum(np.minimum(dot(cross(b, c), n), dot(cross(c, d), n)), dot(cross(d, b), n))
    under = least >= -UNDER_EDGE * np.abs(area)
    volume = np.abs(dot(b, cross(c, d)))
    size = np.sqrt(dot(n, n))
    height = np.full(len(v), np.inf)
    seen = np.flatnonzero(under & (area > 0))
    np.minimum.at(height, move[seen], volume[seen] * size[seen] / area[seen])
    folded = np.zeros(len(v), dtype=bool)
    folded[move[area <= 0]] = True
    height[folded | (height > mesh.allowed[half // 3])] = np.inf
    return Moves(v, u, move, out // 3, w, x, height)


def _judge(mesh: Mesh, moves: Moves, pick: Ints) -> tuple[Array, Array, Array]:
    """Errors of moves: the largest error (picks,) that each makes, infinite if a triangle leans.

    Also the error of each triangle (k,) of `moves`, and how upright it is, where measured.
    """
    worst = np.full(len(moves.v), np.inf)
    worst[pick] = 0.0
    points, u = mesh.points, moves.u[moves.move]
    k = np.flatnonzero(np.isfinite(worst)[moves.move])
    k = k[_fresh_edge(mesh, moves, k)]
    element = mesh.surface[moves.old[k]]
    ends = points[np.stack([u[k], moves.w[k]], axis=1)]
    allowed = mesh.allowed[moves.old]
    error, _ = edge_errors(mesh.elements, element, ends, allowed[k])
    np.maximum.at(worst, moves.move[k], error / allowed[k])
    worst[worst > 1.0] = np.inf

    upright, inside = np.full(len(u), np.nan), np.full(len(u), np.nan)
    k = np.flatnonzero(np.isfinite(worst)[moves.move])
    corners = points[np.stack([u[k], moves.w[k], moves.x[k]], axis=1)]
    inside[k], upright[k] = triangle_errors(mesh.elements, mesh.surface[moves.old[k]], corners)
    inside[k] /= allowed[k]
    np.maximum.at(worst, moves.move[k], np.where(upright[k] < UPRIGHT, np.inf, inside[k]))
    return worst[pick], inside, upright


def _fresh_edge(mesh: Mesh, moves: Moves, k: Ints) -> Bools:
    """Whether the edge from u to w is new: another triangle of the same move has it too."""
    flags = moves.move * len(mesh.points)
    second = np.sort(flags[k] + moves.x[k])
    return found(second, flags[k] + moves.w[k])[1]
