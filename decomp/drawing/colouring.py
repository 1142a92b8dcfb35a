"""Which colour each part and each region of a scene has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.drawing.colours import CATEGORIES, PALETTE, spread
from decomp.drawing.scene import GROUPS, Part, Scene


@dataclass(frozen=True)
class Colouring:
    """Numbers into `PALETTE`.

    Args:
        parts: of each part of the scene, among those of its group.
        regions: by the names of regions.
    """

    parts: tuple[int, ...]
    regions: dict[str, int]


def colouring(scene: Scene) -> Colouring:
    """Choose colours: neighbours in a group differ, and neighbouring regions."""
    parts = [0] * len(scene.parts)
    for group in GROUPS:
        own = [k for k, part in enumerate(scene.parts) if part.group == group]
        pieces = [scene.parts[k].triangles.reshape(-1) for k in own]
        for k, colour in zip(own, spread(pieces, len(scene.points)), strict=True):
            parts[k] = colour
    names = region_names(scene)
    pieces = [
        np.concatenate([p.triangles.reshape(-1) for p in scene.parts if p.region == name])
        for name in names
    ]
    return Colouring(tuple(parts), dict(zip(names, spread(pieces, len(scene.points)), strict=True)))


def region_names(scene: Scene) -> list[str]:
    """The regions that parts are of alone, each once."""
    names = dict.fromkeys(part.region for part in scene.parts if "|" not in part.region)
    return [name for name in names if name]


@dataclass(frozen=True)
class Shown:
    """A part that is seen first.

    Args:
        number: of the part in the scene.
        part: itself.
        colour: such as #0072B2.
        label: what this colour stands for.
    """

    number: int
    part: Part
    colour: str
    label: str


def shown(scene: Scene) -> list[Shown]:
    """The parts of the opaque group, in the colours that are seen first.

    Sheets by kind of surface if there are several kinds, cells of several regions by region, and
    all else each in its own.
    """
    found = colouring(scene)
    own = [(k, part) for k, part in enumerate(scene.parts) if part.group == scene.opaque]
    kinds = list(dict.fromkeys(part.kind for _, part in own))
    by_region = scene.body is not None and len({part.region for _, part in own}) > 1
    result = []
    for k, part in own:
        colour, label = PALETTE[found.parts[k]], part.name
        if len(kinds) > 1:
            colour, label = CATEGORIES[kinds.index(part.kind) % len(CATEGORIES)], part.kind
        elif by_region:
            colour, label = PALETTE[found.regions[part.region]], part.region
        result.append(Shown(k, part, colour, label))
    return result
