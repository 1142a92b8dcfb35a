"""Splits: a vertex at the exact middle of an edge, or at the centre of a triangle."""

from __future__ import annotations

import numpy as np

from decomp.complex.flips import UPRIGHT, twins
from decomp.complex.refine_choose import independent, ranks
from decomp.complex.refine_mesh import Mesh
from decomp.errors import GeometryError
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, Ints, norm, place


def split_lines(mesh: Mesh) -> int:
    """Split segments that are too far from their curve, at most one in each triangle.

    Returns:
        How many were split; those that remain have to wait for the next call.
    """
    edges = mesh.edges
    bad = np.flatnonzero((edges.owner < 0) & (edges.error > mesh.limit))
    return _split_edges(mesh, bad, edges.error[bad])


def split_inside(mesh: Mesh) -> int:
    """Split an edge of each triangle that is too far from its surface, leans, or has a bad edge.

    Where an edge is too far off the worst one is split, else the longest; preferably one inside the
    patch, and if there is none the triangle itself, at its centre.

    Returns:
        How many edges and triangles were split.
    """
    edges = mesh.edges
    sides = edges.of_half[: 3 * len(mesh.triangles)].reshape(-1, 3)
    error = edges.error[sides]
    error[(edges.owner < 0)[sides]] = 0.0
    bad_side = error.max(axis=1, initial=0.0) > mesh.limit
    bad = bad_side | (mesh.error > mesh.limit) | (mesh.upright < UPRIGHT)
    t = np.flatnonzero(bad)
    if len(t) == 0:
        return 0
    ends = mesh.points[edges.ends[sides[t]]]
    length = norm(ends[:, :, 1] - ends[:, :, 0])
    inside = (edges.owner >= 0)[sides[t]]
    wanted = np.where(inside, length, 0.3 * length)
    score = np.where(bad_side[t][:, None], error[t], wanted)
    k = np.argmax(score, axis=1)
    alone = ~inside.any(axis=1)
    _check_size(mesh, t, length.max(axis=1))
    if alone.any():
        return _split_triangles(mesh, t[alone])
    edge, first = np.unique(sides[t, k], return_index=True)
    weight = np.maximum(edges.error[edge], mesh.error[t[first]])
    return _split_edges(mesh, edge, weight)


def split_twins(mesh: Mesh) -> int:
    """Part patches that touch: edges inside of them, or triangles, with the same vertices.

    Of those that coincide the one farthest from its chord is split.

    Raises:
        GeometryError: they coincide with their chords, so that splitting does not part them.
    """
    edges = mesh.edges
    which = np.flatnonzero(twins(mesh))
    if len(which):
        pairs = edges.ends[which]
        _, group = np.unique(pairs, axis=0, return_inverse=True)
        order = np.lexsort((-edges.error[which], group))
        first = np.append(True, np.diff(group[order]) != 0)
        worst = which[order[first]]
        flat = np.flatnonzero(edges.error[worst] <= TOLERANCE * mesh.diagonal)
        if len(flat):
            raise GeometryError(
                f"two patches coincide along an edge at {_middle(mesh, worst[flat[0]])}"
            )
        return _split_edges(mesh, worst, edges.error[worst])
    corners = np.sort(mesh.triangles, axis=1)
    order = np.lexsort((-mesh.error, *corners.T))
    same = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    if not same.any():
        return 0
    first = np.append(same, False) & ~np.insert(same, 0, False)
    worst = order[first]
    flat = np.flatnonzero(mesh.error[worst] <= TOLERANCE * mesh.diagonal)
    if len(flat):
        centre = mesh.points[mesh.triangles[worst[flat[0]]]].mean(axis=0)
        raise GeometryError(f"two triangles coincide at {place(centre)}")
    return _split_triangles(mesh, worst)


def _middle(mesh: Mesh, edge: int) -> str:
    return place(mesh.points[mesh.edges.ends[edge]].mean(axis=0))


