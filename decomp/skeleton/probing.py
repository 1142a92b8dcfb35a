"""Compiled nearest-boundary queries inside one region, one point at a time.

They tell distance and foot, not which of several faces on one carrier it is: `SiteIndex.nearest`
names sites.
"""

from __future__ import annotations

from typing import NamedTuple

from decomp.sites import SiteIndex
from decomp.sites.box_tree import BoxTree, nearest_in_boxes
from decomp.sites.candidates import CandidateTree
from decomp.sites.measure import NONE, Hit, better_inlined, no_hit
from decomp.sites.occupancy import OccupancyTree, label_at, private
from decomp.sites.octree import locate
from decomp.sites.site_table import SiteTable
from decomp.skeleton.compiled import inlined, scalar
from decomp.vectors import Array

TOUCH = 1e-11
"""Distances that differ by less than this part of the size count as equal."""
TOWARDS = 0.3
"""How far towards a foot a query is made to see whether the foot is on the boundary."""
HOLDS, INTRUDED, LOST = 0, 1, 2


class Probe(NamedTuple):
    """All that queries in one region need.

    Args:
        occupancy: tells regions apart; with scratch of its own.
        sites, candidates, boxes: of the region.
        label: its index.
        slack: distances that differ by less count as equal.
    """

    occupancy: OccupancyTree
    sites: SiteTable
    candidates: CandidateTree
    boxes: BoxTree
    label: int
    slack: float


def probe(index: SiteIndex, region: int, size: float) -> Probe:
    """Collect what queries in a region need."""
    part = index._part(region)
    return Probe(
        private(index.occupancy),
        part.sites.table,
        part.candidates,
        part.boxes,
        region,
        TOUCH * size,
    )


@inlined
def inside(probe: Probe, x: float, y: float, z: float) -> bool:
    """Whether a point is in the region."""
    return label_at(probe.occupancy, x, y, z) == probe.label


@inlined
def nearest_hit(probe: Probe, x: float, y: float, z: float) -> Hit:
    """The nearest boundary point of the region, for points in it or close to it."""
    hit = no_hit()
    leaf = locate(probe.candidates.tree, x, y, z)
    if leaf >= 0:
        for m in range(probe.candidates.first[leaf], probe.candidates.first[leaf + 1]):
            k = probe.candidates.items[m]
            hit = better_inlined(probe.occupancy, probe.sites, probe.label, k, x, y, z, hit)
    if hit.candidate == NONE:
        hit = nearest_in_boxes(probe.occupancy, probe.sites, probe.boxes, probe.label, x, y, z)
    return hit


@scalar
def inspect(
    probe: Probe, x: float, y: float, z: float, radius: float, feet: Array, first: int, count: int
) -> tuple[int, int]:
    """Whether a ball is empty and touches the boundary at `count` feet, from row `first` on.

    Returns:
        HOLDS; INTRUDED if something is nearer than the radius or the centre is outside; LOST and
        which foot if one is not on the boundary.
    """
    if not inside(probe, x, y, z):
        return INTRUDED, -1
    if nearest_hit(probe, x, y, z).distance < radius - probe.slack:
        return INTRUDED, -1
    for c in range(count):
        row = first + c
        px = x + TOWARDS * (feet[row, 0] - x)
        py = y + TOWARDS * (feet[row, 1] - y)
        pz = z + TOWARDS * (feet[row, 2] - z)
        if nearest_hit(probe, px, py, pz).distance > (1.0 - TOWARDS) * radius + probe.slack:
            return LOST, c
    return HOLDS, -1
