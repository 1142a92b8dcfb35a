"""Draw skeletons: every sheet in a colour of its own, reflexive curves and points in black.

    pip install decomp[docs]
    python docs/render_skeletons.py MODEL.geo docs/pictures/model-skeleton.png
    python docs/render_skeletons.py --dozen docs/pictures

The second form draws a dozen solids of the shared table. The boundary is shown by its edges.
"""

from __future__ import annotations

import argparse
import colorsys
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyvista
from PIL import Image

from decomp.errors import GeometryError
from decomp.skeletons.files.elements import KINDS, Elements, elements
from decomp.skeletons.model import Skeleton

SIZE = (1000, 750)
VIEW = np.array([0.47, -0.74, 0.48])
OPACITY = 0.78
DOZEN = (
    "block", "cylinder", "through hole", "blind hole", "bracket", "pocket", "fichera", "slot",
    "round boss", "square boss", "countersink", "oblique cone",
)  # fmt: skip


def colours(count: int) -> Any:
    """So many colours (count, 3) from 0 to 255, neighbours far apart."""
    tones = [
        colorsys.hls_to_rgb((0.61803 * k) % 1.0, (0.5, 0.62, 0.72)[k % 3], 0.62)
        for k in range(count)
    ]
    return (np.array(tones).reshape(-1, 3) * 255).astype(np.uint8)


def segments_of(parts: Elements, kinds: tuple[str, ...]) -> Any:
    """The segments of some kinds as lines, None if there are none."""
    count = len(parts.triangles)
    kind = parts.kind[count : count + len(parts.segments)]
    chosen = parts.segments[np.isin(kind, [KINDS.index(name) for name in kinds])]
    if not len(chosen):
        return None
    return pyvista.PolyData(parts.points, lines=np.insert(chosen, 0, 2, axis=1).reshape(-1))


def draw(skeleton: Skeleton, path: Path, wires: bool) -> None:
    """Write a picture of a skeleton.

    Args:
        skeleton: to draw.
        path: of the PNG file.
        wires: draw the triangles' sides too.
    """
    parts = elements(skeleton, boundary=True)
    plotter = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.set_background("white")
    plotter.enable_depth_peeling(number_of_peels=12)
    plotter.enable_anti_aliasing("ssaa")
    sheet = parts.sheet[: len(parts.triangles)]
    plotter.add_mesh(surface_of(parts, sheet < 0), color="#b0c4de", opacity=0.07)
    if (sheet >= 0).any():
        surface = surface_of(parts, sheet >= 0)
        surface.cell_data["colour"] = colours(len(parts.sheet_names))[sheet[sheet >= 0]]
        light = {"ambient": 0.35, "diffuse": 0.65}
        sides = {"show_edges": wires, "edge_color": "#606060"}
        plotter.add_mesh(surface, scalars="colour", rgb=True, opacity=OPACITY, **light, **sides)
    for kinds, colour, width in (
        (("edge",), "#9a9a9a", 1.5),
        (("seam", "rim"), "#303030", 2.5),
        (("reflexive",), "black", 6),
    ):
        lines = segments_of(parts, kinds)
        if lines is not None:
            plotter.add_mesh(lines, color=colour, line_width=width, lighting=False)
    for point in parts.points[parts.singles[:, 0]]:
        dot = pyvista.Sphere(radius=0.008 * skeleton.diagonal, center=point)
        plotter.add_mesh(dot, color="black")
    look_at(plotter, parts.points)
    picture = Image.fromarray(plotter.screenshot(None, return_img=True))
    picture.quantize(128).save(path, optimize=True)
    plotter.close()


def surface_of(parts: Elements, chosen: Any) -> Any:
    """Some of the triangles as a surface."""
    faces = np.insert(parts.triangles[chosen], 0, 3, axis=1).reshape(-1)
    return pyvista.PolyData(parts.points, faces)


def look_at(plotter: Any, points: Any) -> None:
    """A parallel view of points (n, 3) that fills the picture."""
    right = np.cross([0, 0, 1], VIEW)
    right /= np.linalg.norm(right)
    up = np.cross(VIEW, right) / np.linalg.norm(VIEW)
    flat = points @ np.stack([right, up]).T
    low, high = flat.min(axis=0), flat.max(axis=0)
    reach = float(np.linalg.norm(np.ptp(points, axis=0)))
    middle = points.mean(axis=0)
    at = (low + high) / 2 - np.stack([right, up]) @ middle
    focus = middle + at[0] * right + at[1] * up
    plotter.enable_parallel_projection()
    plotter.camera_position = [tuple(focus + 3 * reach * VIEW), tuple(focus), (0, 0, 1)]
    width, height = (high - low) / 2
    plotter.camera.parallel_scale = 1.05 * max(height, width * SIZE[1] / SIZE[0])
    plotter.camera.clipping_range = (0.1 * reach, 10 * reach)


def main() -> int:
    """Compute and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path, nargs="?", help="a model file")
    parser.add_argument("output", type=Path, help="PNG file, or a directory with --dozen")
    parser.add_argument("--dozen", action="store_true", help="draw a dozen of known solids")
    parser.add_argument("--wires", action="store_true", help="draw the triangles' sides")
    options = parser.parse_args()
    if options.dozen == (options.model is not None):
        parser.error("give a model file or --dozen")

    from decomp.skeletons.compute import skeleton

    if not options.dozen:
        draw(skeleton(options.model), options.output, options.wires)
        return 0
    sys.path.insert(0, str(Path(__file__).parents[1]))
    from tests.solids import SOLIDS

    failed = 0
    for name in DOZEN:
        path = options.output / f"skeleton-{name.replace(' ', '-')}.png"
        try:
            draw(skeleton(SOLIDS[name].make()), path, options.wires)
        except GeometryError as error:
            print(f"{name}: {error}", file=sys.stderr)
            failed = 1
        else:
            print(path, flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main())
