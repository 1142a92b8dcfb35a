"""The exact boundary of every solid of the shared table, against closed forms and hand counts."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

import decomp
from decomp.boundary.topology import RegionBoundary
from tests.solids import SOLIDS, Case

EXACT = 1e-10


@pytest.fixture(scope="module", params=SOLIDS, ids=lambda name: name.replace(" ", "-"))
def built(request: pytest.FixtureRequest) -> tuple[Case, RegionBoundary]:
    case = SOLIDS[request.param]
    return case, decomp.Geometry(case.make()).regions[0]


def test_volume_and_area(built: tuple[Case, RegionBoundary]) -> None:
    case, region = built
    if case.volume is not None:
        assert abs(region.volume - case.volume) <= region.volume_error + EXACT * case.volume
    if case.area is not None:
        assert abs(region.area - case.area) <= region.area_error + EXACT * case.area
    assert region.area == pytest.approx(sum(face.area for face in region.faces))
    assert all(face.area > 0 for face in region.faces)


def test_stated_errors_are_small(built: tuple[Case, RegionBoundary]) -> None:
    _, region = built
    assert region.volume_error <= 1e-9 * region.volume
    assert region.area_error <= 1e-9 * region.area


def test_counts(built: tuple[Case, RegionBoundary]) -> None:
    case, region = built
    assert region.euler == case.euler
    assert Counter(region.carriers[f.carrier].kind for f in region.faces) == case.faces
    assert Counter((e.curve.kind, e.convexity.value) for e in region.edges) == case.edges
    assert Counter(v.convexity.value for v in region.vertices) == case.vertices


def test_edge_lengths(built: tuple[Case, RegionBoundary]) -> None:
    case, region = built
    for convexity, total in case.length.items():
        lengths = [e.length for e in region.edges if e.convexity.value == convexity]
        assert sum(lengths) == pytest.approx(total, rel=EXACT)


def test_edges_lie_on_both_carriers(built: tuple[Case, RegionBoundary]) -> None:
    _, region = built
    for edge in region.edges:
        for carrier in edge.carriers:
            off = np.abs(region.carriers[carrier].signed_distance(edge.samples))
            assert off.max() <= 1e-12 * region.diagonal


def test_every_edge_bounds_two_faces_in_opposite_directions(
    built: tuple[Case, RegionBoundary],
) -> None:
    _, region = built
    uses = Counter(half for face in region.faces for loop in face.loops for half in loop)
    assert set(uses.values()) <= {1}
    assert {edge for edge, _ in uses} == set(range(len(region.edges)))
    assert len(uses) == 2 * len(region.edges)


def test_the_boundary_is_closed(built: tuple[Case, RegionBoundary]) -> None:
    """The vector area of a closed surface is zero, and so is the volume it seems to hold when
    seen from far away, if a face is missing: shifting the origin must not change the volume."""
    case, region = built
    moved = decomp.Geometry(case.make().translate((7.0, -5.0, 3.0))).regions[0]
    assert moved.volume == pytest.approx(region.volume, rel=1e-11)
    assert np.allclose(moved.bounds - region.bounds, [7.0, -5.0, 3.0], atol=1e-10)


def test_names_are_unique(built: tuple[Case, RegionBoundary]) -> None:
    _, region = built
    names = [face.name for face in region.faces]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("name", SOLIDS)
def test_similar_solids_have_similar_boundaries(name: str) -> None:
    """Rotated, mirrored, scaled and moved: the same counts, scaled measures."""
    plain = decomp.Geometry(SOLIDS[name].make()).regions[0]
    moved = decomp.Geometry(
        SOLIDS[name]
        .make()
        .rotate((1, 2, -1), 37)
        .mirror((0.2, -1, 0.4), (1, 1, 1))
        .scale(0.07)
        .translate((0.3, 0.2, -0.1))
    ).regions[0]
    assert moved.volume == pytest.approx(plain.volume * 0.07**3, rel=1e-10)
    assert moved.area == pytest.approx(plain.area * 0.07**2, rel=1e-10)
    assert moved.euler == plain.euler
    assert [f.name for f in moved.faces] == [f.name for f in plain.faces]
    assert Counter((e.curve.kind, e.convexity) for e in moved.edges) == Counter(
        (e.curve.kind, e.convexity) for e in plain.edges
    )
