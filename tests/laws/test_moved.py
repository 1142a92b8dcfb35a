"""Skeletons, meshes and their files are the same wherever a solid stands, and however it is turned.

Far from the origin, 1,000 and 100,000 diagonals away, everything public tells places there.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.csg.solid import Difference, Intersection, Solid, Union
from decomp.meshes.model import Group, GroupKind, TetMesh
from decomp.meshes.moved import moved_mesh
from decomp.skeletons.files.as_json import contents
from decomp.skeletons.files.elements import elements
from decomp.skeletons.files.sheet_tables import sheet_tables
from decomp.skeletons.model import RegionSkeleton, Skeleton
from decomp.skeletons.sheet_kinds import sheet_kinds
from decomp.vectors import Array
from tests.skeletons.computed import skeleton_of
from tests.solids import SOLIDS

WAY = np.array([0.6, -0.48, 0.64])
SOME = (
    "through hole",
    "blind hole",
    "cross-drilled block",
    "unequal tee",
    "conical pit",
    "oblique cone",
    "countersink",
    "capsule",
    "slot",
    "pocket",
    "round boss",
    "square boss",
    "bite in a corner",
)
QUICK = ("through hole", "conical pit", "slot")


def plate(bore: float) -> Solid:
    """A plate with a bore along it, close to its top."""
    block = decomp.Block((0, 0, 0), (30, 12, 6), name="plate")
    return block - decomp.Cylinder((-1, 6, 3.5), (31, 6, 3.5), bore, name="bore")


def bracket() -> Solid:
    """An angle with a rib and four holes, two of them through the rib's side of it."""
    foot = decomp.Block((0, 0, 0), (40, 24, 5), name="foot")
    back = decomp.Block((0, 0, 0), (5, 24, 30), name="back")
    rib = decomp.Block((5, 10, 5), (15, 4, 15), name="rib")
    slope = decomp.HalfSpace((20, 0, 5), (1, 0, 1), name="slope")
    hole = decomp.Cylinder((30, 5, -1), (30, 5, 6), 2, name="hole").linear_copies((0, 14, 0), 2)
    return (foot | back | (rib & slope)) - hole


def flange() -> Solid:
    """A disc with a hub, a bore and a ring of holes."""
    disc = decomp.Cylinder((0, 0, 0), (0, 0, 3), 20, name="disc")
    hub = decomp.Cylinder((0, 0, 0), (0, 0, 9), 9, name="hub")
    bore = decomp.Cylinder((0, 0, -1), (0, 0, 10), 6, name="bore")
    hole = decomp.Cylinder((15, 0, -1), (15, 0, 4), 1.5, name="hole")
    return (disc | hub) - bore - hole.polar_copies((0, 0, 1), 4)


def rod() -> Solid:
    """A rod through the edge of a block, which stands out below by its radius."""
    block = decomp.Block((0, 0, 0), (5, 3.75, 2.75), name="block")
    return block | decomp.Cylinder((0.125, 1.875, -0.625), (0.125, 1.875, 2.25), 0.625, name="rod")


def ball() -> Solid:
    """A ball through three faces of a block at its corner."""
    block = decomp.Block((0, 0, 0), (5, 4, 3), name="block")
    return block | decomp.Sphere((4.75, 3.6, 2.75), 0.9, name="ball")


OWN: dict[str, Callable[[], Solid]] = {
    "plate with a bore": lambda: plate(1.5),
    "plate with a wide bore": lambda: plate(2.25),
    "angle with a rib": bracket,
    "flange": flange,
    "rod through an edge": rod,
    "ball through a corner": ball,
}


def solid_of(name: str) -> Solid:
    return OWN[name]() if name in OWN else SOLIDS[name].make()


def plain(name: str) -> Skeleton:
    return decomp.skeleton(solid_of(name)) if name in OWN else skeleton_of(name)


def counts(region: RegionSkeleton) -> tuple[int, ...]:
    certificate = region.certificate
    lines = (region.seams, region.trims, region.rims)
    parts = (region.sheets, *lines, region.junctions, region.reflexive, region.cells)
    return (*map(len, parts), certificate.euler, certificate.expected_euler)


def radii(region: RegionSkeleton) -> list[float]:
    return sorted(junction.radius for junction in region.junctions)


def check_same(one: Skeleton, other: Skeleton, scale: float = 1.0) -> None:
    """Sheets, seams, junctions, volumes and the Euler characteristic are the same."""
    for a, b in zip(one.regions, other.regions, strict=True):
        assert counts(b) == counts(a)
        assert b.boundary.volume == pytest.approx(scale**3 * a.boundary.volume, rel=1e-9)
        assert b.boundary.area == pytest.approx(scale**2 * a.boundary.area, rel=1e-9)
        size = scale * one.diagonal
        assert radii(b) == pytest.approx([scale * r for r in radii(a)], abs=1e-9 * size)


