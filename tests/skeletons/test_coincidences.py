"""Parts whose features coincide: exact volumes, certified skeletons, whatever the place."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.csg.model import model
from tests.skeletons.coincidences import COINCIDENCES
from tests.skeletons.computed import at_most


@pytest.mark.parametrize("name", COINCIDENCES)
def test_skeleton(name: str) -> None:
    given = COINCIDENCES[name]
    geometry = decomp.Geometry(given.make())
    for region, volume, euler in zip(geometry.regions, given.volume, given.euler, strict=True):
        assert region.volume == pytest.approx(volume, rel=1e-9)
        assert region.euler == euler
    with at_most(120):
        skeleton = decomp.skeleton(geometry)
    for region, volume, euler in zip(skeleton.regions, given.volume, given.euler, strict=True):
        assert region.certificate.euler == euler
        assert sum(cell.volume for cell in region.cells) == pytest.approx(volume, rel=1e-3)


def _areas(skeleton: decomp.Skeleton, *names: str) -> list[float]:
    """The areas of the sheets between two sites of the first region."""
    points, found = skeleton.complex.points, []
    for sheet in skeleton.regions[0].sheets:
        if sorted(skeleton.sites[site].name for site in sheet.sites) == sorted(names):
            a, b, c = points[skeleton.complex.patches[sheet.patch].triangles.T]
            found.append(float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2))
    return found


def test_sheet_between_trims_that_touch() -> None:
    """The cone between plate and boss ends in a circle that the hole's circle touches."""
    part = COINCIDENCES["boss as high as a hole is far"].make()
    (area,) = _areas(decomp.skeleton(part), "plate.top", "boss.side")
    assert area == pytest.approx(np.sqrt(2) * np.pi * (7**2 - 3**2 - 1.5**2), rel=2e-3)


def test_seams_that_touch() -> None:
    """The middle plane ends in the circle around each hole, which touches that beside the rim."""
    found = decomp.skeleton(COINCIDENCES["flange on gasket"].make())
    (area,) = _areas(found, "disc.base", "disc.top")
    assert len(found.regions[0].sheets) == 1 + 2 * 6
    assert area == pytest.approx(np.pi * (18**2 - 10**2 - 4 * 3.5**2), rel=1e-3)


def test_seams_that_touch_part_a_sheet() -> None:
    """The hole's circle touches two sides of the middle plane: the corner is a sheet of its own."""
    found = decomp.skeleton(COINCIDENCES["hole in a corner"].make(), tolerance=3e-5)
    corner, rest = sorted(_areas(found, "plate.zmin", "plate.zmax"))
    assert corner == pytest.approx(25 * (1 - np.pi / 4), rel=3e-3)
    assert rest == pytest.approx(36 * 16 - 25 * np.pi - 25 * (1 - np.pi / 4), rel=1e-3)
    assert len(found.regions[0].sheets) == 2 + 2 * 5 + 4


def test_random_bores() -> None:
    """Plates with a bore along them, wherever it lies."""
    rng = np.random.default_rng(5)
    for _ in range(12):
        radius = rng.uniform(0.5, 2.5)
        y = rng.uniform(radius + 0.5, 29.5 - radius)
        z = rng.uniform(radius + 0.4, 8.6 - radius)
        bore = decomp.Cylinder((-1, y, z), (51, y, z), radius)
        skeleton = decomp.skeleton(model(decomp.Block((0, 0, 0), (50, 30, 9)) - bore))
        assert skeleton.regions[0].certificate.euler == 0


def test_small_parts_do_not_make_all_finer() -> None:
    """A ball in air 300 times as wide takes about as many triangles as three balls."""
    both = decomp.skeleton(COINCIDENCES["ball in wide air"].make())
    alone = decomp.skeleton(decomp.Sphere((0, 0, 0), 1))
    count = sum(len(patch.triangles) for patch in both.complex.patches)
    ball = sum(len(patch.triangles) for patch in alone.complex.patches)
    assert count <= 4 * ball
