"""Compiled nearest-boundary queries inside one region, one point at a time.

They tell distance and foot, not which of several faces on one carrier it is: `SiteIndex.nearest`
names sites.
"""

from __future__ import annotations

from dataclasses import dataclass

from decomp.carriers.compiled_carriers import Triple, foot
from decomp.kernels.compiled import inner
from decomp.kernels.records import Record
from decomp.sites.box_tree import BoxTree
from decomp.sites.candidates import CandidateTree
from decomp.sites.measure import Hit
from decomp.sites.nearest import nearest_hit
from decomp.sites.occupancy import OccupancyTree, label_at
from decomp.sites.octree import locate
from decomp.sites.site_bounds import edge_foot
from decomp.sites.site_table import SiteTable
from decomp.skeletons.balls.contact_rows import ContactRows
from decomp.tolerance import TOUCHING

TOWARDS = 0.3
"""How far towards a foot a query is made to see whether the foot is on the boundary."""
HOLDS, INTRUDED, LOST, JOINED = 0, 1, 2, -1
APART = 1e-3
"""Feet farther apart than this part of the radius are different contacts."""


@dataclass(frozen=True, eq=False)
class Probe(Record):
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


def probe_of(
    occupancy: OccupancyTree,
    sites: SiteTable,
    candidates: CandidateTree,
    boxes: BoxTree,
    label: int,
    size: float,
) -> Probe:
    """Put together what queries in a region of a given size need."""
    return Probe(occupancy, sites, candidates, boxes, label, TOUCHING * size)


@inner
def inside(probe: Probe, x: float, y: float, z: float) -> bool:
    """Whether a point is in the region."""
    return label_at(probe.occupancy, x, y, z) == probe.label


@inner
def nearest(probe: Probe, x: float, y: float, z: float) -> Hit:
    """The nearest boundary point of the region, for points in it or close to it."""
    return nearest_hit(
        probe.occupancy, probe.sites, probe.candidates, probe.boxes, probe.label, x, y, z
    )


@inner
def candidate_foot(probe: Probe, k: int, x: float, y: float, z: float) -> Triple:
    """The foot on a candidate's support, or on a part of an edge."""
    sites = probe.sites
    faces, edges = len(sites.face_carriers), len(sites.kinds)
    if k < faces:
        return foot(probe.occupancy.table, sites.face_carriers[k], x, y, z)
    if k < faces + edges:
        _, qx, qy, qz = edge_foot(sites, probe.occupancy.table, k - faces, x, y, z, 0.0)
        return qx, qy, qz
    v = k - faces - edges
    return sites.vertices[v, 0], sites.vertices[v, 1], sites.vertices[v, 2]


@inner
def another(
    probe: Probe, contacts: ContactRows, first: int, x: float, y: float, z: float, radius: float
) -> bool:
    """Whether a ball touches the boundary elsewhere than at its contacts, from row `first` on."""
    feet = contacts.feet
    reach = (radius + probe.slack) ** 2
    leaf = locate(probe.candidates.tree, x, y, z)
    if leaf < 0:
        return False
    for m in range(probe.candidates.first[leaf], probe.candidates.first[leaf + 1]):
        qx, qy, qz = candidate_foot(probe, probe.candidates.items[m], x, y, z)
        if (qx - x) ** 2 + (qy - y) ** 2 + (qz - z) ** 2 > reach:
            continue
        known = False
        for c in range(contacts.count):
            dx, dy, dz = qx - feet[first + c, 0], qy - feet[first + c, 1], qz - feet[first + c, 2]
            if dx * dx + dy * dy + dz * dz <= (APART * radius) ** 2:
                known = True
        if known:
            continue
        px, py, pz = x + TOWARDS * (qx - x), y + TOWARDS * (qy - y), z + TOWARDS * (qz - z)
        away = nearest(probe, px, py, pz).distance
        if away <= (1.0 - TOWARDS) * radius + probe.slack:
            return True
    return False
