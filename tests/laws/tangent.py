"""Solids whose parts touch: round numbers, so that surfaces are tangent, or nearly so."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from decomp.csg.primitives import Block, Cone, Cylinder, Sphere, Torus
from decomp.csg.solid import Solid

Rng = np.random.Generator


def _pick(rng: Rng, *values: float) -> float:
    return float(rng.choice(values))


def _miss(rng: Rng) -> float:
    """By how much a contact is missed: mostly not at all."""
    return _pick(rng, 0, 0, 0, 1e-4, -1e-4, 1e-2, -1e-2)


def slot_to_the_rim(rng: Rng) -> Solid:
    """A disc with a slot whose end plane is tangent to the rim."""
    r, wide = _pick(rng, 1.5, 2, 3), _pick(rng, 0.5, 0.75, 1)
    deep = _pick(rng, 0.25, 0.5, 1)
    disc = Cylinder((0, 0, -deep), (0, 0, deep), r)
    slot = Block.between((_pick(rng, -1, -0.5, 0.5), -wide, -2), (r + _miss(rng), wide, 2))
    return disc - slot


def post_at_a_wall(rng: Rng) -> Solid:
    """A round post whose side touches the plane of a block's side, from within or without."""
    r, high = _pick(rng, 0.5, 1), _pick(rng, 1, 2, 3)
    inside = _pick(rng, 1, -1)
    x = 2 - inside * r + _miss(rng)
    post = Cylinder((x, _pick(rng, -1, 0, 1), -0.5), (x, 0, high), r)
    upright = Cylinder((x, 0, _pick(rng, 0, 0.5)), (x, 0, high), r)
    return Block.between((-2, -2, -1), (2, 2, 1)) | (upright if rng.random() < 0.7 else post)


def crossing_tubes(rng: Rng) -> Solid:
    """Bars of one radius, or nearly so, whose axes meet."""
    r, s = 1.0, 1.0 + _miss(rng)
    one = Cylinder((-3, 0, 0), (3, 0, 0), r)
    two = Cylinder((0, -3, 0), (0, _pick(rng, 3, 0), 0), s)
    return [one | two, one & two, one - two][int(rng.integers(3))]


def ball_in_a_block(rng: Rng) -> Solid:
    """A ball that touches sides of a block."""
    half = _pick(rng, 0.5, 1)
    ball = Sphere((0, 0, _pick(rng, 0, 0.5, 1)), 1 + _miss(rng))
    block = Block.between((-1, -1, -half), (1, 2, _pick(rng, 1, 1.5, 2)))
    return [block & ball, block | ball, Block((-2, -2, -2), (4, 4, 4)) - (block & ball)][
        int(rng.integers(3))
    ]


def capsule(rng: Rng) -> Solid:
    """A rod with round ends."""
    ball = Sphere((0, 0, 1), 1 + _miss(rng))
    rod = Cylinder((0, 0, -1), (0, 0, 1), 1)
    return (rod | ball) - Block.between((1, -0.5, -0.5), (2, 0.5, 2))


def filleted_shaft(rng: Rng) -> Solid:
    """A shaft on a plate with a fillet, which leaves both of them tangentially."""
    minor = _pick(rng, 0.25, 0.5, 1)
    plate = Block.between((-2, -2, -1), (2, _pick(rng, 1, 1.5, 2), 0))
    shaft = Cylinder((0, 0, -0.5), (0, 0, 2), 1)
    ring = Torus((0, 0, minor), (0, 0, 1), 1 + minor + _miss(rng), minor)
    return plate | shaft | (Cylinder((0, 0, -0.5), (0, 0, minor), 1 + minor) - ring)


def cone_on_a_ball(rng: Rng) -> Solid:
    """A ball and a cone of half-angle 30 degrees around it that touches it along a circle."""
    ball = Sphere((0, 0, 0), 1 + _miss(rng))
    low = _pick(rng, 0.5, 0, -1)
    cone = Cone((0, 0, low), (2 - low) / np.sqrt(3), (0, 0, 2), 0.0)
    around = Block((-3, -3, -3), (6, 6, 6))
    return [ball | cone, cone & ball, around - (cone | ball)][int(rng.integers(3))]


def cone_on_a_plane(rng: Rng) -> Solid:
    """A cone whose side touches the plane of a block's top along a ruling."""
    cone = Cone((0, 0, 1), np.sqrt(17) / 4, (2, 0, 0.5), np.sqrt(17) / 8)
    top = _miss(rng)
    block = Block.between((_pick(rng, -1, 0.5, 1), -1, -1), (3, _pick(rng, 0, 1), top))
    return [block | cone, cone - Block.between((0.5, -1, -1), (1, 1, top))][int(rng.integers(2))]


KINDS: tuple[Callable[[Rng], Solid], ...] = (
    slot_to_the_rim,
    post_at_a_wall,
    crossing_tubes,
    ball_in_a_block,
    capsule,
    filleted_shaft,
    cone_on_a_ball,
    cone_on_a_plane,
)
