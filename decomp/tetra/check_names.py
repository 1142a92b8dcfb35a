"""What the names of a mesh's groups stand for in its model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from decomp.geometry import Geometry

LISTED = 5
"""Of names that are missing or unknown so many are told."""


@dataclass(frozen=True)
class Names:
    """Groups by what they are; faces and regions are indices.

    Args:
        regions: tag and region of each volume that is a whole region.
        cells: tag and name of each other volume.
        faces: tag and (region, face) pairs of each surface: one for a face, two for an interface.
        sheets: tag and name of each other surface.
    """

    regions: Mapping[int, int]
    cells: Mapping[int, str]
    faces: Mapping[int, tuple[tuple[int, int], ...]]
    sheets: Mapping[int, str]


def resolved(names: Mapping[tuple[int, int], str], geometry: Geometry) -> Names:
    """Tell regions from cells, and faces and interfaces from sheets."""
    region = {each.name: k for k, each in enumerate(geometry.regions)}
    known = face_names(geometry)
    volumes = {tag: name for (dimension, tag), name in names.items() if dimension == 3}
    surfaces = {tag: name for (dimension, tag), name in names.items() if dimension == 2}
    faces = {
        tag: tuple(known[part] for part in name.split("|"))
        for tag, name in surfaces.items()
        if all(part in known for part in name.split("|"))
    }
    return Names(
        {tag: region[name] for tag, name in volumes.items() if name in region},
        {tag: name for tag, name in volumes.items() if name not in region},
        faces,
        {tag: name for tag, name in surfaces.items() if tag not in faces},
    )


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
        yield from _listed("volumes that the model has not", sorted(given - known))
        covered = {geometry.regions[k].name for k in names.regions.values()}
        missing = [c for c in cells if c not in given and c.split("/")[0] not in covered]
        yield from _listed("cells without a volume", missing)
    else:
        absent = [geometry.regions[k].name for k in range(count)]
        present = {geometry.regions[k].name for k in names.regions.values()}
        yield from _listed("regions without a volume", [n for n in absent if n not in present])
    have = {side for sides in names.faces.values() for side in sides}
    lost = [name for name, side in face_names(geometry).items() if side not in have]
    yield from _listed("faces without a surface", lost)
    yield from _listed(
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


def _listed(what: str, names: Sequence[str]) -> Iterator[str]:
    if names:
        told = ", ".join(name or "(no name)" for name in names[:LISTED])
        more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
        yield f"{len(names)} {what}: {told}{more}"
