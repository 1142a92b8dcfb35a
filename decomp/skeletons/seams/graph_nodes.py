"""The nodes of a graph of seams while it grows, and which of their rays have been followed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from decomp.errors import GeometryError
from decomp.skeletons.balls.contacts import Contacts
from decomp.skeletons.balls.equidistance import balanced
from decomp.skeletons.seams.coinciding import coinciding, is_node
from decomp.skeletons.seams.ending.fins import with_one_foot
from decomp.skeletons.seams.known_seams import KnownSeams
from decomp.skeletons.seams.leaving.arcs import Arcs
from decomp.skeletons.seams.leaving.departures import departures
from decomp.skeletons.seams.leaving.local import SeamRay
from decomp.skeletons.seams.seam_graph_model import Node
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import State
from decomp.vectors import Array, norm

CELL = 1e-3
ENDING = 1e-5
NEAR = 1e-4
"""Junctions are nearer to where a seam was seen to end than this part of the size."""


class OversteppedError(GeometryError):
    """A seam contradicts others: one was followed past a place where its sites change."""


class GraphNodes:
    """Nodes of one region.

    Args:
        points: of the region's seams.
        seams: all that are known.

    Attributes:
        nodes: by their numbers.
        open: rays, as (node, number of its ray), in whose direction it must be looked.
        starts: the first point along each ray.
        taken: the number of the seam along each ray that has been followed.
    """

    def __init__(self, points: SeamPoints, seams: KnownSeams) -> None:
        self._points, self._seams, self._size = points, seams, points.size
        self._arcs = Arcs(points.context)
        self.nodes: list[Node] = []
        self.open: list[tuple[int, int]] = []
        self.starts: dict[tuple[int, int], State] = {}
        self.taken: dict[tuple[int, int], int] = {}
        self._places: dict[tuple[int, ...], list[int]] = {}
        self._unforeseen: set[int] = set()
        self._extrapolated: set[int] = set()

    def on_boundary(self, last: State) -> int:
        """The node where a seam's radius vanishes.

        If it is no convex vertex that seams are known to leave, it is another vertex, or a point of
        an edge where the faces' angle vanishes; its rays are the seams that arrive.
        """
        for number, node in enumerate(self.nodes):
            if node.radius == 0 and float(norm(node.point - last.point)) <= ENDING * self._size:
                return number
        vertices = np.array([v.point for v in self._points.boundary.vertices]).reshape(-1, 3)
        gaps = norm(vertices - last.point)
        if len(gaps) and gaps.min() <= ENDING * self._size:
            point = vertices[int(np.argmin(gaps))]
        else:
            point = last.point + last.radius / -last.slope * last.tangent
            if not float(norm(point - last.point)) <= ENDING * self._size:
                raise GeometryError("the end of a seam on the boundary near {at} is lost", at=point)
        number = self.add(Node(point, 0.0, (), np.empty((0, 3)), ()), [])
        self._unforeseen.add(number)
        return number

    def junction(self, last: State, intruder: int, foot: Array) -> int:
        which = np.array([[*last.sites, intruder]])
        feet = np.concatenate([last.feet, foot[None]])[None]
        found = balanced(self._points.table, self._size, which, last.point[None], feet)
        point = found.points[0]
        if not float(norm(point - last.point)) <= NEAR * self._size:
            raise GeometryError(
                "the junction at the end of a seam near {at} is lost",
                self._points.names([*last.sites, intruder]),
                last.point,
            )
        on_axis = self._arcs.on_axis(last, intruder, point)
        return self.at(point if on_axis is None else on_axis)

    def end(self, last: State) -> int:
        """The node at which a seam ends by itself."""
        centre = self._arcs.centre(last)
        return self.at(last.point if centre is None else centre, ending=last)

    def is_centre(self, state: State) -> bool:
        """Whether a point is the centre of a ball's face at which all its contacts are."""
        return self._arcs.centre(state) is not None

    def is_on_locus(self, point: Array) -> bool:
        """Whether a point is a centre of curvature of a face that its ball touches."""
        return self._arcs.touches_along(
            self._points.contacts.at(point, self._points.tolerances.same), point
        )

    def at(self, point: Array, ending: State | None = None) -> int:
        """The node at a point, a new one unless it is known.

        A fin, or a seam between feet of one edge, can end on a reflexive locus, from which a whole
        arc of a face is as near. No seam leaves with a contact there, which is only one point of
        the arc; the seam that is `ending` is given a ray of its own.
        """
        if ending is None:
            point, touching = coinciding(self._points, point)
            known = self.known(point, touching)
        else:
            touching = self._points.contacts.at(point, self._points.tolerances.same)
            touching = with_one_foot(touching, ending)
            known = self.known(point)
        if known is not None:
            return known
        touching, leaving = self._arcs.leaving(touching, point)
        rays, states = [], []
        arcs = {
            k
            for k, sites in enumerate(touching.sites)
            if ending is not None and self._points.on_locus(sites, point)
        }
        for ray in leaving:
            if arcs & set(ray.contacts):
                continue
            for contacts, state in departures(self._points, point, touching, ray):
                rays.append(replace(ray, contacts=contacts))
                states.append(state)
        node = Node(point, touching.radius, touching.sites, touching.feet, tuple(rays))
        number = self.add(node, states)
        if ending is not None:
            self._extrapolated.add(number)
        if arcs:
            self._unforeseen.add(number)
        return number

    def add(self, node: Node, states: Sequence[State]) -> int:
        """Add a node with the first points of its rays."""
        number = len(self.nodes)
        self.nodes.append(node)
        reach = 2 * self._points.tolerances.one_node
        corners = [node.point + reach * np.array(c) for c in product((-1.0, 1.0), repeat=3)]
        for cell in {_cell(corner, self._size) for corner in corners}:
            self._places.setdefault(cell, []).append(number)
        for k, state in enumerate(states):
            self.starts[number, k] = state
            self.open.append((number, k))
        if node.radius > 0:
            self._cut_at(node)
        return number

    def _cut_at(self, node: Node) -> None:
        """Give up seams that pass a new node: they are traced again, from there."""
        for number in self._seams.through(node.point):
            self._seams.remove(number)
            for ray in [ray for ray, owner in self.taken.items() if owner == number]:
                del self.taken[ray]
                self.open.insert(0, ray)

    def known(self, point: Array, touching: Contacts | None = None) -> int | None:
        """The node at a point; nodes are kept by the cells of a grid that they are close to.

        Args:
            point: (3,).
            touching: contacts of the point if they are known exactly: then another node can be
                closer to it than points are told apart that are known less well.
        """
        for number in self._places.get(_cell(point, self._size), []):
            node = self.nodes[number]
            if float(norm(node.point - point)) <= self._points.tolerances.one_node and (
                touching is None
                or number in self._extrapolated
                or is_node(self._points, node, point, touching)
            ):
                return number
        return None

    def take(self, number: int, last: State, seam: int) -> None:
        """Mark the ray of a node along which a seam has arrived."""
        node = self.nodes[number]
        if node.radius > 0:
            gaps = norm(last.feet[:, None] - node.feet[None])
            contacts = sorted(np.argmin(gaps, axis=1).tolist())
        else:
            node = self._with_sites(number, last.sites)
            contacts = [k for k, sites in enumerate(node.sites) if set(sites) & set(last.sites)]
        fitting = [
            k
            for k, ray in enumerate(node.rays)
            if (number, k) not in self.taken
            and sorted(ray.contacts) == contacts
            and float(ray.direction @ -last.tangent) > 0.9
        ]
        if not fitting and (len(set(contacts)) < len(contacts) or number in self._unforeseen):
            self._add_fin(number, last, contacts, seam)
            return
        if not fitting:
            raise OversteppedError("a seam arrives at {at} where none leaves", at=node.point)
        best = max(fitting, key=lambda k: float(node.rays[k].direction @ -last.tangent))
        self.taken[number, best] = seam

    def _with_sites(self, number: int, sites: Sequence[int]) -> Node:
        """A node on the boundary; one that was not foreseen is given the sites that arrive."""
        node = self.nodes[number]
        known = {site for group in node.sites for site in group}
        new = [site for site in sites if site not in known]
        if number in self._unforeseen and new:
            node = replace(
                node,
                sites=(*node.sites, *((site,) for site in new)),
                feet=np.concatenate([node.feet, np.repeat(node.point[None], len(new), axis=0)]),
            )
            self.nodes[number] = node
        return node

    def _add_fin(self, number: int, last: State, contacts: list[int], seam: int) -> None:
        """Add a ray for a seam that has arrived where none was foreseen, and mark it."""
        node = self.nodes[number]
        ray = SeamRay(-last.tangent, tuple(contacts), -last.slope)
        self.taken[number, len(node.rays)] = seam
        self.starts[number, len(node.rays)] = last.turned()
        self.nodes[number] = replace(node, rays=(*node.rays, ray))


def _cell(point: Array, size: float) -> tuple[int, ...]:
    """The cell of a grid that holds a point."""
    return tuple(int(x) for x in np.floor(point / (CELL * size)))
