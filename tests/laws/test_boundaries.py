"""Laws on the exact boundaries of random models.

A model may be empty, or touch itself, which is refused: then there is nothing to check. That most
examples are accepted is a test of its own.
"""

from __future__ import annotations

from collections import Counter
from math import sqrt

import numpy as np
import pytest
from hypothesis import currently_in_test_context, given, note, reject
from hypothesis import strategies as st

import decomp
from decomp.boundary.topology import Convexity, RegionBoundary
from decomp.carriers import Plane
from decomp.csg.primitives import Block, Cone, HalfSpace, InfiniteCone, InfiniteCylinder
from decomp.csg.solid import Solid
from decomp.errors import ContactError, EmptyRegionError, GeometryError
from decomp.vectors import Array
from tests.formats.membership import contains
from tests.laws.effort import examples
from tests.laws.strategies import directions, generic, points, solids, text

GENERIC = solids()
ANY = st.one_of(solids(), solids(special=True))
FEW = solids(leaves=2)
LARGE = 40.0


def boundary(solid: Solid) -> RegionBoundary | None:
    """The boundary, None if the solid is empty; the example is dropped if it touches itself."""
    if currently_in_test_context():
        note(text(solid))
    try:
        return decomp.Geometry(solid).regions[0]
    except EmptyRegionError:
        return None
    except ContactError:
        reject()


def solid_boundary(solid: Solid) -> RegionBoundary:
    """The boundary; the example is dropped if the solid is empty or touches itself."""
    found = boundary(solid)
    if found is None:
        reject()
    return found


def volume(solid: Solid) -> float:
    found = boundary(solid)
    return found.volume if found else 0.0


def kinds(region: RegionBoundary) -> Counter[tuple[str, str]]:
    """Numbers of faces, edges and vertices of each kind."""
    faces = [("face", region.carriers[f.carrier].kind) for f in region.faces]
    edges = [(e.curve.kind, e.convexity.value) for e in region.edges]
    vertices = [("vertex", v.convexity.value) for v in region.vertices]
    return Counter(faces + edges + vertices)


def same(a: RegionBoundary, b: RegionBoundary, factor: float = 1.0) -> None:
    """Two boundaries are alike, up to a scale."""
    slack = 1e-10 + a.volume_error + b.volume_error / factor**3
    assert b.volume / factor**3 == pytest.approx(a.volume, rel=1e-9, abs=slack)
    slack = 1e-10 + a.area_error + b.area_error / factor**2
    assert b.area / factor**2 == pytest.approx(a.area, rel=1e-9, abs=slack)
    assert b.euler == a.euler
    assert kinds(b) == kinds(a)


def sampled_volume(solid: Solid, box: Array, cells: int = 40) -> tuple[float, float]:
    """Volume inside a box and its standard error, from two random points in each of many cells."""
    rng = np.random.default_rng(11)
    size = (box[1] - box[0]) / cells
    grid = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    hits = np.array(
        [contains(solid, box[0] + (grid + rng.random(grid.shape)) * size) for _ in range(2)]
    )
    cell = size.prod()
    error = cell * sqrt(float((hits[0] != hits[1]).sum())) / 2
    return float(hits.mean(axis=0).sum() * cell), error + 2 * cell


@pytest.mark.parametrize(("special", "least"), [(False, 0.6), (True, 0.5)])
def test_most_random_solids_are_accepted(special: bool, least: float) -> None:
    outcomes: Counter[str] = Counter()

    @examples(25)
    @given(solids(special))
    def build(a: Solid) -> None:
        note(text(a))
        try:
            decomp.Geometry(a)
            outcomes["accepted"] += 1
        except GeometryError as error:
            outcomes[type(error).__name__] += 1

    build()
    assert set(outcomes) <= {"accepted", "EmptyRegionError", "ContactError"}
    assert outcomes["accepted"] > least * outcomes.total()


@examples(5)
@given(ANY)
def test_volume_agrees_with_sampling(a: Solid) -> None:
    region = boundary(a)
    if region is None:
        points = np.random.default_rng(3).uniform(-4, 4, (20000, 3))
        assert contains(a, points).mean() < 1e-3
        return
    margin = 0.01 * region.diagonal
    sampled, error = sampled_volume(a, region.bounds + margin * np.array([[-1], [1]]))
    assert abs(region.volume - sampled) <= 5 * error
    assert region.volume_error <= 1e-5 * max(region.volume, region.diagonal**3 * 1e-3)


