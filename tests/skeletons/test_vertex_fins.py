"""Seams that end where two of their feet run together at a vertex of the boundary."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import ArrayLike

import decomp
from decomp.csg.primitives import Block
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.seams.ending.vertex_fins import at_vertex
from decomp.skeletons.seams.steps.points import SeamPoints
from decomp.skeletons.seams.steps.states import State
from decomp.vectors import norm

CORNER = np.array([1.1, 0.9, 1.3])


def hall() -> SeamPoints:
    """A hall with a shaft on it: two reentrant edges of its ceiling end at the shaft's corner."""
    x, y, z = CORNER
    shaft = Block.between((x, y, 0), (4, 4, 3), name="shaft")
    geometry = decomp.Geometry(Block((0, 0, 0), (4, 4, z), name="hall") | shaft)
    return SeamPoints(RegionContext(geometry.index, 0))


def near(points: SeamPoints, place: ArrayLike, *names: str) -> State:
    """A point near a seam between floor and edges, with feet on their carriers and lines."""
    known = [site.name for site in points.context.sites]
    point = np.asarray(place, dtype=np.float64)
    feet = {
        "hall.zmin": [point[0], point[1], 0.0],
        "hall.zmax|shaft.xmin": [CORNER[0], point[1], CORNER[2]],
        "hall.zmax|shaft.ymin": [point[0], CORNER[1], CORNER[2]],
    }
    sites = tuple(known.index(name) for name in names)
    own = np.array([feet[name] for name in names])
    return State(point, float(point[2]), sites, own, np.array([1.0, 0.0, 0.0]), 0.0)


EDGES = ("hall.zmax|shaft.xmin", "hall.zmax|shaft.ymin")


@pytest.mark.parametrize("off", [(0, 1e-7, 0), (-2e-8, 3e-8, 1e-8), (1e-8, 0, -5e-8)])
def test_place_is_exact(off: ArrayLike) -> None:
    """Above the floor below the corner, half-way; the distances alone tell it to 1e-8 only."""
    points = hall()
    exact = np.array([*CORNER[:2], CORNER[2] / 2])
    start = near(points, exact + off, "hall.zmin", *EDGES)
    assert abs(norm(start.point - start.feet[1]) - norm(start.point - start.feet[2])) <= 1e-14
    end = at_vertex(points, start, (1, 2))
    assert end is not None
    assert norm(end.point - exact) <= 1e-15
    assert end.radius == pytest.approx(CORNER[2] / 2, abs=1e-15)
    assert np.abs(end.feet[1:] - CORNER).max() <= 1e-15


def test_elsewhere_there_is_none() -> None:
    """Off the vertex, between sites that leave a plane of normals, or far off their line."""
    points = hall()
    exact = np.array([*CORNER[:2], CORNER[2] / 2])
    off = near(points, exact + np.array([0.1, 0.1, 0]), "hall.zmin", *EDGES)
    assert at_vertex(points, off, (1, 2)) is None
    at = near(points, exact, "hall.zmin", *EDGES)
    assert at_vertex(points, at, (0, 1)) is None
    same = near(points, exact, "hall.zmin", EDGES[0], EDGES[0])
    assert at_vertex(points, same, (1, 2)) is None
    higher = near(points, exact + np.array([0, 0, 0.1]), "hall.zmin", *EDGES)
    assert at_vertex(points, higher, (1, 2)) is None
