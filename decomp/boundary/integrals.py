"""Area of faces and volume of regions as line integrals along edges, exact up to quadrature.

On each carrier, in coordinates (u, v) that are right-handed along the outward normal, the area
element is w(v) du dv. With W' = w, Green's theorem gives the area of a face with its boundary on
the left as -integral of W(v) du (`Carrier.border_terms`). The volume follows from the divergence
theorem, 3 V = sum over faces of the integral of p . n, and from the vector area, 1/2 integral of
p x dp.

    plane     area = 1/2 integral of n . p x dp
    cylinder  u = length of section, v = z   W = z
    cone      u = angle, v = slant s    W = s^2 sin(angle) / 2
    sphere    u = longitude, v = latitude, W = r^2 (1 + sin v); if the pole where this is
              singular lies inside the face, the result is short by the whole sphere's area
    torus     u = around, v = tube      W = r (R v + r sin v), v unwrapped

On a torus v is known up to full turns only, so the area is known up to multiples of the whole
torus's area, which decides it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.boundary.edges import RawEdge
from decomp.boundary.faces import RawFace
from decomp.boundary.loops import HalfEdge
from decomp.boundary.torus_loops import torus_angles, winding
from decomp.carriers import Carrier, Torus
from decomp.carriers.axial import axial_split
from decomp.carriers.base import Border
from decomp.curves.traced import TracedCurve
from decomp.vectors import Array, cross, dot, norm

RULES = (np.polynomial.legendre.leggauss(16), np.polynomial.legendre.leggauss(11))
SHORT_RULES = (np.polynomial.legendre.leggauss(7), np.polynomial.legendre.leggauss(5))

MOST_HALVINGS = 8
"""How often a panel of an edge is halved at most."""
PANEL_ERROR = 1e-13
"""Panels are halved until the rules differ by less than this part of the edge's length."""


@dataclass(frozen=True, eq=False)
class Track:
    """Quadrature along an edge: points (n, 3) and dp = derivative times weight (n, 3)."""

    points: Array
    steps: Array

    @property
    def length(self) -> float:
        """Arc length."""
        return float(norm(self.steps).sum())


@dataclass(frozen=True)
class FaceIntegrals:
    """Integrals over a face.

    Args:
        area: of the face.
        flux: the integral of (p - origin) . n with the region's outward normal.
        wholes: how often the whole carrier is added to what the line integrals give: on a sphere 1
            if the pole is inside the face, on a torus what the unwrapping leaves open.
    """

    area: float
    flux: float
    wholes: int = 0


def tracks(edge: RawEdge) -> tuple[Track, Track]:
    """Fine and coarse quadrature along an edge; their difference tells the error.

    Panels on which the two rules disagree about the length are halved.
    """
    panels = _panels(edge)
    fine_rule, coarse_rule = SHORT_RULES if isinstance(edge.curve, TracedCurve) else RULES
    for _ in range(MOST_HALVINGS):
        fine, coarse = _track(edge, panels, *fine_rule), _track(edge, panels, *coarse_rule)
        lengths = [
            norm(track.steps).reshape(len(panels) - 1, -1).sum(axis=1) for track in (fine, coarse)
        ]
        bad = np.flatnonzero(np.abs(lengths[0] - lengths[1]) > PANEL_ERROR * lengths[0].sum())
        if not len(bad):
            break
        panels = np.insert(panels, bad + 1, (panels[bad] + panels[bad + 1]) / 2)
    return fine, coarse


def face_integrals(
    face: RawFace,
    carrier: Carrier,
    edges: Sequence[RawEdge],
    track_of: Callable[[int], Track],
    origin: Array,
    pole: Array | None,
) -> FaceIntegrals:
    """Area and flux of one face.

    Args:
        face: the face.
        carrier: its carrier.
        edges: the region's edges.
        track_of: quadrature of an edge by index.
        origin: (3,) reference point of the flux.
        pole: on a sphere with edges, a unit direction away from them.
    """
    sign = float(face.outward)
    signed = [(sign * half.direction, track_of(half.edge)) for loop in face.loops for half in loop]
    vector_area = np.zeros(3)
    for s, track in signed:
        vector_area += s * cross(track.points - origin, track.steps).sum(axis=0) / 2

    wholes = 0
    if isinstance(carrier, Torus):
        border = torus_border(face, carrier, edges, signed)
        area, cosine, wholes = _torus_integrals(carrier, border)
        support = carrier.major * cosine + carrier.minor * area
    else:
        terms = [
            (s, carrier.border_terms(Border(t.points, t.steps), origin, pole)) for s, t in signed
        ]
        area, support = (sum(s * term[k] for s, term in terms) for k in (0, 1))
        if carrier.closed:
            wholes = int(area <= 0)
            area, support = area + wholes * carrier.whole[0], support + wholes * carrier.whole[1]
    flux = float((carrier.packed()[:3] - origin) @ vector_area) + support
    return FaceIntegrals(float(area), sign * float(flux), wholes)


