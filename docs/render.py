"""Draw a model with its faces in different colours, by tracing rays through the exact distance.

    pip install pillow
    python docs/render.py meshes/flange.geo docs/pictures/flange.png

Along a ray one may always step on by the distance to the boundary (J. C. Hart, Sphere tracing,
1996), and the nearest-site query gives that distance, the face it belongs to and the foot.
"""

from __future__ import annotations

import argparse
import colorsys
from pathlib import Path

import numpy as np
from PIL import Image

import decomp
from decomp.vectors import Array, dot, norm

WIDTH, HEIGHT, OVERSAMPLING = 900, 600, 2
STEPS = 300


def camera(geometry: decomp.Geometry) -> tuple[Array, Array]:
    """Origins and directions of the rays of a parallel view from above the front right."""
    low = np.min([r.bounds[0] for r in geometry.regions], axis=0)
    high = np.max([r.bounds[1] for r in geometry.regions], axis=0)
    look = np.array([-0.55, 0.65, -0.6]) / norm(np.array([-0.55, 0.65, -0.6]))
    right = np.cross(look, [0, 0, 1])
    right /= norm(right)
    up = np.cross(right, look)
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    middle = (low + high) / 2
    span = np.abs((corners - middle) @ np.stack([right, up]).T).max(axis=0) * 1.06
    scale = max(span[0] / WIDTH, span[1] / HEIGHT)
    w, h = WIDTH * OVERSAMPLING, HEIGHT * OVERSAMPLING
    x, y = np.meshgrid(np.linspace(-1, 1, w) * WIDTH, np.linspace(1, -1, h) * HEIGHT)
    origins = (
        middle
        + scale * (x.reshape(-1, 1) * right + y.reshape(-1, 1) * up)
        - geometry.diagonal * look
    )
    return origins, look


def trace(geometry: decomp.Geometry, origins: Array, look: Array) -> tuple[Array, Array, Array]:
    """For each ray the site it meets (-1 for none), the shade, and the point."""
    site = np.full(len(origins), -1)
    points = origins.copy()
    alive = np.arange(len(origins))
    tolerance = 1e-6 * geometry.diagonal
    for _ in range(STEPS):
        found = geometry.nearest(points[alive])
        step = np.where(found.region < 0, found.distance, 0.0)
        hit = step < tolerance
        site[alive[hit]] = found.site[hit]
        points[alive] += step[:, None] * look
        gone = dot(points[alive] - origins[alive], look[None, :]) > 2.2 * geometry.diagonal
        alive = alive[~hit & ~gone]
        if not len(alive):
            break
    met = np.flatnonzero(site >= 0)
    outside = points[met] - 1e-4 * geometry.diagonal * look
    found = geometry.nearest(outside)
    normals = outside - found.foot
    normals /= np.maximum(norm(normals), 1e-300)[:, None]
    light = np.array([0.35, -0.6, 0.72])
    shade = np.zeros(len(origins))
    shade[met] = 0.45 + 0.55 * np.clip(normals @ (light / norm(light)), 0, 1)
    site[met] = found.site
    return site, shade, points


def picture(geometry: decomp.Geometry) -> Image.Image:
    """Colour every face, darken the lines between faces."""
    origins, look = camera(geometry)
    site, shade, _ = trace(geometry, origins, look)
    hues = (np.arange(len(geometry.sites)) * 0.61803) % 1.0
    palette = np.array([colorsys.hls_to_rgb(h, 0.62, 0.5) for h in hues])
    colour = np.where((site >= 0)[:, None], palette[site] * shade[:, None], 1.0)
    h, w = HEIGHT * OVERSAMPLING, WIDTH * OVERSAMPLING
    grid = site.reshape(h, w)
    edge = np.zeros((h, w), dtype=bool)
    edge[:, 1:] |= grid[:, 1:] != grid[:, :-1]
    edge[1:] |= grid[1:] != grid[:-1]
    rgb = colour.reshape(h, w, 3)
    rgb[edge] = 0.12
    image = Image.fromarray((rgb * 255).astype(np.uint8))
    return image.resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def main() -> None:
    """Read a model, write a picture."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path)
    parser.add_argument("output", type=Path)
    options = parser.parse_args()
    picture(decomp.Geometry(options.model)).save(options.output, optimize=True)


if __name__ == "__main__":
    main()
