"""Every model that the tests know: the certificate of its skeleton, figure by figure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import decomp
from decomp.complex.model import PatchKind
from decomp.sites.site import SiteKind
from decomp.skeletons.cells.surface import is_closed
from decomp.skeletons.certificate.certificate import shortcomings
from decomp.skeletons.certificate.coverage import coverage
from decomp.skeletons.certificate.evidence import Evidence
from tests.corpus.files import FILES
from tests.skeletons.computed import TOLERANCE, param, skeleton_of, source_of
from tests.skeletons.machine_parts import PARTS
from tests.skeletons.on_equations import off_equations
from tests.skeletons.shapes import SHAPES
from tests.solids import SOLIDS

MODELS = [param(name) for name in (*SOLIDS, *SHAPES, *PARTS, *FILES)]


@pytest.mark.parametrize("name", MODELS)
def test_certificate(name: str) -> None:
    skeleton = skeleton_of(name)
    diagonal, points = skeleton.diagonal, skeleton.complex.points
    assert skeleton.tolerance == pytest.approx(TOLERANCE * diagonal)
    if name in SOLIDS:
        assert [r.certificate.expected_euler for r in skeleton.regions] == [SOLIDS[name].euler]
    assert (skeleton.radius >= 0).all()
    for region in skeleton.regions:
        found = region.certificate
        assert found.residual <= 1e-12
        assert found.chord_error <= TOLERANCE
        assert found.flipped == found.open_cells == 0
        assert found.volume_error <= 1e-3
        assert found.euler == found.expected_euler
        assert found.intrusion <= 1e-9
        assert found.coverage <= 2 * TOLERANCE
        assert shortcomings(found, TOLERANCE) == ()
        for cells in (region.cells, region.face_cells):
            assert all(is_closed(skeleton.complex, cell.sides) for cell in cells)
            total = sum(cell.volume for cell in cells)
            assert total == pytest.approx(region.boundary.volume, rel=1e-3)
            assert all(cell.volume > 0 for cell in cells)
        assert len(region.face_cells) == len(region.boundary.faces)
    assert off_equations(skeleton) <= 1e-10
    used = [patch.triangles for patch in skeleton.complex.patches]
    assert np.isfinite(points).all()
    assert all((triangles >= 0).all() and (triangles < len(points)).all() for triangles in used)


@pytest.mark.parametrize("name", ["block", "through hole", "blind hole", "pocket"])
def test_coverage_by_other_balls(name: str) -> None:
    """Balls from other places than those of the certificate end on the skeleton too."""
    geometry = decomp.Geometry(source_of(name))
    skeleton = skeleton_of(name)
    found = coverage(Evidence.of(skeleton, geometry.index, 0), 20_000, seed=7)
    assert found.value <= 2 * TOLERANCE


@pytest.mark.parametrize("name", ["square boss", "ball on a corner"])
def test_every_missing_sheet_is_seen(name: str) -> None:
    """Sheets between two reentrant edges too, which no ball that touches a face comes to."""
    geometry = decomp.Geometry(source_of(name))
    evidence = Evidence.of(skeleton_of(name), geometry.index, 0)
    between_edges = 0
    for sheet in evidence.sheets:
        if sheet.area < 5e-3 * geometry.diagonal**2:
            continue
        between_edges += all(geometry.sites[k].kind is not SiteKind.FACE for k in sheet.sites)
        rest = tuple(other for other in evidence.sheets if other is not sheet)
        assert coverage(replace(evidence, sheets=rest), 5_000, seed=1).value > 2 * TOLERANCE
    assert between_edges >= (name == "ball on a corner")


@pytest.mark.parametrize("name", ["block", "bracket", "blind hole", "fichera", "cylinder"])
def test_radii_are_distances_to_the_boundary(name: str) -> None:
    geometry = decomp.Geometry(source_of(name))
    skeleton = skeleton_of(name)
    distance = -geometry.distance(skeleton.complex.points)
    assert np.abs(skeleton.radius - distance).max() <= 1e-12 * skeleton.diagonal


@pytest.mark.parametrize("name", ["block", "through hole", "blind hole", "fichera"])
def test_patches_meet_along_their_sides_alone(name: str) -> None:
    """Every side of a boundary triangle belongs to two of them; no triangle stands twice."""
    mesh = skeleton_of(name).complex
    faces = [p.triangles for p in mesh.patches if p.kind is PatchKind.FACE]
    sides = np.concatenate(faces)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    _, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    assert (count == 2).all()
    every = np.sort(np.concatenate([p.triangles for p in mesh.patches]), axis=1)
    assert len(np.unique(every, axis=0)) == len(every)
