"""Gathering all curves of a region's skeleton: seams, trims, rims and reflexive loci."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.optimize import minimize_scalar  # type: ignore[import-untyped]

from decomp.complex.model import LineKind
from decomp.curves.circle import Circle
from decomp.sites.site import SiteKind, faces_at
from decomp.skeletons.balls.balls import inscribed_balls
from decomp.skeletons.balls.fields import site_fields
from decomp.skeletons.curves.curve_elements import LocusCurve, RayCurve, SeamCurve, TrimCurve
from decomp.skeletons.curves.incidence import ANGLE, Incidence
from decomp.skeletons.curves.normal_balls import solve_radius
from decomp.skeletons.curves.normal_curves import NormalCurve, VertexRay, reflex_rays
from decomp.skeletons.curves.pieces import CurvePiece, middle_row
from decomp.skeletons.curves.reflexive import ReflexivePart
from decomp.skeletons.curves.trims import TrimPiece, TrimScanner, on_locus
from decomp.skeletons.seams.graph import Seam
from decomp.vectors import Array, Ints, norm

ALONG = 16
"""Points by which a piece of trim or reflexive locus is first known."""
ASKED = (0.5, 0.37)
"""At which parts of its length a seam is asked what it touches: where all is symmetric it can
touch a trim in its middle, and only there."""
BESIDE = 1e-5
AT_LOCUS = 1e-4
"""A trim ends on a locus if it is that part of its radius from it beside the end."""
STEP = 1e-2
"""Step of differences at a turning point, as a part of the interval that holds it."""
RUN = 256
"""Samples by which it is seen where the centres over a normal curve turn back on a locus."""
RESTING = 1e-8
"""Centres over a trim that move less than this part of the size rest."""
WHOLE = 1e-12
"""A trim that leaves out less than this part of a closed curve is all of it."""
TURNING = 1e-12
"""So exactly the parameter is found where centres turn back."""
SMALL, EVENLY = 1e-3, 0.2
"""A radius below the first part of the size that grows evenly, but for the second part, begins
with 0."""


def seam_pieces(incidence: Incidence, seams: Sequence[Seam]) -> list[CurvePiece]:
    """Traced seams, cut where a foot passes to another site."""
    found = []
    for seam in seams:
        for sites, points, feet in _runs(seam):
            if len(points) < 3 and float(norm(points[-1] - points[0])) == 0.0:
                continue
            found.append(_seam_piece(incidence, sites, points, feet))
    return found


def _runs(seam: Seam) -> list[tuple[tuple[int, ...], Array, Array]]:
    """Maximal parts with constant sites: (sites, points, feet)."""
    points, feet, sites = seam.points, seam.feet, list(seam.sites)
    if seam.ends is None:
        changes = [k for k in range(len(points)) if sites[k] != sites[k - 1]]
        first = changes[0] if changes else 0
        points = np.roll(points, -first, axis=0)
        points = np.concatenate([points, points[:1]])
        feet = np.roll(feet, -first, axis=0)
        feet = np.concatenate([feet, feet[:1]])
        sites = [*sites[first:], *sites[:first]]
        sites.append(sites[-1] if changes else sites[0])
    starts = [0, *(k for k in range(1, len(sites)) if sites[k] != sites[k - 1])]
    ends = [*(k - 1 for k in starts[1:]), len(sites) - 1]
    return [
        (sites[a], points[a : b + 1], feet[a : b + 1]) for a, b in zip(starts, ends, strict=True)
    ]


def _seam_piece(
    incidence: Incidence, sites: tuple[int, ...], points: Array, traced: Array
) -> CurvePiece:
    curve = SeamCurve(incidence, sites, points, traced)
    while len(points) < 4:
        points = _denser(curve, points)
    asked = points[[middle_row(points, share) for share in ASKED]]
    found = []
    for point, at in zip(asked, curve.feet_at(asked), strict=True):
        ways = (point - at) / norm(point - at)[:, None]
        sharing = tuple(
            incidence.touched(site, foot, way)
            for site, foot, way in zip(sites, at, ways, strict=True)
        )
        found.append((sharing, at))
    contacts, at = min(found, key=lambda one: sum(len(contact) for contact in one[0]))
    return CurvePiece(LineKind.SEAM, contacts, curve, points, at)


def _denser(curve: SeamCurve, points: Array) -> Array:
    middle = curve.place((points[:-1] + points[1:]) / 2)
    result = np.empty((2 * len(points) - 1, 3))
    result[::2], result[1::2] = points, middle
    return result


@dataclass(frozen=True, eq=False)
class LocusRun:
    """A part of a normal curve whose balls' centres move one way along a reflexive locus.

    Args:
        over: number of the normal curve.
        s: parameters (k,) of it, ascending.
        points: the centres (k, 3); all the same if they do not move.
    """

    over: int
    s: Array
    points: Array

    @property
    def resting(self) -> bool:
        """Whether all centres are one point."""
        return bool((self.points == self.points[0]).all())


def trim_pieces(
    incidence: Incidence, curves: Sequence[NormalCurve]
) -> tuple[list[CurvePiece], list[LocusRun]]:
    """The trims over normal curves: pieces of their own, and runs along reflexive loci."""
    found: list[CurvePiece] = []
    runs: list[LocusRun] = []
    for number, trims in enumerate(TrimScanner(incidence).pieces(curves)):
        for trim in trims:
            piece = _trim_piece(incidence, trim)
            if isinstance(piece, CurvePiece):
                found.append(replace(piece, over=frozenset({number})))
            else:
                runs.extend(_locus_runs(incidence, number, trim, piece))
    return found, runs


def _locus_runs(
    incidence: Incidence, number: int, trim: TrimPiece, radius: Callable[[Array], Array]
) -> list[LocusRun]:
    """Cut a trim along a reflexive locus where its centres turn back."""
    curve, size = trim.over, incidence.boundary.diagonal
    s = np.linspace(trim.start, trim.end, RUN + 1)
    points = curve.feet(s) + radius(s)[:, None] * curve.directions(s)
    if float(norm(points - points[0]).max()) <= RESTING * size:
        return [LocusRun(number, s, np.repeat(points[:1], len(s), axis=0))]
    way = np.diff(points, axis=0)
    turns = np.flatnonzero((way[1:] * way[:-1]).sum(axis=1) < 0) + 1
    for k in turns:
        s[k] = _turn(curve, radius, float(s[k - 1]), float(s[k + 1]), way[k - 1])
    points = curve.feet(s) + radius(s)[:, None] * curve.directions(s)
    bounds = [0, *turns.tolist(), RUN]
    whole = curve.closed and trim.end - trim.start >= (1 - WHOLE) * (curve.end - curve.start)
    if whole and len(turns) > 1:
        # the parameter's own start is no end of a run
        last = int(turns[-1])
        s = np.concatenate([s[last:-1] - (curve.end - curve.start), s[: last + 1]])
        points = np.concatenate([points[last:-1], points[: last + 1]])
        bounds = [0, *(turns + RUN - last).tolist()]
    return [
        LocusRun(number, s[a : b + 1], points[a : b + 1]) for a, b in itertools.pairwise(bounds)
    ]


def _turn(
    curve: NormalCurve, radius: Callable[[Array], Array], low: float, high: float, way: Array
) -> float:
    """The parameter at which the centres have gone farthest in a direction (3,).

    A minimum is found to the root of rounding; Newton's method on its derivative does the rest.
    """

    def behind(s: Array) -> Array:
        return -((curve.feet(s) + radius(s)[:, None] * curve.directions(s)) @ way)

    found = minimize_scalar(
        lambda s: float(behind(np.array([s]))[0]),
        bounds=(low, high),
        method="bounded",
        options={"xatol": TURNING},
    )
    at, h = float(found.x), STEP * (high - low)
    for _ in range(2):
        before, here, after = behind(np.array([at - h, at, at + h]))
        bend = before - 2 * here + after
        if bend > 0:
            at -= float(h * (after - before) / (2 * bend))
    return min(max(at, low), high)


def _trim_piece(incidence: Incidence, trim: TrimPiece) -> CurvePiece | Callable[[Array], Array]:
    """The piece over a part of a normal curve; on a reflexive locus only the balls' radii."""
    over, size = trim.over, incidence.boundary.diagonal
    span = trim.end - trim.start
    inner = np.linspace(0, 1, ALONG + 1)[1:-1]
    parts = np.concatenate([[BESIDE, 2 * BESIDE], inner, [1 - 2 * BESIDE, 1 - BESIDE]])
    s = trim.start + span * parts
    q, n = over.feet(s), over.directions(s)
    balls = inscribed_balls(incidence.context, q, n)
    round_site = _locus_site(incidence, over.touching, balls.centre)
    if round_site is not None:
        return partial(_locus_radius, incidence, over, round_site)
    far = trim.far[0]
    which: Ints = np.full(len(s), far, dtype=np.int64)
    feet = site_fields(incidence.context, which, balls.centre, balls.foot).foot
    points = balls.centre
    curve = TrimCurve(incidence, over, trim.start, trim.end, far, points, feet)
    points = curve.at(s, balls.radius)
    ends = []
    for near, next_, stop in ((0, 1, trim.start), (-1, -2, trim.end)):
        r, r2 = float(balls.radius[near]), float(balls.radius[next_])
        if r <= SMALL * size and abs(r2 - 2 * r) <= EVENLY * r:
            ends.append(over.feet(np.array([stop]))[0])
        else:
            ends.append(_end(incidence, curve, stop, r))
    points = np.concatenate([ends[0][None], points[2:-2], ends[1][None]])
    whole = over.closed and abs(span - (over.end - over.start)) <= WHOLE * abs(span)
    if whole:
        points[-1] = points[0]
    middle = len(points) // 2
    near_foot = over.feet(s[middle + 1 : middle + 2])[0]
    at = np.array([near_foot, feet[middle + 1]])
    contacts = (tuple(sorted(over.sites)), trim.far)
    return CurvePiece(LineKind.TRIM, contacts, curve, points, at)


