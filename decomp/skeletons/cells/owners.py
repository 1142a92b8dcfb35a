"""Which face owns each site: a cell is what is nearest to the sites of one face."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.sites.site import Site, SiteKind
from decomp.vectors import Ints


def site_owners(sites: Sequence[Site], boundaries: Sequence[RegionBoundary]) -> Ints:
    """The face (s,) that owns each site: an edge's is its first, -1 for sites of the outside.

    A reentrant vertex belongs to the face of its first reentrant edge.
    """
    edges = {(site.region, site.index) for site in sites if site.kind is SiteKind.EDGE}
    owner = np.full(len(sites), -1, dtype=np.int64)
    for number, site in enumerate(sites):
        if site.region < 0:
            continue
        boundary = boundaries[site.region]
        if site.kind is SiteKind.FACE:
            owner[number] = site.index
        elif site.kind is SiteKind.EDGE:
            owner[number] = boundary.edges[site.index].faces[0]
        else:
            vertex = boundary.vertices[site.index]
            own = [edge for edge in vertex.edges if (site.region, edge) in edges]
            owner[number] = boundary.edges[own[0]].faces[0] if own else vertex.faces[0]
    return owner
