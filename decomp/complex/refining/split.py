"""Splits: a vertex at the exact middle of an edge, or at the centre of a triangle."""

from __future__ import annotations

import numpy as np

from decomp.complex.refining.changing_mesh import Mesh
from decomp.complex.refining.choose import independent, ranks
from decomp.complex.refining.flips import UPRIGHT, twins
from decomp.errors import GeometryError
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, Ints, norm

FOLDED = -0.5
"""A triangle whose normal has no more than this inner product with its surface's is turned over."""
STRAIGHT = 1e-9
"""An arc of less (radians) is taken for one of so much: its radius is a divisor."""


def split_lines(mesh: Mesh) -> int:
    """Split segments that are too far from their curve, at most one in each triangle.

    Returns:
        How many were split; those that remain have to wait for the next call.
    """
    edges = mesh.edges
    bad = np.flatnonzero((edges.owner < 0) & (edges.error > 1.0))
    return _split_edges(mesh, bad, edges.error[bad])


def split_inside(mesh: Mesh) -> int:
    """Split an edge of each triangle that is too far from its surface, or has an edge that is.

    Returns:
        How many edges and triangles were split.
    """
    bad = (mesh.error > 1.0) | _worst_sides(mesh)[0]
    small = bad & (_lengths(mesh).max(axis=1) < 0.1 * mesh.allowed)
    if small.any() and mesh.lenient:
        bad &= ~small
    elif small.any():
        t = int(np.flatnonzero(small)[0])
        centre = mesh.points[mesh.triangles[t]].mean(axis=0)
        name = mesh.elements.names[int(mesh.surface[t])]
        raise GeometryError(f"{name} is torn or too crooked at {{at}}", at=centre)
    return _split_some(mesh, np.flatnonzero(bad))


