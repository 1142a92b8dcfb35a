"""Which regions can be traced: sheets are followed where their Voronoi surfaces are known."""

from __future__ import annotations

from decomp.boundary.topology import RegionBoundary
from decomp.errors import GeometryError


def refuse_untraceable(boundary: RegionBoundary) -> None:
    """Raise GeometryError if a region has a face on a carrier of which no skeleton is traced."""
    for face in boundary.faces:
        carrier = boundary.carriers[face.carrier]
        if not carrier.traceable:
            raise GeometryError(
                f"region {boundary.name!r}: {face.name} is on an {carrier.kind}, of which no "
                "skeleton is traced: '--method sampled' looks for it by sampling",
                [face.name],
            )
