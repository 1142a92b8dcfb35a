"""Traced regions beside sampled ones: their curves and sheets over the tetrahedra's boundary.

A traced skeleton needs its region's edges as polylines and its faces as triangles. Where other
regions are sampled these are the tetrahedra's, so that all regions stay one conforming complex.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from decomp.attempts import stage
from decomp.complex.model import Complex
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.sampled.bisecting import Bisected
from decomp.sampled.interior import Interior
from decomp.skeletons.assembly import RegionAssembler, RegionParts
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.joining import Joined, fine_enough_to_part
from decomp.skeletons.sheets.trim_maker import BoundaryVertices
from decomp.skeletons.traced_region import TracedRegion
from decomp.tolerance import TINY
from decomp.vectors import Array, Ints, norm

ON_PIECE = 1e-9
"""Nodes nearer to a vertex, or a piece of an edge, than this part of the diagonal are on it."""


class TetrahedraBoundary:
    """Where the edges and vertices of regions are among the nodes of tetrahedra.

    Args:
        geometry: of the model.
        given: what the tetrahedra conform to.
        mesh: the tetrahedra.
    """

    def __init__(self, geometry: Geometry, given: Interior, mesh: Bisected) -> None:
        self._geometry, self._given, self._mesh = geometry, given, mesh
        self._slack = ON_PIECE * geometry.diagonal

    def put_nodes(self, places: list[Array]) -> None:
        """Have nodes at places (3,) on edges; tetrahedra there are cut."""
        mesh = self._mesh
        for place in places:
            if float(norm(mesh.points - place).min()) <= self._slack:
                continue
            edges, which = mesh.edges()
            own = np.flatnonzero(mesh.line_edges(edges))
            start, end = mesh.points[edges[own, 0]], mesh.points[edges[own, 1]]
            # of all chords the one that the place makes the least detour from
            detour = norm(place - start) + norm(end - place) - norm(end - start)
            chosen = np.zeros(len(edges), dtype=np.bool_)
            chosen[own[int(np.argmin(detour))]] = True
            at: Array = mesh.points[edges].mean(axis=1)
            at[chosen] = place
            mesh.halve(edges, which, chosen, at)

    def of_region(self, region: int, numbers: Ints, points: Array) -> BoundaryVertices:
        """A region's boundary in a complex.

        Args:
            region: its number.
            numbers: (n,) the complex's point that each node is, -1 for none.
            points: (k, 3) of the complex.

        Raises:
            GeometryError: an edge is not one chain of nodes, or a vertex no node.
        """
        surface, boundary = self._given.surface, self._geometry.regions[region]
        edges = []
        for run in surface.pieces.of_edge[region]:
            chains = [numbers[self._chain(piece)][::sense] for piece, sense in run]
            edges.append(np.concatenate([chains[0], *(chain[1:] for chain in chains[1:])]))
        faces: list[Ints] = []
        for sides in surface.face_sides(region, len(boundary.faces)):
            parts = [
                numbers[self._mesh.triangles[self._mesh.patches == patch]][:, ::sense]
                for patch, sense in sides
            ]
            faces.append(np.concatenate([np.empty((0, 3), dtype=np.int64), *parts]))
        used = np.unique(self._mesh.triangles)
        vertices = []
        for node in surface.pieces.of_vertex[region]:
            place = surface.pieces.nodes[node]
            away = norm(self._mesh.points[used] - place)
            if float(away.min()) > self._slack:
                raise GeometryError("no tetrahedron has a node in the vertex {at}", at=place)
            vertices.append(int(numbers[used[int(np.argmin(away))]]))
        return BoundaryVertices(points, vertices, edges, faces)

    def _chain(self, number: int) -> Ints:
        """The nodes of a piece of an edge, in order; a closed one repeats its first."""
        mesh, piece = self._mesh, self._given.surface.pieces.pieces[number]
        edges, _ = mesh.edges()
        on = edges[mesh.line_edges(edges)]
        nodes = np.unique(on)
        t = np.asarray(piece.curve.parameter(mesh.points[nodes]))
        near = norm(piece.curve.point(t) - mesh.points[nodes]) <= self._slack
        nodes, t = nodes[near], t[near]
        reach = self._slack / max(_speed(piece.curve, piece.start), TINY)
        if piece.curve.closed:
            t = piece.start + np.mod(t - piece.start + reach, piece.curve.period) - reach
        within = (t >= piece.start - reach) & (t <= piece.end + reach)
        nodes, t = nodes[within], t[within]
        chain = nodes[np.argsort(t, kind="stable")]
        if piece.closed or (
            piece.ends is not None and piece.ends[0] == piece.ends[1] and len(chain)
        ):
            chain = np.append(chain, chain[0])
        pairs = {(int(a), int(b)) for a, b in on.tolist()}
        for a, b in zip(chain[:-1].tolist(), chain[1:].tolist(), strict=True):
            if (min(a, b), max(a, b)) not in pairs:
                at = mesh.points[a]
                raise GeometryError("tetrahedra do not follow the edge near {at}", at=at)
        if len(chain) < 2:
            at = piece.point(np.array([piece.start]))[0]
            raise GeometryError("tetrahedra do not follow the edge near {at}", at=at)
        return np.asarray(chain)


def with_traced(
    geometry: Geometry,
    given: Interior,
    mesh: Bisected,
    curves: Mapping[int, RegionCurves],
    drawn: Complex,
    along: float,
    with_trims: bool = True,
) -> tuple[Complex, dict[int, TracedRegion]]:
    """Add traced regions to a complex that begins with the tetrahedra's boundary.

    Args:
        geometry: of the model.
        given: what the tetrahedra conform to.
        mesh: the tetrahedra.
        curves: of the traced regions.
        drawn: the complex; its first points are the nodes of boundary triangles, ascending.
        along: chord tolerance along curves, in model units.
        with_trims: whether trim surfaces are to be in the complex.

    Raises:
        GeometryError: a sheet cannot be triangulated; knows its region.
    """
    boundary = TetrahedraBoundary(geometry, given, mesh)
    used = np.unique(mesh.triangles)
    numbers: Ints = np.full(len(mesh.points), -1, dtype=np.int64)
    numbers[used] = np.arange(len(used))
    points, joined = drawn.points, Joined(drawn.patches, drawn.lines, with_trims)
    found = {}
    for number, own in curves.items():
        region = geometry.regions[number]
        with stage("sheets", region.name):
            at = boundary.of_region(number, numbers, points)
            parts = _parts(geometry, own, at, points, along)
        points = np.concatenate([points, parts.points])
        where = joined.add(parts)
        face_sides = given.surface.face_sides(number, len(region.faces))
        found[number] = TracedRegion(
            number, own, parts, where.sheets, where.trims, where.lines, face_sides
        )
    made = replace(drawn, points=points, patches=tuple(joined.patches), lines=tuple(joined.lines))
    return made, found


def _parts(
    geometry: Geometry, curves: RegionCurves, at: BoundaryVertices, before: Array, along: float
) -> RegionParts:
    """A region's part, sampled more finely where its curves cross."""
    return fine_enough_to_part(
        lambda finer, chords, finest: RegionAssembler(
            curves, at, before, along / finer, chords, finest
        ).assemble()
    )


def _speed(curve: object, t: float) -> float:
    return float(norm(curve.derivative(np.array([t])))[0])  # type: ignore[attr-defined]
