"""Which cell each tetrahedron belongs to.

Most meshers tell only points and tetrahedra. Where one lies is asked of the exact geometry at
several points inside it. Where they agree that is the answer. Tetrahedra in doubt lie at an
interface, flat against it or reaching a little beyond: they follow their neighbours, except across
walls, the triangles that have different cells close to both their sides.
"""

from __future__ import annotations

import numpy as np

from decomp.geometry import Geometry
from decomp.meshes.faces import NONE, Faces, faces_of
from decomp.meshing.surface.cells import OUTSIDE, CellMap, locate
from decomp.tolerance import TINY
from decomp.vectors import Array, Bools, Ints, cross, norm

ASKED_TOWARDS = 0.4
"""Points asked lie so far from the middle of a tetrahedron to its vertices."""
ASKED_ASIDE = 2.0
"""So many tolerances off a triangle its two sides are asked."""
ASKED_AT_CORNERS = 0.8
"""It is asked in the middle and so far from there to its corners."""
VOTING_ROUNDS = 30
VOTE_CORRECTIONS = 3
BOUNDARY_OFF = 2.0
"""Nodes of the boundary are at most so many tolerances off it."""
OWN_VOTE = 0.5
"""What a tetrahedron's own points count against all of its neighbours."""


def classified(
    geometry: Geometry, cells: CellMap, points: Array, tets: Ints, tolerance: float
) -> Ints:
    """The part (m,) of a cell that each tetrahedron (m, 4) is in, OUTSIDE for none."""
    votes = _votes(geometry, cells, points, tets)
    label = votes[:, 0].copy()
    doubt = (votes != label[:, None]).any(axis=1)
    faces = faces_of(tets)
    _follow(geometry, cells, points, tets, faces, votes, doubt, label, tolerance)
    _correct(geometry, cells, points, tets, faces, votes[:, 0], label, tolerance)
    return label


def parts_of_cells(
    geometry: Geometry, cells: CellMap, points: Array, tets: Ints, told: Ints
) -> Ints:
    """The part (m,) that each tetrahedron (m, 4) is in, of the cell that it is told to be in.

    Args:
        told: (m,) cells, OUTSIDE for none.
    """
    several = np.bincount(cells.cell, minlength=len(cells.cells)) > 1
    part = told.copy()  # the first part of a cell has its number
    asked = np.flatnonzero((told != OUTSIDE) & several[told])
    found = locate(geometry, cells, points[tets[asked]].mean(axis=1)).part
    same = cells.cell_of(found) == told[asked]
    part[asked[same]] = found[same]
    return part


def _votes(geometry: Geometry, cells: CellMap, points: Array, tets: Ints) -> Ints:
    """The cells (m, 5) at each tetrahedron's middle and near its vertices."""
    corners = points[tets]
    middle = corners.mean(axis=1, keepdims=True)
    asked = np.concatenate([middle, middle + ASKED_TOWARDS * (corners - middle)], axis=1)
    return locate(geometry, cells, asked.reshape(-1, 3)).part.reshape(len(tets), 5)


def walls(
    geometry: Geometry, cells: CellMap, points: Array, triangles: Ints, tolerance: float
) -> Bools:
    """Whether triangles (f, 3) have different cells close to both their sides all over.

    Their middles are asked, and places near all three corners.
    """
    corners = points[triangles]
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    way = normal * (ASKED_ASIDE * tolerance / np.maximum(norm(normal), TINY))[:, None]
    middle = corners.mean(axis=1, keepdims=True)
    asked = np.concatenate([middle, middle + ASKED_AT_CORNERS * (corners - middle)], axis=1)
    both = np.concatenate([asked - way[:, None], asked + way[:, None]])
    found = locate(geometry, cells, both.reshape(-1, 3)).part.reshape(2, len(triangles), 4)
    return np.asarray((found[0] != found[1]).all(axis=1))


def _follow(
    geometry: Geometry,
    cells: CellMap,
    points: Array,
    tets: Ints,
    faces: Faces,
    votes: Ints,
    doubt: Bools,
    label: Ints,
    tolerance: float,
) -> None:
    """Let tetrahedra in doubt take the cell that most of their open sides have.

    Each asks its neighbours, weighted by area; across a wall a neighbour has no say. Sides of its
    own points count too, so that it does not leave its own cell for little.
    """
    inner = faces.tets[:, 1] != NONE
    touching = inner & (doubt[faces.tets[:, 0]] | (doubt[faces.tets[:, 1]] & inner))
    rows = np.flatnonzero(touching)
    rows = rows[~walls(geometry, cells, points, faces.triangles[rows], tolerance)]
    a, b, c = np.moveaxis(points[faces.triangles[rows]], 1, 0)
    area = norm(cross(b - a, c - a))
    ends = faces.tets[rows]
    who = np.concatenate([ends[:, 0], ends[:, 1]])
    other = np.concatenate([ends[:, 1], ends[:, 0]])
    weight = np.concatenate([area, area])
    mine = doubt[who]
    who, other, weight = who[mine], other[mine], weight[mine]
    around = np.bincount(who, weight, minlength=len(tets))
    doubtful = np.flatnonzero(doubt)
    own_who = np.repeat(doubtful, votes.shape[1])
    own_label = votes[doubtful].reshape(-1)
    own_weight = np.repeat(np.maximum(around[doubtful], TINY) * OWN_VOTE / 5, votes.shape[1])
    for turn in range(VOTING_ROUNDS):
        asked = np.concatenate([who, own_who])
        said = np.concatenate([label[other], own_label])
        new = _heaviest(asked, said, np.concatenate([weight, own_weight]), len(tets))
        changing = doubtful[new[doubtful] != label[doubtful]]
        if not len(changing):
            return
        # every other turn only half of them change, so that no two swap for ever
        if turn % 2:
            changing = changing[changing % 2 == (turn // 2) % 2]
        label[changing] = new[changing]


def _correct(
    geometry: Geometry,
    cells: CellMap,
    points: Array,
    tets: Ints,
    faces: Faces,
    middle: Ints,
    label: Ints,
    tolerance: float,
) -> None:
    """Take back what has led the boundary astray: nodes too far from the exact one tell.

    Args:
        geometry, cells, points, tets, faces: of the mesh.
        middle: (m,) the cell at each tetrahedron's middle.
        label: (m,) is changed.
        tolerance: how far the boundary may be off.
    """
    for _ in range(VOTE_CORRECTIONS):
        region = cells.region_of(np.append(label, OUTSIDE)[faces.tets])
        hull = np.unique(faces.triangles[region[:, 0] != region[:, 1]])
        far = np.zeros(len(points), dtype=np.bool_)
        far[hull] = geometry.index.nearest(points[hull]).distance > BOUNDARY_OFF * tolerance
        wrong = np.flatnonzero(far[tets].any(axis=1) & (label != middle))
        if not len(wrong):
            return
        label[wrong] = middle[wrong]


def _heaviest(who: Ints, said: Ints, weight: Array, count: int) -> Ints:
    """For each of `count` the value with the largest sum of weights, -2 where none is given."""
    width = int(said.max(initial=0)) + 2
    key = who * width + said + 1
    unique, which = np.unique(key, return_inverse=True)
    total = np.bincount(which, weight)
    order = np.lexsort((total, unique // width))
    best = np.full(count, -2, dtype=np.int64)
    best[unique[order] // width] = unique[order] % width - 1
    return best
