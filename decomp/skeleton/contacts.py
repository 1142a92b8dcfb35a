"""All contacts of a maximal ball with the boundary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.sites import SiteIndex
from decomp.sites.site import Site, SiteKind
from decomp.skeleton.fields import site_fields
from decomp.vectors import Array, Ints, norm

TOWARDS = 0.3


@dataclass(frozen=True, eq=False)
class Contacts:
    """Where the maximal ball about a point touches the boundary.

    Args:
        radius: of the ball.
        feet: (m, 3), pairwise different.
        sites: for each foot all sites that have it, those of the lowest dimension first.
        gradients: (m, 3), unit vectors from the feet to the point.
    """

    radius: float
    feet: Array
    sites: tuple[tuple[int, ...], ...]
    gradients: Array


def contacts(
    index: SiteIndex, boundary: RegionBoundary, region: int, point: Array, slack: float
) -> Contacts:
    """Find every site whose foot is no more than `slack` farther than the nearest.

    A site's support may come near without the site (its foot lies outside the face). That is told
    by a query a little way towards the foot: from there the foot, if on the boundary, is nearest.
    """
    sites = index.sites
    here = np.array([k for k, s in enumerate(sites) if s.region == region], dtype=np.int64)
    nearest = index.nearest(point[None])
    radius = float(nearest.distance[0])
    points = np.repeat(point[None], len(here), axis=0)
    field = site_fields(boundary, sites, here, points, np.repeat(nearest.foot, len(here), axis=0))
    close = np.abs(field.distance - radius) <= slack
    here, feet = here[close], field.foot[close]
    towards = index.nearest(point + TOWARDS * (feet - point))
    true = np.abs(towards.distance - (1 - TOWARDS) * radius) <= slack
    return _grouped(sites, point, radius, here[true], feet[true], max(slack, 1e-6 * radius))


def _grouped(
    sites: Sequence[Site], point: Array, radius: float, which: Ints, feet: Array, gap: float
) -> Contacts:
    """Join sites that share a foot."""
    order = {SiteKind.VERTEX: 0, SiteKind.EDGE: 1, SiteKind.FACE: 2}
    groups: list[tuple[Array, list[int]]] = []
    for number, foot in sorted(
        zip(which.tolist(), feet, strict=True), key=lambda item: order[sites[item[0]].kind]
    ):
        for place, members in groups:
            if float(norm(place - foot)) <= gap:
                members.append(number)
                break
        else:
            groups.append((foot, [number]))
    places = np.array([foot for foot, _ in groups]).reshape(-1, 3)
    return Contacts(
        radius,
        places,
        tuple(tuple(members) for _, members in groups),
        (point - places) / radius,
    )
