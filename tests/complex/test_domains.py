"""Footprints in the plane: one to one, true to orientation, with the right directions."""

from __future__ import annotations

from collections import Counter
from functools import cache

import numpy as np
import pytest

from decomp.boundary.topology import Convexity, RegionBoundary
from decomp.carriers import Sphere
from decomp.complex.footprints.domain_edges import EdgeDomain, EndKind
from decomp.complex.footprints.domain_vertices import VertexDomain, reaches_into
from decomp.complex.footprints.domains import Domain, FaceDomain, domain_of
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.sites.site import Site, SiteKind
from decomp.vectors import Array, norm
from tests.solids import SOLIDS

RNG = np.random.default_rng(7)


@cache
def boundary_of(name: str) -> RegionBoundary:
    return Geometry(SOLIDS[name].make()).regions[0]


def face(name: str, kind: str) -> tuple[RegionBoundary, int]:
    boundary = boundary_of(name)
    return boundary, next(
        k for k, f in enumerate(boundary.faces) if boundary.carriers[f.carrier].kind == kind
    )


def site(kind: SiteKind, index: int) -> Site:
    return Site(0, kind, index, "")


def scattered(boundary: RegionBoundary, index: int) -> Array:
    """Points (200, 3) all over a face's carrier, in front of a cone's apex."""
    carrier = boundary.carriers[boundary.faces[index].carrier]
    low, high = boundary.bounds
    points = carrier.project(low + (high - low) * RNG.random((400, 3)))
    return points[np.abs(carrier.signed_distance(points)) < 1e-12][:200]


def handedness(domain: Domain, uv: Array) -> Array:
    """Sine of the angle from the image of u to that of v, seen against the inward direction."""
    h = 1e-6
    feet, inward = domain.lift(uv)
    right, up = domain.lift(uv + h * np.eye(2)[0]), domain.lift(uv + h * np.eye(2)[1])
    du, dv = right[0] + 0.1 * right[1], up[0] + 0.1 * up[1]
    middle = feet + 0.1 * inward
    return np.einsum("ij,ij->i", np.cross(du - middle, dv - middle), -inward) / h**2


def assert_round_trip(domain: Domain, feet: Array, toward: Array) -> None:
    uv = domain.to_plane(feet, toward)
    back, inward = domain.lift(uv)
    assert back == pytest.approx(feet, abs=1e-9)
    away = toward - feet
    length = norm(away)[:, None]
    assert inward[length[:, 0] > 0] == pytest.approx((away / length)[length[:, 0] > 0], abs=1e-7)
    again = domain.to_plane(back, back + inward)
    apart = again - uv
    for k, period in enumerate(domain.period):
        if period is not None:
            apart[:, k] -= period * np.round(apart[:, k] / period)
    assert np.abs(apart).max() < 1e-8


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("block", "plane"),
        ("cylinder", "cylinder"),
        ("through hole", "cylinder"),
        ("cone", "cone"),
        ("frustum", "cone"),
        ("conical pit", "cone"),
        ("torus", "torus"),
        ("oval ring", "torus"),
        ("sphere", "sphere"),
        ("bite in a face", "sphere"),
    ],
)
def test_faces_are_drawn_one_to_one(name: str, kind: str) -> None:
    boundary, index = face(name, kind)
    f = boundary.faces[index]
    carrier = boundary.carriers[f.carrier]
    pole = np.array([0.6, 0.0, 0.8]) if kind == "sphere" else None
    domain = domain_of(boundary, site(SiteKind.FACE, index), pole)
    assert isinstance(domain, FaceDomain)
    feet = scattered(boundary, index)
    assert_round_trip(domain, feet, feet - f.outward * 0.01 * carrier.normal(feet))
    uv = domain.to_plane(feet, feet)
    assert (handedness(domain, uv) > 0).all()


