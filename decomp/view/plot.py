"""Results shown by PyVista, which opens a window or, in a notebook, a view in it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from decomp.errors import InputError
from decomp.near import listed, near
from decomp.optional import needed
from decomp.vectors import Array, Ints

if TYPE_CHECKING:
    from decomp.geometry import Geometry
    from decomp.meshes.model import TetMesh
    from decomp.skeletons.model import Skeleton

FINE_FACES = 2e-3
"""How far triangles may be off faces, in diagonals of the model."""
COLOURS = "tab20"


def plot_mesh(mesh: TetMesh, scalars: str, options: Mapping[str, Any]) -> Any:
    """Show tetrahedra, coloured by values of theirs or of their nodes.

    Raises:
        InputError: there are no such values.
    """
    grid = mesh.to_pyvista()
    known = [*grid.cell_data, *grid.point_data]
    if scalars not in known:
        hint = near(str(scalars), known) or f"; there are {listed(known)}"
        raise InputError(f"a mesh cannot be coloured by {scalars!r}{hint}")
    usual: dict[str, Any] = {"show_edges": True, "text": mesh.name}
    if scalars in ("group", "region", "cell", "nearest"):
        usual["cmap"] = COLOURS
    return grid.plot(**{"scalars": scalars, **usual, **options})


def plot_geometry(geometry: Geometry, options: Mapping[str, Any]) -> Any:
    """Show the faces of all regions, each in a colour."""
    from decomp.complex.boundary.boundary import boundary_mesh

    made = boundary_mesh(geometry.local, FINE_FACES * geometry.diagonal).complex
    surface = _surface(made.points + geometry.offset, [patch.triangles for patch in made.patches])
    usual = {"scalars": "face", "cmap": COLOURS, "show_scalar_bar": False}
    return surface.plot(**{**usual, "text": geometry.model.name, **options})


def plot_skeleton(skeleton: Skeleton, options: Mapping[str, Any]) -> Any:
    """Show the sheets of all regions, coloured by radius."""
    patches = skeleton.complex.patches
    own = [patches[sheet.patch].triangles for r in skeleton.regions for sheet in r.sheets]
    surface = _surface(skeleton.complex.points, own)
    surface.point_data["radius"] = skeleton.radius
    return surface.plot(**{"scalars": "radius", "text": skeleton.name, **options})


def _surface(points: Array, parts: Iterable[Ints]) -> Any:
    """A `pyvista.PolyData` of triangles, with the number of the part that each is of."""
    pyvista = needed("pyvista", "pyvista", "plot()")
    every = list(parts)
    triangles = np.concatenate([np.empty((0, 3), dtype=np.int64), *every])
    faces = np.insert(triangles, 0, 3, axis=1).reshape(-1)
    result = pyvista.PolyData(points, faces)
    result.cell_data["face"] = np.repeat(np.arange(len(every)), [len(each) for each in every])
    return result
