"""The seams that leave a point of a reflexive axis or spine, from which whole arcs are as near.

There a ball touches a face, or an edge, along an arc of a circle about the axis. The hull of the
contacts' gradients, see `local`, then has no facets with points inside such an arc as corners, but
the flat one that the circle spans: along its normal goes the axis, which is no seam. So seams leave
along facets whose corners are ends of arcs and single contacts, if the arcs themselves lie inside.
Where arcs have shrunk to their ends, as at the middle of a cross of rods, the axis is at its end,
and what goes on along the flat facet's normal is a seam between the ends.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.boundary.topology import Convexity, Face
from decomp.carriers import Carrier, Cone, Cylinder, Torus
from decomp.curves.circle import Circle
from decomp.sites.site import SiteKind, faces_at
from decomp.skeletons.balls.contacts import Contacts
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.balls.loci import axis_gap
from decomp.skeletons.balls.probing import TOWARDS
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.leaving.local import SeamRay, seam_rays
from decomp.skeletons.seams.leaving.patches import patch_rays
from decomp.skeletons.seams.steps.states import State
from decomp.vectors import Array, cross, norm

TURNS = 180
"""Points of a circle at which it is seen where it is on the boundary."""
ON_BOUNDARY = 1e-10
NEAR = 1e-5
"""A junction is looked for on a locus that is nearer than this part of the size."""
AHEAD = 1e-3
"""Whether an axis goes on is seen so many radii ahead."""
INSIDE = 1e-6
"""An arc lies inside a facet's plane unless its gradients leave it by more than this."""
AT_REST = 1e-16
"""A place on an axis is found to this part of the size."""


