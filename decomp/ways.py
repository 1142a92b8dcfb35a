"""`decomp.skeleton()`: traced, or sampled where tracing fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Literal, get_args

from decomp.compute import TOLERANCE, checked
from decomp.compute import skeleton as traced_skeleton
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import GeometryError, InputError
from decomp.geometry import Geometry
from decomp.located import located
from decomp.medial.moved import moved_skeleton
from decomp.medial.result import Skeleton
from decomp.sampled.sampling import sampled_skeleton

Method = Literal["auto", "traced", "sampled"]

Progress = Callable[[str, float], None]


def skeleton(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
    method: Method = "traced",
) -> Skeleton:
    """The exact interior skeleton of a model.

    Args:
        source: a geometry, or what one can be made of.
        tolerance: largest distance of triangles from their exact surfaces, relative to the
            model's diagonal.
        progress: told what is being done, and which part of the whole (0 to 1) is behind.
        method: `traced` follows the skeleton's curves; `sampled` takes the walls between points
            with different nearest sites, with every vertex placed exactly; `auto` is traced, and
            sampled where that fails. Each region's `method` tells which it was, and its `cause`
            why it was not traced.

    Raises:
        FileError: the file cannot be read.
        InputError: there is no such method, or the tolerance or the progress are none.
        GeometryError: the solid, or its skeleton, cannot be computed; says where and what was
            tried.
    """
    if method not in get_args(Method):
        raise InputError(f"method must be one of {get_args(Method)}, got {method!r}")
    tolerance = checked(tolerance, progress)
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    tell = progress or (lambda what, done: None)
    if method == "sampled":
        return _sampled(geometry, tolerance, tell)
    try:
        return traced_skeleton(geometry, tolerance, progress)
    except GeometryError as error:
        if method == "traced":
            raise
        first = error
    try:
        found = _sampled(geometry, tolerance, tell)
    except GeometryError as error:
        raise first.advised(f"sampled instead: {error}") from None
    cause = str(first)
    return replace(found, regions=tuple(replace(each, cause=cause) for each in found.regions))


def _sampled(geometry: Geometry, tolerance: float, tell: Progress) -> Skeleton:
    with geometry.frame(), located(geometry):
        found = sampled_skeleton(geometry.local, tolerance, tell)
    return moved_skeleton(found, geometry.offset)
