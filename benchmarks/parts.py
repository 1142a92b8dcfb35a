"""Parts as engineers draw them, of random sizes: plates, angles, housings, flanges and more."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import cos, pi, sin
from typing import Any

import numpy as np

import decomp
from decomp.csg.solid import Solid

Make = Callable[[], Solid]


class Rounded:
    """Uniform random numbers, rounded to some digits if any are given."""

    def __init__(self, rng: np.random.Generator, digits: int | None) -> None:
        self._rng, self._digits = rng, digits

    def uniform(self, low: Any, high: Any) -> Any:
        """Between low and high, which are numbers or lists of them."""
        found = self._rng.uniform(low, high)
        return found if self._digits is None else np.round(found, self._digits)

    def count(self, low: int, high: int) -> int:
        """A whole number from low to high."""
        return int(self._rng.integers(low, high + 1))


def plate(rng: Rounded) -> Solid:
    """A plate with a bore along it."""
    length, width, height = rng.uniform([30, 20, 5], [80, 50, 12])
    radius = rng.uniform(0.1 * height, 0.3 * height)
    y = rng.uniform(radius + 1, width - radius - 1)
    z = rng.uniform(radius + 0.6, height - radius - 0.6)
    bore = decomp.Cylinder((-1, y, z), (length + 1, y, z), radius, name="bore")
    return decomp.Block((0, 0, 0), (length, width, height), name="plate") - bore


def angle(rng: Rounded) -> Solid:
    """An L profile with a bore across one of its legs."""
    length, leg, other, thick = rng.uniform([30, 20, 20, 3], [80, 40, 40, 8])
    radius = rng.uniform(1, 0.35 * (leg - thick))
    x = rng.uniform(radius + 1, length - radius - 1)
    y = rng.uniform(thick + radius + 0.5, leg - radius - 0.5)
    body = decomp.Block((0, 0, 0), (length, leg, thick), name="foot")
    body = body | decomp.Block((0, 0, 0), (length, thick, other), name="wall")
    return body - decomp.Cylinder((x, y, -1), (x, y, thick + 1), radius, name="bore")


def housing(rng: Rounded) -> Solid:
    """An open box with a bore through one of its walls."""
    length, width, height, wall = rng.uniform([40, 30, 20, 2], [90, 60, 40, 6])
    radius = rng.uniform(1, 0.3 * (height - wall))
    x = rng.uniform(wall + radius + 1, length - wall - radius - 1)
    z = rng.uniform(wall + radius + 1, height - radius - 1)
    body = decomp.Block((0, 0, 0), (length, width, height), name="box")
    inner = (length - 2 * wall, width - 2 * wall, height)
    room = decomp.Block((wall, wall, wall), inner, name="room")
    return body - room - decomp.Cylinder((x, -1, z), (x, wall + 1, z), radius, name="bore")


def flange(rng: Rounded) -> Solid:
    """A disc with a hub, a bore through both, and bolts around it."""
    radius, thick, hub, high = rng.uniform([30, 5, 12, 8], [60, 12, 20, 25])
    bore = rng.uniform(0.4 * hub, 0.8 * hub)
    disc = decomp.Cylinder((0, 0, 0), (0, 0, thick), radius, name="disc")
    solid = disc | decomp.Cylinder((0, 0, 0), (0, 0, thick + high), hub, name="hub")
    solid = solid - decomp.Cylinder((0, 0, -1), (0, 0, thick + high + 1), bore, name="bore")
    number, around, size = rng.count(3, 6), (radius + hub) / 2, (radius - hub) / 6
    for k in range(number):
        x, y = around * cos(2 * pi * k / number), around * sin(2 * pi * k / number)
        solid = solid - decomp.Cylinder((x, y, -1), (x, y, thick + 1), size, name=f"bolt{k}")
    return solid


def shaft(rng: Rounded) -> Solid:
    """Three steps, a keyway with square ends, a centre bore."""
    radii, lengths = rng.uniform([8, 11, 7], [11, 15, 10]), rng.uniform([20] * 3, [40] * 3)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    steps = [
        decomp.Cylinder((ends[k], 0, 0), (ends[k + 1], 0, 0), radii[k], name=f"step{k}")
        for k in range(3)
    ]
    wide, deep = rng.uniform([3, 2], [6, 4])
    start, end = ends[1] + 0.2 * lengths[1], ends[1] + 0.8 * lengths[1]
    key = decomp.Block(
        (start, -wide / 2, radii[1] - deep), (end - start, wide, deep + 1), name="key"
    )
    bore = decomp.Cylinder((-1, 0, 0), (0.4 * ends[1], 0, 0), 0.3 * radii[0], name="centre")
    return (steps[0] | steps[1] | steps[2]) - key - bore


def channel(rng: Rounded) -> Solid:
    """A U profile with a hole in each of its sides."""
    length, width, height, wall = rng.uniform([40, 25, 20, 3], [80, 45, 40, 6])
    solid = decomp.Block((0, 0, 0), (length, width, height), name="body") - decomp.Block(
        (-1, wall, wall), (length + 2, width - 2 * wall, height), name="room"
    )
    radius = rng.uniform(1.5, 0.25 * height)
    z = rng.uniform(wall + radius + 1, height - radius - 1)
    x = rng.uniform(radius + 2, length - radius - 2)
    return solid - decomp.Cylinder((x, -1, z), (x, width + 1, z), radius, name="pin")


def manifold(rng: Rounded) -> Solid:
    """A block with a bore along it that two others meet."""
    length, width, height = rng.uniform([50, 30, 25], [90, 50, 40])
    radius = rng.uniform(3, 0.3 * min(width, height))
    y, z = width / 2, height / 2
    solid = decomp.Block((0, 0, 0), (length, width, height), name="body")
    solid = solid - decomp.Cylinder((-1, y, z), (length + 1, y, z), radius, name="main")
    for k, share in enumerate((0.3, 0.7)):
        own = rng.uniform(0.4 * radius, 0.8 * radius)
        x = share * length
        solid = solid - decomp.Cylinder((x, y, z), (x, y, height + 1), own, name=f"port{k}")
    return solid


def nozzle(rng: Rounded) -> Solid:
    """A tube that goes on into a cone, both bored, and a collar."""
    radius, length, narrow, end = rng.uniform([10, 20, 3, 15], [16, 40, 5, 30])
    wall = rng.uniform(1.5, 3)
    tube = decomp.Cylinder((0, 0, 0), (0, 0, length), radius, name="tube")
    tip = decomp.Cone((0, 0, length), radius, (0, 0, length + end), narrow + wall, name="tip")
    collar = decomp.Cylinder((0, 0, 0), (0, 0, 4), radius + 6, name="collar")
    inside = decomp.Cylinder((0, 0, -1), (0, 0, length), radius - wall, name="bore")
    throat = decomp.Cone((0, 0, length), radius - wall, (0, 0, length + end), narrow, name="throat")
    mouth = decomp.Cylinder(
        (0, 0, length + end - 0.5), (0, 0, length + end + 1), narrow, name="mouth"
    )
    return (tube | tip | collar) - inside - throat - mouth


ONE_BORE = {"plate": plate, "angle": angle, "housing": housing}
FAMILIES = {
    **ONE_BORE,
    "flange": flange,
    "shaft": shaft,
    "channel": channel,
    "manifold": manifold,
    "nozzle": nozzle,
}


def drawn(
    families: list[str], count: int, first: int, digits: int | None, turned: bool
) -> Iterator[tuple[str, Make]]:
    """Parts of some families, one for each seed, their sizes rounded to some digits."""
    for family in families:
        for seed in range(first, first + count):

            def one(family: str = family, seed: int = seed) -> Solid:
                rng = np.random.default_rng(seed)
                solid = FAMILIES[family](Rounded(rng, digits))
                return solid.rotate(rng.normal(size=3), 360 * rng.random()) if turned else solid

            yield f"{family} {seed}", one
