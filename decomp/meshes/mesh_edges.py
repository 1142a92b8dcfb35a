"""The edges and vertices of a model on its mesh: where triangles of different faces meet.

Each is named by its faces: `region/face&face` for an edge, with more faces for a vertex, and such
names joined by `|` where several regions have it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from decomp.meshes.curve_edges import curve_edges, points_of
from decomp.meshes.group import Group, GroupKind
from decomp.meshes.parts import Parts
from decomp.meshes.pieces import whole_name
from decomp.vectors import Ints


@dataclass(frozen=True, eq=False)
class MeshEdges:
    """Edges of triangles, and nodes, on edges and at vertices of the model.

    Args:
        edges: one for each set of faces that meet.
        lines: (e, 2), with the middle node (e, 3) in quadratic meshes.
        of_lines: (e,) the tag of each one's edge.
        vertices: one for each set of faces that meet.
        nodes: (p,).
        of_nodes: (p,) the tag of each one's vertex.
    """

    edges: tuple[Group, ...]
    lines: Ints
    of_lines: Ints
    vertices: tuple[Group, ...]
    nodes: Ints
    of_nodes: Ints

    @classmethod
    def none(cls, parts: Parts) -> MeshEdges:
        """Where none are wanted."""
        width = 3 if parts.triangles.shape[1] == 6 else 2
        nothing = np.empty(0, dtype=np.int64)
        return cls((), nothing.reshape(0, width), nothing, (), nothing, nothing)


def mesh_edges(parts: Parts, split_faces: bool) -> MeshEdges:
    """Find them.

    Args:
        parts: of the mesh.
        split_faces: whether names tell which pieces of faces meet.
    """
    outer = {s.tag: s for s in parts.surfaces if s.kind is not GroupKind.SHEET}
    rows = np.isin(parts.of_triangles, list(outer))
    found = curve_edges(parts.triangles[rows], parts.of_triangles[rows])
    order = {
        side: k for k, side in enumerate(dict.fromkeys(x for s in outer.values() for x in s.sides))
    }

    def name(tags: Iterable[int]) -> tuple[str, tuple[str, ...]]:
        """The name of what some surfaces meet in, and its regions."""
        sides = sorted({x for tag in tags for x in outer[tag].sides}, key=order.__getitem__)
        regions: dict[str, list[str]] = {}
        for region, face in sides:
            own = regions.setdefault(region, [])
            short = face if split_faces else whole_name(face)
            if short not in own:
                own.append(short)
        joined = "|".join(f"{region}/{'&'.join(faces)}" for region, faces in regions.items())
        return joined, tuple(regions)

    lines = (
        np.column_stack([found.ends, found.middles])
        if parts.triangles.shape[1] == 6
        else (found.ends)
    )
    edges, of_set = _groups(GroupKind.EDGE, [name(tags) for tags in found.sets])
    corner = points_of(found)
    vertices, of_corner = _groups(GroupKind.VERTEX, [name(tags) for tags in corner.sets])
    return MeshEdges(edges, lines, of_set[found.of], vertices, corner.nodes, of_corner[corner.of])


def _groups(
    kind: GroupKind, names: list[tuple[str, tuple[str, ...]]]
) -> tuple[tuple[Group, ...], Ints]:
    """One for each different name, and the tag of each."""
    tag: dict[str, int] = {}
    groups = []
    for name, regions in names:
        if name not in tag:
            tag[name] = len(tag) + 1
            groups.append(Group(kind, tag[name], name, regions))
    return tuple(groups), np.array([tag[name] for name, _ in names], dtype=np.int64)