@examples(5)
@given(ANY)
def test_nothing_lies_beyond_the_bounds(a: Solid) -> None:
    region = solid_boundary(a)
    where = np.random.default_rng(5).uniform(-8, 8, (20000, 3))
    held = where[contains(a, where)]
    slack = 1e-7 * region.diagonal
    assert (held >= region.bounds[0] - slack).all()
    assert (held <= region.bounds[1] + slack).all()
    ends = np.concatenate([e.samples for e in region.edges] + [np.empty((0, 3))])
    assert (ends >= region.bounds[0] - slack).all()
    assert (ends <= region.bounds[1] + slack).all()


@examples(3)
@given(FEW, FEW)
def test_de_morgan_twins_are_alike(a: Solid, b: Solid) -> None:
    frame = Block((-6, -6.5, -7), (13, 13.5, 14), name="frame")
    same(solid_boundary(frame - (a | b)), solid_boundary(frame & ~a & ~b))
    same(solid_boundary(a & b), solid_boundary(frame - (~a | ~b)))


@examples(3)
@given(FEW, FEW)
def test_volumes_and_areas_include_and_exclude(a: Solid, b: Solid) -> None:
    """V(A) + V(B) = V(A | B) + V(A & B); in general position also for area and Euler number."""
    parts = [boundary(s) for s in (a, b, a | b, a & b)]
    volumes, areas, eulers = (
        [getattr(p, what) if p else 0 for p in parts] for what in ("volume", "area", "euler")
    )
    slack = 1e-9 * LARGE + sum(p.volume_error for p in parts if p)
    assert volumes[0] + volumes[1] == pytest.approx(volumes[2] + volumes[3], rel=0, abs=slack)
    if not _shares_carriers(a, b):
        slack = 1e-9 * LARGE + sum(p.area_error for p in parts if p)
        assert areas[0] + areas[1] == pytest.approx(areas[2] + areas[3], rel=0, abs=slack)
        assert eulers[0] + eulers[1] == eulers[2] + eulers[3]


@examples(3)
@given(solids(special=True, leaves=2), solids(special=True, leaves=2))
def test_volumes_include_and_exclude_in_special_positions(a: Solid, b: Solid) -> None:
    assert volume(a) + volume(b) == pytest.approx(volume(a | b) + volume(a & b), abs=1e-9 * LARGE)
    assert volume(a) == pytest.approx(volume(a & b) + volume(a - b), abs=1e-9 * LARGE)


@examples(5)
@given(ANY)
def test_a_mould_has_the_casts_boundary(a: Solid) -> None:
    """A block around a solid, less the solid: the boundary is the same, seen from outside."""
    cast = solid_boundary(a)
    low, high = cast.bounds + 0.21 * cast.diagonal * np.array([[-1], [1]])
    block = Block.between(low, high)
    mould = solid_boundary(block - a)
    size = high - low
    slack = 1e-9 * size.prod() + cast.volume_error + mould.volume_error
    assert mould.volume == pytest.approx(size.prod() - cast.volume, rel=0, abs=slack)
    flat = 2 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0])
    slack = 1e-9 * flat + cast.area_error + mould.area_error
    assert mould.area == pytest.approx(flat + cast.area, rel=0, abs=slack)
    assert mould.euler == 1 + cast.euler
    assert len(mould.faces) == len(cast.faces) + 6
    flipped = Counter({_flipped(kind): n for kind, n in kinds(cast).items()})
    flipped.update({("face", "plane"): 6, ("line", "convex"): 12, ("vertex", "convex"): 8})
    assert kinds(mould) == flipped


@examples(4)
@given(ANY)
def test_cast_and_mould_fill_the_block(a: Solid) -> None:
    """Two regions that touch all over."""
    cast = solid_boundary(a)
    low, high = cast.bounds + 0.21 * cast.diagonal * np.array([[-1], [1]])
    both = decomp.Geometry({"cast": a, "mould": Block.between(low, high) - a}).regions
    slack = 1e-9 * (high - low).prod() + sum(r.volume_error for r in both)
    assert sum(r.volume for r in both) == pytest.approx((high - low).prod(), rel=0, abs=slack)


