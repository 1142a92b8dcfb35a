"""Draw what `decomp mesh` does, step by step: `python docs/render_pipeline.py [OUT.png]`.

Five panels of one model: its faces, its skeleton, its cells pulled apart, the tetrahedra cut open,
and the boundary by name. Needs Pillow.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import decomp
from decomp.drawing.camera import ASLANT, fitted
from decomp.drawing.colours import CATEGORIES, rgb
from decomp.drawing.picture import FINER, HEIGHT, WIDTH, creases
from decomp.drawing.picture import MARGIN as FREE
from decomp.drawing.raster import Triangles, painted
from decomp.meshes.incidence import faces_of, row_keys
from decomp.meshes.model import GroupKind, TetMesh
from decomp.skeletons.cells.surface import side_triangles
from decomp.skeletons.model import Skeleton
from decomp.vectors import Array, Bools, Ints

MODEL = Path(__file__).parents[1] / "meshes" / "blind_hole.geo"
PICTURE = Path(__file__).parent / "pictures" / "pipeline.png"
SIZE = 0.4
APART = 0.35
"""How far cells are pulled apart, in parts of their distance from the middle."""
PANEL, TITLE, MARGIN = (WIDTH // 2, HEIGHT // 2), 46, 14

Part = tuple[str, Array, tuple[float, float, float]]
"""A name, corners (k, 3, 3) of triangles, and their colour."""


def coloured(parts: list[tuple[str, Array]]) -> list[Part]:
    """Parts with colours, in their order."""
    return [
        (name, corners, rgb(CATEGORIES[k % len(CATEGORIES)]))
        for k, (name, corners) in enumerate(parts)
    ]


def solid(skeleton: Skeleton) -> list[Part]:
    """The faces of the boundary."""
    return coloured([
        (face.name, skeleton.complex.points[side_triangles(skeleton.complex, sides)])
        for region in skeleton.regions
        for face, sides in zip(region.boundary.faces, region.face_sides, strict=True)
    ])  # fmt: skip


def sheets(skeleton: Skeleton) -> list[Part]:
    """The sheets of the skeleton."""
    patches, points = skeleton.complex.patches, skeleton.complex.points
    return coloured([
        (str(number), points[patches[sheet.patch].triangles])
        for region in skeleton.regions
        for number, sheet in enumerate(region.sheets)
    ])  # fmt: skip


def exploded(skeleton: Skeleton) -> list[Part]:
    """The cells, moved away from the middle."""
    points = skeleton.complex.points
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    parts = []
    for cell in (cell for region in skeleton.regions for cell in region.cells):
        corners = points[side_triangles(skeleton.complex, cell.sides)]
        parts.append((cell.name, corners + APART * 2 * (corners.mean(axis=(0, 1)) - middle)))
    return coloured(parts)


def cut_open(mesh: TetMesh) -> list[Part]:
    """The tetrahedra behind the middle, by cell."""
    middle = (mesh.points[:, 1].min() + mesh.points[:, 1].max()) / 2
    behind = mesh.points[mesh.tets].mean(axis=1)[:, 1] > middle
    faces = faces_of(mesh.tets[behind])
    _, first, count = np.unique(row_keys(faces), return_index=True, return_counts=True)
    outer = first[count == 1]
    return by_tag(mesh, faces[outer], np.repeat(mesh.tet_tags[behind], 4)[outer], GroupKind.CELL)


def named(mesh: TetMesh) -> list[Part]:
    """The boundary's triangles by name."""
    return by_tag(mesh, mesh.triangles, mesh.triangle_tags, GroupKind.FACE)


def by_tag(mesh: TetMesh, triangles: Ints, tags: Ints, kind: GroupKind) -> list[Part]:
    """Triangles in one part for each group of a kind."""
    groups = [group for group in mesh.groups if group.kind is kind]
    return coloured([(g.name, mesh.points[triangles[tags == g.tag]]) for g in groups])


def panel(parts: list[Part], elements: bool) -> Image.Image:
    """A picture of triangles, lit from above, with all their edges or where they bend alone."""
    corners = np.concatenate([corners for _, corners, _ in parts])
    shades = np.concatenate([np.tile(colour, (len(corners), 1)) for _, corners, colour in parts])
    size = FINER * np.array([WIDTH, HEIGHT])
    points = corners.reshape(-1, 3)
    projection = fitted(points, np.array(ASLANT), FREE * size, (1 - FREE) * size)
    lines = np.concatenate([bends(each) for _, each, _ in parts]) | elements
    image = painted(Triangles(corners, lines, shades), projection, *size.tolist())
    whole = Image.fromarray((255 * np.clip(image, 0, 1) + 0.5).astype(np.uint8))
    return whole.resize(PANEL, Image.Resampling.LANCZOS)


def bends(corners: Array) -> Bools:
    """Which sides (k, 3) of triangles are borders or bend."""
    points, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return creases(points, number.reshape(-1, 3))


def sheet_of(panels: list[tuple[str, list[Part]]]) -> Image.Image:
    """All panels in three columns with their titles; the last one's names in the free place."""
    width, height = PANEL[0] + 2 * MARGIN, PANEL[1] + TITLE + MARGIN
    whole = Image.new("RGB", (3 * width, 2 * height), "white")
    pen = ImageDraw.Draw(whole)
    title, text = ImageFont.load_default(size=26), ImageFont.load_default(size=22)
    for number, (what, parts) in enumerate(panels):
        x, y = number % 3 * width + MARGIN, number // 3 * height
        pen.text((x, y + 10), f"{number + 1}  {what}", fill="black", font=title)
        whole.paste(panel(parts, number >= 3), (x, y + TITLE))
    x, y = 2 * width + 4 * MARGIN, height + TITLE + 2 * MARGIN
    for row, (name, _, colour) in enumerate(panels[-1][1]):
        top = y + 40 * row
        fill = tuple(round(255 * value) for value in colour)
        pen.rectangle((x, top, x + 24, top + 24), fill=fill, outline="black")
        pen.text((x + 38, top - 2), name, fill="black", font=text)
    return whole


def main(path: Path) -> None:
    """Compute, draw, write."""
    skeleton = decomp.skeleton(MODEL)
    mesh = decomp.mesh(MODEL, size=SIZE, volumes="cells")
    panels = [
        ("solid: exact faces", solid(skeleton)),
        ("skeleton: sheets", sheets(skeleton)),
        ("cells, pulled apart", exploded(skeleton)),
        ("tetrahedra, cut open", cut_open(mesh)),
        ("names of faces", named(mesh)),
    ]
    sheet_of(panels).quantize(128).save(path, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURE)
