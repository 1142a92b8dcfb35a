"""A scene as an image (.png), drawn here, as it must come out on machines without a display."""

from __future__ import annotations

import numpy as np

from decomp.output.mesh.picture import painted, smaller
from decomp.output.mesh.png import encoded as png
from decomp.view.colouring import coloured
from decomp.view.colours import rgb
from decomp.view.scene import Scene


def encoded(scene: Scene) -> bytes:
    """The contents of a file: the sheets, or the cells where there are none."""
    corners, colours = [np.empty((0, 3, 3))], [np.empty((0, 3))]
    for part, colour in coloured(scene):
        corners.append(scene.corners(part))
        colours.append(np.tile(rgb(colour), (len(part.triangles), 1)))
    return png(smaller(painted(np.concatenate(corners), np.concatenate(colours))))
