"""The boundary of a region in other coordinates."""

from __future__ import annotations

from dataclasses import replace

from decomp.boundary.topology import Edge, RegionBoundary
from decomp.curves.moved import moved_curve
from decomp.similarity import translation
from decomp.vectors import Array


def moved_boundary(boundary: RegionBoundary, offset: Array) -> RegionBoundary:
    """A boundary moved by `offset` (3,): carriers, curves and points, each rounded once."""
    if not offset.any():
        return boundary
    move = translation(offset)

    def edge(old: Edge) -> Edge:
        return replace(old, curve=moved_curve(old.curve, offset), samples=old.samples + offset)

    return replace(
        boundary,
        carriers=tuple(carrier.transformed(move) for carrier in boundary.carriers),
        faces=tuple(replace(face, point=face.point + offset) for face in boundary.faces),
        edges=tuple(edge(each) for each in boundary.edges),
        vertices=tuple(replace(each, point=each.point + offset) for each in boundary.vertices),
        bounds=boundary.bounds + offset,
    )
