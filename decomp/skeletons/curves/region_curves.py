"""All that is known of a region's skeleton before its sheets: its curves, their nodes and loci."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.curves_of_region import (
    LocusRun,
    ray_pieces,
    reflexive_pieces,
    seam_pieces,
    trim_pieces,
)
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.curves.normal_curves import NormalCurve, normal_curves
from decomp.skeletons.curves.pieces import CurvePiece, network
from decomp.skeletons.curves.reflexive import ReflexivePart, reflexive_parts
from decomp.skeletons.curves.relabel import merging_rays, relabelled
from decomp.skeletons.curves.rims import rim_pieces
from decomp.skeletons.curves.sectors import with_pairs
from decomp.skeletons.curves.touching import touching_points
from decomp.skeletons.seams.graph import seam_graph
from decomp.skeletons.seams.meeting_seams import SeamMeetings
from decomp.vectors import Array

SAME = 1e-9
"""Parameters that differ by less than this part of an edge are one."""


@dataclass(frozen=True, eq=False)
class RegionCurves:
    """Curves of one region's skeleton.

    Args:
        incidence: of the region.
        nodes: (n, 3): the region's vertices, then the reflexive points, then all others.
        pieces: between them, with the pairs of sites whose sheets they border.
        over: the normal curves, into which `CurvePiece.over` points.
        reflexive: curves and points.
        runs: parts of normal curves whose centres lie on reflexive loci.
    """

    incidence: Incidence
    nodes: Array
    pieces: tuple[CurvePiece, ...]
    over: tuple[NormalCurve, ...]
    reflexive: tuple[ReflexivePart, ...]
    runs: tuple[LocusRun, ...]

    @property
    def vertices(self) -> int:
        """How many of the nodes are vertices of the region."""
        return len(self.incidence.boundary.vertices)

    @property
    def points(self) -> list[ReflexivePart]:
        """The reflexive points, in the order of their nodes after the vertices."""
        return [part for part in self.reflexive if part.dimension == 0]

    def turns(self, number: int) -> list[float]:
        """Where, over a normal curve, the centres turn back on a reflexive locus: parameters."""
        curve = self.over[number]
        runs = [run for run in self.runs if run.over == number and not run.resting]
        runs.sort(key=lambda run: float(run.s[0]))
        span = curve.end - curve.start
        found = [
            float(after.s[0])
            for run, after in pairwise(runs)
            if abs(run.s[-1] - after.s[0]) <= SAME * span
        ]
        if curve.closed and len(runs) > 1 and runs[-1].s[-1] - span >= runs[0].s[0] - SAME * span:
            found.insert(0, float(runs[0].s[0]))
        return found

    def turning_feet(self) -> list[Array]:
        """The points (3,) of edges over which centres turn back."""
        found: list[Array] = []
        for number, curve in enumerate(self.over):
            found.extend(curve.feet(np.array(self.turns(number))))
        return found


def region_curves(context: RegionContext, samples: int) -> RegionCurves:
    """Find all curves of a region's skeleton.

    Args:
        context: of the region.
        samples: boundary points from which seams are looked for that no node leads to.

    Raises:
        GeometryError: a curve cannot be followed; says where.
    """
    boundary, incidence = context.boundary, Incidence(context)
    graph = seam_graph(context, samples=samples)
    over = normal_curves(incidence)
    parts = reflexive_parts(incidence)
    trims, locus_runs = trim_pieces(incidence, over)
    seams = seam_pieces(incidence, graph.seams)
    loci = reflexive_pieces(parts)
    found = [
        *seams,
        *trims,
        *ray_pieces(incidence),
        *rim_pieces(incidence),
        *merging_rays(incidence),
        *loci,
    ]
    fixed = [v.point for v in boundary.vertices] + [p.ends[0] for p in parts if p.dimension == 0]
    # loci end exactly; centres that rest on one tell its end to half the digits
    open_ = [piece for piece in loci if (piece.points[0] != piece.points[-1]).any()]
    turns = [piece.points[k] for piece in open_ for k in (0, -1)]
    turns += [run.points[k] for run in locus_runs for k in (0, -1)]
    touches = touching_points(incidence, [*seams, *trims])
    runs = [run for seam in graph.seams for run in seam.runs]
    touches += [meeting.point for meeting in SeamMeetings(context).of(runs)]
    # the graph has told junctions apart by their contacts
    junctions = [node.point for node in graph.nodes if node.radius > 0]
    ends = np.array(fixed).reshape(-1, 3)
    joined = network(boundary.diagonal, ends, found, turns, touches, junctions)
    pieces = with_pairs(incidence, relabelled(incidence, joined.pieces))
    return RegionCurves(
        incidence, joined.nodes, tuple(pieces), tuple(over), tuple(parts), tuple(locus_runs)
    )
