"""What a point can be nearest to."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from decomp.boundary.topology import RegionBoundary
from decomp.sites.site_table import RegionSites


class SiteKind(Enum):
    """The kinds of sites: a face's interior, a reentrant edge, a reentrant vertex."""

    FACE = "face"
    EDGE = "edge"
    VERTEX = "vertex"


@dataclass(frozen=True)
class Site:
    """A part of a boundary that points can be nearest to.

    Args:
        region: index of the region, -1 for the outside of all regions.
        kind: face, edge or vertex.
        index: into the boundary's faces, edges or vertices.
        name: of the face; of an edge or vertex the names of its faces, joined by `|`.
    """

    region: int
    kind: SiteKind
    index: int
    name: str


def sites_of(boundary: RegionBoundary, region: int, sites: RegionSites) -> tuple[Site, ...]:
    """A region's sites, in the order of their numbers."""

    def joined(faces: tuple[int, ...]) -> str:
        return "|".join(sorted(boundary.faces[f].name for f in faces))

    faces = [Site(region, SiteKind.FACE, k, face.name) for k, face in enumerate(boundary.faces)]
    edges = [Site(region, SiteKind.EDGE, k, joined(boundary.edges[k].faces)) for k in sites.edges]
    vertices = [
        Site(region, SiteKind.VERTEX, k, joined(boundary.vertices[k].faces)) for k in sites.vertices
    ]
    return (*faces, *edges, *vertices)


def faces_at(boundary: RegionBoundary, site: Site) -> set[int]:
    """The faces that a site of a region is, or is an edge or a vertex of."""
    match site.kind:
        case SiteKind.FACE:
            return {site.index}
        case SiteKind.EDGE:
            return set(boundary.edges[site.index].faces)
        case SiteKind.VERTEX:
            return set(boundary.vertices[site.index].faces)
