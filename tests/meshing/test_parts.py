"""The steps after TetWild, each by itself on a mesh of a few tetrahedra."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import decomp
from decomp.carriers import Plane
from decomp.complex.elements import CarrierSurface
from decomp.complex.many_elements import Elements
from decomp.complex.model import Complex, Patch, PatchKind
from decomp.meshes.faces import EDGES, edges_of, faces_of, least_dihedral, volumes
from decomp.meshing.exact.project import Projector
from decomp.meshing.exact.targets import SURFACE, Targets, polyline_distance
from decomp.meshing.repairs.collapsing import collapsed
from decomp.meshing.repairs.lifting import lifted
from decomp.meshing.repairs.separating import separated
from decomp.meshing.repairs.smoothing import smoothed
from decomp.meshing.repairs.splitting import freed, held
from decomp.meshing.surface.content import contents
from decomp.meshing.surface.surface import SurfaceMaker
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.region_curves import region_curves
from decomp.vectors import Array, Ints, direction, vector
from tests.solids import SOLIDS


def grid(n: int) -> tuple[Array, Ints]:
    """A unit cube of n^3 boxes, each in six positive tetrahedra around a diagonal."""
    line = np.linspace(0, 1, n + 1)
    points = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    base, step = number[:-1, :-1, :-1].reshape(-1, 1), np.array([(n + 1) ** 2, n + 1, 1])
    orders = itertools.permutations(step.tolist())
    tets = np.concatenate([base + np.cumsum([0, *order]) for order in orders])
    turned = volumes(points, tets) < 0
    tets[turned] = tets[turned][:, [0, 1, 3, 2]]
    return points, tets


def test_faces_of_a_cube() -> None:
    points, tets = grid(2)
    faces = faces_of(tets)
    hull = faces.triangles[faces.tets[:, 1] < 0]
    assert len(hull) == 6 * 4 * 2
    a, b, c = np.moveaxis(points[hull] - 0.5, 1, 0)
    assert (np.einsum("ij,ij->i", a, np.cross(b, c)) > 0).all()
    with pytest.raises(ValueError, match="three"):
        faces_of(np.concatenate([tets, tets[:1], tets[:1]]))


def test_dihedral_angles() -> None:
    regular = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    both = np.array([[0, 1, 2, 3], [0, 1, 3, 2]])
    angle = np.degrees(np.arccos(1 / 3))
    sign = np.sign(volumes(regular, both))
    assert sorted(sign.tolist()) == [-1, 1]
    assert least_dihedral(regular, both) == pytest.approx(sign * angle)


@pytest.mark.parametrize("n", [1, 2])
def test_elements_held_by_the_boundary_are_split(n: int) -> None:
    points, tets = grid(n)
    label = np.arange(len(tets)) % 2
    region = np.zeros(2, dtype=np.int64)
    assert len(held(tets, region[label])[0])
    content = [volumes(points, tets)[label == k].sum() for k in (0, 1)]
    points, tets, label = freed(points, tets, label, region)
    assert len(held(tets, region[label])[0]) == 0
    assert (volumes(points, tets) > 0).all()
    after = [volumes(points, tets)[label == k].sum() for k in (0, 1)]
    assert after == pytest.approx(content)
    faces = faces_of(tets)
    assert (faces.tets[:, 1] < 0).sum() == 12 * n**2


def unlimited(tets: Ints) -> Array:
    return np.full(len(edges_of(tets, EDGES)[0]), np.inf)


def on_plane(height: float) -> Elements:
    plane = CarrierSurface(
        Plane(vector((0, 0, height), "point"), direction((0, 0, 1), "normal")), 1
    )
    corners = np.array([[0.0, 0, height], [1, 0, height], [0, 1, height]])
    patch = Patch(PatchKind.FACE, plane, np.array([[0, 1, 2]]))
    return Elements(Complex(corners, (patch,), ()))


def targets_of(nodes: Ints) -> Targets:
    zero = np.zeros(len(nodes), dtype=np.int64)
    every = np.ones(len(nodes), dtype=np.bool_)
    return Targets(nodes, np.full(len(nodes), SURFACE), zero, zero, every)


def test_nodes_are_moved_together() -> None:
    points, tets = grid(4)
    top = np.flatnonzero(points[:, 2] == 1)
    points[top, 2] += 0.02 * np.random.default_rng(0).normal(size=len(top))
    moved = Projector(points, tets, targets_of(top), on_plane(1.0), np.empty((0, 3)))
    assert len(moved.settle()) == 0
    moved.smooth(unlimited(tets))
    assert (moved.points[top, 2] == 1).all()
    assert (volumes(moved.points, tets) > 0).all()


def test_a_node_that_would_invert_stays_and_is_counted() -> None:
    points, tets = grid(3)
    lone = np.flatnonzero((points == np.array([0, 0, 1])).all(axis=1))
    plane = on_plane(-0.5)
    moved = Projector(points, tets, targets_of(lone), plane, np.empty((0, 3)))
    assert moved.settle().tolist() == lone.tolist()
    moved.smooth(unlimited(tets))
    assert (volumes(moved.points, tets) > 0).all()
    assert (moved.points[lone] == points[lone]).all()


def test_a_node_without_room_is_merged_with_one_that_belongs_there_too() -> None:
    points, tets = grid(4)
    part = np.arange(len(tets))
    edge = np.flatnonzero((points[:, 1:] == 0).all(axis=1))
    near = int(np.flatnonzero((points == np.array([0.5, 0, 0.25])).all(axis=1))[0])
    points[near, 2] = 0.02
    kinds = {int(node): frozenset({1, 2}) for node in edge}
    merged = collapsed(points, tets, part, np.array([near]), kinds | {near: frozenset({1, 2})})
    assert merged is not None
    left, labels = merged
    assert np.setdiff1d(np.arange(len(points)), left).tolist() == [near]
    assert (volumes(points, left) > 0).all()
    assert volumes(points, left).sum() == pytest.approx(1, rel=1e-12)
    assert len(labels) == len(left) < len(tets)
    faces_of(left)


@pytest.mark.parametrize("most", [1 << 21, 8])
def test_triangles_are_paired_whatever_the_number_of_vertices(
    most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, tets = grid(3)
    monkeypatch.setattr("decomp.meshes.faces.MOST_VERTICES", most)
    faces = faces_of(tets)
    inner = faces.tets[:, 1] >= 0
    assert (inner.sum(), (~inner).sum()) == (2 * len(tets) - 54, 108)
    for triangle, pair in zip(faces.triangles[inner], faces.tets[inner], strict=True):
        assert np.isin(triangle, tets[pair[0]]).all()
        assert np.isin(triangle, tets[pair[1]]).all()


def test_a_node_is_not_merged_with_one_that_belongs_elsewhere() -> None:
    points, tets = grid(4)
    near = int(np.flatnonzero((points == np.array([0.5, 0, 0.25])).all(axis=1))[0])
    kinds = {near: frozenset({1, 2})} | {k: frozenset({1}) for k in range(len(points)) if k != near}
    assert collapsed(points, tets, np.arange(len(tets)), np.array([near]), kinds) is None


def test_a_sheet_is_lifted_off_a_face() -> None:
    points, tets = grid(4)
    part = np.ones(len(tets), dtype=np.int64)
    node = np.flatnonzero((points == np.array([0.5, 0.5, 0])).all(axis=1))

    def parts_at(places: Array) -> Ints:
        return np.where(places[:, 2] > 0.1, 1, 0)

    owner = np.zeros(1, dtype=np.int64)
    found = separated(points, tets, part, node, owner, parts_at)
    assert found is not None
    more, cut, labels = found
    assert volumes(more, cut).sum() == pytest.approx(1, rel=1e-12)
    assert (volumes(more, cut) > 0).all()
    faces_of(cut)
    at = (cut == node[0]).any(axis=1)
    assert (labels[at] == 0).all() and (labels[~at] == 1).all()
    assert more[np.unique(cut[at])].max(axis=0)[2] == pytest.approx(0.25 * 0.40625)
    assert separated(more, cut, labels, node, owner, parts_at) is None


def test_smoothing_makes_angles_better_and_keeps_what_is_held() -> None:
    points, tets = grid(4)
    inside = ((points > 0) & (points < 1)).all(axis=1)
    top = (points[:, 2] == 1) & ((points[:, :2] > 0) & (points[:, :2] < 1)).all(axis=1)
    random = np.random.default_rng(0)
    points[inside] += 0.06 * random.uniform(-1, 1, size=(int(inside.sum()), 3))
    assert (volumes(points, tets) > 0).all()

    def onto_top(nodes: Ints, wanted: Array) -> tuple[Array, np.ndarray]:
        assert top[nodes].all()
        return wanted * [1, 1, 0] + [0, 0, 1], np.ones(len(nodes), dtype=np.bool_)

    better = smoothed(points, tets, inside, top, onto_top, unlimited(tets))
    before, after = least_dihedral(points, tets), least_dihedral(better, tets)
    assert after.mean() > before.mean() + 1
    assert after.min() >= min(before.min(), 20)
    assert (better[top, 2] == 1).all()
    still = ~(inside | top)
    assert (better[still] == points[still]).all()


def test_smoothing_draws_no_edge_out() -> None:
    points, tets = grid(4)
    inside = np.asarray(((points > 0) & (points < 1)).all(axis=1))
    random = np.random.default_rng(0)
    points[inside] += 0.06 * random.uniform(-1, 1, size=(int(inside.sum()), 3))
    ends, _ = edges_of(tets, EDGES)

    def length(at: Array) -> Array:
        return np.asarray(np.linalg.norm(at[ends[:, 0]] - at[ends[:, 1]], axis=1))

    def nowhere(nodes: Ints, wanted: Array) -> tuple[Array, np.ndarray]:
        return wanted, np.ones(len(nodes), dtype=np.bool_)

    most = 1.05 * length(points).max() * np.ones(len(ends))
    most[: len(ends) // 2] = 0.0
    none = np.zeros(len(points), dtype=np.bool_)
    better = smoothed(points, tets, inside, none, nowhere, most)
    grown = length(better) > length(points) + 1e-12
    assert grown.any()
    assert (length(better)[grown] <= most[grown]).all()


def test_distance_from_a_polyline() -> None:
    line = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    places = np.array([[0.5, -0.2, 0], [2, 2, 0], [1, 0.5, 3]])
    assert polyline_distance(line, places) == pytest.approx([0.2, np.sqrt(2), 3])


@pytest.mark.parametrize("name", ["sphere", "cylinder", "conical pit", "blind hole"])
def test_bent_triangles_hold_what_the_region_does(name: str) -> None:
    geometry = decomp.Geometry(SOLIDS[name].make())
    made = SurfaceMaker(geometry, lambda *_: None).made(2e-3 * geometry.diagonal, False)
    region = made.regions[0]
    total = sum(cell.volume for cell in region.cells)
    assert total == pytest.approx(region.boundary.volume, rel=2e-4)
    whole = [side for sides in region.face_sides for side in sides]
    assert contents(made.complex, [whole])[0] == pytest.approx(region.boundary.volume, rel=2e-4)


def test_every_pair_of_a_bracket_s_cells_is_parted_once() -> None:
    from decomp.meshing.surface.cells import cell_map
    from decomp.meshing.surface.layout import layout

    geometry = decomp.Geometry(SOLIDS["bracket"].make())
    made = SurfaceMaker(geometry, lambda *_: None).made(2e-3 * geometry.diagonal, False)
    cells = cell_map(made)
    plan = layout(made, cells)
    listed = list(itertools.chain(*plan.between.values()))
    assert len(set(listed)) == len(listed)
    kinds = [made.complex.patches[k].kind for k in listed]
    assert set(kinds) == {PatchKind.SHEET}
    assert all(around for around in plan.around_corner)


def test_a_squashed_element_is_mended_and_the_boundary_stays() -> None:
    points, tets = grid(4)
    inside = ((points > 0) & (points < 1)).all(axis=1)
    node = int(np.flatnonzero(inside)[13])
    points[node] += [0.97 / 4, 0, 0]
    assert least_dihedral(points, tets).min() < 3
    mended = lifted(points, tets, inside)
    assert least_dihedral(mended, tets).min() > 12
    moved = np.flatnonzero((mended != points).any(axis=1))
    assert node in moved
    assert inside[moved].all()


def test_trim_surfaces_of_face_cells_are_exact() -> None:
    """Those over a saddle edge are cut along normals, which end in vertices of the edge."""
    geometry = decomp.Geometry(SOLIDS["unequal tee"].make())
    made = SurfaceMaker(geometry, lambda *_: None).made(0.005 * geometry.diagonal, True)
    feet = region_curves(RegionContext(geometry.index, 0), 2000).turning_feet()
    assert len(feet) >= 4
    points = made.complex.points
    for foot in feet:
        assert np.linalg.norm(points - foot, axis=1).min() <= 1e-9 * geometry.diagonal
    elements = Elements(made.complex)
    trims = [k for k, p in enumerate(made.complex.patches) if p.kind is PatchKind.TRIM]
    assert len(trims) == 2  # over the two halves of the edge between its turning points
    for k in trims:
        vertices = np.unique(made.complex.patches[k].triangles)
        numbers = np.full(len(vertices), elements.of_patch[k])
        gap = elements.gap(numbers, points[vertices])
        assert gap.max() <= 1e-9 * geometry.diagonal