def split_leaning(mesh: Mesh) -> int:
    """Split an edge of each triangle that leans; how many."""
    least = FOLDED if mesh.lenient else -np.inf
    return _split_some(mesh, np.flatnonzero((mesh.upright < UPRIGHT) & (mesh.upright > least)))


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
        if len(flat) and mesh.lenient:
            worst = np.setdiff1d(worst, worst[flat])
        elif len(flat):
            raise GeometryError(
                "two patches coincide along an edge at {at}",
                at=mesh.points[mesh.edges.ends[worst[flat[0]]]].mean(axis=0),
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
    if len(flat) and mesh.lenient:
        return 0
    if len(flat):
        centre = mesh.points[mesh.triangles[worst[flat[0]]]].mean(axis=0)
        raise GeometryError("two triangles coincide at {at}", at=centre)
    return _split_triangles(mesh, worst)


def _lengths(mesh: Mesh) -> Array:
    """The sides (m, 3) of all triangles."""
    corners = mesh.points[mesh.triangles]
    return norm(np.roll(corners, -1, axis=1) - corners)


def _worst_sides(mesh: Mesh) -> tuple[Bools, Ints]:
    """Whether a triangle has a bad edge inside its patch, and which of its sides is the worst."""
    edges = mesh.edges
    sides = edges.of_half[: 3 * len(mesh.triangles)].reshape(-1, 3)
    error = np.where((edges.owner < 0)[sides], 0.0, edges.error[sides])
    return error.max(axis=1, initial=0.0) > 1.0, error.argmax(axis=1)


def _split_some(mesh: Mesh, t: Ints) -> int:
    """Split an edge of each of the triangles, as far as they do not share it.

    Where an edge is too far off the worst one is split, else the longest; preferably one inside
    the patch, and if there is none the triangle itself, at its centre.
    """
    if len(t) == 0:
        return 0
    edges = mesh.edges
    sides = edges.of_half[: 3 * len(mesh.triangles)].reshape(-1, 3)[t]
    inside = (edges.owner >= 0)[sides]
    alone = ~inside.any(axis=1)
    if alone.any():
        return _split_triangles(mesh, t[alone])
    bad, worst = _worst_sides(mesh)
    longest = np.where(inside, 1.0, 0.3) * _lengths(mesh)[t]
    k = np.where(bad[t], worst[t], longest.argmax(axis=1))
    edge, first = np.unique(sides[np.arange(len(t)), k], return_index=True)
    return _split_edges(mesh, edge, np.maximum(edges.error[edge], mesh.error[t[first]]))


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
    points = _cuts(mesh, edge[some], element)
    good = _check_new(mesh, element, points, mesh.points[edges.ends[edge[some]]])
    if not good.all():
        # left as they are from now on
        edges.error[edge[some[~good]]] = 0.0
        chosen[some[~good]] = False
        some, points = some[good], points[good]
        if not len(some):
            return 0
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


def _cuts(mesh: Mesh, edge: Ints, element: Ints) -> Array:
    """Where edges are split: at the middle, or off it if an odd number of parts is needed.

    With chord error e and length l the edge is taken for an arc of the angle 4 atan(2 e / l); n
    equal parts of it are within the limit, and the cut is made after n // 2 of them.
    """
    edges = mesh.edges
    ends = mesh.points[edges.ends[edge]]
    length = norm(ends[:, 1] - ends[:, 0])
    points = edges.middle[edge].copy()
    allowed = edges.allowed[edge]
    angle = np.minimum(4 * np.arctan2(2 * edges.error[edge] * allowed, length), 0.9 * np.pi)
    radius = length / (2 * np.sin(np.maximum(angle, STRAIGHT) / 2))
    wanted = allowed / _bulge(mesh)[edge]
    parts = np.ceil(angle / (2 * np.arccos(np.maximum(1 - wanted / radius, 0.0))) - 0.02)
    odd = np.flatnonzero((parts > 2) & (parts % 2 == 1))
    turn = ((parts[odd] // 2) / parts[odd] - 0.5) * angle[odd]
    along = (0.5 + np.tan(turn) / (2 * np.tan(angle[odd] / 2)))[:, None]
    chord = (1 - along) * ends[odd, 0] + along * ends[odd, 1]
    points[odd] = mesh.elements.place(element[odd], chord)
    return points


def _bulge(mesh: Mesh) -> Array:
    """For each edge, how much larger errors inside its triangles are than on their sides.

    It is 1 on developable and saddle surfaces, 4/3 for equilateral triangles on a sphere.
    """
    edges = mesh.edges
    of_half = edges.of_half[: 3 * len(mesh.triangles)]
    side = edges.error[of_half].reshape(-1, 3).max(axis=1)
    ratio = np.clip(mesh.error / np.maximum(side, 1e-3), 1.0, 1.5)
    bulge = np.ones(len(edges.keys))
    np.maximum.at(bulge, of_half, np.repeat(ratio, 3))
    return bulge


def _split_triangles(mesh: Mesh, t: Ints) -> int:
    """Split triangles at the exact points over their centres."""
    corners = mesh.points[mesh.triangles[t]]
    points = mesh.elements.place(mesh.surface[t], corners.mean(axis=1))
    good = _check_new(mesh, mesh.surface[t], points, corners)
    mesh.error[t[~good]] = 0.0
    t, points = t[good], points[good]
    if not len(t):
        return 0
    v = mesh.add(points)
    a, b, c = mesh.triangles[t].T
    mesh.set_triangles(t, np.stack([a, b, v], axis=1))
    mesh.add_triangles(np.stack([b, c, v], axis=1), mesh.patch[t])
    mesh.add_triangles(np.stack([c, a, v], axis=1), mesh.patch[t])
    mesh.connect()
    return len(t)


def _check_new(mesh: Mesh, element: Ints, points: Array, near: Array) -> Bools:
    """Which new vertices (k,) lie on their element and apart from their neighbours (k, j, 3).

    Raises:
        GeometryError: one does not, unless the mesh is lenient.
    """
    small = TOLERANCE * mesh.diagonal
    off: Bools = mesh.elements.gap(element, points) > small
    off |= (norm(near - points[:, None]) <= small).any(axis=1)
    if off.any() and not mesh.lenient:
        first = int(np.flatnonzero(off)[0])
        name = mesh.elements.names[int(element[first])]
        raise GeometryError(
            f"no new vertex can be placed on the {name} at {{at}}", at=points[first]
        )
    return ~off


def spans(starts: Ints, sizes: Ints) -> Ints:
    """The numbers starts[0], starts[0] + 1, ..., then from starts[1] on, and so on."""
    skip = np.repeat(starts - np.cumsum(sizes) + sizes, sizes)
    return np.asarray(np.arange(int(sizes.sum())) + skip)
