"""The tetrahedral mesh of a model, with a name on every cell, face, interface and sheet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

from decomp.vectors import Array, Ints

if TYPE_CHECKING:
    import meshio  # type: ignore[import-untyped]
    import pyvista
    import skfem  # type: ignore[import-untyped]


class GroupKind(Enum):
    """What a physical group is: of tetrahedra a cell or a region, else of triangles."""

    CELL = "cell"
    REGION = "region"
    FACE = "face"
    INTERFACE = "interface"
    SHEET = "sheet"


@dataclass(frozen=True)
class Group:
    """A named set of elements, written as a physical group.

    Args:
        kind: what it is; tells the dimension.
        tag: positive, unique among the groups of its dimension; also the tag of its entity.
        name: unique among the groups of its dimension, such as `part/hole.side`.
        regions: names of the regions that it is of (cells, regions, faces: one; interfaces: two).
        faces: names of the boundary faces of a cell; empty for other kinds.
        volume: exact-complex volume of a cell or exact volume of a region, in model units cubed;
            None for triangles.
        maxh: largest edge length that the input file asks for in this region, or on this face or
            interface; None for none.
        bc: boundary condition number of the input file (Netgen's `-bc`), None for none.
        length: largest edge length asked for there, of `maxh`, the user's size and the default;
            None if unknown, and for sheets.
    """

    kind: GroupKind
    tag: int
    name: str
    regions: tuple[str, ...]
    faces: tuple[str, ...] = ()
    volume: float | None = None
    maxh: float | None = None
    bc: int | None = None
    length: float | None = None

    @property
    def dimension(self) -> int:
        """3 for cells and regions, 2 for the others."""
        return 3 if self.kind in (GroupKind.CELL, GroupKind.REGION) else 2


@dataclass(frozen=True)
class FoundBy:
    """How the skeleton of a region was found.

    Args:
        region: its name.
        method: `traced` or `sampled`.
        cause: why it was not traced, where that was tried first.
    """

    region: str
    method: str
    cause: str | None = None


@dataclass(frozen=True, eq=False)
class TetMesh:
    """A conforming mesh. Every tetrahedron and every tagged triangle is in exactly one group.

    Args:
        name: the model's.
        points: (n, 3) nodes; all are used.
        tets: (m, 4) or (m, 10), positively oriented; mid-edge nodes in Gmsh's order: edges
            01, 12, 20, 30, 32, 31.
        tet_tags: (m,) the tag of each one's group of dimension 3.
        triangles: (k, 3) or (k, 6) faces of tets; boundary triangles point out of the region,
            mid-edge nodes on edges 01, 12, 20.
        triangle_tags: (k,) the tag of each one's group of dimension 2.
        groups: those of dimension 3 first, each kind in ascending order of tags.
        unprojected: nodes on the boundary, interfaces or sheets that could not be moved onto their
            exact geometry without spoiling a tetrahedron; ascending.
        point_data: (n,) values at nodes by name: the fields asked for, see `decomp.tetra.fields`.
        cell_data: (m,) values of tetrahedra by name.
        lengths: (n,) edge length wanted at each node; None if unknown.
        source: the file that the model was read from, if any; no output may replace it.
        found_by: how the skeleton of each region was found; none without cells.
    """

    name: str
    points: Array
    tets: Ints
    tet_tags: Ints
    triangles: Ints
    triangle_tags: Ints
    groups: tuple[Group, ...]
    unprojected: Ints
    point_data: Mapping[str, Array] = field(default_factory=dict)
    cell_data: Mapping[str, Ints] = field(default_factory=dict)
    lengths: Array | None = None
    source: Path | None = None
    found_by: tuple[FoundBy, ...] = ()

    @property
    def order(self) -> int:
        """1 for straight, 2 for quadratic elements."""
        return 1 if self.tets.shape[1] == 4 else 2

    def group(self, name: str, dimension: int | None = None) -> Group:
        """The group of a name; without a dimension (2 or 3) a volume comes before a surface.

        Raises:
            KeyError: there is none.
        """
        for group in self.groups:
            if group.name == name and dimension in (None, group.dimension):
                return group
        raise KeyError(name)

    def write(self, path: str | Path, *, text: bool = False, version: str = "4.1") -> None:
        """Write to a file, whole or not at all.

        Args:
            path: ends in .msh, .vtu, .xdmf, .inp, .mesh or .png, and is not the file that the
                model was read from.
            text: write Gmsh's format 4.1 as text, not binary.
            version: of Gmsh's format, 4.1 or 2.2 (always text).

        Raises:
            InputError: the suffix or the version is unknown.
            FileError: the file cannot be written.
        """
        from decomp.output.mesh import write

        write(self, path, text=text, version=version)

    def to_meshio(self) -> meshio.Mesh:
        """As meshio reads it from a .msh file (`decomp.tetra.convert.to_meshio`)."""
        from decomp.tetra.convert import to_meshio

        return to_meshio(self)

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The tetrahedra with `group` and `region` (`decomp.tetra.convert.to_pyvista`)."""
        from decomp.tetra.convert import to_pyvista

        grid: pyvista.UnstructuredGrid = to_pyvista(self)
        return grid

    def to_skfem(self) -> skfem.Mesh:
        """With named subdomains and boundaries (`decomp.tetra.convert.to_skfem`)."""
        from decomp.tetra.convert import to_skfem

        return to_skfem(self)
