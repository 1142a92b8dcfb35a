"""How coarse whole spheres may be that are far from all else: the far end of the air around a part.

The tolerance, and with it the chord tolerance, follows the smallest feature of a model. A sphere
that nothing comes near needs no such chords: its own edges, which are long, leave it by more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from decomp.carriers import Sphere
from decomp.complex.boundary.boundary import BoundaryMesh, BoundaryPatch
from decomp.complex.elements import CarrierSurface
from decomp.complex.model import Complex, Line, Patch
from decomp.complex.refining.refine import refine
from decomp.skeletons.certificate.distance import triangle_distance, triangle_tree
from decomp.vectors import Array, norm

OF_CHORD = 0.25
"""Chords of triangles are at most this part of those of the edges wanted,"""
CHORD_OF_GAP = 0.02
"""and at most this part of the way to what is nearest."""


def refined_apart(drawn: BoundaryMesh, tolerance: float, sizes: Array) -> Complex:
    """The boundaries refined, whole spheres far from all else to a coarser tolerance of their own.

    Args:
        drawn: the boundaries of all regions.
        tolerance: chord tolerance, in model units.
        sizes: (r,) the largest edge wanted in each region.

    Raises:
        GeometryError: a surface cannot be followed.
    """
    mesh = drawn.complex
    own = [
        _allowed(drawn, number, sizes) if _is_whole_sphere(drawn, patch) else 0.0
        for number, patch in enumerate(drawn.patches)
    ]
    far = [number for number, allowed in enumerate(own) if allowed > tolerance]
    near = [number for number, allowed in enumerate(own) if allowed <= tolerance]
    parts = []
    for numbers, lines, chord in ((near, mesh.lines, tolerance), *(([k], (), own[k]) for k in far)):
        if numbers:
            parts.append((refine(_part(mesh, numbers, lines), chord), numbers))
    return _joined(parts, len(own))


def _part(mesh: Complex, numbers: Sequence[int], lines: Sequence[Line]) -> Complex:
    """Some patches and lines of a complex over the points that they use."""
    patches = [mesh.patches[number] for number in numbers]
    corners = [p.triangles.ravel() for p in patches]
    used = np.unique(np.concatenate([*corners, *(each.vertices for each in lines)]))
    return Complex(
        mesh.points[used],
        tuple(replace(p, triangles=np.searchsorted(used, p.triangles)) for p in patches),
        tuple(replace(each, vertices=np.searchsorted(used, each.vertices)) for each in lines),
    )


def _is_whole_sphere(drawn: BoundaryMesh, patch: BoundaryPatch) -> bool:
    on_lines = np.concatenate([np.empty(0, np.int64), *(each.vertices for each in drawn.lines)])
    surface = patch.patch.surface
    round_ = isinstance(surface, CarrierSurface) and isinstance(surface.carrier, Sphere)
    return round_ and not np.isin(patch.patch.triangles, on_lines).any()


def _allowed(drawn: BoundaryMesh, number: int, sizes: Array) -> float:
    """The chord tolerance that a whole sphere may have."""
    own = drawn.patches[number]
    assert isinstance(own.patch.surface, CarrierSurface)
    sphere = own.patch.surface.carrier
    assert isinstance(sphere, Sphere)
    regions = [side[0] for side in (own.outer, own.inner) if side is not None]
    chord = float(sizes[regions].min()) ** 2 / (8 * sphere.radius)
    return min(OF_CHORD * chord, CHORD_OF_GAP * _gap(drawn, number, sphere))


def _gap(drawn: BoundaryMesh, number: int, sphere: Sphere) -> float:
    """How far the nearest of all other patches is from a sphere; at most its radius."""
    others = [p.patch.triangles for k, p in enumerate(drawn.patches) if k != number]
    corners = drawn.points[np.concatenate([np.empty((0, 3), np.int64), *others])]
    away = norm(corners - sphere.centre).max(axis=1, initial=0.0)
    within = away < sphere.radius
    gap = sphere.radius - float(away[within].max(initial=0.0))
    if (~within).any():
        tree = triangle_tree(corners[~within])
        gap = min(gap, float(triangle_distance(tree, sphere.centre[None])[0]) - sphere.radius)
    return gap


def _joined(parts: Sequence[tuple[Complex, Sequence[int]]], count: int) -> Complex:
    """Complexes with the patches of given numbers, and all lines in the first, made one."""
    patches: list[Patch | None] = [None] * count
    lines: tuple[Line, ...] = ()
    points, start = [], 0
    for mesh, numbers in parts:
        for number, patch in zip(numbers, mesh.patches, strict=True):
            patches[number] = replace(patch, triangles=patch.triangles + start)
        lines += tuple(replace(line, vertices=line.vertices + start) for line in mesh.lines)
        points.append(mesh.points)
        start += len(mesh.points)
    return Complex(np.concatenate(points), tuple(p for p in patches if p is not None), lines)
