"""The tetrahedral mesh of a model: its elements, its named groups, and what groups are made of."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from decomp.meshes.group import NOUNS
from decomp.meshes.group import Group as Group
from decomp.meshes.group import GroupKind as GroupKind
from decomp.meshes.group_names import named, selected
from decomp.meshes.grouping import Chosen, Volumes, grouped
from decomp.meshes.parts import Parts, looked_up, of_groups
from decomp.meshes.reasons import Reason
from decomp.shown import Shown
from decomp.vectors import Array, Ints

if TYPE_CHECKING:
    import meshio  # type: ignore[import-untyped]
    import pyvista
    import skfem  # type: ignore[import-untyped]


NO_TAGS: Ints = np.empty(0, dtype=np.int64)


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
class TetMesh(Shown):
    """A conforming mesh. Every tetrahedron, and every other element, is in exactly one group.

    What it is made of at the finest, `parts`, stays whatever groups are made of it: `grouped`
    makes others.

    Args:
        name: the model's.
        points: (n, 3) nodes; all are used.
        tets: (m, 4) or (m, 10), positively oriented; mid-edge nodes in Gmsh's order: edges
            01, 12, 20, 30, 32, 31.
        tet_tags: (m,) the tag of each one's group of dimension 3.
        triangles: (k, 3) or (k, 6) faces of tets; boundary triangles point out of the region,
            mid-edge nodes on edges 01, 12, 20.
        triangle_tags: (k,) the tag of each one's group of dimension 2.
        groups: those of dimension 3 first, then 2, 1 and 0, each in ascending order of tags.
        unprojected: nodes on the boundary, interfaces or sheets that could not be moved onto their
            exact geometry without spoiling a tetrahedron; ascending.
        point_data: (n,) values at nodes by name: the fields asked for, see `decomp.meshes.fields`.
        cell_data: (m,) values of tetrahedra by name; `cell`, the number of its cell from 1, where
            there are cells.
        lengths: (n,) edge length wanted at each node; None if unknown.
        reason: (n,) which of `reasons` decided it; None if unknown.
        reasons: why lengths are wanted.
        source: the file that the model was read from, if any; no output may replace it.
        found_by: how the skeleton of each region was found; none without cells.
        lines: (e, 2) or (e, 3) edges of triangles, with the middle node last.
        line_tags: (e,) the tag of each one's group of dimension 1.
        nodes: (p,) nodes at vertices.
        node_tags: (p,) the tag of each one's group of dimension 0.
        parts: regions, cells, faces, interfaces and sheets; None if groups are all that is known.
        part_rows: (k,) the row of each triangle in `parts.triangles`.
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
    reason: Ints | None = None
    reasons: tuple[Reason, ...] = ()
    source: Path | None = None
    found_by: tuple[FoundBy, ...] = ()
    lines: Ints = field(default_factory=lambda: NO_TAGS.reshape(0, 2))
    line_tags: Ints = field(default_factory=lambda: NO_TAGS)
    nodes: Ints = field(default_factory=lambda: NO_TAGS)
    node_tags: Ints = field(default_factory=lambda: NO_TAGS)
    parts: Parts | None = None
    part_rows: Ints | None = None

    @property
    def order(self) -> int:
        """1 for straight, 2 for quadratic elements."""
        return 1 if self.tets.shape[1] == 4 else 2

    @property
    def all_parts(self) -> Parts:
        """The parts; where they are unknown each group is one."""
        if self.parts is not None:
            return self.parts
        return of_groups(self.groups, self.tet_tags, self.triangles, self.triangle_tags)

    @property
    def triangle_parts(self) -> Ints:
        """The tag (k,) of each triangle's part."""
        if self.parts is None or self.part_rows is None:
            return self.triangle_tags
        return self.parts.of_triangles[self.part_rows]

    def _facts(self) -> Mapping[str, Any]:
        kinds = {3: "volumes", 2: "surfaces", 1: "curves", 0: "points"}
        counts = {
            what: tuple(g.name for g in self.groups if g.dimension == d) or None
            for d, what in kinds.items()
        }
        return {
            "name": self.name,
            "nodes": len(self.points),
            "tetrahedra": len(self.tets),
            "order": self.order,
            "cells": len(self.all_parts.cells) or None,
            **counts,
            "fields": (*self.point_data, *self.cell_data) or None,
        }

    def _table(self) -> tuple[Sequence[str], Iterable[Sequence[Any]]]:
        tags = (self.node_tags, self.line_tags, self.triangle_tags, self.tet_tags)
        rows = (
            (g.name, NOUNS[g.dimension], g.tag, int((tags[g.dimension] == g.tag).sum()))
            for g in self.groups
        )
        return ("group", "of", "tag", "elements"), rows

    def summary(self) -> str:
        """What `decomp mesh` prints: counts, volumes, lengths of edges, groups, quality."""
        from decomp.meshes.report import as_text, report

        return "\n".join(as_text(report(self)))

    def plot(self, scalars: str = "group", **options: Any) -> Any:
        """Show it with PyVista, in a window or in a notebook.

        Args:
            scalars: what it is coloured by: `group`, `region`, `cell`, or a field.
            options: of `pyvista.DataSet.plot`, such as `off_screen`, `screenshot`, `cpos`.

        Raises:
            InputError: there are no such values.
            MissingPackageError: pyvista is not installed.
        """
        from decomp.view.plot import plot_mesh

        return plot_mesh(self, scalars, options)

    def group(self, name: str, dimension: int | None = None) -> Group:
        """The group of a name.

        Args:
            name: of it.
            dimension: 3 for a volume, 2 for a surface, 1 for a curve, 0 for a point. Without it
                there must be one group of the name: a cell of one face has the face's.

        Raises:
            UnknownNameError: (a `KeyError`) there is none, or more than one.
        """
        return named(self.groups, name, dimension)

    def select(self, pattern: str, dimension: int | None = None) -> tuple[Group, ...]:
        """The groups whose names a pattern stands for, such as `*/bolt*.side`.

        In each part of a name (`region/face`) `*` stands for any characters, `?` for one and `[ab]`
        for one of some. Without `/` and `.` a pattern stands for regions and names without these;
        without `/` for faces in any region. An interface is selected by either of its sides.

        Args:
            pattern: for names (`decomp.meshes.patterns`).
            dimension: of the groups, 3 to 0; None for any.

        Raises:
            UnknownNameError: (a `KeyError`) there is none.
        """
        return selected(self.groups, pattern, dimension)

    def grouped(
        self,
        *,
        volumes: Volumes = "regions",
        sheets: bool = False,
        groups: Mapping[str, str | Sequence[str]] | None = None,
        split_faces: bool = False,
        edges: bool = False,
    ) -> TetMesh:
        """The same mesh with other groups; the arguments are those of `decomp.mesh`.

        Raises:
            InputError: an argument is of a wrong kind, a pattern stands for nothing, two for the
                same, or a group's name is taken.
        """
        chosen = Chosen(volumes, sheets, {} if groups is None else groups, split_faces, edges)
        return regrouped(self, chosen)

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
        from decomp.meshes.files import write

        write(self, path, text=text, version=version)

    def to_meshio(self) -> meshio.Mesh:
        """As meshio reads it from a .msh file (`decomp.meshes.convert.to_meshio`)."""
        from decomp.meshes.convert import to_meshio

        return to_meshio(self)

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The tetrahedra with `group` and `region` (`decomp.meshes.convert.to_pyvista`)."""
        from decomp.meshes.convert import to_pyvista

        grid: pyvista.UnstructuredGrid = to_pyvista(self)
        return grid

    def to_skfem(self) -> skfem.Mesh:
        """With named subdomains and boundaries (`decomp.meshes.convert.to_skfem`)."""
        from decomp.meshes.convert import to_skfem

        return to_skfem(self)


def regrouped(mesh: TetMesh, chosen: Chosen) -> TetMesh:
    """A mesh with groups as they are chosen.

    Raises:
        InputError: see `TetMesh.grouped`.
    """
    parts = mesh.all_parts
    made = grouped(parts, chosen)
    cell_data = dict(mesh.cell_data)
    if parts.nearest is not None:
        cell_data["nearest"] = looked_up(dict(made.surface_tags), parts.nearest)
    return replace(
        mesh,
        groups=made.groups,
        tet_tags=made.tet_tags,
        triangles=parts.triangles[made.rows],
        triangle_tags=made.triangle_tags,
        lines=made.lines,
        line_tags=made.line_tags,
        nodes=made.nodes,
        node_tags=made.node_tags,
        cell_data=cell_data,
        parts=parts,
        part_rows=made.rows,
    )