def _end(incidence: Incidence, curve: TrimCurve, stop: float, guess: float) -> Array:
    """The end (3,) of a trim, at a parameter of its normal curve.

    There a normal of a face can lead to the face's locus, from which the far site may be as near
    along an edge: then the locus tells the place.
    """
    at, over = np.array([stop]), curve.over
    q, n = over.feet(at), over.directions(at)
    near = {f for k in over.sites for f in faces_at(incidence.boundary, incidence.sites[k])}
    for face in sorted(near):
        radius = _face_radius(incidence, face, q)
        turned = float(norm(incidence.inward(face, q)[0] - n[0]))
        if turned <= ANGLE and abs(radius - guess) <= AT_LOCUS * guess:
            return np.asarray(q[0] + radius * n[0])
    return np.asarray(curve.at(at, np.array([guess]))[0])


def _face_radius(incidence: Incidence, face: int, foot: Array) -> float:
    """How far along its normal at a foot (1, 3) a face's reflexive locus is, inf without one."""
    it = incidence.boundary.faces[face]
    carrier = incidence.boundary.carriers[it.carrier]
    if not np.isfinite(carrier.reflexive_gap(it.outward, foot)).all():
        return np.inf
    return float(carrier.inner_radius(it.outward, foot)[0])


def _locus_site(incidence: Incidence, sites: tuple[int, ...], centres: Array) -> int | None:
    """The site that is touched on whose reflexive locus most of some balls' centres (k, 3) are.

    Not all: where the site is bent most, a ball can come to rest a little late.
    """
    for site in sites:
        if 2 * np.count_nonzero(on_locus(incidence, (site,), centres)) > len(centres):
            return site
    return None