class Arcs:
    """The arcs along which balls of one region touch its faces.

    Args:
        context: of the region.
    """

    def __init__(self, context: RegionContext) -> None:
        boundary = context.boundary
        self._context, self._boundary = context, boundary
        self._sites, self._queries = context.sites, context.queries
        self._size, self._near = boundary.diagonal, boundary.tolerances.on_locus
        self._beside: dict[int, list[int]] = {}
        for edge in boundary.edges:
            if edge.convexity is Convexity.SMOOTH:
                for one, other in (edge.faces, edge.faces[::-1]):
                    self._beside.setdefault(one, []).append(other)
        self._vertices = cKDTree(np.array([v.point for v in boundary.vertices]).reshape(-1, 3))
        self._round = {
            k: face
            for k, face in enumerate(boundary.faces)
            if boundary.carriers[face.carrier].locus == 1
        }
        self._circles = {
            k: edge.curve
            for k, edge in enumerate(boundary.edges)
            if isinstance(edge.curve, Circle) and edge.convexity is Convexity.REENTRANT
        }
        self._balls = {
            k: face
            for k, face in enumerate(boundary.faces)
            if boundary.carriers[face.carrier].locus == 0
        }

    def leaving(self, touching: Contacts, point: Array) -> tuple[Contacts, list[SeamRay]]:
        """The seams that leave a point, of arcs and of single contacts, and with which contacts."""
        balls = self._osculating(self._balls, touching, point)
        if not balls:
            return touching, self._of_arcs(touching, point)
        single = [k for k, sites in enumerate(touching.sites) if not self._is_on(sites, balls)]
        return patch_rays(self._context, balls, touching, single)

    def touches_along(self, touching: Contacts, point: Array) -> bool:
        """Whether the ball about a point touches a face all along an arc."""
        return any(self._osculating(some, touching, point) for some in (self._round, self._balls))

    def _of_arcs(self, touching: Contacts, point: Array) -> list[SeamRay]:
        faces = self._osculating(self._round, touching, point)
        at = {edge for sites in touching.sites for k in sites for edge in self._edges_at(k)}
        circles = self._circles
        edges = {k for k in at & circles.keys() if self._is_about(circles[k], touching, point)}
        if not faces and not edges:
            return seam_rays(touching.gradients)
        on = [
            self._is_on(sites, faces, edges) or self._is_at_border(foot, faces)
            for sites, foot in zip(touching.sites, touching.feet, strict=True)
        ]
        inner = [self._is_inside(sites, faces, edges) for sites in touching.sites]
        corners = np.flatnonzero(~np.array(inner))
        if len(corners) < 3:
            return []
        arcs = self._arcs(touching, point, faces, on)
        arcs = np.concatenate([arcs, self._circle_arcs(touching, point, edges)])
        found = []
        for ray in seam_rays(touching.gradients[corners]):
            chosen = tuple(int(corners[k]) for k in ray.contacts)
            beyond = arcs @ ray.direction < ray.slope - INSIDE
            if beyond.any():
                continue
            of_arcs = all(on[k] for k in chosen)
            if not of_arcs or self._ends(point, ray.direction, touching.radius, faces, edges):
                found.append(replace(ray, contacts=chosen))
        return found

    def _ends(
        self, point: Array, direction: Array, radius: float, faces: set[int], edges: set[int]
    ) -> bool:
        """Whether a direction from a point is that of straight loci which all end there."""
        carriers = [self._boundary.carriers[self._boundary.faces[k].carrier] for k in faces]
        circles = [self._circles[k] for k in edges]
        if any(isinstance(carrier, Torus) for carrier in carriers):
            return False
        axes = [_axis(carrier, point) for carrier in carriers]
        axes += [cross(circle.x, circle.y) for circle in circles]
        if any(float(norm(cross(axis, direction))) > INSIDE for axis in axes):
            return False
        ahead = point + AHEAD * radius * direction
        seen = float(self._queries.nearest(ahead[None]).distance[0])
        far = [abs(float(carrier.signed_distance(ahead))) for carrier in carriers]
        far += [float(np.hypot(norm(ahead - c.centre), c.radius)) for c in circles]
        return (
            seen > max(far) + ON_BOUNDARY * self._size or seen < min(far) - ON_BOUNDARY * self._size
        )

    def centre(self, last: State) -> Array | None:
        """The centre of a ball's faces that a seam has come to, None if it has come to none.

        Close to it all edges of these faces are as far but for rounding.

        Args:
            last: of the seam.
        """
        groups: dict[tuple[int, int], set[int]] = {}
        for number, face in self._balls.items():
            groups.setdefault((face.carrier, face.outward), set()).add(number)
        for (number, outward), faces in groups.items():
            carrier = self._boundary.carriers[number]
            gap = float(carrier.reflexive_gap(outward, last.point[None])[0])
            of_faces = all(faces & set(self._faces_at(site)) for site in last.sites)
            if gap <= NEAR * self._size and of_faces:
                return carrier.place
        return None

    def on_axis(self, last: State, intruder: int, near: Array) -> Array | None:
        """The point where a seam meets the locus of a face that bounds some of its edges.

        There the seam's equations lose rank. But on the locus edges of the face are as far as the
        face is, so that the others alone tell the place on it.

        Args:
            last: of the seam.
            intruder: the face.
            near: the point (3,), roughly.

        Returns:
            None if it is no such point.
        """
        face = self._round.get(self._face_of(intruder))
        others = [k for k in last.sites if self._face_of(intruder) not in self._faces_at(k)]
        if face is None or not others or len(others) == len(last.sites):
            return None
        carrier = self._boundary.carriers[face.carrier]
        if float(carrier.reflexive_gap(face.outward, near[None])[0]) > NEAR * self._size:
            return None
        axis, centre = _axis(carrier, near), _on_axis(carrier, near)
        if centre is None:
            return None
        foot = last.feet[last.sites.index(others[0])]

        def gap(way: float) -> float:
            at = centre + way * axis
            field = site_fields(self._context, np.array(others[:1]), at[None], foot[None])
            return float(field.distance[0]) - abs(float(carrier.signed_distance(at)))

        step = NEAR * self._size
        if gap(-step) * gap(step) > 0:
            return None
        return np.asarray(centre + brentq(gap, -step, step, xtol=AT_REST * self._size) * axis)

    def _face_of(self, number: int) -> int:
        site = self._sites[number]
        return site.index if site.kind is SiteKind.FACE else -1

    def _osculating(self, faces: Mapping[int, Face], touching: Contacts, point: Array) -> set[int]:
        """Those of some faces that a ball about a point touches along an arc."""
        at = {face for sites in touching.sites for k in sites for face in self._faces_at(k)}
        # a contact can be on the border of a face that touches all along, without being told so
        at |= {face for k in at for face in self._beside.get(k, ())}
        for near in self._vertices.query_ball_point(touching.feet, self._near):
            at |= {face for k in near for face in self._boundary.vertices[k].faces}
        return {k for k in at & faces.keys() if self._osculates(faces[k], touching.radius, point)}

    def _osculates(self, face: Face, radius: float, point: Array) -> bool:
        carrier = self._boundary.carriers[face.carrier]
        gap = float(carrier.reflexive_gap(face.outward, point[None])[0])
        depth = abs(float(carrier.signed_distance(point)))
        return gap <= self._near and abs(depth - radius) <= self._near

    def _is_about(self, circle: Circle, touching: Contacts, point: Array) -> bool:
        """Whether a ball about a point touches all of a circle, which may be an edge in part."""
        gap = float(axis_gap(circle, point[None])[0])
        off = float(np.hypot(norm(point - circle.centre), circle.radius)) - touching.radius
        return max(gap, abs(off)) <= self._near

    def _is_on(self, sites: tuple[int, ...], faces: set[int], edges: Collection[int] = ()) -> bool:
        """Whether a contact is a point of an arc, or its end."""
        return any(
            faces & self._faces_at(site) or self._edges_at(site) & set(edges) for site in sites
        )

    def _is_at_border(self, foot: Array, faces: set[int]) -> bool:
        """Whether a contact of another face is where that goes on into one of some round ones."""
        carriers = [self._boundary.carriers[self._boundary.faces[k].carrier] for k in faces]
        return any(abs(float(c.signed_distance(foot))) <= self._near for c in carriers)

    def _is_inside(self, sites: tuple[int, ...], faces: set[int], edges: set[int]) -> bool:
        """Whether a contact is a point of an arc, and not its end."""
        own = [self._sites[k] for k in sites]
        return all(
            (s.kind is SiteKind.FACE and s.index in faces)
            or (s.kind is SiteKind.EDGE and s.index in edges)
            for s in own
        )

    def _edges_at(self, number: int) -> set[int]:
        site = self._sites[number]
        match site.kind:
            case SiteKind.EDGE:
                return {site.index}
            case SiteKind.VERTEX:
                return set(self._boundary.vertices[site.index].edges)
            case SiteKind.FACE:
                return set()

    def _faces_at(self, number: int) -> set[int]:
        return faces_at(self._boundary, self._sites[number])

    def _arcs(self, touching: Contacts, point: Array, faces: set[int], on: list[bool]) -> Array:
        """Gradients (k, 3) of points of the arcs."""
        found = []
        for number in faces:
            carrier = self._boundary.carriers[self._boundary.faces[number].carrier]
            off = np.abs(carrier.signed_distance(touching.feet))
            known = np.flatnonzero(np.array(on) & (off <= self._near))
            if not len(known):
                continue
            start, axis = touching.feet[known[0]] - point, _axis(carrier, point)
            reach = _turned(start, axis)
            seen = self._queries.nearest(point + TOWARDS * reach).distance
            true = np.abs(seen - (1 - TOWARDS) * touching.radius) <= ON_BOUNDARY * self._size
            # a little beyond an arc's end the boundary is as near but for the square of the way
            blur = np.sqrt(2 * ON_BOUNDARY * self._size * touching.radius * (1 - TOWARDS) / TOWARDS)
            ends = touching.feet - point
            true &= norm(reach[:, None] - ends[None]).min(axis=1) > blur
            found.append(-reach[true] / touching.radius)
        return np.concatenate([np.empty((0, 3)), *found])

    def _circle_arcs(self, touching: Contacts, point: Array, edges: set[int]) -> Array:
        """Gradients (k, 3) of points of edges that are touched as a whole."""
        found = [np.empty((0, 3))]
        for number in edges:
            edge = self._boundary.edges[number]
            along = np.linspace(edge.start, edge.end, TURNS)
            found.append((point - edge.curve.point(edge.curve.wrapped(along))) / touching.radius)
        return np.concatenate(found)


def _turned(start: Array, axis: Array) -> Array:
    """A vector (3,) turned about a unit vector by all parts (k, 3) of a turn."""
    along = float(start @ axis) * axis
    angles = 2 * np.pi * np.arange(TURNS)[:, None] / TURNS
    return np.asarray(
        along + np.cos(angles) * (start - along) + np.sin(angles) * cross(axis, start)
    )


def _axis(carrier: Carrier, point: Array) -> Array:
    """The direction about which the feet of a point of a locus are turned."""
    assert isinstance(carrier, (Cylinder, Cone, Torus))
    if isinstance(carrier, Torus):
        away = point - carrier.centre
        away = away - float(away @ carrier.axis) * carrier.axis
        if float(norm(away)) > 0.5 * carrier.major:
            tangent = cross(carrier.axis, away)
            return np.asarray(tangent / norm(tangent))
    return carrier.axis


def _on_axis(carrier: Carrier, point: Array) -> Array | None:
    """The foot of a point on a straight locus, None if the carrier's is none."""
    if not isinstance(carrier, (Cylinder, Cone)):
        return None
    start = carrier.point if isinstance(carrier, Cylinder) else carrier.apex
    return np.asarray(start + float((point - start) @ carrier.axis) * carrier.axis)
