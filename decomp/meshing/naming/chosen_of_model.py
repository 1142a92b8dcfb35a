"""Whether groups can be made as they are chosen, as far as a model tells before it is meshed."""

from __future__ import annotations

from collections.abc import Sequence

from decomp.boundary.topology import RegionBoundary
from decomp.geometry import Geometry
from decomp.meshes.group import Group, GroupKind
from decomp.meshes.grouping import Chosen, names_given, standing_for
from decomp.meshes.patterns import simple_patterns
from decomp.meshes.pieces import whole_name


def check_chosen(geometry: Geometry, chosen: Chosen, with_cells: bool) -> None:
    """Refuse patterns for what the model does not have, and volumes and sheets that it has not.

    Which faces of two regions meet the mesh tells: of a pattern for an interface the faces that it
    names are looked for.

    Raises:
        InputError: see `decomp.meshes.grouping`.
    """
    chosen.check(with_cells, (each.options.get("material") for each in geometry.model.regions))
    regions = geometry.regions
    there = {
        3: [Group(GroupKind.REGION, 1, region.name, (region.name,)) for region in regions],
        2: [
            Group(GroupKind.FACE, 1, f"{region.name}/{face.name}", (region.name,))
            for region in regions
            for face in region.faces
        ],
        1: [
            each
            for region in regions
            for each in _meetings(
                GroupKind.EDGE, region, [edge.faces for edge in region.edges], chosen.split_faces
            )
        ],
        0: [
            each
            for region in regions
            for each in _meetings(
                GroupKind.VERTEX, region, [v.faces for v in region.vertices], chosen.split_faces
            )
        ],
    }
    plain = {}
    for group, patterns in chosen.groups.items():
        if not any("|" in pattern for pattern in patterns):
            plain[group] = patterns
            continue
        for pattern in patterns:
            # sheets bear names of cells
            simple = [] if chosen.sheets and "|" in pattern else simple_patterns(pattern)
            for each in simple:
                standing_for(each, group, there, chosen.split_faces)
    names_given(plain, there, chosen.split_faces)


def _meetings(
    kind: GroupKind, region: RegionBoundary, faces: Sequence[Sequence[int]], split: bool
) -> list[Group]:
    """The edges or vertices of a region, one for each set of two faces or more that meet."""
    names = [face.name if split else whole_name(face.name) for face in region.faces]
    found: dict[str, None] = {}
    for each in faces:
        own = list(dict.fromkeys(names[k] for k in sorted(each)))
        if len(own) > 1:
            found[f"{region.name}/{'&'.join(own)}"] = None
    return [Group(kind, 1, name, (region.name,)) for name in found]
