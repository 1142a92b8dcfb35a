"""How fine triangles must be for the volumes' sake, region by region.

Sheets cancel in the sum of the cells' volumes, so its error depends on the boundary alone, and is
known before there are any sheets. It goes with the chord error. A small part in a wide box of air
asks for a chord error of its own: only its faces, and the sheets inside it, are made finer.
"""

from __future__ import annotations

import numpy as np

from decomp.complex.boundary.boundary import BoundaryMesh, boundary_mesh
from decomp.complex.model import Complex
from decomp.complex.refining.refine import refine
from decomp.geometry import Geometry
from decomp.skeletons.cells.surface import volume
from decomp.skeletons.certificate.certificate import VOLUME
from decomp.vectors import Array

SPARE = 0.9
"""What a volume's error is brought to, as a part of what is allowed."""


def fine_enough(geometry: Geometry, relative: float, share: float) -> Array:
    """Chord tolerances (r,) of regions with which volumes are close enough, none above a given one.

    Args:
        geometry: of the model.
        relative: the given one, relative to the model's diagonal as is the result.
        share: the part of it that curves may use up.
    """
    tolerance = relative * geometry.diagonal
    every = np.full(len(geometry.regions), relative)
    surface = boundary_mesh(geometry, share * tolerance)
    # refining only brings the triangles closer
    if volume_errors(geometry, surface, surface.complex).max() <= SPARE * VOLUME:
        return every
    errors = volume_errors(geometry, surface, refine(surface.complex, tolerance))
    return finer(every, errors / VOLUME)


def finer(relative: Array, excess: Array) -> Array:
    """Chord tolerances (r,) after some with which errors are so many times (r,) as is allowed."""
    return np.where(excess > 1.0, relative * SPARE / np.maximum(excess, 1.0), relative)


def volume_errors(geometry: Geometry, surface: BoundaryMesh, mesh: Complex) -> Array:
    """The errors (r,) of the regions' volumes inside a complex's boundary, relative to them.

    Args:
        geometry: of the model.
        surface: the boundaries as they were at first.
        mesh: the complex, in which the boundaries' patches are the first.
    """
    errors = []
    for number, region in enumerate(geometry.regions):
        sides = [
            (patch, sign)
            for patch, each in enumerate(surface.patches)
            if (sign := each.outward_of(number))
        ]
        origin = mesh.points[mesh.patches[sides[0][0]].triangles[0, 0]]
        inside = volume(mesh, sides, origin)
        errors.append(abs(inside - region.volume) / abs(region.volume))
    return np.array(errors)
