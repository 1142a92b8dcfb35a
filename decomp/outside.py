"""The space around a model, out to a ball or a box, as a region of its own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Literal, get_args

from decomp.arguments import one_of, switch
from decomp.csg.model import Model, Region
from decomp.csg.primitives import Block, Sphere
from decomp.csg.solid import Solid, union
from decomp.errors import InputError
from decomp.geometry import Geometry
from decomp.vectors import Array, number

Shape = Literal["ball", "box"]
SHAPES: tuple[Shape, ...] = get_args(Shape)
OUTSIDE, FAR = "outside", "far"
"""Names of the region and of the primitive that bounds it."""
FACTOR = 2.0
"""Half its size by default, in diagonals of the model."""
LEAST_FACTOR, MOST_FACTOR = 0.51, 1e4
"""The least reaches past every corner of the model; beyond the most it is a point."""


def with_outside(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    shape: Shape = "ball",
    factor: float = FACTOR,
    *,
    only: bool = False,
) -> Model:
    """The model with the space around it, for flow, far fields, or its exterior skeleton.

    The space is the region `outside`: the complement of all other regions in a ball or box about
    the model's middle. Its far faces are `far.surface` of a ball, `far.xmin` to `far.zmax` of a
    box; what it shares with other regions are interfaces.

    Args:
        source: a geometry, or what one can be made of.
        shape: `ball` or `box`.
        factor: the ball's radius, or half the box's width along each axis, in diagonals of the
            box around the model; from 0.51.
        only: leave the model's regions out; their faces are the walls of holes then.

    Raises:
        InputError: an option is of a wrong kind or out of its range, or the model has a region of
            that name already.
        FileError: the file cannot be read.
        GeometryError: the model's boundary cannot be computed.
    """
    shape = one_of(shape, SHAPES, "shape")
    factor = number(factor, "factor")
    switch(only, "only")
    if not LEAST_FACTOR <= factor <= MOST_FACTOR:
        raise InputError(
            f"factor must be from {LEAST_FACTOR:g} to {MOST_FACTOR:g} diagonals, got {factor:g}"
        )
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    regions = geometry.model.regions
    if any(region.name == OUTSIDE for region in regions):
        raise InputError(f"the model has a region {OUTSIDE!r} already: rename it")
    box = geometry.boundaries.box + geometry.offset
    far = _far(shape, box.mean(axis=0), factor * geometry.diagonal)
    around = Region(OUTSIDE, far - union([region.solid for region in regions]))
    return replace(geometry.model, regions=(around,) if only else (*regions, around))


def _far(shape: Shape, centre: Array, half: float) -> Solid:
    if shape == "ball":
        return Sphere(centre, half, name=FAR)
    return Block.between(centre - half, centre + half, name=FAR)
