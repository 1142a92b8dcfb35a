"""How far nodes are off the exact surfaces that their triangles' groups are named for.

A mesh's report and its check both count by this. Faces and interfaces are carriers; a sheet is the
surface between two sites, one of each of its two cells, or one of several such surfaces. Between
the cells of faces there are trim surfaces too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.checking.names import Names, Sides, sides
from decomp.complex.many_elements import Elements
from decomp.geometry import Geometry
from decomp.meshing.exact.targets import SURFACE, placed
from decomp.meshing.surface.surface import MeshSurface, RegionSurface
from decomp.vectors import Array, Ints, norm


@dataclass(frozen=True, eq=False)
class KnownSheets:
    """The sheets of a model by the cells that they part.

    Args:
        elements: their surfaces, with those of faces.
        points: (p, 3) the complex's.
        between: numbers of surfaces by the names of the two cells, one name for a sheet in a cell.
    """

    elements: Elements
    points: Array
    between: Mapping[frozenset[str], tuple[int, ...]]

    def named(self, name: str) -> tuple[int, ...]:
        """The surfaces of a sheet `region/one|two`; all of either cell where none parts the two."""
        cells = frozenset(sides(name))
        own = self.between.get(cells)
        if own is not None:
            return own
        found = (k for pair, numbers in self.between.items() if pair & cells for k in numbers)
        return tuple(dict.fromkeys(found))


def known_sheets(surface: MeshSurface, elements: Elements, names: Sequence[str]) -> KnownSheets:
    """The sheets of a model.

    Args:
        surface: with its complex.
        elements: of the complex.
        names: (s,) of the cell that each site is of; what those of the outside have is not asked.
    """
    between: dict[frozenset[str], dict[int, None]] = {}
    for region in surface.regions:
        for patch, sites in region.sheets.items():
            cells = frozenset(names[site] for site in sites)
            between.setdefault(cells, {})[int(elements.of_patch[patch])] = None
        for patch, cells in _trims(region).items():
            between.setdefault(cells, {})[int(elements.of_patch[patch])] = None
    return KnownSheets(
        elements, surface.complex.points, {cells: tuple(own) for cells, own in between.items()}
    )


def _trims(region: RegionSurface) -> dict[int, frozenset[str]]:
    """The patches that part two cells and are no sheets, with the names of the two."""
    outer = {patch for sides in region.face_sides for patch, _ in sides}
    found: dict[int, list[str]] = {}
    for cell in region.cells:
        for patch, _ in cell.sides:
            if patch not in region.sheets and patch not in outer:
                found.setdefault(patch, []).append(cell.name)
    return {patch: frozenset(names) for patch, names in found.items() if len(set(names)) == 2}


def off_surfaces(
    geometry: Geometry,
    points: Array,
    triangles: Ints,
    tags: Ints,
    names: Names,
    known: KnownSheets | None,
) -> Array:
    """The distance (n,) of each node from the farthest surface that it should be on, 0 for none.

    Args:
        geometry: of the model.
        points: (n, 3) nodes.
        triangles: (k, 3) or (k, 6).
        tags: (k,) of the groups.
        names: what these are.
        known: the model's sheets; None where no group is of any.
    """
    off = np.zeros(len(points))
    for tag, choices in names.faces.items():
        nodes = np.unique(triangles[tags == tag])
        away = np.full(len(nodes), np.inf)
        for own in dict.fromkeys(_carriers(geometry, each) for each in choices):
            gaps = [
                np.abs(geometry.regions[region].carriers[k].signed_distance(points[nodes]))
                for region, k in own
            ]
            away = np.minimum(away, np.max(gaps, axis=0))
        off[nodes] = np.maximum(off[nodes], away)
    for tag, name in names.sheets.items():
        numbers = known.named(name) if known is not None else ()
        nodes = np.unique(triangles[tags == tag])
        if known is not None and numbers and len(nodes):
            gap = _gap(known, numbers, points[nodes])
            off[nodes] = np.maximum(off[nodes], gap)
    return off


def _carriers(geometry: Geometry, sides: Sides) -> tuple[tuple[int, int], ...]:
    """Region and carrier of a face, or of the two of an interface."""
    return tuple((region, geometry.regions[region].faces[face].carrier) for region, face in sides)


def _gap(known: KnownSheets, numbers: Sequence[int], points: Array) -> Array:
    """How far points (k, 3) are from the nearest of some surfaces, infinite if from none."""
    count = len(points)
    found = np.full(count, np.inf)
    for number in numbers:
        dimension, element = np.full(count, SURFACE), np.full(count, number)
        on, good = placed(known.elements, known.points, dimension, element, points)
        found[good] = np.minimum(found[good], norm(on - points)[good])
    return found
