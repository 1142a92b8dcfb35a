"""The nearest site of many points of one region."""

from __future__ import annotations

from decomp.kernels.compiled import inlined, scalar
from decomp.sites.box_tree import BoxTree, nearest_in_boxes
from decomp.sites.candidates import CandidateTree
from decomp.sites.measure import NONE, Hit, better_inlined, no_hit
from decomp.sites.occupancy import Labels, OccupancyTree
from decomp.sites.octree import locate
from decomp.sites.site_table import SiteTable
from decomp.vectors import Array, Ints


@inlined
def nearest_hit(
    occupancy: OccupancyTree,
    sites: SiteTable,
    candidates: CandidateTree,
    boxes: BoxTree,
    label: int,
    x: float,
    y: float,
    z: float,
) -> Hit:
    """The nearest boundary point of a region, for points in it or close to it."""
    hit = no_hit()
    leaf = locate(candidates.tree, x, y, z)
    if leaf >= 0:
        for m in range(candidates.first[leaf], candidates.first[leaf + 1]):
            k = candidates.items[m]
            hit = better_inlined(occupancy, sites, label, k, x, y, z, hit)
    if hit.candidate == NONE:
        hit = nearest_in_boxes(occupancy, sites, boxes, label, x, y, z)
    return hit


@scalar
def nearest_in_region(
    occupancy: OccupancyTree,
    sites: SiteTable,
    candidates: CandidateTree,
    boxes: BoxTree,
    label: int,
    points: Array,
    labels: Labels,
    found: Ints,
    distances: Array,
    feet: Array,
    slots: Ints,
) -> None:
    """Fill in candidate, distance, foot and slot of the points (n, 3) that carry a label."""
    for i in range(len(points)):
        if labels[i] != label:
            continue
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        hit = nearest_hit(occupancy, sites, candidates, boxes, label, x, y, z)
        found[i], distances[i], slots[i] = hit.candidate, hit.distance, hit.slot
        feet[i, 0], feet[i, 1], feet[i, 2] = hit.x, hit.y, hit.z
