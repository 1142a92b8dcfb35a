"""Slow, plain references for the queries, written from the definitions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from decomp.boundary.topology import Convexity, Edge, RegionBoundary
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.vectors import Array, Bools, norm


def holds(form: HalfSpaceForm, label: int, inside: Bools) -> Bools:
    """Whether a region (-1: the outside) has sign patterns (..., n_carriers)."""
    regions = form.program.evaluate(inside)
    return ~regions.any(axis=-1) if label < 0 else regions[..., label]


def labels(form: HalfSpaceForm, points: Array) -> Array:
    """The first region that holds each point, -1 if none does."""
    regions = form.regions_at(points)
    return np.where(regions.any(axis=1), regions.argmax(axis=1), -1)


def clear_of(form: HalfSpaceForm, points: Array, gap: float, but: int = -1) -> Bools:
    """Which points are further than `gap` from every carrier (except one)."""
    away = np.abs(form.signed_distances(points))
    if but >= 0:
        away[:, but] = np.inf
    return np.asarray((away > gap).all(axis=1))


def accepted(form: HalfSpaceForm, label: int, carrier: int, points: Array) -> Bools:
    """Whether points on a carrier, clear of all others, are on a region's boundary."""
    inside = form.signed_distances(points) < 0
    inside[:, carrier] = True
    behind = holds(form, label, inside)
    inside[:, carrier] = False
    return np.asarray(behind != holds(form, label, inside))


def boundary_samples(
    form: HalfSpaceForm, label: int, box: Array, count: int, rng: np.random.Generator
) -> Array:
    """Points on a region's boundary: random points moved to every carrier and kept if on it."""
    found = []
    for k, carrier in enumerate(form.carriers):
        feet = carrier.project(rng.uniform(box[0], box[1], (count, 3)))
        feet = feet[clear_of(form, feet, 1e-9 * form.scale, k)]
        found.append(feet[accepted(form, label, k, feet)])
    return np.concatenate(found)


def nearest_on_edge(edge: Edge, points: Array) -> Array:
    """Distance to an edge: in each of its parts the best of some samples, then of finer ones."""
    best = np.full(len(points), np.inf)
    ends = np.linspace(edge.start, edge.end, 13 if edge.curve.kind != "line" else 2)
    for first, last in pairwise(ends):
        low, high = np.full(len(points), first), np.full(len(points), last)
        for _ in range(6):
            step = (high - low) / 15
            t = low[:, None] + step[:, None] * np.arange(16)
            gaps = norm(edge.curve.point(t) - points[:, None])
            at = t[np.arange(len(points)), gaps.argmin(axis=1)]
            best = np.minimum(best, gaps.min(axis=1))
            low, high = np.maximum(at - step, first), np.minimum(at + step, last)
    return best


def nearest_distance(
    form: HalfSpaceForm, boundary: RegionBoundary, label: int, points: Array
) -> Array:
    """Least distance to carriers' feet on the boundary, reentrant edges and vertices."""
    best = np.full(len(points), np.inf)
    for k, carrier in enumerate(form.carriers):
        feet = carrier.project(points)
        good = accepted(form, label, k, feet)
        best = np.where(good, np.minimum(best, norm(points - feet)), best)
    for edge in boundary.edges:
        if edge.convexity is Convexity.REENTRANT:
            best = np.minimum(best, nearest_on_edge(edge, points))
    for vertex in boundary.vertices:
        if vertex.convexity in (Convexity.REENTRANT, Convexity.SADDLE):
            best = np.minimum(best, norm(points - vertex.point))
    return best