def _check_size(mesh: Mesh, triangles: Ints, longest: Array) -> None:
    """No triangle below the chord tolerance can need a split, unless it is folded."""
    small = np.flatnonzero(longest < 0.1 * mesh.limit)
    if len(small):
        t = triangles[small[0]]
        centre = mesh.points[mesh.triangles[t]].mean(axis=0)
        name = mesh.elements.names[int(mesh.surface[t])]
        raise GeometryError(f"{name} stays folded or torn at {place(centre)}")


def _split_edges(mesh: Mesh, edge: Ints, weight: Array) -> int:
    """Split those of the edges that share no triangle, heaviest first."""
    if len(edge) == 0:
        return 0
    edges = mesh.edges
    sizes = edges.starts[edge + 1] - edges.starts[edge]
    item = np.repeat(np.arange(len(edge)), sizes)
    half = edges.halves[spans(edges.starts[edge], sizes)]
    inner = 3 * len(mesh.triangles)
    thing = np.where(half < inner, half // 3, half)
    chosen = independent(len(edge), item, thing, ranks(-weight, edge))
    _, curve = mesh.segments()
    new = np.full(len(edge), -1)
    some = np.flatnonzero(chosen)
    last = edges.halves[edges.starts[edge[some] + 1] - 1]
    element = np.where(
        last >= inner,
        curve[np.maximum(last - inner, 0)] if len(curve) else -1,
        mesh.surface[np.minimum(last // 3, len(mesh.triangles) - 1)] if inner else -1,
    )
    points = edges.middle[edge[some]]
    _check_new(mesh, element, points, mesh.points[edges.ends[edge[some]]])
    new[some] = mesh.add(points)

    use = chosen[item]
    half, vertex = half[use], new[item[use]]
    of_triangle = half < inner
    t, k, v = half[of_triangle] // 3, half[of_triangle] % 3, vertex[of_triangle]
    a, b, c = (mesh.triangles[t, (k + s) % 3] for s in range(3))
    at, _ = mesh.segments()
    where = at[half[~of_triangle] - inner]
    mesh.set_triangles(t, np.stack([a, v, c], axis=1))
    mesh.add_triangles(np.stack([v, b, c], axis=1), mesh.patch[t])
    mesh.path_line = np.insert(mesh.path_line, where + 1, mesh.path_line[where])
    mesh.path = np.insert(mesh.path, where + 1, vertex[~of_triangle])
    mesh.connect()
    return len(some)


def _split_triangles(mesh: Mesh, t: Ints) -> int:
    """Split triangles at the exact points over their centres."""
    corners = mesh.points[mesh.triangles[t]]
    points = mesh.elements.place(mesh.surface[t], corners.mean(axis=1))
    _check_new(mesh, mesh.surface[t], points, corners)
    v = mesh.add(points)
    a, b, c = mesh.triangles[t].T
    mesh.set_triangles(t, np.stack([a, b, v], axis=1))
    mesh.add_triangles(np.stack([b, c, v], axis=1), mesh.patch[t])
    mesh.add_triangles(np.stack([c, a, v], axis=1), mesh.patch[t])
    mesh.connect()
    return len(t)


def _check_new(mesh: Mesh, element: Ints, points: Array, near: Array) -> None:
    """New vertices must lie on their element and apart from their neighbours (k, j, 3)."""
    small = TOLERANCE * mesh.diagonal
    off: Bools = mesh.elements.gap(element, points) > small
    off |= (norm(near - points[:, None]) <= small).any(axis=1)
    if off.any():
        first = int(np.flatnonzero(off)[0])
        name = mesh.elements.names[int(element[first])]
        raise GeometryError(f"no new vertex can be placed on the {name} at {place(points[first])}")


def spans(starts: Ints, sizes: Ints) -> Ints:
    """The numbers starts[0], starts[0] + 1, ..., then from starts[1] on, and so on."""
    skip = np.repeat(starts - np.cumsum(sizes) + sizes, sizes)
    return np.asarray(np.arange(int(sizes.sum())) + skip)
