"""A picture (.png) of a mesh cut open: a colour for each cell or region, every element's edges.

The half of the tetrahedra that is nearer to the eye is left away, so that cells show inside. It is
drawn here, with a depth buffer, as a picture must come out on machines without a display.
"""

from __future__ import annotations

import colorsys

import numpy as np
from numpy.typing import NDArray

from decomp.output.mesh import png
from decomp.tetra.incidence import faces_of, row_keys
from decomp.tetra.mesh import TetMesh
from decomp.tracing.compiled import scalar
from decomp.vectors import Array, Ints, cross, norm

WIDTH, HEIGHT, FINER = 1200, 900, 2
"""Size of the picture, and how much finer it is drawn, to be smooth."""
EYE = np.array([0.45, -0.75, 0.48])
"""Where the picture is taken from, seen from the model's middle."""
CUT = np.array([0.0, -1.0, 0.0])
"""Tetrahedra on this side of the middle are left away."""
LIGHT = np.array([0.2, -0.6, 0.77])
MARGIN, EDGE, DARK = 0.05, 0.8, 0.45
"""Share of the picture left free; half an edge's width in drawn pixels; its brightness."""


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file."""
    triangles, groups = _shown(mesh)
    corners = mesh.points[triangles]
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    seen = normal @ EYE > 0
    image = painted(corners[seen], _palette(int(groups.max()) + 1)[groups[seen]])
    return png.encoded(smaller(image))


def painted(corners: Array, colours: Array) -> Array:
    """An image (HEIGHT, WIDTH, 3, each FINER times) of triangles (k, 3, 3), lit from above."""
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(norm(normal), 1e-300)[:, None]
    bright = 0.55 + 0.45 * np.abs(normal @ (LIGHT / np.linalg.norm(LIGHT)))
    size = (HEIGHT * FINER, WIDTH * FINER)
    image = np.ones((*size, 3))
    if len(corners):
        draw(projected(corners), colours * bright[:, None], image, np.full(size, -np.inf))
    return image


def smaller(image: Array) -> NDArray[np.uint8]:
    """An image in its final size, with smooth edges."""
    small = image.reshape(HEIGHT, FINER, WIDTH, FINER, 3).mean(axis=(1, 3))
    return np.asarray(255 * np.clip(small, 0, 1) + 0.5).astype(np.uint8)


def _shown(mesh: TetMesh) -> tuple[Ints, Ints]:
    """The hull (k, 3) of the half that is left, pointing out, and the cells or regions (k,)."""
    middle = (mesh.points.min(axis=0) + mesh.points.max(axis=0)) / 2
    behind = (mesh.points[mesh.tets[:, :4]].mean(axis=1) - middle) @ CUT < 0
    tets, tags = mesh.tets[behind], mesh.all_parts.of_tets[behind]
    faces = faces_of(tets)
    _, first, count = np.unique(row_keys(faces), return_index=True, return_counts=True)
    outer = first[count == 1]
    return faces[outer], tags[outer // 4]


def projected(corners: Array) -> Array:
    """Corners (k, 3, 3) as column and row in the picture, and depth towards the eye."""
    eye = EYE / np.linalg.norm(EYE)
    right = cross(np.array([0.0, 0.0, 1.0]), eye)
    right /= np.linalg.norm(right)
    axes = np.stack([right, -cross(eye, right), eye])
    flat = corners.reshape(-1, 3) @ axes[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    size = FINER * np.array([WIDTH, HEIGHT])
    scale = float(((1 - 2 * MARGIN) * size / np.maximum(high - low, 1e-300)).min())
    result = corners @ axes.T * scale
    result[..., :2] += size / 2 - (low + high) / 2 * scale
    return np.asarray(result)


def _palette(count: int) -> Array:
    """So many colours (count, 3) from 0 to 1, neighbours far apart."""
    tones = [(0.61803 * k % 1.0, (0.55, 0.65, 0.74)[k % 3], 0.6) for k in range(count)]
    return np.array([colorsys.hls_to_rgb(*tone) for tone in tones])


@scalar
def draw(screen: Array, colours: Array, image: Array, depth: Array) -> None:
    """Fill triangles (k, 3, 3) into the picture where nothing nearer is; edges are darker."""
    height, width = depth.shape
    for k in range(len(screen)):
        ax, ay, az = screen[k, 0, 0], screen[k, 0, 1], screen[k, 0, 2]
        bx, by, bz = screen[k, 1, 0], screen[k, 1, 1], screen[k, 1, 2]
        cx, cy, cz = screen[k, 2, 0], screen[k, 2, 1], screen[k, 2, 2]
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if area == 0.0:
            continue
        # heights of the corners over the opposite sides, in pixels
        ha = abs(area) / max(((bx - cx) ** 2 + (by - cy) ** 2) ** 0.5, 1e-300)
        hb = abs(area) / max(((ax - cx) ** 2 + (ay - cy) ** 2) ** 0.5, 1e-300)
        hc = abs(area) / max(((ax - bx) ** 2 + (ay - by) ** 2) ** 0.5, 1e-300)
        for row in range(max(0, int(min(ay, by, cy))), min(height, int(max(ay, by, cy)) + 1)):
            y = row + 0.5
            for column in range(max(0, int(min(ax, bx, cx))), min(width, int(max(ax, bx, cx)) + 1)):
                x = column + 0.5
                u = ((bx - x) * (cy - y) - (cx - x) * (by - y)) / area
                v = ((cx - x) * (ay - y) - (ax - x) * (cy - y)) / area
                w = 1.0 - u - v
                z = u * az + v * bz + w * cz
                if u < 0.0 or v < 0.0 or w < 0.0 or z <= depth[row, column]:
                    continue
                depth[row, column] = z
                near = min(u * ha, v * hb, w * hc)
                shade = DARK if near < EDGE else 1.0
                for channel in range(3):
                    image[row, column, channel] = colours[k, channel] * shade
