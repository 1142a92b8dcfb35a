"""All curves of a region's skeleton, cut into pieces at all nodes.

On a piece the contacts of the maximal balls are constant, so the sheets that meet along it are too.
Pieces come from seams, trims, rims and reflexive loci; they are welded at their ends, cut where
another curve's node lies on them, and pieces that coincide are made one.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.complex.model import CurveElement, LineKind
from decomp.skeletons.curves.curve_elements import gaps_from
from decomp.tolerance import ONE_NODE
from decomp.vectors import Array, Ints, norm

LEAST = 10
"""A piece from a node back to it is longer than so many times `ONE_NODE`."""
AT_CORNER = 1e-6
"""Places nearer to the end of a chord than this part of it are at it."""
ON = 3e-8
"""Nodes nearer to a curve than this part of the size lie on it."""
SPACING = 1e-2
"""The same, as a part of the distance from the next node, for nodes closer than `ONE_NODE`."""
FEET = 0.1
"""Feet farther apart than this part of the radius are different contacts, also between middles of
pieces that are sampled differently."""

Contact = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class CurvePiece:
    """A piece of a skeleton curve.

    Args:
        kind: what curve it is from.
        contacts: for each contact of its balls all sites that share it.
        element: the exact curve.
        points: (n, 3) on it from start to end, n at least 3, dense enough to be followed by it; a
            closed piece repeats its first point at its end.
        feet: (m, 3), of the contacts at the middle point.
        ends: the nodes where it starts and ends, None if it is closed without a node.
        pairs: the sites of each sheet that meets it there.
        over: numbers of the normal curves whose trims run along it.
    """

    kind: LineKind
    contacts: tuple[Contact, ...]
    element: CurveElement
    points: Array
    feet: Array
    ends: tuple[int, int] | None = None
    pairs: tuple[tuple[int, int], ...] = ()
    over: frozenset[int] = frozenset()

    @property
    def middle(self) -> Array:
        """A point (3,) in its inside."""
        return np.asarray(self.points[middle_row(self.points)])

    @property
    def length(self) -> float:
        """Length of the polyline."""
        return float(norm(np.diff(self.points, axis=0)).sum())


def middle_row(points: Array, share: float = 0.5) -> int:
    """Which inner one of points (n, 3) along a curve is next to half its length, or another share.

    They can crowd at an end, where what a ball touches is not told well.
    """
    along = np.cumsum(norm(np.diff(points, axis=0)))
    return 1 + int(np.argmin(np.abs(along[:-1] - share * along[-1])))


@dataclass(frozen=True, eq=False)
class Network:
    """Nodes (k, 3) and the pieces between them."""

    nodes: Array
    pieces: tuple[CurvePiece, ...]


def network(
    size: float,
    fixed: Array,
    pieces: Sequence[CurvePiece],
    turns: Sequence[Array] = (),
    touches: Sequence[Array] = (),
    junctions: Sequence[Array] = (),
) -> Network:
    """Join pieces into a network.

    Args:
        size: of the region.
        fixed: points (f, 3) that stay as they are: the first nodes. Other ends are joined to one
            of them, or to each other.
        turns: more points (3,) at which pieces are cut; ends that are joined to one move there.
        touches: the same, but these move to ends.
        junctions: points (3,) that are ends, different ones however close they are to each other.
        pieces: with their ends as first and last point; a piece whose first and last points agree
            to rounding and that is marked by `ends` None and `closed` points stays closed.
    """
    open_ = [p for p in pieces if not _is_loop(p)]
    # a seam that comes back to its start at once is no more than its node
    loops = [p for p in pieces if _is_loop(p) and p.length > LEAST * ONE_NODE * size]
    ends = np.array([q for p in open_ for q in (p.points[0], p.points[-1])]).reshape(-1, 3)
    firm, loose, apart = (np.array(points).reshape(-1, 3) for points in (turns, touches, junctions))
    every = np.concatenate([fixed, firm, apart, ends, loose])
    first = len(fixed) + len(firm)
    alone = range(first, first + len(apart))
    nodes, which = _welded(every, len(fixed), alone, ONE_NODE * size)
    first += len(apart)
    numbers = which[first : first + len(ends)].reshape(-1, 2)
    joined = []
    for piece, (a, b) in zip(open_, numbers.tolist(), strict=True):
        points = np.array(piece.points)
        points[0], points[-1] = nodes[a], nodes[b]
        if a == b and piece.length <= LEAST * ONE_NODE * size:
            continue
        joined.append(replace(piece, points=points, ends=(a, b)))
    tree = cKDTree(nodes)
    cut = [part for piece in (*joined, *loops) for part in _cut(piece, nodes, tree, size)]
    return Network(nodes, tuple(_merged(cut, size)))


def _is_loop(piece: CurvePiece) -> bool:
    return bool((piece.points[0] == piece.points[-1]).all()) and len(piece.points) > 3


def _welded(points: Array, fixed: int, alone: range, tolerance: float) -> tuple[Array, Ints]:
    """Unique points and for each point its number.

    The first `fixed` points keep their numbers; those `alone` are not joined to each other, and
    others to the nearest one.
    """
    which = np.full(len(points), -1, dtype=np.int64)
    which[:fixed] = np.arange(fixed)
    unique = list(points[:fixed])
    tree = cKDTree(points)
    for k in range(len(points)):
        if which[k] < 0:
            near = [j for j in tree.query_ball_point(points[k], tolerance) if which[j] >= 0]
            if k in alone:
                near = [j for j in near if j not in alone]
            if near:
                gaps = [float(norm(points[j] - points[k])) for j in sorted(near)]
                which[k] = which[sorted(near)[int(np.argmin(gaps))]]
            else:
                which[k] = len(unique)
                unique.append(points[k])
    return np.array(unique).reshape(-1, 3), which


def _cut(piece: CurvePiece, nodes: Array, tree: cKDTree, size: float) -> list[CurvePiece]:
    """Cut a piece at all nodes on it, which a tree holds."""
    if not len(nodes):
        return [piece]
    chords = np.diff(piece.points, axis=0)
    length = norm(chords)
    middle = piece.points[:-1] + chords / 2
    found: list[tuple[float, int, Array]] = []
    for k, near in enumerate(tree.query_ball_point(middle, 0.6 * length + ON * size)):
        for number in near:
            if (piece.ends and number in piece.ends) or not length[k]:
                continue
            along = float((nodes[number] - piece.points[k]) @ chords[k]) / float(length[k]) ** 2
            if not -AT_CORNER <= along < 1 + AT_CORNER:
                continue
            off = float(norm(nodes[number] - piece.points[k] - along * chords[k]))
            if off > 0.2 * length[k] + ON * size:
                continue
            found.append((k + along, number, nodes[number]))
    if not found:
        return [piece]
    candidates = np.array([point for _, _, point in found])
    on = gaps_from(piece.element, candidates) <= _on(candidates, tree, size)
    taken: dict[int, float] = {}
    for (at, number, _), good in zip(found, on.tolist(), strict=True):
        if good:
            taken.setdefault(number, at)
    if not taken:
        return [piece]
    stops = sorted((at, number) for number, at in taken.items())
    return _split(piece, nodes, stops)


def _on(points: Array, tree: cKDTree, size: float) -> Array:
    """How near to a curve each of some nodes (k, 3) must be to lie on it.

    Those that are closer to another node than others can be told apart are exact.
    """
    spacing = tree.query(points, k=2)[0][:, 1]
    return np.where(spacing > ONE_NODE * size, ON * size, SPACING * spacing)


def _split(piece: CurvePiece, nodes: Array, stops: list[tuple[float, int]]) -> list[CurvePiece]:
    """Cut at places (index into the polyline with fraction, node)."""
    last = len(piece.points) - 1
    if piece.ends is None:
        first_at, first = stops[0]
        bounds = [*stops, (first_at + last, first)]
        cycle = np.concatenate([piece.points[:-1], piece.points])
    else:
        bounds = [(0.0, piece.ends[0]), *stops, (float(last), piece.ends[1])]
        cycle = piece.points
    parts = []
    for (a, one), (b, two) in itertools.pairwise(bounds):
        low, high = int(np.floor(a + AT_CORNER)) + 1, int(np.ceil(b - AT_CORNER)) - 1
        inner = cycle[low : high + 1]
        points = np.concatenate([nodes[one][None], inner, nodes[two][None]])
        if len(points) < 3:
            middle = piece.element.place((points[0] + points[1])[None] / 2)
            points = np.concatenate([points[:1], middle, points[1:]])
        parts.append(replace(piece, points=points, ends=(one, two)))
    return parts


def _merged(pieces: Sequence[CurvePiece], size: float) -> list[CurvePiece]:
    """Make coinciding pieces one."""
    order = [LineKind.REFLEXIVE, LineKind.SEAM, LineKind.RIM, LineKind.TRIM]
    kept: list[CurvePiece] = []
    known: dict[tuple[int, ...], list[int]] = {}
    for piece in sorted(pieces, key=lambda p: order.index(p.kind)):
        key = tuple(sorted(piece.ends)) if piece.ends else ()
        for other in known.get(key, []):
            if _coincide(kept[other], piece, size):
                kept[other] = replace(
                    kept[other],
                    contacts=_joint(kept[other], piece),
                    over=kept[other].over | piece.over,
                )
                break
        else:
            known.setdefault(key, []).append(len(kept))
            kept.append(piece)
    return kept


def _coincide(a: CurvePiece, b: CurvePiece, size: float) -> bool:
    """Whether two pieces with the same ends are one curve: b's middle lies on a.

    Seams that overlap by little are nearer to each other than curves can be told apart, but not
    their feet.
    """
    if a.kind is b.kind is LineKind.SEAM:
        apart = norm(a.feet[:, None] - b.feet[None]).min(axis=1)
        if bool((apart > FEET * float(norm(a.middle - a.feet[0]))).any()):
            return False
    middle = b.middle
    gap = norm(a.points - middle)
    step = norm(np.diff(a.points, axis=0)).max()
    if float(gap.min()) > step:
        return False
    return float(gaps_from(a.element, middle[None])[0]) <= ON * size


def _joint(a: CurvePiece, b: CurvePiece) -> tuple[Contact, ...]:
    """The contacts of a with the sites that b knows of them."""
    result = list(a.contacts)
    for contact in b.contacts:
        for k, known in enumerate(result):
            if set(known) & set(contact):
                result[k] = tuple(sorted(set(known) | set(contact)))
                break
    return tuple(result)
