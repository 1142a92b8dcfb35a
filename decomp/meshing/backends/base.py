"""What a mesher is given and what it gives: the protocol of the entries of `table.py`.

A mesher fills a complex of triangles with tetrahedra. It may leave the triangles by a tolerance:
nodes are put onto the exact surfaces afterwards. It need not know what it fills either: what a
tetrahedron belongs to is then asked of the exact geometry.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from decomp.errors import DecompError
from decomp.meshing.sizing.size_field import SizeField
from decomp.vectors import Array, Ints

PATIENCE = 4.0
"""By the clock, work may take so many times as long as on a machine with nothing else to do."""


class MeshingError(DecompError):
    """A mesher gave no mesh."""

    exit_code = 4


class Repair(Enum):
    """What a mesher that follows triangles to a tolerance may leave amiss, and has mended.

    Whatever mesher there was, elements without a free node get one, edges longer than allowed are
    cut and small angles improved.
    """

    LAYERS = "layers thinner than the tolerance are pressed flat: they are opened again"
    DENTS = "edges are cut off and sheets end early: what lies at such nodes is changed"
    CHANCE = "triangles are left out by chance: it is run once more, and the better mesh taken"


@dataclass(frozen=True)
class TimeLimit:
    """When a mesher is stopped.

    Args:
        clock: seconds that may pass.
        busy: seconds that it may compute, whatever else the machine does, in whole ones. Where a
            mesher or the system has no such limit the clock's counts alone.
    """

    clock: float
    busy: float = math.inf

    @classmethod
    def of_work(cls, seconds: float) -> TimeLimit:
        """For so much work, on a machine that may be doing other things beside it."""
        return cls(PATIENCE * seconds, seconds)


@dataclass(frozen=True, eq=False)
class Task:
    """What is to be filled.

    Args:
        points: (n, 3) in model units, all used.
        triangles: (m, 3) indices of points. They share their edges and corners, and no two cross;
            together they enclose all that is to be filled.
        beside: (m, 2) the cells that each triangle's normal points into and out of; -1 where none
            is, on both sides for a triangle that parts no cells.
        length: of edges, wanted where nothing asks for shorter ones.
        lengths: points (k, 3) -> lengths (k,) of edges wanted there.
        field: the same at the nodes of a background mesh, all around; None if `length` is all.
        tolerance: how far tetrahedra may leave the triangles.
    """

    points: Array
    triangles: Ints
    beside: Ints
    length: float
    lengths: Callable[[Array], Array]
    field: SizeField | None
    tolerance: float


@dataclass(frozen=True, eq=False)
class Tetrahedra:
    """What a mesher has made of a task.

    Args:
        points: (n, 3) in model units.
        tets: (m, 4) positively oriented; they may reach beyond what is to be filled.
        tolerance: how far they leave the triangles, which may be less than was allowed.
        cells: (m,) the cell that each is in, -1 for none; None where this is to be asked of the
            geometry.
    """

    points: Array
    tets: Ints
    tolerance: float
    cells: Ints | None = None


@dataclass(frozen=True)
class Mesher:
    """A way to fill a complex with tetrahedra.

    Args:
        title: what it is called where its progress is told.
        repairs: what it needs.
        run: fills a task within a time limit; tells in words of what went wrong on the way. Raises
            `MeshingError` where there is no mesh, `InputError` for a task that it cannot do.
    """

    title: str
    repairs: frozenset[Repair]
    run: Callable[[Task, TimeLimit, Callable[[str], None]], Tetrahedra]
