"""What the skeleton looks like around one of its points, from the contacts of the maximal ball.

A ball about p touches the boundary at feet q_k. Close to p the distance to the boundary is
r + min over k of g_k . u, where u is the displacement and g_k = (p - q_k) / r. So near p the
points nearest to foot k are the directions u in which g_k . u is least: the normal cones of the
convex hull of the g_k. Seams leave p along the inward normals of the hull's facets, one for each
facet, however many corners it has; sheets leave p along the hull's edges. Where all g_k lie in one
plane, p is inside a seam, which runs both ways along the plane's normal; with two g_k it is inside
a sheet.

At a convex vertex of the solid the g_k are the inward normals of its faces, and only directions
into the solid count.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.vectors import Array, cross, frame, norm

FLAT = 1e-7
"""Unit vectors that leave a plane by less than this lie in it."""


@dataclass(frozen=True, eq=False)
class SeamRay:
    """A seam that leaves a point.

    Args:
        direction: unit vector (3,).
        contacts: the contacts that are nearest along it, in cyclic order about it (right-handed);
            between neighbours a sheet joins the seam.
        slope: how the radius changes along it.
    """

    direction: Array
    contacts: tuple[int, ...]
    slope: float


def seam_rays(gradients: Array) -> list[SeamRay]:
    """The seams that leave a point with contact gradients (m, 3), all different unit vectors."""
    if len(gradients) < 3:
        return []
    middle = gradients.mean(axis=0)
    _, spread, axes = np.linalg.svd(gradients - middle)
    if spread[1] <= FLAT:
        return []
    if len(spread) < 3 or spread[2] <= FLAT:
        return [_ray(gradients, sign * axes[2], range(len(gradients))) for sign in (1.0, -1.0)]
    return [_ray(gradients, -normal, corners) for normal, corners in _facets(gradients)]


def _ray(gradients: Array, direction: Array, contacts: range | list[int]) -> SeamRay:
    x, y = frame(direction)
    chosen = list(contacts)
    around = gradients[chosen] - gradients[chosen].mean(axis=0)
    order = np.argsort(np.arctan2(around @ y, around @ x))
    slope = float(np.mean(gradients[chosen] @ direction))
    return SeamRay(direction, tuple(chosen[k] for k in order), slope)


def _facets(points: Array) -> list[tuple[Array, list[int]]]:
    """Facets of the convex hull of points on the unit sphere: outward normals and corners.

    Every triple is tried: contacts are few, and coplanar ones must come out as one facet.
    """
    found: dict[tuple[int, ...], Array] = {}
    count = len(points)
    for i in range(count):
        for j in range(i + 1, count):
            for k in range(j + 1, count):
                normal = cross(points[j] - points[i], points[k] - points[i])
                length = float(norm(normal))
                if length <= FLAT:
                    continue
                normal = normal / length
                heights = points @ normal - points[i] @ normal
                for side in (1.0, -1.0):
                    if (side * heights <= FLAT).all():
                        corners = tuple(np.flatnonzero(np.abs(heights) <= FLAT).tolist())
                        found.setdefault(corners, side * normal)
    return [(normal, list(corners)) for corners, normal in found.items()]
