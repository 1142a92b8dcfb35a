"""The boundaries of all regions as one complex: closed, conforming, exact, unfolded."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from math import pi, sqrt

import numpy as np
import pytest

from decomp.complex.boundary.boundary import BoundaryMesh, boundary_mesh, boundary_patches
from decomp.complex.boundary.boundary_pieces import boundary_pieces
from decomp.complex.boundary.boundary_samples import numbered, piece_samples, sample_pieces
from decomp.complex.elements import CarrierSurface
from decomp.complex.model import PatchKind
from decomp.complex.refining.errors_of import flipped
from decomp.complex.refining.refine import refine
from decomp.csg.primitives import Block, Cone, Cylinder, HalfSpace, Sphere, Torus
from decomp.csg.solid import Solid
from decomp.geometry import Geometry
from decomp.vectors import Array, Ints, norm
from tests.corpus.files import FILES
from tests.solids import SOLIDS

RELATIVE = 5e-4
PLANAR = [name for name, case in SOLIDS.items() if set(case.faces) == {"plane"}]


def half(x: float, y: float, z: float) -> HalfSpace:
    return HalfSpace((0, 0, 0), (x, y, z))


def ring() -> Solid:
    return Torus((0, 0, 0), (0, 0, 1), 2, 0.5)


def ball() -> Solid:
    return Sphere((0, 0, 0), 1)


def box(at: tuple[float, float, float], size: tuple[float, float, float]) -> Block:
    return Block(at, size)


MODELS: dict[str, tuple[dict[str, Solid], int]] = {
    "plates that overlap": (
        {"a": box((0, 0, 0), (4, 4, 1)), "b": box((2, 2, 1), (4, 4, 1))},
        1,
    ),
    "crossed bars": ({"a": box((0, 1, 0), (4, 1, 1)), "b": box((1, 0, 1), (1, 4, 1))}, 1),
    "two on one": (
        {
            "a": box((0, 0, 0), (2, 2, 1)),
            "b": box((0, 0, 1), (1, 2, 1)),
            "c": box((1, 0, 1), (1, 2, 1)),
        },
        3,
    ),
    "discs that overlap": (
        {"a": Cylinder((0, 0, 0), (0, 0, 1), 1), "b": Cylinder((0.7, 0, 1), (0.7, 0, 2), 1)},
        1,
    ),
    "disc inscribed in a square": (
        {"a": box((-1, -1, 0), (2, 2, 1)), "b": Cylinder((0, 0, 1), (0, 0, 2), 1)},
        1,
    ),
    "ball in two halves": (
        {
            "ball": ball(),
            "left": box((-2, -2, -2), (2, 4, 4)) - ball(),
            "right": box((0, -2, -2), (2, 4, 4)) - ball(),
        },
        3,
    ),
    "ball in three": (
        {
            "half": ball() & half(1, 0, 0),
            "one": ball() & half(-1, 0, 0) & half(0, 1, 0),
            "other": ball() & half(-1, 0, 0) & half(0, -1, 0),
        },
        3,
    ),
    "knife on a plate": (
        {
            "plate": box((0, 0, 0), (4, 4, 1)),
            "knife": box((1, 1, 1), (2, 2, 2))
            & HalfSpace((2, 2, 1), (1, 0, -1))
            & HalfSpace((2, 2, 1), (-1, 0, -1)),
        },
        0,
    ),
    "cone on its tip": (
        {"plate": box((-2, -2, -1), (4, 4, 1)), "cone": Cone((0, 0, 0), 0, (0, 0, 2), 1)},
        0,
    ),
    "pipe with plugs": (
        {
            "pipe": Cylinder((0, 0, 0), (0, 0, 3), 1) - Cylinder((0, 0, -1), (0, 0, 4), 0.5),
            "upper": Cylinder((0, 0, 1), (0, 0, 2), 0.5),
            "lower": Cylinder((0, 0, 0), (0, 0, 1), 0.5),
        },
        3,
    ),
    "ring in two shells": (
        {
            "ring": ring(),
            "upper": box((-3, -3, 0), (6, 6, 1)) - ring(),
            "lower": box((-3, -3, -1), (6, 6, 1)) - ring(),
        },
        4,
    ),
    "ring in two": ({"a": ring() & half(0, 1, 0), "b": ring() & half(0, -1, 0)}, 2),
    "shallow dome": (
        {
            "dome": Sphere((0, 0, 0), 10) & HalfSpace((0, 0, 9.9), (0, 0, -1)),
            "base": Cylinder((0, 0, 9), (0, 0, 9.9), sqrt(100 - 9.9**2)),
        },
        1,
    ),
}

AWKWARD: dict[str, Solid] = {
    "thin lens": ball() & Sphere((1.98, 0, 0), 1),
    "needle": Cone((0, 0, 0), 0.02, (0, 0, 2)),
    "blunt needle": Cone((0, 0, 0), 0.2, (0, 0, 2), 0.19),
    "flat cone": Cone((0, 0, 0), 2, (0, 0, 0.02)),
    "holes that nearly touch": box((0, 0, 0), (4, 2, 1))
    - Cylinder((1.5, 1, -1), (1.5, 1, 2), 0.49999)
    - Cylinder((2.5, 1, -1), (2.5, 1, 2), 0.49999),
    "foil": Cylinder((0, 0, 0), (0, 0, 0.001), 1),
    "thin tube": Cylinder((0, 0, 0), (0, 0, 1), 1) - Cylinder((0, 0, -1), (0, 0, 2), 0.9999),
    "long pipe with small holes": Cylinder((0, 0, 0), (0, 0, 100), 1)
    - Cylinder((0, 0, 50), (2, 0, 50), 0.05)
    - Cylinder((0, 0, 7), (2, 0.1, 9), 0.05),
    "hole near a round edge": Cylinder((0, 0, 0), (0, 0, 1), 1.5)
    - Cylinder((1.48, 0, -1), (1.48, 0, 2), 0.015),
    "pierced ball": ball() - box((-0.001, -0.001, -2), (0.002, 0.002, 4)),
    "bitten ring": ring() - Sphere((2.5, 0, 0), 0.3) - Cylinder((-2, 0, -1), (-2, 0, 1), 0.2),
    "slit ring": ring() - box((1, -0.01, -1), (2, 0.02, 2)),
    "slim ring": Torus((0, 0, 0), (0, 0, 1), 20, 0.5),
    "fat ring": Torus((0, 0, 0), (0, 0, 1), 1, 0.95),
}


def meshed(geometry: Geometry, relative: float = RELATIVE) -> BoundaryMesh:
    return boundary_mesh(geometry, relative * geometry.diagonal)


def volume(points: Array, triangles: Ints) -> float:
    p = points[triangles]
    return float(np.einsum("ij,ij->", p[:, 0], np.cross(p[:, 1], p[:, 2]))) / 6


def assert_sound(geometry: Geometry, mesh: BoundaryMesh) -> None:
    """Closed 2-manifolds of the right topology, exact vertices, unfolded, conforming."""
    n = len(mesh.points)
    for r, region in enumerate(geometry.regions):
        triangles = mesh.triangles_of(r)
        ends = np.roll(triangles, -1, axis=1)
        forth, back = (triangles * n + ends).ravel(), (ends * n + triangles).ravel()
        assert len(np.unique(forth)) == len(forth), region.name
        assert np.isin(forth, back).all(), region.name
        euler = len(np.unique(triangles)) - len(forth) // 2 + len(triangles)
        assert euler == 2 * region.euler, region.name
        sides = mesh.face_sides(r, len(region.faces))
        assert all(sides)
    small = 1e-9 * geometry.diagonal
    for patch in mesh.patches:
        surface = patch.patch.surface
        assert isinstance(surface, CarrierSurface)
        corners = mesh.points[np.unique(patch.patch.triangles)]
        assert np.abs(surface.carrier.signed_distance(corners)).max() <= small
    for line in mesh.lines:
        corners = mesh.points[line.vertices]
        assert norm(line.curve.place(corners) - corners).max() <= small
    assert flipped(mesh.complex) == 0
    # an edge between two points belongs to one carrier, or it is a segment of a line
    segments = {
        tuple(sorted(s))
        for line in mesh.lines
        for s in zip(line.vertices[:-1].tolist(), line.vertices[1:].tolist(), strict=True)
    }
    edges: Counter[tuple[int, ...]] = Counter()
    for carrier in {p.carrier for p in mesh.patches}:
        found = set()
        for patch in mesh.patches:
            if patch.carrier == carrier:
                t = patch.patch.triangles
                ends = np.stack([t, np.roll(t, -1, axis=1)], axis=-1).reshape(-1, 2)
                found |= {tuple(sorted(e)) for e in ends.tolist()}
        edges.update(found - segments)
    assert max(edges.values(), default=1) == 1


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_is_bounded_by_a_closed_surface(name: str) -> None:
    geometry = Geometry(SOLIDS[name].make())
    assert_sound(geometry, meshed(geometry))


@pytest.mark.parametrize("name", AWKWARD)
def test_an_awkward_solid_is_bounded_by_a_closed_surface(name: str) -> None:
    geometry = Geometry(AWKWARD[name])
    assert_sound(geometry, meshed(geometry))


@pytest.mark.parametrize("name", MODELS)
def test_regions_that_touch_share_their_interfaces(name: str) -> None:
    solids, interfaces = MODELS[name]
    geometry = Geometry(solids)
    mesh = meshed(geometry)
    assert_sound(geometry, mesh)
    kinds = [p.patch.kind for p in mesh.patches]
    assert kinds.count(PatchKind.INTERFACE) == interfaces
    for patch in mesh.patches:
        regions = [side[0] for side in (patch.inner, patch.outer) if side is not None]
        assert (len(regions) == 2) == (patch.patch.kind is PatchKind.INTERFACE)
        assert patch.outward_of(min(regions)) == 1
        assert patch.outward_of(max(regions)) == (1 if len(regions) == 1 else -1)


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_a_corpus_model_is_bounded_by_closed_surfaces(name: str) -> None:
    geometry = Geometry(FILES[name])
    assert_sound(geometry, meshed(geometry))


@pytest.mark.parametrize("name", PLANAR)
def test_planar_solids_are_exact(name: str) -> None:
    geometry = Geometry(SOLIDS[name].make())
    mesh = meshed(geometry)
    assert not mesh.interior.any()
    assert len(mesh.points) == len(geometry.regions[0].vertices)
    found = volume(mesh.points, mesh.triangles_of(0))
    assert found == pytest.approx(SOLIDS[name].volume, rel=1e-12)


@pytest.mark.parametrize("name", [n for n in SOLIDS if n not in PLANAR])
def test_refined_to_a_tolerance_the_volume_is_off_by_no_more_than_that_allows(name: str) -> None:
    """A surface that moves by at most h changes the volume by at most h times its area."""
    geometry = Geometry(SOLIDS[name].make())
    tolerance = RELATIVE * geometry.diagonal
    mesh = boundary_mesh(geometry, tolerance)
    finer = refine(mesh.complex, tolerance)
    parts = [
        patch.triangles[:, :: of.outward_of(0)]
        for patch, of in zip(finer.patches, mesh.patches, strict=True)
    ]
    region = geometry.regions[0]
    off = volume(finer.points, np.concatenate(parts)) - region.volume
    assert abs(off) <= tolerance * region.area


def test_a_block_takes_twelve_triangles() -> None:
    mesh = meshed(Geometry(SOLIDS["block"].make()))
    assert [len(p.patch.triangles) for p in mesh.patches] == [2] * 6


def test_a_cylinder_takes_two_triangles_a_sample() -> None:
    mesh = meshed(Geometry(SOLIDS["cylinder"].make()))
    count = len(mesh.lines[0].vertices) - 1
    sizes = sorted(len(p.patch.triangles) for p in mesh.patches)
    assert sizes == [count - 2, count - 2, 2 * count]
    assert len(mesh.points) == 2 * count


def test_an_apex_is_a_vertex() -> None:
    mesh = meshed(Geometry(SOLIDS["cone"].make()))
    assert norm(mesh.points - [0, 0, 2]).min() == 0


def test_circles_take_the_fewest_samples_that_the_sagitta_allows() -> None:
    pieces = boundary_pieces(Geometry(SOLIDS["cylinder"].make()))
    for tolerance in (0.1, 1e-2, 1e-3, 1e-4):
        t = piece_samples(pieces.pieces[0], tolerance)
        # sagitta r (1 - cos(pi / n)) of a regular polygon
        count = len(t) - 1
        assert 1 - np.cos(pi / count) <= tolerance * 1.001
        assert count <= max(6, 1.06 * pi / np.arccos(1 - tolerance) + 1)
        assert np.diff(t) == pytest.approx(np.full(count, 2 * pi / count))


def test_pieces_of_touching_regions_are_shared() -> None:
    solids, _ = MODELS["crossed bars"]
    geometry = Geometry(solids)
    pieces = boundary_pieces(geometry)
    used = [{p for edge in region for p, _ in edge} for region in pieces.of_edge]
    assert not used[0] & used[1]  # the bars' edges cross, they do not overlap
    assert len(pieces.nodes) == 16 + 4
    assert len(pieces.pieces) == 24 + 2 * 4
    solids, _ = MODELS["two on one"]
    pieces = boundary_pieces(Geometry(solids))
    used = [{p for edge in region for p, _ in edge} for region in pieces.of_edge]
    assert len(used[0] & used[1]) == 3
    assert len(used[1] & used[2]) == 4
    for region in pieces.of_edge:
        for edge in region:
            ends = [pieces.pieces[p].ends for p, _ in edge]
            for before, after in pairwise(ends):
                assert before is not None
                assert after is not None
                assert before[1] == after[0]


def test_more_samples_can_be_asked_for() -> None:
    geometry = Geometry(SOLIDS["cylinder"].make())
    pieces = boundary_pieces(geometry)
    samples = sample_pieces(pieces, 0.1)
    extra = [np.sort(np.append(t, 1.2345)) for t in samples.parameters]
    mesh = boundary_patches(geometry, pieces, numbered(pieces, extra))
    assert_sound(geometry, mesh)
    assert len(mesh.points) == len(samples.points) + 2
    for piece, t, vertices in zip(
        pieces.pieces, mesh.samples.parameters, mesh.samples.vertices, strict=True
    ):
        assert mesh.points[vertices] == pytest.approx(piece.point(t), abs=1e-12)
