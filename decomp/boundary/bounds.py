"""The axis-parallel box around a region's boundary, exact on every carrier."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from decomp.boundary.faces import RawFace
from decomp.boundary.member import Member
from decomp.boundary.topology import Edge, Vertex
from decomp.csg.halfspaces import HalfSpaceForm
from decomp.curves.circle import Circle
from decomp.curves.ellipse import Ellipse
from decomp.curves.line import Line
from decomp.vectors import Array, Bools, norm

TILT = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
"""A rotation by odd angles, so that steps do not run along the model's own planes."""
BESIDE_POINT = 1e-7
"""Whether a point is on a face is asked this part of the scale beside it."""


def region_bounds(
    form: HalfSpaceForm,
    member: Member,
    faces: Sequence[RawFace],
    edges: Sequence[Edge],
    vertices: Sequence[Vertex],
) -> Array:
    """Corners (2, 3) of the box.

    A coordinate is extreme on an edge, at a cone's apex, or inside a face where its normal is an
    axis of the box, which happens on spheres and tori only (on planes, cylinders and cones such
    points come in lines, which end at an edge).
    """
    points = [edge.samples for edge in edges]
    points += [vertex.point[None] for vertex in vertices]
    points += [
        _conic_extremes(edge, edge.curve)
        for edge in edges
        if isinstance(edge.curve, (Circle, Ellipse))
    ]
    box = np.array([np.full(3, np.inf), np.full(3, -np.inf)])
    for group in points:
        box = _grown(box, group)
    for face in faces:
        candidates = form.carriers[face.carrier].extreme_points()
        beyond = ((candidates < box[0]) | (candidates > box[1])).any(axis=1)
        if beyond.any():
            candidates = candidates[beyond]
            box = _grown(box, candidates[_near_face(form, member, face, candidates)])
    for edge in edges:
        if not isinstance(edge.curve, (Line, Circle, Ellipse)) and _may_stick_out(edge, box):
            box = _grown(box, _extremes(edge))
    return box


def _grown(box: Array, points: Array) -> Array:
    """The box that holds a box and points (k, 3)."""
    low = np.minimum(box[0], points.min(axis=0, initial=np.inf))
    return np.array([low, np.maximum(box[1], points.max(axis=0, initial=-np.inf))])


def _near_face(form: HalfSpaceForm, member: Member, face: RawFace, points: Array) -> Bools:
    """Whether points on a carrier are on a face or so close that the box cannot tell.

    At an extreme point the coordinate is stationary, so a step of 1e-7 changes it by 1e-14. The
    point itself will not do where another carrier touches there, as a cube's sides touch a ball.
    """
    carrier = form.carriers[face.carrier]
    on = np.zeros(len(points), dtype=np.bool_)
    for step in np.concatenate([np.eye(3), -np.eye(3)]) @ TILT:
        moved = carrier.project(points + BESIDE_POINT * form.scale * step)
        on |= member.is_face(face.carrier, face.outward, moved)
    return on


def _may_stick_out(edge: Edge, box: Array) -> bool:
    """Whether the curve between samples may leave a box: it bulges by less than the chord."""
    chord = norm(np.diff(edge.samples, axis=0)).max()
    low, high = edge.samples.min(axis=0), edge.samples.max(axis=0)
    return bool(((low - chord < box[0]) | (high + chord > box[1])).any())


def _extremes(edge: Edge) -> Array:
    """Points of a curved edge where a coordinate is stationary."""
    t = np.linspace(edge.start, edge.end, len(edge.samples) + 1)
    slope = edge.curve.derivative(edge.curve.wrapped(t))
    found = [np.empty(0)]
    for k in range(3):
        turn = np.flatnonzero(slope[:-1, k] * slope[1:, k] < 0)
        low, high, sign = t[turn], t[turn + 1], slope[turn, k]
        for _ in range(50):
            middle = (low + high) / 2
            same = edge.curve.derivative(edge.curve.wrapped(middle))[..., k] * sign > 0
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        found.append(low)
    return edge.curve.point(edge.curve.wrapped(np.concatenate(found)))


def _conic_extremes(edge: Edge, curve: Circle | Ellipse) -> Array:
    """Coordinate k of centre + a cos t x + b sin t y is stationary where tan t = b y_k / a x_k."""
    a, b = (curve.radius, curve.radius) if isinstance(curve, Circle) else (curve.a, curve.b)
    first = np.arctan2(b * curve.y, a * curve.x)
    t = np.concatenate([first, first + np.pi])
    t = edge.start + np.mod(t - edge.start, 2 * np.pi)
    return curve.point(t[t <= edge.end])
