"""Is the skeleton of the right topology, and are its cells closed and complete?"""

from __future__ import annotations

import numpy as np

from decomp.skeletons.cells.surface import is_closed, open_edges, side_triangles
from decomp.skeletons.certificate.evidence import Evidence, Worst
from decomp.vectors import Ints


def euler(evidence: Evidence) -> int:
    """Euler characteristic of the union of all sheets, reflexive curves and reflexive points.

    Sheets that reach the boundary count with what they have there: they are closed sets.
    """
    triangles = np.unique(np.sort(evidence.sheet_triangles(), axis=1), axis=0)
    segments = np.concatenate([sides_of(triangles), evidence.reflexive_segments()])
    segments = np.unique(np.sort(segments, axis=1), axis=0)
    return len(evidence.skeleton_vertices()) - len(segments) + len(triangles)


def sides_of(triangles: Ints) -> Ints:
    """The three sides (3 m, 2) of each triangle (m, 3)."""
    return triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)


def open_cells(evidence: Evidence) -> Worst:
    """The number of cells of either kind whose surface is not a closed 2-cycle."""
    cells = (*evidence.cells, *evidence.face_cells)
    opened = [cell for cell in cells if not is_closed(evidence.complex, cell.sides)]
    if not opened:
        return Worst(0.0)
    edge = open_edges(side_triangles(evidence.complex, opened[0].sides))[0]
    return Worst(float(len(opened)), evidence.complex.points[edge].mean(axis=0))


def volume_error(evidence: Evidence) -> float:
    """Relative error of the sum of the cells' volumes; of cells of either kind, the larger."""
    volume = evidence.boundary.volume
    sums = [sum(c.volume for c in cells) for cells in (evidence.cells, evidence.face_cells)]
    return max(abs(total - volume) / abs(volume) for total in sums)
