"""`decomp.skeleton()`: each region traced, or sampled where tracing fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, get_args

from decomp.attempts import first_cause
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import ContactError, GeometryError, InputError
from decomp.geometry import Geometry
from decomp.located import located
from decomp.sampled.sampling import Sampled, TracedRegionError, sampled_skeleton
from decomp.skeletons.compute import checked
from decomp.skeletons.compute import skeleton as traced_skeleton
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.drafts import SAMPLES, traced_alone
from decomp.skeletons.model import Method as Found
from decomp.skeletons.model import Skeleton
from decomp.skeletons.moved import moved_skeleton
from decomp.tolerance import CHORDS

Method = Literal["auto", "traced", "sampled"]

Progress = Callable[[str, float], None]


def skeleton(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    tolerance: float = CHORDS,
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
            sampled where that fails, region by region. Each region's `method` tells which it was,
            and its `cause` why it was not traced.

    Raises:
        FileError: the file cannot be read.
        InputError: there is no such method, or the tolerance or the progress are none.
        GeometryError: the solid, or its skeleton, cannot be computed; says where and what was
            tried.
    """
    method = checked_method(method)
    tolerance = checked(tolerance, progress)
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    tell = progress or (lambda what, done: None)
    if method == "sampled":
        with geometry.frame(), located(geometry):
            found = sampled_skeleton(geometry.local, tolerance, tell).skeleton
        return moved_skeleton(found, geometry.offset)
    try:
        return traced_skeleton(geometry, tolerance, progress)
    except GeometryError as error:
        if method == "traced" or isinstance(error, ContactError):
            raise
        first = error
    with geometry.frame(), located(geometry):
        rest = sampled_where_refused(geometry.local, tolerance, tell, first)
    return moved_skeleton(rest.skeleton, geometry.offset)


def checked_method(method: object) -> Method:
    """The name of a way as it is given.

    Raises:
        InputError: there is no such way.
    """
    for known in get_args(Method):
        if method == known:
            return known  # type: ignore[no-any-return]
    raise InputError(f"method must be one of {get_args(Method)}, got {method!r}")


@dataclass(frozen=True, eq=False)
class _Regions:
    """Which regions are traced, and why the others are not."""

    curves: dict[int, RegionCurves]
    refused: dict[int, GeometryError]


def sampled_where_refused(
    geometry: Geometry, tolerance: float, tell: Progress, first: GeometryError
) -> Sampled:
    """The skeleton of a model that cannot be traced as a whole.

    Regions that can be traced are; if one of them cannot be finished beside the others, all are
    sampled.

    Args:
        geometry: of the model.
        tolerance: chord tolerance, relative to the model's diagonal.
        tell: of the progress.
        first: what tracing said.

    Raises:
        GeometryError: `first`, with what sampling said among its tries.
    """
    regions = _traced_apart(geometry, tell, first)
    try:
        try:
            made = sampled_skeleton(geometry, tolerance, tell, regions.curves)
        except TracedRegionError as error:
            refused = {n: regions.refused.get(n, error) for n in range(len(geometry.regions))}
            regions = _Regions({}, refused)
            made = sampled_skeleton(geometry, tolerance, tell)
    except GeometryError as error:
        told = first.advised(f"sampled instead: {error}")
        told.tries = first_cause([("traced", first), ("sampled", error)]).tries
        raise told from error
    found = tuple(
        replace(each, cause=str(regions.refused[number])) if each.method is Found.SAMPLED else each
        for number, each in enumerate(made.skeleton.regions)
    )
    return replace(made, skeleton=replace(made.skeleton, regions=found))


def _traced_apart(geometry: Geometry, tell: Progress, first: GeometryError) -> _Regions:
    """The curves of all regions that have some; of the only one nothing more is asked."""
    count = len(geometry.regions)
    names = [region.name for region in geometry.regions]
    if count == 1 or first.region not in names:
        return _Regions({}, dict.fromkeys(range(count), first))
    curves, refused = {}, {names.index(first.region): first}
    for number in range(count):
        if number in refused:
            continue
        try:
            curves[number] = traced_alone(geometry, number, SAMPLES[0], tell)
        except GeometryError as error:
            refused[number] = error
    return _Regions(curves, refused)
