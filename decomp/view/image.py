"""A scene as an image (.png), drawn here, as it must come out on machines without a display."""

from __future__ import annotations

import numpy as np

from decomp.output.mesh.picture import EYE, FINER, HEIGHT, LIGHT, WIDTH, draw, projected
from decomp.output.mesh.png import encoded as png
from decomp.vectors import Array, cross, norm
from decomp.view.colours import CATEGORIES, rgb
from decomp.view.scene import Scene


def encoded(scene: Scene) -> bytes:
    """The contents of a file: the sheets, or the cells where there are none."""
    groups = {part.group for part in scene.parts}
    group = "cell" if scene.values == "quality" or "sheet" not in groups else "sheet"
    shown = [part for part in scene.parts if part.group == group]
    kinds = list(dict.fromkeys(part.kind for part in shown))
    by_kind = len(kinds) > 1
    corners, colours = [np.empty((0, 3, 3))], [np.empty((0, 3))]
    for number, part in enumerate(shown):
        k = kinds.index(part.kind) if by_kind else number
        corners.append(part.corners)
        colours.append(np.tile(rgb(CATEGORIES[k % len(CATEGORIES)]), (len(part.corners), 1)))
    return _drawn(np.concatenate(corners), np.concatenate(colours))


def _drawn(corners: Array, colours: Array) -> bytes:
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(norm(normal), 1e-300)[:, None]
    normal *= np.where(normal @ EYE < 0, -1.0, 1.0)[:, None]
    bright = 0.55 + 0.45 * np.abs(normal @ (LIGHT / np.linalg.norm(LIGHT)))
    size = (HEIGHT * FINER, WIDTH * FINER)
    image = np.ones((*size, 3))
    if len(corners):
        draw(projected(corners), colours * bright[:, None], image, np.full(size, -np.inf))
    small = image.reshape(HEIGHT, FINER, WIDTH, FINER, 3).mean(axis=(1, 3))
    return png((255 * np.clip(small, 0, 1) + 0.5).astype(np.uint8))
