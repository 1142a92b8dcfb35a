"""Is anything missing? From random boundary points, maximal balls must end on the skeleton.

Sheets between two reentrant edges or vertices have no feet inside faces: they are looked for by
balls that touch the edges, in random directions between the normals of their faces.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.boundary.topology import Convexity
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.balls import inscribed_balls
from decomp.skeletons.balls.queries import region_queries
from decomp.skeletons.certificate.distance import TriangleTree, triangle_distance, triangle_tree
from decomp.skeletons.certificate.evidence import Evidence, Worst
from decomp.skeletons.seams.edge_seeds import EdgeFan
from decomp.vectors import Array, Bools, Ints, cross, norm

LEAST = 20
"""Balls on the smallest of faces and edges."""
ON_EDGES = 0.1
"""So many balls on edges for each one on faces."""
BESIDE = 1e-2
"""A foot off its point by no more than this part of the step is that point."""

STEP = 1e-7
"""How far from the boundary it is asked which face is nearest, relative to the region's size."""
ASIDE = 1e-3
"""Beside a face its distance is the step itself, but for this part of it."""


def coverage(evidence: Evidence, balls: int, seed: int) -> Worst:
    """The largest distance from the centre of a maximal ball to the skeleton.

    Args:
        balls: about how many, shared out by area, with some on every face and reentrant edge.
        seed: of the random numbers.

    Raises:
        GeometryError: a ball does not come to rest.
    """
    rng = np.random.default_rng(seed)
    parts = [*boundary_samples(evidence, balls, rng), *edge_samples(evidence, balls, rng)]
    points = np.concatenate([points for points, _ in parts])
    inward = np.concatenate([inward for _, inward in parts])
    found = inscribed_balls(evidence.context, points, inward)
    away = triangle_distance(skeleton_tree(evidence), found.centre)
    k = int(np.argmax(away))
    site = int(found.site[k])
    own = int(evidence.index.nearest(points[k : k + 1] + _step(evidence) * inward[k]).site[0])
    sites = (own,) if site < 0 else (own, site)
    return Worst(float(away[k]) / evidence.diagonal, found.centre[k], sites)


def skeleton_tree(evidence: Evidence) -> TriangleTree:
    """A search tree over sheets, reflexive curves and reflexive points."""
    corners = [
        evidence.sheet_triangles(),
        evidence.reflexive_segments()[:, [0, 1, 1]],
        np.repeat(evidence.reflexive_points()[:, None], 3, axis=1),
    ]
    return triangle_tree(evidence.complex.points[np.concatenate(corners)])


def boundary_samples(
    evidence: Evidence, count: int, rng: np.random.Generator
) -> Iterator[tuple[Array, Array]]:
    """Random points (k, 3) of each face, exactly on it, with inward unit normals (k, 3).

    They are drawn from the face's triangles and brought onto its carrier; the few that come to lie
    beyond the face's edge are left out.
    """
    boundary = evidence.boundary
    whole = sum(face.area for face in boundary.faces)
    for number, (face, sides) in enumerate(zip(boundary.faces, evidence.face_sides, strict=True)):
        carrier = boundary.carriers[face.carrier]
        triangles = np.concatenate(
            [evidence.complex.patches[patch].triangles for patch, _ in sides]
        )
        share = max(LEAST, round(count * face.area / whole))
        drawn = random_points(evidence.complex.points, triangles, share, rng)
        points = carrier.project(np.concatenate([face.point[None], drawn]))
        inward = -face.outward * carrier.normal(points)
        inside = _in_face(evidence, number, points, inward)
        yield points[inside], inward[inside]


def edge_samples(
    evidence: Evidence, count: int, rng: np.random.Generator
) -> Iterator[tuple[Array, Array]]:
    """Random points (k, 3) of each reentrant edge, with directions (k, 3) between its normals."""
    boundary = evidence.boundary
    edges = [edge for edge in boundary.edges if edge.convexity is Convexity.REENTRANT]
    whole = sum(edge.length for edge in edges)
    step, queries = _step(evidence), region_queries(evidence.index, evidence.region)
    for edge in edges:
        share = max(LEAST, round(ON_EDGES * count * edge.length / whole))
        points, inward = EdgeFan(boundary, edge).place(rng.random((share, 2)))
        found = queries.nearest(points + step * inward)
        # beside the ends of an edge another one may be nearer
        own = (found.site >= 0) & (norm(found.foot - points) <= BESIDE * step)
        yield points[own], inward[own]


def random_points(points: Array, triangles: Ints, count: int, rng: np.random.Generator) -> Array:
    """Points (count, 3) spread evenly over triangles (m, 3)."""
    corners = points[triangles]
    area = norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    chosen = rng.choice(len(triangles), size=count, p=area / area.sum())
    u, v = rng.random((2, count, 1))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    a, b, c = np.moveaxis(corners[chosen], 1, 0)
    return np.asarray(a + u * (b - a) + v * (c - a))


def _step(evidence: Evidence) -> float:
    return STEP * evidence.boundary.diagonal


def _in_face(evidence: Evidence, number: int, points: Array, inward: Array) -> Bools:
    """Whether points of a face's carrier lie in the face: from a little inside it is nearest."""
    step = _step(evidence)
    found = region_queries(evidence.index, evidence.region).nearest(points + step * inward)
    own = [
        s.kind is SiteKind.FACE and s.region == evidence.region and s.index == number
        for s in evidence.sites
    ]
    inside: Bools = np.array(own, dtype=np.bool_)[found.site]
    inside &= (found.site >= 0) & (np.abs(found.distance - step) <= ASIDE * step)
    return inside
