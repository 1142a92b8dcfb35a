"""The mid-surface of a model: the parts of its skeleton whose feet face each other.

A point of the skeleton sees its two nearest boundary points at an angle, which is 180 degrees
between parallel walls, 90 in the mitre of a box's edge. Keeping what exceeds a threshold is the
theta-simplified medial axis of Foskey, Lin and Manocha (Efficient computation of a simplified
medial axis, 2003, doi:10.1145/781606.781623); here sheets are cut along the exact curve of the
threshold.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi, radians
from pathlib import Path

import numpy as np

from decomp.errors import InputError
from decomp.midsurfaces.facing_sheets import facing_sheets
from decomp.midsurfaces.level_cut import LevelCut
from decomp.places import seen_from
from decomp.shown import Shown
from decomp.skeletons.model import Skeleton
from decomp.vectors import Array, Ints, cross, norm
from decomp.vectors import number as finite

FACING_DEGREES = 120.0
"""The least angle between feet, in degrees, by default."""


@dataclass(frozen=True, eq=False)
class MidSurface(Shown):
    """Triangles between walls that face each other, with the walls' distance.

    Args:
        name: the model's.
        facing: the threshold, in degrees.
        points: (n, 3), equally far from two sites, to rounding.
        thickness: (n,) twice the distance to the boundary, in model units.
        triangles: (m, 3); where sheets meet they share points.
        angle: (m,) in degrees, between the feet of each triangle's centre.
        region: (m,) number of the region.
        sheet: (m,) number of the sheet, through all regions.
        sites: (m, 2) between which it lies, indices into `Skeleton.sites`.
        sheet_names: `region/sheet-N` by number.
        source: the file that the model was read from, if any; no output may replace it.
    """

    name: str
    facing: float
    points: Array
    thickness: Array
    triangles: Ints
    angle: Array
    region: Ints
    sheet: Ints
    sites: Ints
    sheet_names: tuple[str, ...]
    source: Path | None = None

    @property
    def area(self) -> float:
        """Of all triangles."""
        a, b, c = np.moveaxis(self.points[self.triangles], 1, 0)
        return float(norm(cross(b - a, c - a)).sum() / 2)

    def write(self, path: str | Path) -> None:
        """Write to a file, whole or not at all.

        Args:
            path: ends in .vtu, .ply, .obj or .stl, and is not the file that the model was read
                from.

        Raises:
            InputError: the suffix is unknown.
            FileError: the file cannot be written.
        """
        from decomp.midsurfaces.files import write

        write(self, path)


def mid_surface(skeleton: Skeleton, facing: float = FACING_DEGREES) -> MidSurface:
    """The parts of a skeleton's sheets whose feet face each other by more than an angle.

    Reflexive curves and points (the axis of a rod) are no sheets, and are left out.

    Args:
        skeleton: of a model.
        facing: in degrees, from 0 to less than 180.

    Raises:
        InputError: the skeleton is none, or the angle is out of its range.
        GeometryError: a sheet cannot be followed; says where.
    """
    if not isinstance(skeleton, Skeleton):
        raise InputError(f"a mid-surface is that of a skeleton, got {skeleton!r}")
    facing = finite(facing, "facing")
    if not 0 <= facing < 180:
        raise InputError(f"facing must be an angle from 0 to less than 180 degrees, got {facing:g}")
    with seen_from(skeleton.offset, skeleton.diagonal):
        found = _mid_surface(skeleton.local, facing)
    return replace(found, points=found.points + skeleton.offset)


def _mid_surface(skeleton: Skeleton, facing: float) -> MidSurface:
    mesh = skeleton.complex
    surfaces = facing_sheets(skeleton)
    triangles, regions, between = [], [], []
    names: list[str] = []
    for number, region in enumerate(skeleton.regions):
        for sheet in region.sheets:
            triangles.append(mesh.patches[sheet.patch].triangles)
            regions.append(number)
            between.append(sheet.sites)
            names.append(f"{region.name}/sheet-{len(names)}")
    every = np.concatenate([np.empty((0, 3), dtype=np.int64), *triangles])
    owner = np.repeat(np.arange(len(triangles)), [len(each) for each in triangles])
    curves = {}
    used = np.zeros(len(mesh.points), dtype=np.bool_)
    used[every] = True
    for line in mesh.lines:
        pairs = np.sort(np.stack([line.vertices[:-1], line.vertices[1:]], axis=1), axis=1)
        for a, b in pairs[used[pairs].all(axis=1)].tolist():
            curves[a, b] = line.curve
    cut = LevelCut(surfaces, mesh.points, every, owner, curves, radians(facing), skeleton.tolerance)
    made = cut.done()
    kept = np.flatnonzero(cut.above())
    kept = kept[np.argsort(made.owner[kept], kind="stable")]
    points, corners = np.unique(made.triangles[kept], return_inverse=True)
    corners = corners.reshape(-1, 3)
    owner = made.owner[kept]
    angle, radius = np.empty(len(owner)), np.zeros(len(points))
    places = made.points[points]
    for number in np.unique(owner).tolist():
        rows = np.flatnonzero(owner == number)
        surface = surfaces[number]
        some = np.unique(corners[rows])
        angle[rows] = surface.facing(places[corners[rows]].mean(axis=1))[0]
        radius[some] = surface.facing(places[some])[1]
    return MidSurface(
        skeleton.name,
        facing,
        places,
        2 * np.maximum(radius, 0.0),
        corners,
        angle * 180 / pi,
        np.array(regions, dtype=np.int64)[owner],
        owner,
        np.array(between, dtype=np.int64).reshape(-1, 2)[owner],
        tuple(names),
        skeleton.source,
    )
