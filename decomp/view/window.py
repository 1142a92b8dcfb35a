"""A scene in a window of PyVista's."""

from __future__ import annotations

from typing import Any

import numpy as np

from decomp.view.colours import CATEGORIES
from decomp.view.scene import Scene


def plotter(scene: Scene, pyvista: Any, **options: Any) -> Any:
    """A `pyvista.Plotter` with all parts: sheets (else cells) opaque, faces as glass.

    Args:
        scene: to show.
        pyvista: the module.
        options: of the plotter.
    """
    result = pyvista.Plotter(title=f"{scene.title} - decomp", **options)
    groups = {part.group for part in scene.parts}
    solid = "cell" if scene.values == "quality" or "sheet" not in groups else "sheet"
    kinds = list(dict.fromkeys(part.kind for part in scene.parts if part.group == solid))
    number = 0
    for part in scene.parts:
        if part.group not in (solid, "face"):
            continue
        triangles = np.arange(3 * len(part.corners)).reshape(-1, 3)
        mesh = pyvista.PolyData.from_regular_faces(part.corners.reshape(-1, 3), triangles)
        if part.group == "face":
            result.add_mesh(mesh, color="#999999", opacity=0.15, name=f"face {part.name}")
            continue
        k = kinds.index(part.kind) if len(kinds) > 1 else number
        colour = CATEGORIES[k % len(CATEGORIES)]
        result.add_mesh(mesh, color=colour, name=part.name, label=part.name)
        number += 1
    result.add_axes()
    return result