def offset(size: float, times: float) -> Array:
    return np.round(times * size * WAY)


@pytest.mark.parametrize(
    ("name", "times"),
    [
        pytest.param(name, times, marks=[] if name in QUICK or times > 1e3 else pytest.mark.slow)
        for name in (*SOME, *OWN)
        for times in (1e3, 1e5)
    ],
)
def test_skeletons_far_away(name: str, times: float) -> None:
    here = plain(name)
    away = offset(here.diagonal, times)
    there = decomp.skeleton(solid_of(name).translate(away))
    check_same(here, there)
    rounding = 2 * np.spacing(np.abs(away).max() + here.diagonal)
    for one, other in zip(here.regions, there.regions, strict=True):
        low_high = one.boundary.bounds + away
        assert np.abs(other.boundary.bounds - low_high).max() <= rounding
        check_places(other, rounding)
    points = there.complex.points
    assert np.abs(points.min(axis=0) - here.complex.points.min(axis=0) - away).max() <= rounding
    for patch in there.complex.patches:
        corners = points[np.unique(patch.triangles)]
        assert np.abs(patch.surface.place(corners) - corners).max() <= 1e3 * rounding
        assert np.isfinite(patch.surface.normal(corners)).all()
    for line in there.complex.lines:
        on = points[line.vertices]
        assert np.abs(line.curve.place(on) - on).max() <= 1e3 * rounding


def check_places(region: RegionSkeleton, rounding: float) -> None:
    """Carriers, curves, samples and vertices of a boundary are where it is."""
    boundary = region.boundary
    for face in boundary.faces:
        assert abs(boundary.carriers[face.carrier].signed_distance(face.point)) <= 4 * rounding
    for edge in boundary.edges:
        for carrier in edge.carriers:
            off = np.abs(boundary.carriers[carrier].signed_distance(edge.samples)).max()
            assert off <= 4 * rounding
        on = edge.curve.point(edge.curve.parameter(edge.samples))
        assert np.abs(on - edge.samples).max() <= 4 * rounding
        centre, radius = edge.curve.bounding_ball()
        assert np.linalg.norm(edge.samples - centre, axis=1).max() <= radius + 4 * rounding
        for end in edge.vertices or ():
            ends = edge.samples[[0, -1]] - boundary.vertices[end].point
            assert np.abs(ends).max(axis=1).min() <= 4 * rounding


def reordered(solid: Solid) -> Solid:
    """The same set of points, with all operands in the opposite order."""
    match solid:
        case Union() | Intersection():
            return replace(solid, parts=tuple(reordered(each) for each in solid.parts[::-1]))
        case Difference(base=base, tool=tool):
            return replace(solid, base=reordered(base), tool=reordered(tool))
    return solid


VARIANTS: dict[str, Callable[[Solid], Solid]] = {
    "small": lambda solid: solid.scale(1e-3),
    "large": lambda solid: solid.scale(1e3),
    "turned": lambda solid: solid.rotate((1, 2, 3), 40),
    "mirrored": lambda solid: solid.mirror((1, 0, 0)),
    "mirrored across": lambda solid: solid.mirror((1, 2, 0)),
    "in another order": reordered,
    "turned far away": lambda solid: solid.translate((1e6, 0, 0)).rotate((1, 2, 3), 40),
}
SCALES = {"small": 1e-3, "large": 1e3}


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[] if n in QUICK else pytest.mark.slow) for n in (*SOME, *OWN)],
)
def test_skeletons_of_similar_solids(name: str, variant: str) -> None:
    check_same(
        plain(name), decomp.skeleton(VARIANTS[variant](solid_of(name))), SCALES.get(variant, 1.0)
    )


