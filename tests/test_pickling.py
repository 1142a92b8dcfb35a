"""Models, geometries, skeletons and meshes are pickled and copied, and answer alike afterwards."""

from __future__ import annotations

import copy
import multiprocessing
import pickle
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
import pytest

import decomp
from decomp.csg.solid import Difference
from decomp.formats.native import dumps

T = TypeVar("T")
BLOCK = decomp.Block((0, 0, 0), (4, 4, 2), name="plate")
HOLE = decomp.Cylinder((2, 2, -1), (2, 2, 3), 1, name="hole").named("a", bc=2)
RING = decomp.Torus((2, 2, 1), (0, 0, 1), 1.2, 0.4, name="ring")
CLOUD = np.random.default_rng(3).uniform(-1, 5, (500, 3))


def unpickled(value: T) -> T:
    return pickle.loads(pickle.dumps(value))  # type: ignore[no-any-return]


WAYS: dict[str, Callable[[Any], Any]] = {
    "pickle": unpickled,
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


@pytest.fixture(params=WAYS)
def way(request: pytest.FixtureRequest) -> Callable[[Any], Any]:
    return WAYS[request.param]


@pytest.mark.parametrize("asked_before", [False, True])
@pytest.mark.parametrize("regions", [1, 2])
def test_geometries(way: Callable[[Any], Any], regions: int, asked_before: bool) -> None:
    """Two regions, one of which has several faces on one carrier."""
    model = {"plate": BLOCK - HOLE} if regions == 1 else {"ring": RING, "rest": BLOCK - RING}
    geometry = decomp.Geometry(model)
    if asked_before:
        geometry.nearest(CLOUD)
    again = way(geometry)
    expected, found = geometry.nearest(CLOUD), again.nearest(CLOUD)
    for key in ("site", "distance", "foot", "region"):
        np.testing.assert_array_equal(getattr(found, key), getattr(expected, key))
    np.testing.assert_array_equal(again.distance(CLOUD), geometry.distance(CLOUD))
    np.testing.assert_array_equal(again.contains(CLOUD), geometry.contains(CLOUD))
    names = [face.name for region in again.regions for face in region.faces]
    assert names == [face.name for region in geometry.regions for face in region.faces]
    assert [dict(face.options) for face in again.regions[0].faces] == [
        dict(face.options) for face in geometry.regions[0].faces
    ]
    assert again.boundaries.touching == geometry.boundaries.touching
    assert dumps(again.model) == dumps(geometry.model)


def test_deep_and_shared_models(way: Callable[[Any], Any]) -> None:
    deep: decomp.Solid = BLOCK
    for _ in range(5000):
        deep = deep - HOLE
    again = way(deep)
    assert isinstance(again, Difference)
    assert again.tool is again.base.tool  # type: ignore[attr-defined]
    regions = (
        decomp.Region("a", deep, {"maxh": 1}),
        decomp.Region("b", ~deep, {"material": "tin"}),
    )
    model = way(decomp.Model(regions, "m"))
    assert dumps(model) == dumps(decomp.Model(regions, "m"))
    assert model.regions[1].solid.part is model.regions[0].solid


def test_a_shallow_copy_shares_its_parts() -> None:
    whole = BLOCK - HOLE
    assert copy.copy(whole).tool is HOLE
    assert copy.copy(whole) is not whole


def test_skeletons(way: Callable[[Any], Any]) -> None:
    skeleton = decomp.skeleton(decomp.Block((0, 0, 0), (3, 2, 0.5)))
    again = way(skeleton)
    np.testing.assert_array_equal(again.complex.points, skeleton.complex.points)
    np.testing.assert_array_equal(again.radius, skeleton.radius)
    assert again.regions[0].certificate == skeleton.regions[0].certificate
    expected, found = decomp.mid_surface(skeleton), decomp.mid_surface(again)
    assert found.area == expected.area > 0
    assert way(found).area == found.area


def test_meshes(way: Callable[[Any], Any], tmp_path: Any) -> None:
    mesh = decomp.mesh(decomp.Block((0, 0, 0), (1, 1, 1)), size=0.6, fields=["distance", "cell"])
    again = way(mesh)
    assert again.groups == mesh.groups
    np.testing.assert_array_equal(again.points, mesh.points)
    np.testing.assert_array_equal(again.point_data["distance"], mesh.point_data["distance"])
    for name, each in (("a.msh", mesh), ("b.msh", again)):
        each.write(tmp_path / name)
    assert (tmp_path / "a.msh").read_bytes() == (tmp_path / "b.msh").read_bytes()


def test_other_processes_answer_alike() -> None:
    geometry = decomp.Geometry(BLOCK - HOLE)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        (found,) = pool.map(geometry.distance, [CLOUD])
    np.testing.assert_array_equal(found, geometry.distance(CLOUD))
