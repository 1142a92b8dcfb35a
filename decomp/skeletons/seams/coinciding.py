"""What coincides at a point where seams meet: decided once, by what is equal to rounding.

Contacts that are within the tolerance of a ball are all its contacts if there is a point close by
at which they are so exactly. If there is none they are those of several points, which can be as
close together as the tolerance is.
"""

from __future__ import annotations

import numpy as np

from decomp.skeletons.balls.contacts import Contacts
from decomp.skeletons.balls.equidistance import balanced
from decomp.skeletons.seams.seam_graph_model import Node
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.vectors import Array, norm

SLACK = 2.0
"""Distances that differ by more than so many times what counts as equal are different."""


def coinciding(points: SeamPoints, point: Array) -> tuple[Array, Contacts]:
    """The point (3,) that is meant where several contacts are as near, and its contacts.

    On a reflexive locus, where whole arcs are as near, they are those within the tolerance.
    """
    tolerances = points.tolerances
    near = points.contacts.at(point, tolerances.same)
    if _off(point, near.radius, near.feet) <= tolerances.touching:
        return point, near
    if any(points.on_locus(sites, point) for sites in near.sites):
        return point, near
    which = np.array([[sites[0] for sites in near.sites]])
    found = balanced(points.table, points.size, which, point[None], near.feet[None])
    moved = found.points[0]
    if found.converged[0] and float(norm(moved - point)) <= tolerances.one_node:
        again = points.contacts.at(moved, tolerances.same)
        if _off(moved, again.radius, again.feet) <= tolerances.touching:
            return moved, again
    return point, points.contacts.at(point, tolerances.touching)


def is_node(points: SeamPoints, node: Node, point: Array, touching: Contacts) -> bool:
    """Whether a point close to a node is the node: each has the contacts of the other."""
    slack = SLACK * points.tolerances.touching
    return (
        _off(point, touching.radius, node.feet) <= slack
        and _off(node.point, node.radius, touching.feet) <= slack
    )


def _off(point: Array, radius: float, feet: Array) -> float:
    """How much farther the farthest of some feet (m, 3) is than a ball's radius."""
    return float((norm(point - feet) - radius).max(initial=0.0))
