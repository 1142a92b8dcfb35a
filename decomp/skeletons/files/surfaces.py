"""What a sheet lies on, as JSON values."""

from __future__ import annotations

from typing import Any

from decomp.skeletons.model import RegionSkeleton, Sheet, Skeleton
from decomp.skeletons.sheet_kinds import SheetKind, sheet_kind

DIGITS = 15


def surface_values(
    skeleton: Skeleton, region: RegionSkeleton, sheet: Sheet, digits: int = DIGITS
) -> dict[str, Any]:
    """Kind, degree, equation and, where the kind has them, canonical parameters.

    The equation has integer coefficients where they are short, else rounded ones of which the
    largest is 1; its x, y and z are counted from `Skeleton.offset`, as coefficients have no digits
    for a model far from the origin. Origin and axes (as rows) are the frame in which the kind's
    canonical equation holds; of a surface of revolution that meets its axis the tips, and whether
    between two of them it has a spindle; lengths are in the model's units, angles in radians. Where
    the nearest point of a cone is its apex, the sheet goes over to another surface: `also`. Where
    the sheet lies on a part of a Voronoi surface, as on one plane of a pair, the whole is told too:
    `part_of`. Where no
    equation is known a remark says why.
    """
    return lies_on(sheet_kind(skeleton, region, sheet), digits)


def lies_on(found: SheetKind, digits: int = DIGITS) -> dict[str, Any]:
    """The same of a sheet whose kind is known."""
    values = _values(found, digits)
    if found.part_of is not None:
        whole = found.part_of
        values["part_of"] = {
            "kind": whole.kind.value,
            "degree": whole.degree,
            "equation": None if whole.polynomial is None else whole.polynomial.decimals(digits),
        }
    if found.also:
        values["also"] = [_values(other, digits) for other in found.also]
    return values


def _values(found: SheetKind, digits: int) -> dict[str, Any]:
    values: dict[str, Any] = {
        "kind": found.kind.value,
        "degree": found.degree,
        "equation": found.equation(digits),
    }
    if values["equation"] is None and found.surface is not None:
        values["remark"] = found.surface.remark
    if found.shape is not None:
        values["origin"] = (found.shape.origin + found.offset).tolist()
        values["axes"] = found.shape.axes.tolist()
        values["parameters"] = {name: float(v) for name, v in found.shape.parameters.items()}
        if len(found.shape.tips):
            values["tips"] = (found.shape.tips + found.offset).tolist()
            values["spindle"] = found.shape.spindle
    return values
