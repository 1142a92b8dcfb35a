"""What a view shows: named parts of triangles, the tetrahedra of meshes, fields to colour by."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from decomp.vectors import Array, Ints

GROUPS = ("cell", "sheet", "interface", "face")


@dataclass(frozen=True, eq=False)
class Part:
    """One thing that can be shown and hidden.

    Args:
        group: one of `GROUPS`; volumes of any kind are cells.
        region: the name of the region that it is of, or of two with `|` between them; "" if
            unknown.
        name: what it is called.
        kind: the kind of surface of a sheet, else the group.
        triangles: (k, 3) numbers of the scene's points; of cells they point out.
    """

    group: str
    region: str
    name: str
    kind: str
    triangles: Ints


@dataclass(frozen=True, eq=False)
class Body:
    """The tetrahedra of a mesh.

    Args:
        tets: (m, 4) numbers of the scene's points.
        part: (m,) the number of each one's part.
        neighbours: (m, 4) the tetrahedron behind each face, in the order of `incidence.FACES`;
            -1 for none.
    """

    tets: Ints
    part: Ints
    neighbours: Ints


@dataclass(frozen=True, eq=False)
class Field:
    """Values to colour by.

    Args:
        name: of it.
        at_points: whether values are at points, else of tetrahedra.
        values: (n,) or (m,).
    """

    name: str
    at_points: bool
    values: Array


@dataclass(frozen=True, eq=False)
class Scene:
    """All parts.

    Args:
        title: of what is shown.
        points: (n, 3) of all parts, about `origin`.
        parts: by group.
        fields: to colour by.
        body: of a mesh; None for skeletons.
        origin: (3,) what is far away has no digits in a view: coordinates are about this point.
    """

    title: str
    points: Array
    parts: tuple[Part, ...]
    fields: tuple[Field, ...] = ()
    body: Body | None = None
    origin: Array = field(default_factory=lambda: np.zeros(3))

    @property
    def opaque(self) -> str:
        """The group that is seen first: the cells of a mesh, or the sheets, or what there is."""
        groups = [part.group for part in self.parts]
        if self.body is None and "sheet" in groups:
            return "sheet"
        return next((group for group in GROUPS if group in groups), GROUPS[0])

    def corners(self, part: Part) -> Array:
        """The corners (k, 3, 3) of a part's triangles."""
        return np.asarray(self.points[part.triangles])
