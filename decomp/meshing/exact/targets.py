"""Which exact surface, curve or point each node of a mesh belongs to.

A node knows the patches of the triangles around it: one patch means a surface, several the line
along which they meet, or the corner where their lines do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.complex.many_elements import Elements
from decomp.complex.polylines import polyline_distance
from decomp.errors import GeometryError
from decomp.meshing.exact.exact_model import ExactModel
from decomp.meshing.naming.tagging import Tagged
from decomp.meshing.surface.cells import locate
from decomp.vectors import Array, Bools, Ints, norm

BESIDE = 1e-9
"""A sheet's two sides are asked this part of the model's diagonal off it."""
NEAR_CORNER = 6.0
"""A corner takes nodes within so many epsilons."""
SURFACE, LINE, CORNER = 2, 1, 0


@dataclass(frozen=True, eq=False)
class Targets:
    """Where nodes belong.

    Args:
        nodes: (k,) ascending.
        dimension: (k,) SURFACE, LINE or CORNER.
        element: (k,) the number of the surface or curve in `Elements`, the point of the complex
            for a corner.
        surface: (k,) the number of one of its surfaces, for nodes that cannot be moved further.
        complete: (k,) whether that is on all patches around the node.
    """

    nodes: Ints
    dimension: Ints
    element: Ints
    surface: Ints
    complete: Bools


def renewed(given: Targets, now: Targets) -> tuple[Targets, Ints]:
    """Targets found anew for nodes that have moved along what they are on.

    Args:
        given: that they were moved onto.
        now: found where they are; of the same nodes.

    Returns:
        those of nodes on another surface or line now taken from `now`, and these nodes, ascending.
    """
    other = given.complete & (given.dimension == now.dimension) & (given.element != now.element)
    element = np.where(other, now.element, given.element)
    surface = np.where(other, now.surface, given.surface)
    made = Targets(given.nodes, given.dimension, element, surface, given.complete)
    return made, given.nodes[other]


class Finder:
    """Finds the targets of nodes.

    Args:
        model: whose surfaces, curves and points they are.
    """

    def __init__(self, model: ExactModel) -> None:
        plan = model.plan
        self._geometry, self._cells = model.geometry, model.cells
        self._sites = {
            patch: sites
            for region in model.surface.regions
            for patch, sites in region.sheets.items()
        }
        self._plan, self._elements, self._epsilon = plan, model.elements, model.epsilon
        self._group: dict[int, tuple[int, ...]] = {
            patch: own for own in plan.between.values() for patch in own
        }
        self._lines: dict[frozenset[int], list[int]] = {}
        self._corners = [self._kinds(around) for around in plan.around_corner]
        self._corners_of: dict[int, list[int]] = {}
        for number, kinds in enumerate(self._corners):
            for kind in kinds:
                self._corners_of.setdefault(kind, []).append(number)
        for number, around in enumerate(plan.around_line):
            kinds = self._kinds(around)
            if len(kinds) > 1:
                self._lines.setdefault(kinds, []).append(number)

    def _kinds(self, patches: Sequence[int]) -> frozenset[int]:
        """Patches, with one of them for all sheets that part the same two cells.

        Such sheets go on into one another, and near their common ends tags mistake one for the
        next.
        """
        return frozenset(self._group.get(patch, (patch,))[0] for patch in patches)

    def targets(self, points: Array, tagged: Tagged) -> Targets:
        """The targets of all nodes of tagged triangles."""
        pairs = np.unique(
            np.stack([tagged.triangles.reshape(-1), np.repeat(tagged.patches, 3)], axis=1), axis=0
        )
        nodes, first = np.unique(pairs[:, 0], return_index=True)
        sets = [tuple(own.tolist()) for own in np.split(pairs[:, 1], first[1:])]
        by_set: dict[tuple[int, ...], list[int]] = {}
        for row, own in enumerate(sets):
            by_set.setdefault(own, []).append(row)
        found = Targets(
            nodes,
            np.full(len(nodes), SURFACE),
            np.zeros(len(nodes), dtype=np.int64),
            np.zeros(len(nodes), dtype=np.int64),
            np.ones(len(nodes), dtype=np.bool_),
        )
        ambiguous: dict[tuple[int, ...], list[int]] = {}
        for own, listed in by_set.items():
            rows = np.array(listed, dtype=np.int64)
            found.surface[rows] = self._elements.of_patch[own[0]]
            if len(self._kinds(own)) > 1:
                self._meet(points[nodes[rows]], own, rows, found)
            elif len(self._group.get(own[0], ())) > 1:
                ambiguous.setdefault(self._group[own[0]], []).extend(listed)
            else:
                found.element[rows] = self._elements.of_patch[own[0]]
        for patches, listed in ambiguous.items():
            rows = np.array(listed, dtype=np.int64)
            self._on_one_sheet(points[nodes[rows]], patches, rows, found)
        return found

    def kinds(self, tagged: Tagged) -> dict[int, frozenset[int]]:
        """The kinds of patches that meet at each node of tagged triangles."""
        found: dict[int, set[int]] = {}
        for node, patch in zip(
            tagged.triangles.reshape(-1).tolist(),
            np.repeat(tagged.patches, 3).tolist(),
            strict=True,
        ):
            found.setdefault(node, set()).add(patch)
        return {node: self._kinds(tuple(own)) for node, own in found.items()}

    def _meet(self, places: Array, own: tuple[int, ...], rows: Ints, found: Targets) -> None:
        """Nodes at which several patches meet: on a line or at a corner."""
        kinds = self._kinds(own)
        lines = self._lines.get(kinds, [])
        if not lines:
            near = self._near_corner(places, kinds)
            found.dimension[rows[near >= 0]] = CORNER
            found.element[rows[near >= 0]] = self._plan.corners[near[near >= 0]]
            rows, places = rows[near < 0], places[near < 0]
            if not len(rows):
                return
            lines = self._lines_like(kinds)
        if lines:
            found.dimension[rows] = LINE
            found.element[rows] = self._elements.of_line[self._nearest_line(places, lines)]
        else:
            found.element[rows] = found.surface[rows]
            found.complete[rows] = False

    def _near_corner(self, places: Array, kinds: frozenset[int]) -> Ints:
        """The corner (k,) at each place where most of some patches meet, -1 for none."""
        near_kinds = {k for kind in kinds for k in self._corners_of.get(kind, ())}
        least = min(3, len(kinds))
        rows = np.array(
            sorted(k for k in near_kinds if len(kinds & self._corners[k]) >= least), dtype=np.int64
        )
        if not len(rows):
            return np.full(len(places), -1, dtype=np.int64)
        at = self._plan.complex.points[self._plan.corners[rows]]
        gap, which = cKDTree(at).query(places)
        near = gap < NEAR_CORNER * self._epsilon
        return np.asarray(np.where(near, rows[which], -1), dtype=np.int64)

    def _lines_like(self, kinds: frozenset[int]) -> list[int]:
        """Lines along which some of the patches meet, else lines where more than they do."""
        within = [around for around in self._lines if around <= kinds]
        if within:
            most = max(len(around) for around in within)
            return [k for around in within if len(around) == most for k in self._lines[around]]
        return [k for around, ks in self._lines.items() if kinds <= around for k in ks]

    def _nearest_line(self, places: Array, lines: Sequence[int]) -> Ints:
        if len(lines) == 1:
            return np.full(len(places), lines[0], dtype=np.int64)
        mesh = self._plan.complex
        gaps = np.stack(
            [polyline_distance(mesh.points[mesh.lines[k].vertices], places) for k in lines]
        )
        return np.asarray(np.array(lines, dtype=np.int64)[np.argmin(gaps, axis=0)])

    def _on_one_sheet(
        self, places: Array, patches: tuple[int, ...], rows: Ints, found: Targets
    ) -> None:
        """Nodes at places (k, 3) between two cells that several sheets part, one after another.

        Each is on the nearest one of those that part their own sites there: where another sheet
        goes on in its stead, a sheet's continuation does not.
        """
        away, foreign = np.full((2, len(patches), len(rows)), np.inf)
        for row, patch in enumerate(patches):
            element = np.full(len(rows), self._elements.of_patch[patch])
            on, good = placed(
                self._elements, self._plan.complex.points, found.dimension[rows], element, places
            )
            away[row, good] = norm(on - places)[good]
            foreign[row, good] = ~self._parts(self._sites[patch], element[good], on[good])
        best = np.lexsort((away, foreign), axis=0)[0]
        elements = np.asarray(self._elements.of_patch)[np.array(patches, dtype=np.int64)[best]]
        found.element[rows] = found.surface[rows] = elements

    def _parts(self, sites: tuple[int, int], surfaces: Ints, on: Array) -> Bools:
        """Whether one of two sites is the nearest on one side of surfaces, the other beyond."""
        way = BESIDE * self._geometry.diagonal * self._elements.normal(surfaces, on)
        sides = np.concatenate([on - way, on + way])
        near = locate(self._geometry, self._cells, sides).site.reshape(2, -1)
        return np.asarray((np.sort(near, axis=0) == np.sort(sites)[:, None]).all(axis=0))


def placed(
    elements: Elements, mesh_points: Array, dimension: Ints, element: Ints, points: Array
) -> tuple[Array, Bools]:
    """Move points (k, 3) onto what they belong to.

    Args:
        elements: of the complex.
        mesh_points: the complex's points.
        dimension, element: (k,) as in `Targets`.
        points: close to it.

    Returns:
        the places (k, 3), and whether each was found (k,).
    """
    result = np.array(points)
    good = np.ones(len(points), dtype=np.bool_)
    corner = dimension == CORNER
    result[corner] = mesh_points[element[corner]]
    rows = np.flatnonzero(~corner)
    _place(elements, element, points, rows, result, good)
    return result, good


def _place(
    elements: Elements, element: Ints, points: Array, rows: Ints, result: Array, good: Bools
) -> None:
    """Place rows together; where that fails, halves of them, down to the ones that fail."""
    if not len(rows):
        return
    try:
        result[rows] = elements.place(element[rows], points[rows])
    except GeometryError:
        if len(rows) == 1:
            good[rows] = False
            return
        _place(elements, element, points, rows[: len(rows) // 2], result, good)
        _place(elements, element, points, rows[len(rows) // 2 :], result, good)
