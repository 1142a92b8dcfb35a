"""The certificate's figures: right on exact skeletons, and they notice what is wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import decomp
from decomp.complex.model import Complex, Patch, PatchKind
from decomp.errors import GeometryError
from decomp.sites.site import SiteKind
from decomp.skeletons.certificate.certificate import certified, explained, shortcomings
from decomp.skeletons.certificate.coverage import boundary_samples, random_points
from decomp.skeletons.certificate.distance import triangle_distance, triangle_tree
from decomp.skeletons.certificate.evidence import Evidence
from decomp.skeletons.certificate.placement import residual
from decomp.skeletons.model import Certificate, Sheet
from decomp.vectors import Array
from tests.skeleton_fixtures import Flat, block, capsule
from tests.solids import SOLIDS

BALLS = 500
TOLERANCE = 5e-4


def measured(evidence: Evidence) -> Certificate:
    return certified(evidence, BALLS).certificate


def short(evidence: Evidence) -> tuple[str, ...]:
    return shortcomings(measured(evidence), TOLERANCE)


def with_points(evidence: Evidence, points: Array) -> Evidence:
    mesh = evidence.complex
    return replace(evidence, complex=Complex(points, mesh.patches, mesh.lines))


def with_patch(evidence: Evidence, number: int, **changes: Any) -> Evidence:
    mesh = evidence.complex
    patches = list(mesh.patches)
    patches[number] = replace(patches[number], **changes)
    return replace(evidence, complex=Complex(mesh.points, tuple(patches), mesh.lines))


def test_the_block_is_exact() -> None:
    found = measured(block().evidence)
    assert found.residual <= 1e-15
    assert found.intrusion <= 1e-15
    assert found.chord_error <= 1e-15
    assert found.coverage <= 1e-12
    assert found.volume_error <= 1e-15
    assert (found.flipped, found.open_cells, found.euler, found.expected_euler) == (0, 0, 1, 1)
    assert shortcomings(found, TOLERANCE) == ()


def test_the_capsule_has_reflexive_loci_alone() -> None:
    found = measured(capsule().evidence)
    assert found.residual <= 1e-15
    assert found.coverage <= 1e-11
    assert (found.flipped, found.open_cells, found.euler) == (0, 0, 1)
    assert 5e-4 < found.chord_error < 1e-3  # as coarse as it is made
    assert shortcomings(found, TOLERANCE) == ("chord_error", "volume_error")


@pytest.mark.parametrize("made", [block(), capsule()])
def test_a_moved_vertex_is_noticed(made: Any) -> None:
    points = made.evidence.complex.points.copy()
    points[-1] += 1e-9
    found = certified(with_points(made.evidence, points), BALLS)
    assert 1 <= found.certificate.residual * made.geometry.diagonal / 1e-9 < 2.01
    assert "residual" in shortcomings(found.certificate, TOLERANCE)
    assert found.where["residual"].point == pytest.approx(points[-1])


def test_a_moved_boundary_vertex_is_noticed() -> None:
    points = capsule().evidence.complex.points.copy()
    points[5] *= 1 + 1e-9
    assert "residual" in short(with_points(capsule().evidence, points))


def test_a_vertex_that_is_no_number_is_refused() -> None:
    points = block().evidence.complex.points.copy()
    points[-1] = np.nan
    evidence = with_points(block().evidence, points)
    assert residual(evidence).value == np.inf
    with pytest.raises(GeometryError, match="no place"):
        certified(evidence, BALLS)


def test_a_sheet_of_an_edge_with_itself() -> None:
    """Under a thin branch on a thicker run, points of the plane y = 0 have two feet on one edge."""
    tee = decomp.Geometry(SOLIDS["unequal tee"].make())
    edge = next(k for k, s in enumerate(tee.sites) if s.region == 0 and s.kind is SiteKind.EDGE)
    rng = np.random.default_rng(0)
    points = np.stack([rng.uniform(-0.55, 0.55, 600), np.zeros(600), rng.uniform(0, 0.8, 600)], 1)
    found = tee.nearest(points)
    both = (found.site == edge) & (np.abs(found.foot[:, 1]) > 1e-6)
    points, radius = points[both], found.distance[both]
    assert len(points) > 100
    triangles = np.arange(len(points) // 3 * 3).reshape(-1, 3)
    patch = Patch(PatchKind.SHEET, Flat(np.zeros(3), np.array([0, 1.0, 0])), triangles)
    sheet = Sheet((edge, edge), None, 0, 0.0, (0.0, 0.0))
    mesh = Complex(points, (patch,), ())
    evidence = Evidence(tee.index, 0, tee.diagonal, mesh, radius, (sheet,), (), ((),) * 5, (), ())
    assert residual(evidence).value < 1e-15


def test_a_ball_too_large_is_noticed() -> None:
    radius = block().evidence.radius.copy()
    radius[-1] += 1e-6
    found = certified(replace(block().evidence, radius=radius), BALLS)
    assert found.certificate.intrusion == pytest.approx(1e-6 / block().geometry.diagonal, rel=1e-6)
    lines = explained(found, TOLERANCE, block().skeleton.sites)
    assert len(lines) == 2
    assert str(lines[1]).startswith("intrusion is 1.86e-07, allowed 1e-09, at (3, 2, 1) of block.")


def test_a_missing_sheet_is_noticed() -> None:
    evidence = block().evidence
    gone = evidence.sheets[0].patch
    cells = tuple(
        replace(cell, sides=tuple(side for side in cell.sides if side[0] != gone))
        for cell in evidence.cells
    )
    found = measured(replace(evidence, sheets=evidence.sheets[1:], cells=cells, face_cells=cells))
    assert found.open_cells == 4  # both kinds
    assert found.euler == 0
    assert found.coverage > 0.05
    assert shortcomings(found, TOLERANCE) == ("open_cells", "euler", "coverage")


def test_a_missing_axis_is_noticed() -> None:
    found = measured(replace(capsule().evidence, reflexive=capsule().evidence.reflexive[1:]))
    assert found.euler == 2
    assert found.coverage > 0.2


def test_a_folded_triangle_is_noticed() -> None:
    patch = block().evidence.complex.patches[0]
    triangles = patch.triangles.copy()
    triangles[0] = triangles[0, ::-1]
    found = short(with_patch(block().evidence, 0, triangles=triangles))
    assert found == ("flipped", "open_cells")


def test_a_missing_cell_is_noticed() -> None:
    found = measured(replace(block().evidence, cells=block().evidence.cells[1:]))
    assert found.volume_error == pytest.approx(7 / 3 / 24)


def test_samples_lie_on_their_faces() -> None:
    evidence = capsule().evidence
    samples = list(boundary_samples(evidence, 1000, np.random.default_rng(1)))
    for face, (points, inward) in zip(evidence.boundary.faces, samples, strict=True):
        carrier = evidence.boundary.carriers[face.carrier]
        assert np.abs(carrier.signed_distance(points)).max() < 1e-15
        assert (evidence.index.region_of(points + 1e-3 * inward) == 0).all()
        z = points[:, 2]
        inside = {"rod": (0, 3), "low": (-1, 0), "high": (3, 4)}[face.name.split(".")[0]]
        assert (z >= inside[0]).all() and (z <= inside[1]).all()
    counts = np.array([len(points) for points, _ in samples])
    areas = np.array([face.area for face in evidence.boundary.faces])
    assert counts / counts.sum() == pytest.approx(areas / areas.sum(), abs=0.02)


def test_distances_to_triangles() -> None:
    """Against the plain minimum over a fine sampling and over all triangles one by one."""
    rng = np.random.default_rng(2)
    corners = rng.random((200, 1, 3)) + 0.2 * rng.standard_normal((200, 3, 3))
    corners[50:80, 2] = corners[50:80, 1]  # segments
    corners[80:90] = corners[80:90, :1]  # points
    points = 2 * rng.random((300, 3)) - 0.5
    points[:20] = corners[:20].mean(axis=1)
    found = triangle_distance(triangle_tree(corners), points)
    assert (found[:20] < 1e-15).all()
    single = [triangle_distance(triangle_tree(corners[k : k + 1]), points) for k in range(200)]
    assert found == pytest.approx(np.min(single, axis=0), abs=1e-15)
    for k in (0, 20, 40, 60, 85):
        sampled = fine(corners[k])
        nearest = np.linalg.norm(points[:, None] - sampled, axis=2).min(axis=1)
        assert (single[k] <= nearest + 1e-15).all()
        assert single[k] == pytest.approx(nearest, abs=0.02)
    assert (triangle_distance(triangle_tree(corners[:0]), points) == np.inf).all()


def fine(triangle: Array) -> Array:
    """A lattice of points of a triangle."""
    n = 40
    u, v = np.mgrid[: n + 1, : n + 1] / n
    inside = u + v <= 1 + 1e-12
    weights = np.stack([u[inside], v[inside], 1 - u[inside] - v[inside]], axis=1)
    return np.asarray(weights @ triangle)


def test_random_points_are_spread_by_area() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 0, 0], [0, 0, 0.0]])
    drawn = random_points(points, np.array([[0, 1, 2], [1, 3, 2]]), 3000, np.random.default_rng(3))
    assert (drawn[:, 0] / 3 + drawn[:, 1] <= 1 + 1e-15).all()
    assert (drawn[:, 0] + drawn[:, 1] < 1).mean() == pytest.approx(1 / 3, abs=0.03)
