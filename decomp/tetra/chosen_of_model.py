"""Whether groups can be made as they are chosen, as far as a model tells before it is meshed."""

from __future__ import annotations

from decomp.geometry import Geometry
from decomp.tetra.group import Group, GroupKind
from decomp.tetra.grouping import Chosen, names_given, standing_for
from decomp.tetra.patterns import simple_patterns


def check_chosen(geometry: Geometry, chosen: Chosen, with_cells: bool) -> None:
    """Refuse patterns for what the model does not have, and volumes and sheets that it has not.

    Which faces meet in interfaces and edges the mesh tells: of a pattern for one the faces that it
    names are looked for.

    Raises:
        InputError: see `decomp.tetra.grouping`.
    """
    chosen.check(with_cells, (each.options.get("material") for each in geometry.model.regions))
    names = [region.name for region in geometry.regions]
    regions = [Group(GroupKind.REGION, k, name, (name,)) for k, name in enumerate(names, 1)]
    faces = [
        Group(GroupKind.FACE, 1, f"{region.name}/{face.name}", (region.name,), (face.name,))
        for region in geometry.regions
        for face in region.faces
    ]
    there = {3: regions, 2: faces, 1: [], 0: []}
    plain = {}
    for group, patterns in chosen.groups.items():
        simple = {pattern: simple_patterns(pattern) for pattern in patterns}
        if all(found == [pattern] for pattern, found in simple.items()):
            plain[group] = patterns
            continue
        for pattern, found in simple.items():
            if not (chosen.sheets and "|" in pattern):
                for each in found:
                    standing_for(each, group, there, chosen.split_faces)
    names_given(plain, there, chosen.split_faces)