def test_lengths_are_kept_where_they_can_be() -> None:
    for name, kind in (("block", "plane"), ("cylinder", "cylinder"), ("hollow sphere", "sphere")):
        boundary, index = face(name, kind)
        pole = np.array([0.0, 0.0, 1.0]) if kind == "sphere" else None
        domain = domain_of(boundary, site(SiteKind.FACE, index), pole)
        uv = np.array([[0.0, 0.0], [1e-5, 0.0], [0.0, 1e-5]])
        feet, _ = domain.lift(uv)
        assert norm(feet[1:] - feet[0]) == pytest.approx(np.full(2, 1e-5), rel=1e-4)


def test_a_cone_without_its_apex_is_a_strip() -> None:
    boundary, index = face("frustum", "cone")
    assert domain_of(boundary, site(SiteKind.FACE, index)).period[0] is not None
    boundary, index = face("cone", "cone")
    domain = domain_of(boundary, site(SiteKind.FACE, index))
    apex = np.array([[0.0, 0.0, 2.0]])
    assert domain.period == (None, None)
    assert domain.to_plane(apex, apex) == pytest.approx(np.zeros((1, 2)), abs=1e-12)


def test_a_sphere_needs_a_pole_away_from_all_points() -> None:
    boundary, index = face("sphere", "sphere")
    sphere = boundary.carriers[boundary.faces[index].carrier]
    assert isinstance(sphere, Sphere)
    with pytest.raises(GeometryError):
        domain_of(boundary, site(SiteKind.FACE, index))
    pole = np.array([0.0, 0.0, 1.0])
    at = (sphere.centre + sphere.radius * pole)[None]
    with pytest.raises(GeometryError):
        domain_of(boundary, site(SiteKind.FACE, index), pole).to_plane(at, at)


def edges_of(name: str, kind: str) -> list[tuple[RegionBoundary, int]]:
    boundary = boundary_of(name)
    return [
        (boundary, k)
        for k, e in enumerate(boundary.edges)
        if e.convexity is Convexity.REENTRANT and e.curve.kind == kind
    ]


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("bracket", "line"),
        ("fichera", "line"),
        ("pocket", "line"),
        ("blind hole", "circle"),
        ("round boss", "circle"),
        ("square boss", "line"),
        ("unequal tee", "curve"),
        ("equal tee", "ellipse"),
    ],
)
def test_edges_are_drawn_one_to_one(name: str, kind: str) -> None:
    for boundary, index in edges_of(name, kind):
        domain = domain_of(boundary, site(SiteKind.EDGE, index), reach=0.3)
        assert isinstance(domain, EdgeDomain)
        edge = boundary.edges[index]
        t = edge.start + (edge.end - edge.start) * RNG.uniform(0.02, 0.98, 100)
        feet = edge.curve.point(edge.curve.wrapped(t))
        one, two = (
            -boundary.faces[f].outward * boundary.carriers[boundary.faces[f].carrier].normal(feet)
            for f in edge.faces
        )
        share = RNG.uniform(0.02, 0.98, 100)[:, None]
        toward = feet + 0.3 * ((1 - share) * one + share * two)
        assert_round_trip(domain, feet, toward)
        uv = domain.to_plane(feet, toward)
        assert (handedness(domain, uv) > 0).all()
        # the faces' own normals are the strip's long sides
        sides = [domain.to_plane(feet, feet + n)[:, 1] for n in (one, two)]
        assert (np.min(sides, axis=0) < uv[:, 1]).all()
        assert (np.max(sides, axis=0) > uv[:, 1]).all()


FLARED = {EndKind.FLARED_FIRST, EndKind.FLARED_SECOND}


