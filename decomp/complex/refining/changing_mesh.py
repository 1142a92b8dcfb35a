"""A complex while it is changed: flat arrays of triangles and line segments, and their edges.

Edges are of two kinds. A segment of a line is ONE edge for all patches and lines that contain it.
An edge inside a patch belongs to that patch alone, even where another patch joins the same two
vertices: the two surfaces differ between them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from decomp.complex.halfway import halfway
from decomp.complex.many_elements import Elements
from decomp.complex.model import Complex
from decomp.complex.refining.errors_of import (
    edge_errors,
    thorough_edge_errors,
    thorough_errors,
    triangle_errors,
)
from decomp.complex.refining.lenient import LenientElements
from decomp.errors import GeometryError
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, Ints, norm

BITS = 22
"""Bits of a vertex number in an edge's key."""

SURELY_WITHIN = 0.9
"""What is within this part of the limit is sure to be within the limit itself."""

PAIR = (1 << 2 * BITS) - 1


@dataclass(eq=False)
class Edges:
    """All edges of a mesh, sorted by key.

    A half-edge h is side h % 3 of triangle h // 3, from its corner h % 3 to the next; numbers from
    3 m on are the segments of lines.

    Args:
        keys: (n,) owner and two vertices, packed.
        owner: (n,) the patch that an edge is inside of, -1 for segments of lines.
        ends: (n, 2) vertices.
        of_half: (h,) the edge of each half-edge.
        halves: (h,) half-edges, grouped by edge, those of triangles first.
        starts: (n + 1,) where each edge's group begins.
        sides: (n,) how many triangles have the edge.
        allowed: (n,) the least of what its patches and lines allow.
        error: (n,) chord error, as a part of what is allowed, NaN where not measured.
        middle: (n, 3) midpoint on the element, where measured.
        checked: (n,) whether an edge has been measured thoroughly.
    """

    keys: Ints
    owner: Ints
    ends: Ints
    of_half: Ints
    halves: Ints
    starts: Ints
    sides: Ints
    allowed: Array
    error: Array
    middle: Array
    checked: Bools

    @cached_property
    def pairs(self) -> Ints:
        """Keys of the vertex pairs of all edges, sorted."""
        return np.sort(self.keys & PAIR)


def pair_keys(a: Ints, b: Ints) -> Ints:
    """One number for two vertices in any order."""
    return (np.minimum(a, b) << BITS) | np.maximum(a, b)


def found(sorted_keys: Ints, keys: Ints) -> tuple[Ints, Bools]:
    """Where each key stands in a sorted array, and whether it is there."""
    if len(sorted_keys) == 0:
        return np.zeros(len(keys), dtype=np.int64), np.zeros(len(keys), dtype=bool)
    at = np.minimum(np.searchsorted(sorted_keys, keys), len(sorted_keys) - 1)
    return at, sorted_keys[at] == keys


