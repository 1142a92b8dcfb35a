"""The complex of a mesh without cells: the boundaries of all regions alone.

Each region is one cell, named like the region. Nothing is traced, so that all models whose boundary
is known have one.
"""

from __future__ import annotations

from decomp.complex.boundary.boundary import BoundaryMesh, boundary_mesh
from decomp.geometry import Geometry
from decomp.meshing.surface.far_spheres import refined_apart
from decomp.meshing.surface.surface import MeshSurface, RegionSurface, checked, coarsest
from decomp.skeletons.drafts import SHARE
from decomp.skeletons.model import Cell
from decomp.vectors import Array


def boundary_surface(geometry: Geometry, sizes: Array, tolerance: float) -> MeshSurface:
    """The boundaries, as coarse as they may be.

    Args:
        geometry: of the model.
        sizes: (r,) the largest edge wanted in each region.
        tolerance: chord tolerance, in model units; a finer one is taken if that fails. Whole
            spheres far from all else may be coarser (`far_spheres`).

    Raises:
        GeometryError: faces cannot be triangulated; says where.
    """
    return coarsest(lambda fine: _made(geometry, sizes, fine), tolerance)


def _made(geometry: Geometry, sizes: Array, tolerance: float) -> MeshSurface:
    drawn = boundary_mesh(geometry, SHARE * tolerance)
    mesh = refined_apart(drawn, tolerance, sizes)
    regions = tuple(_region(geometry, drawn, number) for number in range(len(geometry.regions)))
    return checked(MeshSurface(geometry.sites, mesh, tolerance, regions, has_skeleton=False))


def _region(geometry: Geometry, drawn: BoundaryMesh, number: int) -> RegionSurface:
    boundary = geometry.regions[number]
    faces = drawn.face_sides(number, len(boundary.faces))
    sides = tuple(side for own in faces for side in own)
    names = tuple(face.name for face in boundary.faces)
    whole = Cell(boundary.name, names, sides, float("nan"))
    return RegionSurface(boundary.name, boundary, faces, {}, (whole,))
