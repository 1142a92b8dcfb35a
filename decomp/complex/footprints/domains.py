"""The footprint of a site in the plane.

Every point of the skeleton above a site has a foot on it and a direction in which it lies from
there. A domain draws these as points of a plane, one to one, so that sheets can be triangulated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import Face, RegionBoundary
from decomp.carriers import Carrier
from decomp.carriers.charts import Chart
from decomp.complex.footprints.domain_base import AT_APEX, Domain
from decomp.complex.footprints.domain_edges import edge_domain
from decomp.complex.footprints.domain_vertices import vertex_domain
from decomp.complex.plane.planar import Period
from decomp.sites.site import Site, SiteKind
from decomp.vectors import Array, norm

__all__ = ["Domain", "FaceDomain", "domain_of", "face_domain"]


@dataclass(frozen=True, eq=False)
class FaceDomain(Domain):
    """A face's carrier laid out flat.

    Args:
        carrier: of the face.
        outward: +1 if the region's outward normal is the carrier's, else -1.
        chart: of the carrier.
    """

    carrier: Carrier
    outward: int
    chart: Chart

    @property
    def period(self) -> Period:
        return self.chart.period

    def to_plane(self, feet: Array, toward: Array) -> Array:
        return np.asarray(self.chart.to_plane(feet) * np.array([1.0, self.outward]))

    def lift(self, uv: Array) -> tuple[Array, Array]:
        feet = self.chart.to_space(uv * np.array([1.0, self.outward]))
        return feet, -self.outward * self.carrier.normal(feet)


def domain_of(
    boundary: RegionBoundary, site: Site, pole: Array | None = None, reach: float | None = None
) -> Domain:
    """The domain of a site.

    Args:
        boundary: that the site belongs to.
        site: a face, a reentrant edge or a reentrant vertex.
        pole: for a face on a sphere, a unit vector (3,) from its centre to a point off the face.
        reach: for an edge, a typical distance of the skeleton from it; by default a twentieth of
            the boundary's diagonal. Angles are drawn as arcs of that radius.

    Raises:
        GeometryError: a sphere is given no pole.
    """
    if site.kind is SiteKind.EDGE:
        return edge_domain(boundary, site.index, reach or boundary.diagonal / 20)
    if site.kind is SiteKind.VERTEX:
        return vertex_domain(boundary, site.index)
    return face_domain(boundary, boundary.faces[site.index], pole)


def face_domain(boundary: RegionBoundary, face: Face, pole: Array | None = None) -> FaceDomain:
    """The domain of a face; a cone's apex has a place in it only if it is on the face.

    Raises:
        GeometryError: a sphere is given no pole.
    """
    carrier = boundary.carriers[face.carrier]
    tip, reach = False, 1.0
    if carrier.tip is not None:
        at = carrier.tip
        index = next(k for k, f in enumerate(boundary.faces) if f is face)
        corners = [v.point for v in boundary.vertices if index in v.faces]
        tip = any(norm(p - at) <= AT_APEX * boundary.diagonal for p in corners)
        reach = float(norm(face.point - at))
    return FaceDomain(carrier, face.outward, carrier.chart(tip, reach, pole))
