"""Refined complexes conform, are unfolded, exact to tolerance, and lean."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from decomp import Geometry
from decomp.carriers import Plane
from decomp.complex.boundary.boundary import boundary_mesh
from decomp.complex.model import Complex
from decomp.complex.refining.changing_mesh import Mesh
from decomp.complex.refining.errors_of import chord_error, flipped
from decomp.complex.refining.refine import GROWING, _check_growth, refine, refined
from decomp.errors import GeometryError
from tests.complex import shapes
from tests.solids import SOLIDS

SHAPES: dict[str, tuple[Callable[[], Complex], int]] = {
    "block": (shapes.block, 12),
    "cylinder": (shapes.cylinder, 220),
    "cone": (shapes.cone, 120),
    "half-discs": (shapes.half_discs, 100),
    "sphere": (shapes.sphere, 5200),
    "torus": (shapes.torus, 5800),
    "saddle": (shapes.saddle, 900),
    "twisted": (lambda: shapes.saddle(-2.0), 1700),
    "lens": (shapes.lens, 3000),
}
"""Shapes and how many triangles they may need."""


def tolerance_of(given: Complex) -> float:
    return 5e-4 * float(np.linalg.norm(np.ptp(given.points, axis=0)))


def sides(triangles: np.ndarray) -> Counter[tuple[int, int]]:
    """How often each directed side occurs."""
    return Counter((int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3))


def check_conforming(given: Complex) -> None:
    """Patches are oriented surfaces bounded by lines, and no two triangles are one."""
    segments = {
        frozenset((int(a), int(b)))
        for line in given.lines
        for a, b in zip(line.vertices[:-1], line.vertices[1:], strict=True)
    }
    inner: Counter[frozenset[int]] = Counter()
    everything = np.sort(np.concatenate([p.triangles for p in given.patches]), axis=1)
    assert len(np.unique(everything, axis=0)) == len(everything)
    for patch in given.patches:
        directed = sides(patch.triangles)
        assert max(directed.values()) == 1
        for a, b in directed:
            if (b, a) not in directed:
                assert frozenset((a, b)) in segments
            elif frozenset((a, b)) not in segments:
                inner[frozenset((a, b))] += 1
    assert set(inner.values()) <= {2}, "two patches share a chord inside both"
    assert not segments & set(inner)
    used = np.unique(np.concatenate([everything.ravel(), *(line.vertices for line in given.lines)]))
    assert len(used) == len(given.points)
    assert len(np.unique(given.points.round(12), axis=0)) == len(given.points)


@pytest.mark.parametrize("name", SHAPES)
def test_refined_shapes_are_valid_exact_and_lean(name: str) -> None:
    make, most = SHAPES[name]
    given = make()
    tolerance = tolerance_of(given)
    result = refine(given, tolerance)
    check_conforming(result)
    assert flipped(result) == 0
    assert chord_error(result, samples=9) <= tolerance
    assert sum(len(p.triangles) for p in result.patches) <= most
    for old, new in zip(given.patches, result.patches, strict=True):
        assert new.surface is old.surface
    assert euler(result) == (3 if name == "lens" else euler(given))


def euler(given: Complex) -> int:
    triangles = np.concatenate([p.triangles for p in given.patches])
    edges = {frozenset(side) for side in sides(triangles)}
    return len(np.unique(triangles)) - len(edges) + len(triangles)


@pytest.mark.parametrize("name", ["cross-drilled block", "pipe elbow", "bite in a corner"])
def test_boundaries_of_solids_are_refined(name: str) -> None:
    geometry = Geometry(SOLIDS[name].make())
    tolerance = 5e-4 * geometry.diagonal
    given = boundary_mesh(geometry, tolerance).complex
    result = refine(given, tolerance)
    check_conforming(result)
    assert flipped(result) == 0
    assert chord_error(result, samples=9) <= tolerance
    assert euler(result) == euler(given) == 2 * SOLIDS[name].euler


def test_lines_that_are_fine_are_left_alone() -> None:
    geometry = Geometry(SOLIDS["cylinder"].make())
    tolerance = 5e-4 * geometry.diagonal
    given = boundary_mesh(geometry, tolerance).complex
    assert len(refine(given, tolerance).points) == len(given.points)


def test_vertices_lie_on_their_elements() -> None:
    given = shapes.cylinder(3)
    result = refine(given, tolerance_of(given))
    for patch in result.patches:
        at = result.points[np.unique(patch.triangles)]
        assert np.abs(patch.surface.place(at) - at).max() < 1e-14
    for line in result.lines:
        at = result.points[line.vertices]
        assert np.abs(line.curve.place(at) - at).max() < 1e-14
        assert line.vertices[0] == line.vertices[-1]


@pytest.mark.parametrize("name", ["cylinder", "cone", "half-discs", "block"])
def test_developable_patches_need_no_vertex_inside(name: str) -> None:
    given = SHAPES[name][0]()
    result = refine(given, tolerance_of(given))
    on_lines = set(np.concatenate([line.vertices for line in result.lines]).tolist())
    inside = set(np.concatenate([p.triangles for p in result.patches]).ravel().tolist()) - on_lines
    assert len(inside) == (1 if name == "cone" else 0)


def test_circles_are_divided_evenly() -> None:
    given = shapes.cylinder(3)
    result = refine(given, tolerance_of(given))
    for line in result.lines:
        at = result.points[line.vertices]
        length = np.linalg.norm(np.diff(at, axis=0), axis=1)
        assert length.max() < 1.6 * length.min()


def test_a_fine_torus_becomes_lean() -> None:
    given = shapes.torus(60, 40)
    result = refine(given, 0.02)
    check_conforming(result)
    assert flipped(result) == 0
    assert chord_error(result, samples=9) <= 0.02
    assert len(result.patches[0].triangles) < 1500


def test_vertices_inside_a_plane_patch_go() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.3, 0.6, 0], [0.5, 0.5, 0]])
    fan = [[0, 1, 5], [1, 2, 5], [2, 3, 5], [3, 4, 5], [0, 5, 4], [0, 4, 3]]
    patch = shapes.face(Plane(shapes.O3, shapes.Z), fan)
    lines = [
        shapes.edge(shapes.Straight(square[i], square[(i + 1) % 4]), [i, (i + 1) % 4])
        for i in range(4)
    ]
    given = Complex(square, (patch,), tuple(lines))
    result, number = refined(given, 0.01)
    assert len(result.patches[0].triangles) == 2
    assert number.tolist() == [0, 1, 2, 3, -1, -1]


def test_points_alone_and_lines_alone_stay() -> None:
    given = shapes.sphere()
    axis = shapes.edge(shapes.Straight(-shapes.Z, shapes.Z), [6, 4])
    ring = shapes.edge(shapes.Round(shapes.O3, shapes.X, 0.5), [7, 8, 9, 7])
    t = np.array([0, 2, 4]) * np.pi / 3
    loop = 0.5 * np.stack([0 * t, np.cos(t), np.sin(t)], axis=1)
    points = np.concatenate([given.points, [shapes.O3], loop, [[7.0, 7.0, 7.0]]])
    result, number = refined(Complex(points, given.patches, (axis, ring)), 0.01)
    assert (result.points[number] == points).all()
    assert result.lines[0].vertices.tolist() == [number[6], number[4]]
    assert len(result.lines[1].vertices) > 10


def test_flips_find_the_rulings_of_a_cylinder() -> None:
    given = shapes.cylinder(12)
    side = given.patches[2]
    # the wrong diagonal: from each bottom vertex to the top vertex three steps on
    k = 12
    turned = np.array(
        [
            [[i, (i + 1) % k, k + (i + 3) % k], [i, k + (i + 3) % k, k + (i + 2) % k]]
            for i in range(k)
        ]
    ).reshape(-1, 3)
    wrong = replace(given, patches=(*given.patches[:2], replace(side, triangles=turned)))
    result = refine(wrong, 0.05)
    check_conforming(result)
    assert chord_error(result) <= 0.05
    assert len(result.patches[2].triangles) == 24


def test_refining_again_changes_nothing() -> None:
    given = shapes.torus()
    once = refine(given, 0.02)
    twice = refine(once, 0.02)
    assert len(twice.points) <= len(once.points)
    assert len(twice.points) > 0.95 * len(once.points)


def test_progress_is_told() -> None:
    told: list[int] = []
    refine(shapes.sphere(), 0.02, told.append)
    assert told[0] == 8
    assert max(told) > 100


def test_an_equal_vertex_is_an_error() -> None:
    given = shapes.sphere()
    patch = replace(given.patches[0], triangles=np.array([[0, 1, 1]]))
    with pytest.raises(GeometryError, match="same vertex twice at"):
        refine(replace(given, patches=(patch,)), 0.01)


def test_a_turned_patch_is_an_error() -> None:
    given = shapes.block()
    patch = replace(given.patches[0], triangles=given.patches[0].triangles[:, ::-1].copy())
    with pytest.raises(GeometryError, match=r"folded on the face surface at \(0, "):
        refine(replace(given, patches=(patch, *given.patches[1:])), 0.01)


def test_a_line_with_two_vertices_around_is_an_error() -> None:
    given = shapes.half_discs(2)
    line = shapes.edge(shapes.Round(shapes.O3, shapes.Y, 1.0), [0, 1, 0])
    with pytest.raises(GeometryError, match="passes twice through a segment"):
        refine(replace(given, lines=(*given.lines, line)), 0.01)


def test_two_curves_over_one_segment_are_an_error() -> None:
    given = shapes.half_discs(2)
    line = shapes.edge(shapes.Round(0.3 * shapes.Z, shapes.Y, 1.3), [0, 2])
    with pytest.raises(GeometryError, match="share a segment"):
        refine(replace(given, lines=(*given.lines, line)), 0.01)


def test_a_fold_is_an_error() -> None:
    """A vertex inside a square patch that lies outside the square."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1.5, 0.5, 0]], dtype=float)
    fan = [[i, (i + 1) % 4, 4] for i in range(4)]
    lines = [
        shapes.edge(shapes.Straight(square[i], square[(i + 1) % 4]), [i, (i + 1) % 4])
        for i in range(4)
    ]
    given = Complex(square, (shapes.face(Plane(shapes.O3, shapes.Z), fan),), tuple(lines))
    with pytest.raises(GeometryError, match="stays folded on the face surface at"):
        refine(given, 0.01)


