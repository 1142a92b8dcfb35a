"""The tetrahedral mesh of a model, with a name on every cell, face, interface and sheet."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from decomp.vectors import Array, Ints


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
        maxh: largest edge length that the input file asks for in this region, None for none.
        bc: boundary condition number of the input file (Netgen's `-bc`), None for none.
    """

    kind: GroupKind
    tag: int
    name: str
    regions: tuple[str, ...]
    faces: tuple[str, ...] = ()
    volume: float | None = None
    maxh: float | None = None
    bc: int | None = None

    @property
    def dimension(self) -> int:
        """3 for cells and regions, 2 for the others."""
        return 3 if self.kind in (GroupKind.CELL, GroupKind.REGION) else 2


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
    """

    name: str
    points: Array
    tets: Ints
    tet_tags: Ints
    triangles: Ints
    triangle_tags: Ints
    groups: tuple[Group, ...]
    unprojected: Ints

    @property
    def order(self) -> int:
        """1 for straight, 2 for quadratic elements."""
        return 1 if self.tets.shape[1] == 4 else 2

    def group(self, name: str) -> Group:
        """The group of a name.

        Raises:
            KeyError: there is none.
        """
        for group in self.groups:
            if group.name == name:
                return group
        raise KeyError(name)
