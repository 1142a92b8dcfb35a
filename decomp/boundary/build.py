"""From a half-space form to the exact boundary of each region."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from decomp.boundary import checks
from decomp.boundary.arcs import Arrangement, arrange
from decomp.boundary.assembled import assembled
from decomp.boundary.edges import RawEdge, raw_edges
from decomp.boundary.faces import RawFace, face_at, raw_faces
from decomp.boundary.loops import LoopSet, loop_sets, touches_at
from decomp.boundary.member import Member
from decomp.boundary.topology import RegionBoundary
from decomp.boundary.touching import tangent_carriers, touching_regions
from decomp.boundary.wedges import Star, stars
from decomp.csg.halfspaces import HalfSpaceForm, half_space_form
from decomp.csg.model import EMPTY, Model, without_empty
from decomp.csg.placing import AT_ORIGIN, placing_of
from decomp.errors import EmptyRegionError, UnboundedRegionError
from decomp.places import FAR_SIZES, seen_from
from decomp.vectors import Array, Ints, norm

WINDOWS = (2.0, 2e4)
"""Radii, in units of the estimated scale, within which a model is looked for."""


@dataclass(frozen=True, eq=False)
class Boundaries:
    """The exact boundaries of all regions of a model, in coordinates about `offset`.

    Args:
        model: whose boundaries they are: of the model asked for, the regions that have an interior.
            Those that have none are among what it ignores.
        form: its carriers and program.
        regions: one boundary per region, in the model's order.
    """

    model: Model
    form: HalfSpaceForm
    regions: tuple[RegionBoundary, ...]
    _sources: tuple[_Source, ...]

    @property
    def offset(self) -> Array:
        """Where their origin is in the model's coordinates (3,): near the model, or 0."""
        return self.form.offset

    @property
    def box(self) -> Array:
        """Corners (2, 3) of the box around all regions."""
        low = np.min([region.bounds[0] for region in self.regions], axis=0)
        high = np.max([region.bounds[1] for region in self.regions], axis=0)
        return np.array([low, high])

    @property
    def diagonal(self) -> float:
        """Length of the diagonal of the box around all regions."""
        low, high = self.box
        return float(np.linalg.norm(high - low))

    @cached_property
    def outside(self) -> RegionBoundary:
        """The boundary of everything outside all regions."""
        if len(self.regions) == 1:
            return _flipped(self.regions[0])
        return _flipped(self._union.boundary)

    @cached_property
    def _union(self) -> _Source:
        source = self._sources[0]
        return _build(source.arrangement, source.stars, Member(self.form, None))

    @cached_property
    def touching(self) -> tuple[tuple[int, int], ...]:
        """Pairs of regions that share a piece of surface, lower index first."""
        whole = [face for s in self._sources for face in s.faces if not face.loops]
        return touching_regions(self.form, self._sources[0].stars, whole)

    @cached_property
    def tangent(self) -> frozenset[frozenset[int]]:
        """Pairs of carriers that are tangent to each other along a curve or at a point."""
        source = self._sources[0]
        return tangent_carriers(source.stars, source.arrangement.contacts)

    def face_at(self, region: int, carrier: int, points: Array) -> Ints:
        """Indices (n,) of a region's faces that hold points (n, 3) of a carrier, else -1.

        Region -1 is the outside. The points lie on the carrier. Exact but slow where the carrier
        has several faces.
        """
        if region >= 0:
            return self._sources[region].face_at(carrier, points)
        source = self._sources[0] if len(self.regions) == 1 else self._union
        return source.face_at(carrier, points)


@dataclass(frozen=True, eq=False)
class _Source:
    """What a region's boundary was made from."""

    arrangement: Arrangement
    stars: list[Star]
    member: Member
    edges: list[RawEdge]
    sets: list[LoopSet]
    faces: list[RawFace]
    boundary: RegionBoundary

    def face_at(self, carrier: int, points: Array) -> Ints:
        return face_at(
            self.edges,
            self.sets,
            self.faces,
            self.member,
            self.arrangement.radius,
            carrier,
            points,
        )