def test_a_fold_over_many_triangles_is_flipped_away() -> None:
    """A triangle lies on its back, and every single flip leaves one that does; the last does not.

    The border's dent, vertex 1, is beyond the lines from vertex 2 to all vertices on the long side
    but the first ones.
    """
    side = [(x, 0.0) for x in np.linspace(0.2, 2.0, 19)]
    points = np.array([(0.0, 0.0), (1.4, 0.35), (0.6, 1.0), *side])
    points = np.column_stack([points, np.zeros(len(points))])
    first, last = 3, len(points) - 1
    # a fan of vertex 2, whose last triangle is folded over the dent
    fan = [[k, k + 1, 2] for k in range(first, last)]
    triangles = [[0, first, 2], *fan, [last, 1, 2]]
    loop = [0, *range(first, last + 1), 1, 2, 0]
    lines = tuple(
        shapes.edge(shapes.Straight(points[a], points[b]), [a, b]) for a, b in pairwise(loop)
    )
    given = Complex(points, (shapes.face(Plane(shapes.O3, shapes.Z), triangles),), lines)
    assert flipped(given) == 1
    found = refine(given, 0.01)
    assert flipped(found) == 0
    assert len(found.points) == len(points)
    check_conforming(found)


class Nowhere(shapes.Round):
    """A curve that leaves points where they are, beside it."""

    def place(self, points: np.ndarray) -> np.ndarray:
        return points + 0.1


