"""A named set of elements of a mesh, and a part of it at the finest that groups are made of."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from decomp.shown import Shown


class GroupKind(Enum):
    """What a group is: of tetrahedra, triangles, edges of triangles, or nodes."""

    CELL = "cell"
    REGION = "region"
    FACE = "face"
    INTERFACE = "interface"
    SHEET = "sheet"
    EDGE = "edge"
    VERTEX = "vertex"


DIMENSIONS = {GroupKind.CELL: 3, GroupKind.REGION: 3, GroupKind.EDGE: 1, GroupKind.VERTEX: 0}
"""Of kinds; the others are surfaces."""
NOUNS = {3: "volume", 2: "surface", 1: "curve", 0: "point"}
"""What groups of a dimension are called."""


@dataclass(frozen=True)
class Group(Shown):
    """A named set of elements, written as a physical group; or one of the parts that these join.

    Args:
        kind: what it is, or what the parts are that it joins; tells the dimension.
        tag: positive, unique among the groups of its dimension.
        name: unique among the groups of its dimension, such as `part/hole.side`.
        regions: names of the regions that it is of (cells, regions, faces: one; interfaces: two;
            what joins several parts: those of all).
        faces: names of the boundary faces of a cell; of the face, or the two faces of an
            interface, one in each of the regions; empty for other kinds.
        volume: exact-complex volume of a cell or exact volume of a region, in model units cubed;
            None for triangles.
        maxh: largest edge length that the input file asks for in this region, or on this face or
            interface; None for none.
        bc: boundary condition number of the input file (Netgen's `-bc`), None for none, and where
            parts have several.
        length: largest edge length asked for there, of `maxh`, the user's size and the default;
            None if unknown, and for sheets, edges and vertices.
        members: names of the parts that it joins; empty for a part itself.
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
    members: tuple[str, ...] = ()

    @property
    def dimension(self) -> int:
        """3 for cells and regions, 1 for edges, 0 for vertices, 2 for the others."""
        return DIMENSIONS.get(self.kind, 2)

    @property
    def sides(self) -> tuple[tuple[str, str], ...]:
        """Of a face or an interface its region and face, or its two."""
        if len(self.faces) == len(self.regions):
            return tuple(zip(self.regions, self.faces, strict=True))
        split = (each.partition("/") for each in self.name.split("|"))
        return tuple((region, face) for region, _, face in split)