@examples(5)
@given(ANY, directions(False), generic(0, 360), points(generic(-1, 1)), generic(0.3, 3))
def test_similar_solids_have_similar_boundaries(
    a: Solid, axis: Array, angle: float, offset: Array, factor: float
) -> None:
    plain = solid_boundary(a)
    moved = a.mirror(axis).rotate((1, 2, -1), angle).scale(factor).translate(offset)
    same(plain, solid_boundary(moved), factor)


@examples(3)
@given(ANY)
def test_equal_expressions_have_equal_boundaries(a: Solid) -> None:
    plain = solid_boundary(a)
    same(plain, solid_boundary(~(~a | ~a)))
    same(plain, solid_boundary((a & a) | (a - a)))


@examples(3)
@given(ANY)
def test_two_copies_apart_are_twice_one(a: Solid) -> None:
    one = solid_boundary(a)
    two = solid_boundary(a.linear_copies((1.1 * one.diagonal, 0.1, 0.2), 2))
    slack = 2 * one.volume_error + two.volume_error
    assert two.volume == pytest.approx(2 * one.volume, rel=1e-9, abs=slack)
    slack = 2 * one.area_error + two.area_error
    assert two.area == pytest.approx(2 * one.area, rel=1e-9, abs=slack)
    assert two.euler == 2 * one.euler
    assert kinds(two) == Counter({kind: 2 * n for kind, n in kinds(one).items()})


@examples(8)
@given(ANY)
def test_each_edge_bounds_two_half_edges(a: Solid) -> None:
    region = solid_boundary(a)
    halves = Counter(h for face in region.faces for loop in face.loops for h in loop)
    assert halves == Counter((k, d) for k in range(len(region.edges)) for d in (1, -1))
    for index, face in enumerate(region.faces):
        for loop in face.loops:
            for (k, d), (m, e) in zip(loop, loop[1:] + loop[:1], strict=True):
                assert index in region.edges[k].faces
                if region.edges[k].vertices is None:
                    assert len(loop) == 1
                    continue
                assert region.edges[m].vertices is not None
                assert region.edges[k].vertices[::d][1] == region.edges[m].vertices[::e][0]


@examples(8)
@given(ANY)
def test_loops_turn_around_plane_faces_by_their_area(a: Solid) -> None:
    """Half the integral of r x dr along the loops is the area times the outward normal."""
    region = solid_boundary(a)
    for face in region.faces:
        carrier = region.carriers[face.carrier]
        if isinstance(carrier, Plane):
            vector = sum(d * _swept(region, k) for loop in face.loops for k, d in loop)
            expected = face.area * face.outward * carrier.normal(face.point)
            assert vector == pytest.approx(expected, abs=2e-4 * (1 + region.area))


@examples(8)
@given(ANY)
def test_edges_lie_on_their_carriers_and_end_at_their_vertices(a: Solid) -> None:
    region = solid_boundary(a)
    slack = 1e-10 * region.diagonal
    for edge in region.edges:
        for carrier in edge.carriers:
            assert np.abs(region.carriers[carrier].signed_distance(edge.samples)).max() < slack
        gaps = np.linalg.norm(np.diff(edge.samples, axis=0), axis=1)
        assert gaps.sum() <= edge.length * (1 + 1e-9)
        assert gaps.sum() >= edge.length * 0.99
        if edge.vertices is not None:
            ends = np.array([region.vertices[v].point for v in edge.vertices])
            assert np.allclose(edge.samples[[0, -1]], ends, atol=1e-7 * region.diagonal)


@examples(8)
@given(ANY)
def test_faces_part_inside_from_outside(a: Solid) -> None:
    """A step along the outward normal from a face leaves the region."""
    region = solid_boundary(a)
    for face in region.faces:
        carrier = region.carriers[face.carrier]
        step = 1e-6 * region.diagonal * face.outward * carrier.normal(face.point)
        away = [abs(c.signed_distance(face.point)) for c in region.carriers]
        away[face.carrier] = np.inf
        if min(away) > 3e-6 * region.diagonal:
            assert contains(a, np.array([face.point - step, face.point + step])).tolist() == [
                True,
                False,
            ]