@pytest.mark.parametrize(
    ("name", "ends"),
    [
        ("bracket", {"pinched pinched": 1}),  # an L's inner edge from one plane face to the other
        ("fichera", {"open pinched": 3}),  # from the reentrant vertex to saddle vertices
        ("pocket", {"open pinched": 4, "open open": 4}),
        ("square boss", {"flared flared": 4}),  # a ball below a corner touches the top's plane only
        ("blind hole", {"open open": 1}),  # closed
        ("equal tee", {"open open": 2}),
    ],
)
def test_strips_end_as_balls_touch_there(name: str, ends: dict[str, int]) -> None:
    boundary = boundary_of(name)
    found: Counter[str] = Counter()
    for k, edge in enumerate(boundary.edges):
        if edge.convexity is Convexity.REENTRANT:
            domain = domain_of(boundary, site(SiteKind.EDGE, k))
            assert isinstance(domain, EdgeDomain)
            kinds = ["flared" if e.kind in FLARED else e.kind.value for e in domain.ends]
            found[" ".join(sorted(kinds))] += 1
    assert found == ends


def test_a_rim_below_the_corner_of_a_boss_is_a_segment() -> None:
    """The sheet halfway between two edges of a boss ends in a segment below their corner."""
    boundary = boundary_of("square boss")
    corner = np.array([1.0, 1.0, 1.0])
    for index, edge in enumerate(boundary.edges):
        if edge.convexity is not Convexity.REENTRANT or norm(edge.samples - corner).min() > 1e-9:
            continue
        domain = domain_of(boundary, site(SiteKind.EDGE, index), reach=0.5)
        along = edge.samples[np.argmax(norm(edge.samples - corner))] - corner
        along /= norm(along)
        across = np.array([along[1], along[0], 0.0])
        depth = np.array([0.0, 0.1, 0.3, 0.5])
        # points of the sheet at ways s along the edge, the rim being s = 0
        for s, near in ((0.0, 1e-9), (1e-9, 1e-6), (1e-4, 1e-2)):
            feet = corner + np.full((4, 1), s) * along
            toward = feet + s * across - depth[:, None] * np.array([0.0, 0.0, 1.0])
            uv = domain.to_plane(feet, toward)
            rim = domain.to_plane(
                np.repeat(corner[None], 4, axis=0), corner - depth[:, None] * [0, 0, 1]
            )
            assert uv == pytest.approx(rim, abs=max(near, 2 * s))
            assert (np.abs(np.diff(rim[:, 1])) > 0.02).all()
            back, inward = domain.lift(uv)
            assert back == pytest.approx(feet, abs=1e-9)
            away = toward[1:] - feet[1:]
            assert inward[1:] == pytest.approx(away / norm(away)[:, None], abs=1e-4)
        # all other directions are the one point without radius
        one = domain.to_plane(corner[None], corner[None])
        close = corner + 1e-9 * along
        other = domain.to_plane(
            close[None], (close + 1e-9 * across - 1e-9 * np.array([0, 0, 1.0]))[None]
        )
        assert one == pytest.approx(other, abs=1e-6)


def test_a_pinched_end_is_one_point() -> None:
    boundary, index = edges_of("bracket", "line")[0]
    edge = boundary.edges[index]
    domain = domain_of(boundary, site(SiteKind.EDGE, index))
    foot = np.repeat(edge.curve.point(np.array([edge.start])), 2, axis=0)
    directions = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    uv = domain.to_plane(foot, foot - directions)
    assert uv[0] == pytest.approx(uv[1], abs=1e-12)


@pytest.mark.parametrize("name", ["fichera", "pocket"])
def test_vertices_are_drawn_one_to_one(name: str) -> None:
    boundary = boundary_of(name)
    tried = 0
    for k, vertex in enumerate(boundary.vertices):
        d = RNG.normal(size=(3000, 3))
        d /= norm(d)[:, None]
        d = d[reaches_into(boundary, k, d)]
        if vertex.convexity not in (Convexity.REENTRANT, Convexity.SADDLE) or not len(d):
            continue
        tried += 1
        domain = domain_of(boundary, site(SiteKind.VERTEX, k))
        assert isinstance(domain, VertexDomain)
        feet = np.repeat(vertex.point[None], len(d), axis=0)
        assert_round_trip(domain, feet, feet + 0.2 * d)
        assert (handedness(domain, domain.to_plane(feet, feet + d)) > 0).all()
    assert tried == {"fichera": 1, "pocket": 4}[name]
