"""How fine triangles must be for the volume's sake.

Sheets cancel in the sum of the cells' volumes, so its error depends on the boundary alone, and is
known before there are any sheets. It goes with the chord error.
"""

from __future__ import annotations

from decomp.cells.surface import volume
from decomp.certificate.certificate import VOLUME
from decomp.complex.boundary import BoundaryMesh, boundary_mesh
from decomp.complex.model import Complex
from decomp.complex.refine import refine
from decomp.geometry import Geometry

SPARE = 0.9
"""What the volume's error is brought to, as a part of what is allowed."""


def fine_enough(geometry: Geometry, relative: float, share: float) -> float:
    """A chord tolerance with which the volumes are close enough, no more than a given one.

    Args:
        geometry: of the model.
        relative: the given one, relative to the model's diagonal as is the result.
        share: the part of it that curves may use up.
    """
    tolerance = relative * geometry.diagonal
    surface = boundary_mesh(geometry, share * tolerance)
    # refining only brings the triangles closer
    if volume_error(geometry, surface, surface.complex) <= SPARE * VOLUME:
        return relative
    error = volume_error(geometry, surface, refine(surface.complex, tolerance))
    return finer(relative, error / VOLUME) if error > VOLUME else relative


def finer(relative: float, excess: float) -> float:
    """The chord tolerance after one with which an error is so many times as large as allowed."""
    return relative * SPARE / excess


def volume_error(geometry: Geometry, surface: BoundaryMesh, mesh: Complex) -> float:
    """The largest error of a region's volume inside a complex's boundary, relative to it.

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
    return max(errors)