def boundaries(model: Model) -> Boundaries:
    """Compute the exact boundary of every region of a model; regions without interior are left out.

    Raises:
        EmptyRegionError: no region has an interior.
        UnboundedRegionError: a region reaches infinity; names the direction.
        OverlapError: two regions share interior points.
        ContactError: carriers touch in a way that is not resolved. Where a region touches itself
            its boundary says so (`RegionBoundary.touches`).
    """
    try:
        form = half_space_form(model)
        placing = placing_of(*_box(form))
        if placing is not AT_ORIGIN:
            form = half_space_form(model, placing=placing)
        with seen_from(form.offset, form.scale):
            result = _boundaries_of(model, form)
        better = placing_of(*result.box + form.offset)
        strayed = norm(better.offset - form.offset) > FAR_SIZES * result.diagonal
        if strayed or not 0.1 < result.diagonal / form.scale < 10:
            # what was estimated from the primitives was far off: again with true size and place
            form = half_space_form(model, result.diagonal, better if strayed else placing)
            with seen_from(form.offset, form.scale):
                result = _boundaries_of(model, form)
    except _SomeEmptyError as found:
        return boundaries(without_empty(model, found.regions))
    return result


class _SomeEmptyError(EmptyRegionError):
    """Regions without interior, by index, in a model that has others."""

    def __init__(self, regions: Collection[int]) -> None:
        super().__init__("some regions are empty")
        self.regions = regions


def _boundaries_of(model: Model, form: HalfSpaceForm) -> Boundaries:
    for window in WINDOWS:
        arrangement = arrange(form, max(window * form.scale, _reach(form)))
        surroundings = stars(arrangement)
        try:
            sources = _all_built(arrangement, surroundings, form)
        except UnboundedRegionError:
            if window == WINDOWS[-1]:
                raise
        else:
            break
    checks.refuse_overlaps(form, arrangement, surroundings)
    return Boundaries(model, form, tuple(s.boundary for s in sources), tuple(sources))


def _all_built(arrangement: Arrangement, around: list[Star], form: HalfSpaceForm) -> list[_Source]:
    sources: list[_Source] = []
    empty: dict[int, EmptyRegionError] = {}
    for k in range(len(form.names)):
        try:
            sources.append(_build(arrangement, around, Member(form, k)))
        except EmptyRegionError as error:
            empty[k] = error
    if not sources:
        raise empty[0]
    if empty:
        raise _SomeEmptyError(empty)
    return sources


def _box(form: HalfSpaceForm) -> Array:
    """Corners (2, 3) of a box around all regions, or where the primitives are if none is known."""
    boxes = form.region_boxes
    box = np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
    if np.isfinite(box).all() and (box[0] < box[1]).all():
        return box
    return np.asarray(form.centre + np.array([[-0.5], [0.5]]) * form.scale / np.sqrt(3))


def _reach(form: HalfSpaceForm) -> float:
    """The distance from the form's centre to the far end of its regions, 0 if not known."""
    corners = np.abs(form.region_boxes - form.centre)
    farthest = float(norm(corners.max(axis=1)).max())
    return 1.01 * farthest if np.isfinite(farthest) else 0.0


def _build(arrangement: Arrangement, surroundings: list[Star], member: Member) -> _Source:
    form = member.form
    edges, points, touches = raw_edges(arrangement, surroundings, member)
    checks.refuse_unbounded(arrangement, member)
    sets, umbrellas = loop_sets(edges, points, member)
    touches += touches_at(edges, points, member, umbrellas)
    faces = raw_faces(edges, sets, member, arrangement.radius)
    if not faces:
        raise EmptyRegionError(f"region {member.name!r} is {EMPTY}")
    tangent = (checks.touch_between(arrangement, each, member) for each in arrangement.contacts)
    touches += [said for said in tangent if said is not None]
    parts = [len(around) for around in umbrellas]
    boundary = assembled(form, member, edges, points, parts, sets, faces, arrangement.radius)
    boundary = replace(boundary, touches=tuple(touches))
    return _Source(arrangement, surroundings, member, edges, sets, faces, boundary)


def _flipped(boundary: RegionBoundary) -> RegionBoundary:
    """The same boundary seen from the other side."""
    return replace(
        boundary,
        name="outside",
        faces=tuple(
            replace(
                f,
                outward=-f.outward,
                loops=tuple(tuple((e, -d) for e, d in reversed(p)) for p in f.loops),
            )
            for f in boundary.faces
        ),
        edges=tuple(replace(e, convexity=e.convexity.flipped()) for e in boundary.edges),
        vertices=tuple(replace(v, convexity=v.convexity.flipped()) for v in boundary.vertices),
        volume=-boundary.volume,
        euler=0,
    )
