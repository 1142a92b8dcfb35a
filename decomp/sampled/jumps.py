"""Is every sheet one? The nearest point has to jump across it; the certificate does not ask."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.complex.model import Complex
from decomp.places import place
from decomp.sites.site import Site
from decomp.skeletons.model import RegionSkeleton
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.vectors import Array

LEAST_JUMP = 1e-3
"""Radians between the directions to both feet, at the least, inside a sheet."""


def without_jump(
    mesh: Complex, radius: Array, region: RegionSkeleton, sites: Sequence[Site]
) -> list[str]:
    """One line for each sheet of a region whose two feet are one somewhere inside it.

    Args:
        mesh: the complex.
        radius: (n,) of its points.
        region: whose sheets are asked.
        sites: of the model.

    Raises:
        GeometryError: a point inside a sheet has no place on it.
    """
    on_line = np.zeros(len(mesh.points), dtype=np.bool_)
    for line in mesh.lines:
        on_line[line.vertices] = True
    found = []
    for sheet in region.sheets:
        patch = mesh.patches[sheet.patch]
        surface = patch.surface
        assert isinstance(surface, SheetSurface)
        inside = np.unique(patch.triangles)
        inside = inside[~on_line[inside] & (radius[inside] > 0)]
        points = mesh.points[inside]
        if not len(inside):
            points = surface.place(mesh.points[patch.triangles].mean(axis=1))
        angle, _ = surface.facing(points)
        one = np.flatnonzero(angle < LEAST_JUMP)  # nan where a point has many feet on one site
        if len(one):
            names = " and ".join(sites[k].name for k in sheet.sites)
            found.append(f"no jump across the sheet of {names} at {place(points[one[0]])}")
    return found
