"""Lengths asked for by the names of regions and faces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from decomp.csg.options import OF_FACES, OF_REGIONS, Options, checked
from decomp.errors import InputError, UnknownNameError
from decomp.geometry import Geometry
from decomp.meshes.group import GroupKind
from decomp.meshes.patterns import matches, names_regions
from decomp.near import listed, near
from decomp.vectors import positive


def checked_sizes(given: Any) -> dict[str, float]:
    """Lengths by pattern.

    Raises:
        InputError: these are none.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InputError(f"sizes must be lengths by pattern, got {given!r}")
    wrong = [pattern for pattern in given if not isinstance(pattern, str) or not pattern]
    if wrong:
        raise InputError(f"sizes must have patterns as keys, got {wrong[0]!r}")
    return {pattern: positive(size, f"size of {pattern!r}") for pattern, size in given.items()}


def sized(geometry: Geometry, sizes: Mapping[str, float]) -> tuple[Geometry, dict[str, float]]:
    """A geometry whose regions and faces have lengths as their `maxh`, and those of its regions.

    A later pattern goes before an earlier one.

    Args:
        geometry: to begin with.
        sizes: by pattern.

    Raises:
        UnknownNameError: a pattern stands for nothing.
    """
    if not sizes:
        return geometry, {}
    regions: dict[str, float] = {}
    faces: dict[tuple[int, int], float] = {}
    names = [region.name for region in geometry.regions]
    all_faces = {
        (r, f): f"{region.name}/{face.name}"
        for r, region in enumerate(geometry.regions)
        for f, face in enumerate(region.faces)
    }
    for pattern, size in sizes.items():
        if names_regions(pattern):
            found = [name for name in names if matches(pattern, name, GroupKind.REGION)]
            regions.update(dict.fromkeys(found, size))
            known, what = names, "region"
        else:
            own = [key for key, name in all_faces.items() if matches(pattern, name, GroupKind.FACE)]
            faces.update(dict.fromkeys(own, size))
            found, known, what = [all_faces[key] for key in own], [*all_faces.values()], "face"
        if not found:
            others = near(pattern, known) or f"; there are {listed(known)}"
            raise UnknownNameError(f"{pattern!r} of sizes stands for no {what}{others}")
    return _with_maxh(geometry, regions, faces), regions


def _with_maxh(
    geometry: Geometry, regions: Mapping[str, float], faces: Mapping[tuple[int, int], float]
) -> Geometry:
    given = geometry.boundaries
    model = replace(
        given.model,
        regions=tuple(
            replace(
                each, options=_with(each.options, regions.get(each.name), OF_REGIONS, each.name)
            )
            for each in given.model.regions
        ),
    )
    boundaries = tuple(
        replace(
            region,
            faces=tuple(
                replace(face, options=_with(face.options, faces.get((r, f)), OF_FACES, face.name))
                for f, face in enumerate(region.faces)
            ),
        )
        for r, region in enumerate(given.regions)
    )
    return Geometry.of(replace(given, model=model, regions=boundaries))


def _with(options: Mapping[str, Any], maxh: float | None, known: Any, where: str) -> Options:
    values = dict(options) if maxh is None else {**options, "maxh": maxh}
    return checked(values, known, where)
