"""Whole spheres far from all else are coarser than what is small, and no others are."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.carriers import Sphere
from decomp.checking.check import check
from decomp.complex.elements import CarrierSurface
from decomp.csg.solid import Solid
from decomp.meshing.sizing.sizes import Wanted, region_sizes
from decomp.meshing.surface.boundary_surface import boundary_surface
from decomp.meshing.surface.surface import MeshSurface
from decomp.skeletons.cells.surface import is_closed

FINE = 2e-3


def surface_of(
    solids: Solid | dict[str, Solid], size: float | None = None
) -> tuple[decomp.Geometry, MeshSurface]:
    geometry = decomp.Geometry(solids)
    return geometry, boundary_surface(geometry, region_sizes(geometry, Wanted(size)), FINE)


def off(surface: MeshSurface, radius: float) -> float:
    """How far middles of triangles on the sphere of a radius about the origin are inside it."""
    mesh, found = surface.complex, []
    for patch in mesh.patches:
        assert isinstance(patch.surface, CarrierSurface)
        carrier = patch.surface.carrier
        if isinstance(carrier, Sphere) and carrier.radius == radius:
            middles = mesh.points[patch.triangles].mean(axis=1)
            found.append(radius - float(np.linalg.norm(middles, axis=1).min()))
    return max(found)


def test_the_end_of_the_air_is_coarse() -> None:
    part = decomp.Sphere((0.1, 0, 0), 0.5, name="part") - decomp.Block((0, -1, -1), (2, 2, 2))
    air = decomp.Sphere((0, 0, 0), 20, name="air")
    _, surface = surface_of({"part": part, "air": air - part})
    assert 5 * FINE < off(surface, 20) < 0.02 * 19.5
    for region in surface.regions:
        for cell in region.cells:
            assert is_closed(surface.complex, cell.sides)
            assert cell.volume == pytest.approx(region.boundary.volume, rel=2e-3)


@pytest.mark.parametrize(
    ("solid", "size"),
    [
        (decomp.Sphere((0, 0, 0), 20) - decomp.Sphere((0, 0, 0), 19.95), None),
        (decomp.Sphere((0, 0, 0), 20) - decomp.Block((-30, -30, 15), (60, 60, 60)), None),
        (decomp.Sphere((0, 0, 0), 20) | decomp.Block((-9, -9, 20.05), (18, 18, 1)), None),
        (decomp.Sphere((0, 0, 0), 20), 0.5),
    ],
)
def test_others_are_not(solid: Solid, size: float | None) -> None:
    """Walls, cut spheres, narrow gaps, and short edges."""
    _, surface = surface_of(solid, size)
    assert off(surface, 20) <= FINE


def test_a_mesh_is_sound() -> None:
    part = decomp.Block((-0.5, -0.5, -0.5), (1, 1, 1), name="part")
    air = decomp.Sphere((0, 0, 0), 10, name="air")
    geometry = decomp.Geometry({"part": part, "air": air - part})
    mesh = decomp.mesh(geometry, cells="none", size=2.5)
    found = check(geometry, mesh, volume_error=0.03)
    assert found.shortcomings == ()