@examples(8)
@given(ANY)
def test_wedges_tell_convexity(a: Solid) -> None:
    """About a point of an edge the region fills less than half for convex, more for reentrant."""
    region = solid_boundary(a)
    rng = np.random.default_rng(1)
    ball = rng.normal(size=(4000, 3))
    ball *= (rng.random(4000) ** (1 / 3) / np.linalg.norm(ball, axis=1))[:, None]
    for edge in region.edges[:12]:
        middle = edge.curve.point(
            edge.curve.wrapped(np.array([0.45 * edge.start + 0.55 * edge.end]))
        )[0]
        others = [
            abs(c.signed_distance(middle))
            for k, c in enumerate(region.carriers)
            if k not in edge.carriers
        ]
        reach = min([1e-4 * region.diagonal, *others])
        if reach < 1e-6 * region.diagonal:
            continue
        share = contains(a, middle + 0.9 * reach * ball).mean()
        if edge.convexity is Convexity.CONVEX:
            assert share < 0.53
        elif edge.convexity is Convexity.REENTRANT:
            assert share > 0.47
        else:
            assert 0.45 < share < 0.55


def _swept(region: RegionBoundary, index: int) -> Array:
    """Half the integral of r x dr along an edge, from many chords."""
    edge = region.edges[index]
    r = edge.curve.point(edge.curve.wrapped(np.linspace(edge.start, edge.end, 2001)))
    return np.asarray(np.cross(r[:-1], r[1:]).sum(axis=0) / 2)


def _flipped(kind: tuple[str, str]) -> tuple[str, str]:
    swap = {"convex": "reentrant", "reentrant": "convex"}
    return (kind[0], swap.get(kind[1], kind[1]))


def _shares_carriers(a: Solid, b: Solid) -> bool:
    """Whether a surface of one solid is also one of the other, as with a common frame."""
    both = decomp.csg.halfspaces.half_space_form(decomp.csg.model.model({"a": a, "b": b}))
    used = [{side.carrier for k in part for side in both.placed[k].sides} for part in both.used]
    return bool(used[0] & used[1])


@pytest.mark.parametrize(
    "solid",
    [
        Cone((0, 0, 0), 0.5, (1, 0, 0)),
        InfiniteCone((0, 0, 0), (1, 0, 0), 20) & Block((-3, -3, -3), (6, 6, 6)),
        Block((-1, -1, -1), (2, 2, 2)) | Cone((0, 0, 0), 0.5, (0, 0, 2)),
        InfiniteCylinder((-1, 0, -1), (0, 1, 0), 0.5)
        & InfiniteCone((-0.5, -1, -1), (-1, 0, 0), 45),
    ],
    ids=["pointed cone", "cut nappe", "spire", "apex on a cylinder"],
)
def test_bounds_reach_the_apex(solid: Solid) -> None:
    """An apex inside a face is extreme without an edge."""
    region = decomp.Geometry(solid).regions[0]
    apex = region.vertices[-1].point
    assert (region.bounds[0] <= apex).all()
    assert (apex <= region.bounds[1]).all()
    test_nothing_lies_beyond_the_bounds.hypothesis.inner_test(solid)


FRAME = Block((-3, -3, -3), (6, 6, 6), name="frame")


@pytest.mark.parametrize(
    ("solid", "alike"),
    [
        (
            FRAME
            & (InfiniteCone((0, 0, 0), (1, 0, 0), 45) | InfiniteCone((1, 1, 0), (1, 0, 0), 45)),
            FRAME & InfiniteCone((0, 0, 0), (1, 0, 0), 45),
        ),
        (
            FRAME
            & (HalfSpace((1, 0, 0), (-1, 0, 0)) | ~InfiniteCone((1, 0.5, 0.5), (1, 0, 0), 20)),
            FRAME,
        ),
    ],
    ids=["on a cone", "on a plane"],
)
def test_an_apex_of_no_face_is_no_vertex(solid: Solid, alike: Solid) -> None:
    """The apex of a swallowed cone lies on another carrier, where rounding decides its side."""
    same(solid_boundary(alike), solid_boundary(solid))