class Mesh:
    """Triangles and segments that are split, flipped and collapsed.

    Each patch has a chord error that it is allowed, in model units; a line is allowed the least of
    the patches that it borders. Errors are measured as parts of what is allowed.

    Args:
        given: the complex.
        allowed: (p,) of its patches.
        lenient: whether what cannot be followed is left as it is, instead of being an error.

    Attributes:
        points: (n, 3) exact vertices.
        triangles: (m, 3).
        patch: (m,) the patch of each triangle.
        error, upright: (m,) as `triangle_errors` gives them, the errors as parts of what is
            allowed, NaN where not measured.
        fresh: (m,) whether a triangle has changed since flips were last tried.
        checked: (m,) whether it has been measured thoroughly.
        path, path_line: (s,) vertices of all lines, one line after the other, and their lines.
        edges: of the triangles and segments as they are now.
    """

    def __init__(self, given: Complex, allowed: Array, lenient: bool = False) -> None:
        self.lenient = lenient
        self.elements = LenientElements(given) if lenient else Elements(given)
        self._of_patch, self._of_line = allowed, _line_limits(given, allowed)
        self.points: Array = np.array(given.points, dtype=np.float64)
        self.diagonal = float(norm(np.ptp(self.points, axis=0))) if len(self.points) else 0.0
        self.triangles: Ints = np.concatenate(
            [np.empty((0, 3), np.int64), *(p.triangles for p in given.patches)]
        ).astype(np.int64)
        self.patch: Ints = np.repeat(
            np.arange(len(given.patches)), [len(p.triangles) for p in given.patches]
        )
        self.path: Ints = np.concatenate(
            [np.empty(0, np.int64), *(line.vertices for line in given.lines)]
        ).astype(np.int64)
        self.path_line: Ints = np.repeat(
            np.arange(len(given.lines)), [len(line.vertices) for line in given.lines]
        )
        self.error: Array = np.full(len(self.triangles), np.nan)
        self.upright: Array = np.full(len(self.triangles), np.nan)
        self.fresh: Bools = np.ones(len(self.triangles), dtype=bool)
        self.checked: Bools = np.zeros(len(self.triangles), dtype=bool)
        if len(self.points) >= 1 << BITS or len(given.patches) >= 1 << (62 - 2 * BITS):
            raise GeometryError(f"{len(self.points)} points are more than can be refined")
        self._given = given
        self.edges: Edges = self._connected(None)

    @property
    def surface(self) -> Ints:
        """The element (m,) of each triangle."""
        return self.elements.of_patch[self.patch]

    @property
    def allowed(self) -> Array:
        """The chord error (m,) that each triangle is allowed, in model units."""
        return self._of_patch[self.patch]

    def connect(self) -> None:
        """Find the edges anew; what was measured of those that stay is kept."""
        self.edges = self._connected(self.edges)

    def _connected(self, old: Edges | None) -> Edges:
        segment = np.flatnonzero(self.path_line[1:] == self.path_line[:-1])
        a = np.concatenate([self.triangles.ravel(), self.path[segment]])
        b = np.concatenate([np.roll(self.triangles, -1, axis=1).ravel(), self.path[segment + 1]])
        pairs = pair_keys(a, b)
        inner = len(self.triangles) * 3
        owner = np.repeat(self.patch, 3)
        _, on_line = found(np.sort(pairs[inner:]), pairs[:inner])
        keys = pairs
        keys[:inner] |= np.where(on_line, 0, owner + 1) << 2 * BITS
        halves = np.argsort(keys, kind="stable")
        first = np.ones(len(keys), dtype=bool)
        first[1:] = keys[halves[1:]] != keys[halves[:-1]]
        starts = np.append(np.flatnonzero(first), len(keys))
        of_half = np.empty(len(keys), dtype=np.int64)
        of_half[halves] = np.cumsum(first) - 1
        distinct = keys[halves[first]]
        count = len(distinct)
        ends = np.stack([(distinct & PAIR) >> BITS, distinct & ((1 << BITS) - 1)], axis=1)
        error, middle = np.full(count, np.nan), np.empty((count, 3))
        checked = np.zeros(count, dtype=bool)
        if old is not None:
            at, same = found(old.keys, distinct)
            error[same] = old.error[at[same]]
            middle[same] = old.middle[at[same]]
            checked[same] = old.checked[at[same]]
        sides = np.bincount(of_half[:inner], minlength=count)
        owner_of = (distinct >> 2 * BITS) - 1
        allowed = np.full(count, np.inf)
        of_segment = self._of_line[self.path_line[segment]]
        np.minimum.at(allowed, of_half, np.concatenate([np.repeat(self.allowed, 3), of_segment]))
        return Edges(
            distinct,
            owner_of,
            ends,
            of_half,
            halves,
            starts,
            sides,
            allowed,
            error,
            middle,
            checked,
        )

    def segments(self) -> tuple[Ints, Ints]:
        """Where in `path` each segment begins, and the curve that it is on."""
        at = np.flatnonzero(self.path_line[1:] == self.path_line[:-1])
        return at, self.elements.of_line[self.path_line[at]]

    # --- measuring --------------------------------------------------------------------------

    def measure(self) -> None:
        """Measure the edges and triangles that have not been."""
        self.measure_edges()
        new = np.flatnonzero(np.isnan(self.error))
        corners = self.points[self.triangles[new]]
        error, self.upright[new] = triangle_errors(self.elements, self.surface[new], corners)
        self.error[new] = error / self.allowed[new]

    def measure_edges(self) -> None:
        """Measure the edges that have not been."""
        self._measure_edges(np.isnan(self.edges.error), thorough=False)

    def _measure_edges(self, new: Bools, thorough: bool) -> None:
        """Measure edges, each against all elements that it is on.

        Raises:
            GeometryError: an element places points farther away than its own vertices are, or two
                lines share a segment but not the curve between its ends.
        """
        edges = self.edges
        if not new.any():
            return
        half = np.flatnonzero(new[edges.of_half])
        inner = 3 * len(self.triangles)
        _, curves = self.segments()
        element = np.empty(len(half), dtype=np.int64)
        of_triangle = half < inner
        element[of_triangle] = self.surface[half[of_triangle] // 3]
        element[~of_triangle] = curves[half[~of_triangle] - inner]
        # curves come last in each edge's group, so that a segment's midpoint is on its curve
        own = np.empty(len(half))
        own[of_triangle] = self._of_patch[self.patch[half[of_triangle] // 3]]
        own[~of_triangle] = self._of_line[
            self.path_line[self.segments()[0][half[~of_triangle] - inner]]
        ]
        both, first = np.unique(
            np.stack([edges.of_half[half], element]), axis=1, return_inverse=True
        )
        which, element = both
        allowed = np.full(len(which), np.inf)
        np.minimum.at(allowed, first.reshape(-1), own)
        ends = self.points[edges.ends[which]]
        if thorough:
            edges.error[new], edges.checked[new] = 0.0, True
            error = thorough_edge_errors(self.elements, element, ends)
            np.maximum.at(edges.error, which, error / allowed)
            return
        error, middle = edge_errors(self.elements, element, ends, allowed)
        if self.lenient:
            error[error > norm(ends[:, 1] - ends[:, 0])] = 0.0
        else:
            self._shorten(element, ends, error, middle)
        last = np.append(which[1:] != which[:-1], True)
        edges.middle[which[last]] = middle[last]
        curve = np.flatnonzero(element >= self.elements.first_curve)
        part = norm(middle[curve] - edges.middle[which[curve]])
        apart = np.flatnonzero(part > 1e3 * TOLERANCE * self.diagonal)
        if len(apart) and not self.lenient:
            raise GeometryError(
                "two lines share a segment but not its curve at {at}; it must be divided",
                at=ends.mean(axis=1)[curve[apart[0]]],
            )
        edges.error[new] = 0.0
        np.maximum.at(edges.error, which, error / allowed)

    def check(self) -> bool:
        """Measure what is close to the limit more thoroughly; whether any is beyond it."""
        edges = self.edges
        self._measure_edges((edges.error > SURELY_WITHIN) & ~edges.checked, thorough=True)
        sides = edges.error[edges.of_half[: 3 * len(self.triangles)]].reshape(-1, 3)
        worst = np.maximum(self.error, sides.max(axis=1))
        near = np.flatnonzero((worst > SURELY_WITHIN) & ~self.checked)
        corners = self.points[self.triangles[near]]
        error = thorough_errors(self.elements, self.surface[near], corners, samples=10)
        error /= self.allowed[near]
        # between the points of the lattice the surface may be a little farther away
        error += 0.05 * np.maximum(error - sides[near].max(axis=1), 0.0)
        self.error[near] = error
        self.checked[near] = True
        return bool((self.error > 1.0).any() or (edges.error > 1.0).any())

    def _shorten(self, element: Ints, ends: Array, moved: Array, middle: Array) -> None:
        """Replace midpoints placed farther away than their chords are long by ways along surfaces.

        Raises:
            GeometryError: there is none.
        """
        length = norm(ends[:, 1] - ends[:, 0])
        far = moved > np.maximum(length, TOLERANCE * self.diagonal)
        rows = np.flatnonzero(far & (element < self.elements.first_curve))
        if len(rows):
            way = halfway(self.elements, element[rows], ends[rows])
            good = ~np.isnan(way).any(axis=1)
            middle[rows[good]], far[rows[good]] = way[good], False
        if far.any():
            first = int(np.argmax(far))
            raise GeometryError(
                f"{self.elements.names[int(element[first])]} places {{at}} farther away than its "
                "own vertices are",
                at=ends[first].mean(axis=0),
            )

    # --- changing ---------------------------------------------------------------------------

    def add(self, points: Array) -> Ints:
        """Append vertices (k, 3); their numbers."""
        before = len(self.points)
        if before + len(points) >= 1 << BITS:
            raise GeometryError("more points are needed than can be numbered: tolerance too small")
        self.points = np.concatenate([self.points, points])
        return np.arange(before, before + len(points))

    def set_triangles(self, which: Ints, corners: Ints) -> None:
        """Give triangles other corners (k, 3)."""
        self.triangles[which] = corners
        self.error[which] = np.nan
        self.upright[which] = np.nan
        self.fresh[which] = True
        self.checked[which] = False

    def add_triangles(self, corners: Ints, patch: Ints) -> None:
        """Append triangles (k, 3)."""
        count = len(corners)
        self.triangles = np.concatenate([self.triangles, corners])
        self.patch = np.concatenate([self.patch, patch])
        self.error = np.concatenate([self.error, np.full(count, np.nan)])
        self.upright = np.concatenate([self.upright, np.full(count, np.nan)])
        self.fresh = np.concatenate([self.fresh, np.ones(count, dtype=bool)])
        self.checked = np.concatenate([self.checked, np.zeros(count, dtype=bool)])

    def drop_triangles(self, which: Ints) -> None:
        """Remove triangles."""
        keep = np.ones(len(self.triangles), dtype=bool)
        keep[which] = False
        self.triangles, self.patch = self.triangles[keep], self.patch[keep]
        self.error, self.upright = self.error[keep], self.upright[keep]
        self.fresh, self.checked = self.fresh[keep], self.checked[keep]

    # --- result -----------------------------------------------------------------------------

    def result(self) -> tuple[Complex, Ints]:
        """The complex as it is now, and the new number of each of the given points.

        Given points keep their order. One that was inside a patch and is gone has the number -1;
        given points that were in no triangle and on no line stay.
        """
        before = len(self._given.points)
        keep = np.zeros(len(self.points), dtype=bool)
        keep[:before] = True
        for patch in self._given.patches:
            keep[patch.triangles] = False
        keep[self.triangles] = True
        keep[self.path] = True
        number = np.where(keep, np.cumsum(keep) - 1, -1)
        order = np.argsort(self.patch, kind="stable")
        triangles = number[self.triangles[order]]
        cuts = np.searchsorted(self.patch[order], np.arange(1, len(self._given.patches)))
        patches = [
            replace(patch, triangles=some)
            for patch, some in zip(self._given.patches, np.split(triangles, cuts), strict=False)
        ]
        cuts = np.searchsorted(self.path_line, np.arange(1, len(self._given.lines)))
        lines = [
            replace(line, vertices=some)
            for line, some in zip(
                self._given.lines, np.split(number[self.path], cuts), strict=False
            )
        ]
        made = Complex(self.points[keep], tuple(patches), tuple(lines))
        return made, number[:before]


def _line_limits(given: Complex, allowed: Array) -> Array:
    """What each line is allowed: the least of the patches that it borders, or the most of all."""
    owner = np.repeat(np.arange(len(given.patches)), [3 * len(p.triangles) for p in given.patches])
    sides = [np.empty(0, dtype=np.int64)]
    for patch in given.patches:
        sides.append(pair_keys(patch.triangles, np.roll(patch.triangles, -1, axis=1)).ravel())
    keys = np.concatenate(sides)
    order = np.argsort(keys, kind="stable")
    most = float(allowed.max(initial=0.0)) if len(allowed) else np.inf
    found_for = np.full(len(given.lines), most)
    for number, line in enumerate(given.lines):
        if len(line.vertices) < 2:
            continue
        first = pair_keys(line.vertices[:1], line.vertices[1:2])
        a, b = np.searchsorted(keys[order], [first[0], first[0] + 1])
        if b > a:
            found_for[number] = allowed[owner[order[a:b]]].min()
    return found_for