def _panels(edge: RawEdge) -> Array:
    """Parameters that divide an edge into panels, smooth inside, which turn by about 30 degrees."""
    if edge.curve.kind == "line":
        return np.linspace(edge.start, edge.end, 3)
    if isinstance(edge.curve, TracedCurve):
        return _knots(edge, edge.curve)
    fine = np.linspace(edge.start, edge.end, 65)
    tangents = edge.curve.derivative(edge.curve.wrapped((fine[1:] + fine[:-1]) / 2))
    tangents = tangents / norm(tangents)[:, None]
    turning = np.arccos(np.clip(dot(tangents[1:], tangents[:-1]), -1, 1))
    progress = np.concatenate([[0], np.cumsum(turning + 0.05), [0]])
    progress[-1] = progress[-2] + 0.05
    wanted = np.arange(1, int(progress[-1] / (np.pi / 6)) + 1) * (np.pi / 6)
    inner = np.interp(wanted, progress, fine)
    return np.unique(np.concatenate([[edge.start], inner, [edge.end]]))


def _knots(edge: RawEdge, curve: TracedCurve) -> Array:
    """The edge's ends and the knots between them, where the parametrisation has a kink."""
    knots = curve.knots[:-1] if curve.closed else curve.knots
    if curve.closed:
        knots = np.concatenate([knots, knots + curve.period])
    inner = knots[(knots > edge.start) & (knots < edge.end)]
    return np.concatenate([[edge.start], inner, [edge.end]])


def _track(edge: RawEdge, panels: Array, nodes: Array, weights: Array) -> Track:
    half = np.diff(panels)[:, None] / 2
    t = ((panels[1:] + panels[:-1])[:, None] / 2 + half * nodes).ravel()
    t = edge.curve.wrapped(t)
    steps = edge.curve.derivative(t) * (half * weights).ravel()[:, None]
    return Track(edge.curve.point(t), steps)


@dataclass(frozen=True, eq=False)
class TorusBorder:
    """Quadrature along the loops of a face on a torus, its angles unwrapped along each loop.

    Args:
        around, tube: angles (n,).
        steps: d(around) times weight (n,).
        cut: where two loops go around the torus, the angles around of two points of them and the
            turns in the tube by which the unwrapping jumps on the way from one to the other.
    """

    around: Array
    tube: Array
    steps: Array
    cut: tuple[float, float, int]


def torus_border(
    face: RawFace,
    torus: Torus,
    edges: Sequence[RawEdge],
    signed: Sequence[tuple[float, Track]],
) -> TorusBorder:
    """Unwrap the loops of a face.

    Args:
        face, torus, edges: the face.
        signed: for its half-edges in order, +1 or -1 and the quadrature of their edges.
    """
    none = np.empty(0)
    parts: list[tuple[Array, Array, Array]] = [(none, none, none)]
    position = 0
    anchors: list[tuple[Array, int]] = []
    for loop in face.loops:
        own = signed[position : position + len(loop)]
        position += len(loop)
        angles, steps, turns, start = _unwrapped(face, torus, edges, loop, own)
        parts.append((angles[:, 0], angles[:, 1], steps))
        if turns != (0, 0):
            anchors.append((start, turns[1]))
    cut = (0.0, 0.0, 0)
    if len(anchors) == 2:
        cut = (float(anchors[0][0][0]), float(anchors[1][0][0]), anchors[0][1])
    around, tube, steps = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return TorusBorder(around, tube, steps, cut)


def _torus_integrals(torus: Torus, border: TorusBorder) -> tuple[float, float, int]:
    """Area, the integral of cos(tube), and how many whole tori were added to both."""
    big, small, tube, steps = torus.major, torus.minor, border.tube, border.steps
    turn = 2 * np.pi
    whole = turn * turn * big * small
    if not len(steps):
        return whole, turn * turn * small**2 / 2, 1
    area = -float((small * (big * tube + small * np.sin(tube)) * steps).sum())
    second = tube / 2 + np.sin(2 * tube) / 4
    cosine = -float((small * (big * np.sin(tube) + small * second) * steps).sum())
    start, end, turns = border.cut
    shift = turn * turns * (end - start)
    area -= big * small * shift
    cosine -= small**2 / 2 * shift
    wholes = -int(np.floor(area / whole))
    return area + wholes * whole, cosine + wholes * turn * turn * small**2 / 2, wholes


def _unwrapped(
    face: RawFace,
    torus: Torus,
    edges: Sequence[RawEdge],
    loop: Sequence[HalfEdge],
    own: Sequence[tuple[float, Track]],
) -> tuple[Array, Array, tuple[int, int], Array]:
    """A loop's quadrature: unwrapped angles (n, 2) and d(around); its turns; its start angles."""
    wound = winding(torus, edges, loop, face.outward)
    ordered = list(own) if face.outward > 0 else list(own)[::-1]
    points, steps = [], []
    for sign, track in ordered:
        points.append(track.points if sign > 0 else track.points[::-1])
        steps.append(track.steps if sign > 0 else -track.steps[::-1])
    where, moves = np.concatenate(points), np.concatenate(steps)
    start = wound.angles[0]
    angles = np.unwrap(np.concatenate([start[None, :], torus_angles(torus, where)]), axis=0)[1:]
    _, rho, out = axial_split(where, torus.centre, torus.axis)
    arc = dot(cross(torus.axis, out), moves)
    return angles, arc / rho, wound.turns, start