@pytest.mark.parametrize(("shrinking", "raises"), [(1.0, True), (0.999, False)])
def test_folds_that_only_grow_are_an_error(shrinking: float, raises: bool) -> None:
    """Batch by batch one more triangle lies on its back; the largest error stays, or gets less."""
    mesh = Mesh(shapes.torus(), np.full(len(shapes.torus().patches), 1e-2))
    mesh.measure()
    mesh.upright[:] = 1.0
    history: list[tuple[int, float]] = []
    for batch in range(GROWING):
        mesh.upright[batch] = -0.5
        mesh.error *= shrinking
        _check_growth(mesh, history)
    mesh.upright[GROWING] = -0.5
    mesh.error *= shrinking
    if raises:
        with pytest.raises(GeometryError, match="triangles fold over without end on the"):
            _check_growth(mesh, history)
    else:
        _check_growth(mesh, history)
    mesh.upright[:] = 1.0
    _check_growth(mesh, history)


def test_an_element_that_does_not_place_is_an_error() -> None:
    given = shapes.half_discs(1)
    wrong = replace(given.lines[1], curve=Nowhere(shapes.O3, shapes.Y, 1.0))
    with pytest.raises(GeometryError, match="edge curve"):
        refine(replace(given, lines=(given.lines[0], wrong)), 0.01)
