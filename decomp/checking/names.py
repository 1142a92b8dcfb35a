"""What the names of a mesh's groups stand for in its model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from decomp.geometry import Geometry
from decomp.meshes.pieces import whole_name

Sides = tuple[tuple[int, int], ...]
"""A face, or the two of an interface, as numbers of region and face."""
LISTED = 5
"""Of names that are missing or unknown so many are told."""


@dataclass(frozen=True)
class Names:
    """Groups by what they are; faces and regions are indices.

    Args:
        regions: tag and region of each volume that is a whole region.
        cells: tag and name of each other volume.
        faces: tag of each surface of faces, and what each of its triangles is on one of: (region,
            face) pairs, one for a face, two for an interface. There are several where the pieces
            of a face are one surface.
        sheets: tag and name of each other surface.
    """

    regions: Mapping[int, int]
    cells: Mapping[int, str]
    faces: Mapping[int, tuple[Sides, ...]]
    sheets: Mapping[int, str]


def resolved(names: Mapping[tuple[int, int], str], geometry: Geometry) -> Names:
    """Tell regions from cells, and faces and interfaces from sheets."""
    region = {each.name: k for k, each in enumerate(geometry.regions)}
    known = face_names(geometry)
    volumes = {tag: name for (dimension, tag), name in names.items() if dimension == 3}
    surfaces = {tag: name for (dimension, tag), name in names.items() if dimension == 2}
    pieces = _pieces(known)
    given = set(surfaces.values())
    faces = {
        tag: _standing_for(name, known, pieces, given)
        for tag, name in surfaces.items()
        if all(part in known for part in name.split("|"))
    }
    return Names(
        {tag: region[name] for tag, name in volumes.items() if name in region},
        {tag: name for tag, name in volumes.items() if name not in region},
        faces,
        {tag: name for tag, name in surfaces.items() if tag not in faces},
    )


def _pieces(known: Mapping[str, tuple[int, int]]) -> dict[str, list[str]]:
    """The pieces of each face, by the name of the first."""
    found: dict[str, list[str]] = {}
    for name in known:
        found.setdefault(whole_name(name), []).append(name)
    return found


def _standing_for(
    name: str,
    known: Mapping[str, tuple[int, int]],
    pieces: Mapping[str, list[str]],
    given: set[str],
) -> tuple[Sides, ...]:
    """What a surface of faces can be on: its own faces, or pieces of them that no surface has."""
    own = name.split("|")
    every = product(*(pieces.get(part, [part]) for part in own))
    names = [each for each in every if list(each) == own or "|".join(each) not in given]
    return tuple(tuple(known[part] for part in each) for each in names)


def face_names(geometry: Geometry) -> dict[str, tuple[int, int]]:
    """The full name of each face of each region, `region/face`."""
    return {
        f"{region.name}/{face.name}": (number, k)
        for number, region in enumerate(geometry.regions)
        for k, face in enumerate(region.faces)
    }


def name_shortcomings(names: Names, geometry: Geometry, cells: Sequence[str]) -> Iterator[str]:
    """Names that the model does not know, and parts of the model that no group is named for.

    Args:
        names: of the mesh.
        geometry: of the model.
        cells: names of all cells; empty if the volumes are regions.
    """
    count = len(geometry.regions)
    if names.cells:
        known = set(cells)
        given = set(names.cells.values())
        yield from listed_names("volumes that the model has not", sorted(given - known))
        covered = {geometry.regions[k].name for k in names.regions.values()}
        missing = [c for c in cells if c not in given and c.split("/")[0] not in covered]
        yield from listed_names("cells without a volume", missing)
    else:
        absent = [geometry.regions[k].name for k in range(count)]
        present = {geometry.regions[k].name for k in names.regions.values()}
        yield from listed_names("regions without a volume", [n for n in absent if n not in present])
    have = {side for each in names.faces.values() for sides in each for side in sides}
    lost = [name for name, side in face_names(geometry).items() if side not in have]
    yield from listed_names("faces without a surface", lost)
    yield from listed_names(
        "surfaces that the model has not",
        sorted(name for name in names.sheets.values() if not _is_sheet(name, cells)),
    )


def sides(name: str) -> tuple[str, ...]:
    """The names of the two cells at a sheet `region/one|two`; none if it is named otherwise."""
    region, slash, rest = name.partition("/")
    one, bar, two = rest.partition("|")
    return (f"{region}/{one}", f"{region}/{two}") if slash and bar else ()


def _is_sheet(name: str, cells: Sequence[str]) -> bool:
    """Whether a name is that of a sheet between two of some cells."""
    return bool(sides(name)) and set(sides(name)) <= set(cells)


def listed_names(what: str, names: Sequence[str]) -> Iterator[str]:
    """A line with the first of some names; none if there are none."""
    if names:
        told = ", ".join(name or "(no name)" for name in names[:LISTED])
        more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
        yield f"{len(names)} {what}: {told}{more}"
