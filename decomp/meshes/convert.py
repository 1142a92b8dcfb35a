"""Meshes as the objects of other libraries, which are loaded when they are first asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from decomp.meshes.incidence import incidence
from decomp.meshes.lower import lower_blocks
from decomp.meshes.ordering import in_vtk_order
from decomp.meshes.parts import looked_up
from decomp.optional import needed

if TYPE_CHECKING:
    from decomp.meshes.model import TetMesh

MESHIO = {1: "vertex", 3: "line", 21: "line3", 5: "triangle", 22: "triangle6"}
"""meshio's names of types of elements by VTK's numbers."""
TETS = {4: "tetra", 10: "tetra10"}
VTK_TYPES = {4: 10, 10: 24}
"""VTK's types of tetrahedra by number of nodes."""


def to_meshio(mesh: TetMesh) -> Any:
    """A `meshio.Mesh`, laid out as meshio reads it from a .msh file.

    Cell data `gmsh:physical` and `gmsh:geometrical`; field data name: (tag, dimension); cell sets
    by name. Where a volume and a surface share a name, the set holds both, in blocks of their own,
    and the field data the surface's tag.

    Raises:
        MissingPackageError: meshio is not installed.
    """
    meshio = needed("meshio", "meshio", "mesh.to_meshio()")
    lower = lower_blocks(mesh)
    tags = [*(block.tags for block in lower), mesh.tet_tags]
    dimensions = [*(block.dimension for block in lower), 3]
    sets: dict[str, list[Any]] = {}
    for group in mesh.groups:
        rows = sets.setdefault(group.name, [np.empty(0, dtype=np.int64) for _ in tags])
        block = dimensions.index(group.dimension)
        rows[block] = np.flatnonzero(tags[block] == group.tag)
    ordered = sorted(mesh.groups, key=lambda group: -group.dimension)
    return meshio.Mesh(
        mesh.points,
        [
            *((MESHIO[block.vtk], block.elements) for block in lower),
            (TETS[mesh.tets.shape[1]], in_vtk_order(mesh.tets)),
        ],
        point_data=dict(mesh.point_data),
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags}
        | {
            name: [*(np.full(len(block.tags), -1) for block in lower), values]
            for name, values in mesh.cell_data.items()
        },
        field_data={group.name: np.array([group.tag, group.dimension]) for group in ordered},
        cell_sets=sets,
    )


def to_pyvista(mesh: TetMesh) -> Any:
    """A `pyvista.UnstructuredGrid` of the tetrahedra.

    Cell data: `group` (tag), `region` (index into field data `regions`), and `cell`, where there
    are cells. Field data: `names`, in the order of `tags`.

    Raises:
        MissingPackageError: pyvista is not installed.
    """
    pyvista = needed("pyvista", "pyvista", "mesh.to_pyvista()")
    tets = in_vtk_order(mesh.tets)
    width = np.full((len(tets), 1), tets.shape[1])
    types = np.full(len(tets), VTK_TYPES[tets.shape[1]], dtype=np.uint8)
    grid = pyvista.UnstructuredGrid(np.hstack([width, tets]).ravel(), types, mesh.points)
    volumes = [group for group in mesh.groups if group.dimension == 3]
    regions = region_names(mesh)
    grid.cell_data["group"] = mesh.tet_tags
    grid.cell_data["region"] = region_numbers(mesh, 3)
    for name, values in mesh.point_data.items():
        grid.point_data[name] = values
    for name, numbers in mesh.cell_data.items():
        grid.cell_data[name] = numbers
    grid.field_data["names"] = [group.name for group in volumes]
    grid.field_data["tags"] = [group.tag for group in volumes]
    grid.field_data["regions"] = regions
    return grid


def to_skfem(mesh: TetMesh) -> Any:
    """A `skfem.MeshTet1` or `MeshTet2` with named subdomains and boundaries.

    Subdomains are the volumes, and each region by its own name if no volume has it; boundaries are
    the surfaces, oriented as the mesh's triangles are.

    Raises:
        MissingPackageError: scikit-fem is not installed.
    """
    skfem = needed("skfem", "scikit-fem", "mesh.to_skfem()")
    oriented = needed("skfem.generic_utils", "scikit-fem", "mesh.to_skfem()").OrientedBoundary
    tets = in_vtk_order(mesh.tets).T
    made = skfem.MeshTet1 if mesh.order == 1 else skfem.MeshTet2
    result = made(np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(tets))
    subdomains = {
        group.name: np.flatnonzero(mesh.tet_tags == group.tag).astype(np.int32)
        for group in mesh.groups
        if group.dimension == 3
    }
    for number, name in enumerate(region_names(mesh)):
        subdomains.setdefault(
            name, np.flatnonzero(region_numbers(mesh, 3) == number).astype(np.int32)
        )
    facet, side = _facets(mesh, result)
    boundaries = {}
    for group in mesh.groups:
        if group.dimension == 2:
            own = mesh.triangle_tags == group.tag
            boundaries[group.name] = oriented(facet[own], side[own])
    return result.with_subdomains(subdomains).with_boundaries(boundaries)


def region_names(mesh: TetMesh) -> list[str]:
    """The names of the regions, in the model's order."""
    return [region.name for region in mesh.all_parts.regions]


def region_numbers(mesh: TetMesh, dimension: int) -> Any:
    """For each tetrahedron or triangle the place of its first region in `region_names`."""
    parts = mesh.all_parts
    place = {region.name: k for k, region in enumerate(parts.regions)}
    if dimension == 3:
        return looked_up({r.tag: place[r.name] for r in parts.regions}, parts.region_of_tets)
    table = {s.tag: place.get(s.regions[0], -1) for s in parts.surfaces if s.regions}
    return looked_up(table, mesh.triangle_parts)


def _facets(mesh: TetMesh, result: Any) -> tuple[Any, Any]:
    """For each triangle scikit-fem's facet, and on which of its sides the normal's tail is."""
    pairs = incidence(mesh.triangles, mesh.tets)
    order = np.argsort(-pairs.outward, kind="stable")
    triangle, first = np.unique(pairs.triangle[order], return_index=True)
    rows = order[first]
    tet = pairs.tet[rows]
    corners = np.sort(mesh.triangles[triangle, :3], axis=1)
    of_tet = result.t2f[:, tet]
    match = (np.sort(result.facets[:3], axis=0)[:, of_tet] == corners.T[:, None, :]).all(axis=0)
    facet = of_tet[np.argmax(match, axis=0), np.arange(len(tet))]
    tail = result.f2t[1, facet] == tet
    # a triangle whose normal points into its only tetrahedron has its tail on the other side
    side = np.where(pairs.outward[rows] > 0, tail, ~tail)
    return facet.astype(np.int32), side.astype(np.int32)
