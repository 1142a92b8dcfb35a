"""What a mesh tells apart at the finest, which groups are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from decomp.meshes.group import Group, GroupKind
from decomp.shown import Shown
from decomp.vectors import Ints


@dataclass(frozen=True, eq=False)
class Parts(Shown):
    """Regions and cells of tetrahedra, and faces, interfaces and sheets of triangles.

    Args:
        regions: one for each region of the model, in its order.
        materials: the material of each region, None for none.
        cells: of all regions; none if the mesh was made without cells.
        of_tets: (m,) the tag of each tetrahedron's cell; of its region if there are no cells.
        surfaces: each piece of a face or interface, and each sheet.
        triangles: (k, 3) or (k, 6), those of all surfaces.
        of_triangles: (k,) the tag of each one's surface.
        nearest: (m,) the tag of the surface that is nearest to each tetrahedron, where it was
            asked for.
    """

    regions: tuple[Group, ...]
    materials: tuple[str | None, ...]
    cells: tuple[Group, ...]
    of_tets: Ints
    surfaces: tuple[Group, ...]
    triangles: Ints
    of_triangles: Ints
    nearest: Ints | None = None

    @property
    def solids(self) -> tuple[Group, ...]:
        """The cells, or the regions if there are none."""
        return self.cells or self.regions

    @property
    def region_of_tets(self) -> Ints:
        """The tag (m,) of each tetrahedron's region."""
        tag = {region.name: region.tag for region in self.regions}
        return looked_up({s.tag: tag[s.regions[0]] for s in self.solids}, self.of_tets)


def of_groups(groups: Sequence[Group], of_tets: Ints, triangles: Ints, of_triangles: Ints) -> Parts:
    """The parts of a mesh of which nothing is known but its groups: each is a part."""
    solids = tuple(group for group in groups if group.dimension == 3)
    surfaces = tuple(group for group in groups if group.dimension == 2)
    if all(group.kind is GroupKind.REGION for group in solids):
        regions, cells = solids, solids[:0]
    else:
        regions, cells = _regions_of(solids), solids
    nothing = (None,) * len(regions)
    return Parts(regions, nothing, cells, of_tets, surfaces, triangles, of_triangles)


def _regions_of(cells: Sequence[Group]) -> tuple[Group, ...]:
    """The regions that cells are of, as far as these tell them."""
    first: dict[str, Group] = {}
    for cell in cells:
        first.setdefault(cell.regions[0], cell)
    return tuple(
        replace(cell, kind=GroupKind.REGION, tag=k, name=name, faces=(), volume=None)
        for k, (name, cell) in enumerate(first.items(), 1)
    )


def looked_up(table: dict[int, int], tags: Ints, default: int = -1) -> Ints:
    """The entry (n,) of each tag (n,)."""
    found, which = np.unique(tags, return_inverse=True)
    entries = np.array([table.get(int(tag), default) for tag in found], dtype=np.int64)
    return entries[which.reshape(-1)]