def _locus_radius(incidence: Incidence, curve: NormalCurve, number: int, s: Array) -> Array:
    """Radii (k,) of the balls that touch a site at the feet and have their centres on its locus."""
    site = incidence.sites[number]
    if site.kind is SiteKind.EDGE:
        circle = incidence.boundary.edges[site.index].curve
        assert isinstance(circle, Circle)
        n = curve.directions(s)
        return np.asarray(circle.radius / np.hypot(n @ circle.x, n @ circle.y))
    face = incidence.boundary.faces[site.index]
    return incidence.boundary.carriers[face.carrier].inner_radius(face.outward, curve.feet(s))


def ray_pieces(incidence: Incidence) -> list[CurvePiece]:
    """Rims over vertices at which two reentrant edges of a face meet at a reflex angle."""
    found = []
    boundary = incidence.boundary
    for vertex, face, direction in reflex_rays(incidence):
        point = boundary.vertices[vertex].point
        balls = inscribed_balls(incidence.context, point[None], direction[None])
        radius = float(balls.radius[0])
        if radius <= boundary.tolerances.same:
            continue
        which: Ints = np.array([balls.site[0]])
        ray = np.linspace(0, radius, 5)
        edges = [
            incidence.edge_site[e]
            for e in boundary.vertices[vertex].edges
            if face in boundary.edges[e].faces and e in incidence.edge_site
        ]
        foot = site_fields(incidence.context, which, balls.centre, balls.foot).foot[0]
        exact = _face_radius(incidence, face, point[None])
        if abs(exact - radius) > AT_LOCUS * radius:
            exact = _ray_end(incidence, point, direction, int(which[0]), foot, radius)
        points = point + (exact / radius) * ray[:, None] * direction
        a, b = sorted(edges)
        found.append(
            CurvePiece(
                LineKind.RIM,
                ((incidence.vertex_site[vertex], a, b),),
                RayCurve(point, direction),
                points,
                point[None],
                pairs=((a, b),),
            )
        )
    return found


def _ray_end(
    incidence: Incidence, point: Array, direction: Array, far: int, foot: Array, guess: float
) -> float:
    ray = VertexRay(0.0, guess, False, (far, far), point, direction)
    at = np.array([0.0])
    return float(solve_radius(incidence, ray, far, at, foot[None], np.array([guess]))[0])


def reflexive_pieces(parts: Sequence[ReflexivePart]) -> list[CurvePiece]:
    """Reflexive curves as pieces; points are none."""
    found = []
    for part in parts:
        if part.locus is None or part.dimension == 0:
            continue
        u = np.linspace(part.start, part.end, ALONG + 1)
        points = part.locus.point(u)
        if part.closed:
            points[-1] = points[0]
        else:
            points[0], points[-1] = part.ends
        touched = part.locus.point(u[ALONG // 2 : ALONG // 2 + 1])
        found.append(
            CurvePiece(LineKind.REFLEXIVE, (part.sites,), LocusCurve(part.locus), points, touched)
        )
    return found