def test_what_is_told_of_sheets_far_away() -> None:
    """Places are the model's; equations count from a point that is told."""
    here = plain("conical pit")
    away = np.array([2e6, -1e6, 5e5])
    there = decomp.skeleton(SOLIDS["conical pit"].make().translate(away))
    one, other = contents(here), contents(there)
    assert "equations_from" not in one
    assert other["equations_from"] == there.offset.tolist()
    assert np.abs(there.offset - away).max() < 2 * here.diagonal
    for key in ("junctions", "reflexive"):
        for before, after in zip(one["regions"][0][key], other["regions"][0][key], strict=True):
            if "point" in before:
                assert np.subtract(after["point"], before["point"]) == pytest.approx(away, abs=1e-9)
    for kinds, mesh, start in (
        (sheet_kinds(here, here.regions[0]), here, 0.0),
        (sheet_kinds(there, there.regions[0]), there, there.offset),
    ):
        for sheet, kind in zip(mesh.regions[0].sheets, kinds, strict=True):
            if kind.polynomial is None or kind.also:
                continue
            corners = mesh.complex.points[mesh.complex.patches[sheet.patch].triangles]
            values = kind.polynomial(corners.reshape(-1, 3) - start)
            terms = max(map(abs, kind.polynomial.terms.values()))
            assert np.abs(values / float(terms)).max() < 1e-7
    for before, after in zip(
        one["regions"][0]["sheets"], other["regions"][0]["sheets"], strict=True
    ):
        a, b = before["surface"], after["surface"]
        assert (a["kind"], a["degree"]) == (b["kind"], b["degree"])
        if "parameters" in a:
            assert b["parameters"] == pytest.approx(a["parameters"], abs=1e-9)
        for key in ("origin", "tips"):
            if key in a and a["kind"] not in ("plane",):
                assert np.shape(a[key]) == np.shape(b[key])
    parts = elements(there)
    assert parts.points.min(axis=0) == pytest.approx(
        elements(here).points.min(axis=0) + away, abs=1e-9
    )
    tables = sheet_tables(parts.sheet_kinds, parts.sheet_names)
    assert tables["equation_origin"].values.tolist() == [there.offset.tolist()]


def test_mid_surfaces_far_away() -> None:
    away = np.array([-3e6, 1e6, 2e6])
    near = decomp.mid_surface(plain("plate with a bore"), 120)
    far = decomp.mid_surface(decomp.skeleton(plate(1.5).translate(away)), 120)
    assert len(far.triangles) == len(near.triangles)
    assert far.area == pytest.approx(near.area, rel=1e-8)
    assert far.points.min(axis=0) == pytest.approx(near.points.min(axis=0) + away, abs=1e-9)
    assert sorted(far.thickness) == pytest.approx(sorted(near.thickness), abs=1e-9)


@pytest.mark.slow
def test_a_mesh_far_away(tmp_path: Path) -> None:
    """Nodes are where the model is, on its surfaces, and the file holds them."""
    away = np.array([-3e6, 1e6, 2e6])
    geometry = decomp.Geometry(plate(1.5).translate(away))
    mesh = decomp.mesh(geometry, size=3, fields=["distance"])
    assert mesh.points.min(axis=0) == pytest.approx(away, abs=1e-9)
    assert mesh.points.max(axis=0) == pytest.approx(np.add(away, (30, 12, 6)), abs=1e-9)
    assert mesh.point_data["distance"] == pytest.approx(-geometry.distance(mesh.points), abs=1e-8)
    file = tmp_path / "far.msh"
    mesh.write(file)
    found = check(geometry, file, unprojected=len(mesh.unprojected))
    assert found.shortcomings == ()
    moved = replace(mesh, points=np.add(mesh.points, (0.5, 0, 0)))
    wrong = check(geometry, moved).shortcomings
    assert any("off their exact surfaces" in line and "(-29999" in line for line in wrong)


def test_a_mesh_that_coordinates_cannot_hold() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1e-4]])
    tags = np.ones(1, dtype=np.int64)
    group = Group(GroupKind.REGION, 1, "flat", ("flat",))
    none = np.empty((0, 3), dtype=np.int64)
    mesh = TetMesh("flat", points, np.arange(4)[None], tags, none, tags[:0], (group,), tags[:0])
    assert moved_mesh(mesh, np.zeros(3)) is mesh
    near = moved_mesh(mesh, np.array([0, 0, 1e9]))
    assert near.points[3].tolist() == [0.2, 0.2, 1e9 + 1e-4]
    with pytest.raises(decomp.DecompError, match=r"turned over by rounding; move the model nearer"):
        moved_mesh(mesh, np.array([0, 0, 1e13]))


def test_files_with_large_numbers(tmp_path: Path) -> None:
    """A file that draws at 1,000,000 what another draws at 0: the same skeleton."""
    text = """algebraic3d
solid plate = orthobrick ({0}.1, 0, 0; {1}.1, 3, 1);
solid hole = cylinder ({2}.6, 1.5, -1; {2}.6, 1.5, 2; 0.5);
solid cut = cone ({2}.6, 1.5, 0.5; 0.4; {2}.6, 1.5, 1; 0.9);
solid part = plate and not hole and not cut;
tlo part;
"""
    found = []
    for start in (0, 1_000_000):
        file = tmp_path / f"at{start}.geo"
        file.write_text(text.format(start, start + 4, start + 1))
        found.append(decomp.skeleton(str(file)))
    check_same(*found)
    low = found[1].regions[0].boundary.bounds[0]
    assert low.tolist() == [1000000.1, 0, 0]
    assert json.dumps(contents(found[1]))
