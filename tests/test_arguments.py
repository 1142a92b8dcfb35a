"""Arguments of public functions that are of a wrong kind or out of range: one clear error each."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.errors import InputError
from decomp.vectors import number, vector
from decomp.ways.skeleton import Method

BLOCK: Any = decomp.Block((0, 0, 0), (1, 1, 1), name="b")
NAN = float("nan")

MESH = [
    ({"size": "4"}, "size must be a number, got '4'"),
    ({"size": True}, "size must be a number, got True"),
    ({"size": [1]}, "size must be a number, got [1]"),
    ({"size": 0.0}, "size must be positive, got 0"),
    ({"size": NAN}, "size must be finite, got nan"),
    ({"size": 10**400}, "size must be finite"),
    ({"layers": 2.5}, "layers must be a whole number from 1, got 2.5"),
    ({"layers": "2"}, "layers must be a number, got '2'"),
    ({"layers": True}, "layers must be a number, got True"),
    ({"layers": 0}, "layers must be a whole number from 1, got 0"),
    ({"layers": 101}, "layers must be from 1 to 100, got 101"),
    ({"elements_per_circle": "12"}, "elements per circle must be a number, got '12'"),
    ({"elements_per_circle": 2}, "elements per circle must be from 3 to 10000, got 2"),
    ({"order": "2"}, "order must be one of 1, 2, got '2'"),
    ({"order": True}, "order must be one of 1, 2, got True"),
    ({"order": 3}, "order must be one of 1, 2, got 3"),
    ({"order": None}, "order must be one of 1, 2, got None"),
    ({"order": [2]}, "order must be one of 1, 2, got [2]"),
    ({"cells": "faces"}, "cells must be one of 'skeleton', 'face', 'none', got 'faces'"),
    ({"cells": np.array(["face"])}, "cells must be one of 'skeleton', 'face', 'none', got array"),
    ({"volumes": 1}, "volumes must be one of 'regions', 'cells', 'materials', got 1"),
    ({"sheets": "no"}, "sheets must be True or False, got 'no'"),
    ({"fields": "distance"}, "fields must be a list of names, such as ['distance'], got 'distance"),
    ({"fields": 1}, "fields must be a list of names"),
    ({"fields": ["speed"]}, "'speed' is no field"),
    ({"fields": [["distance"]]}, "['distance'] is no field"),
    ({"timeout": "9"}, "timeout must be a number, got '9'"),
    ({"timeout": 0}, "timeout must be positive, got 0"),
    ({"progress": "bar"}, "progress must be a function or None, got 'bar'"),
]


@pytest.mark.parametrize(("wrong", "said"), MESH)
def test_meshes(wrong: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError) as caught:
        decomp.mesh(BLOCK, **wrong)
    assert said in str(caught.value)


def test_numbers_of_numpy_are_numbers() -> None:
    mesh = decomp.mesh(
        BLOCK,
        size=np.float64(0.6),
        layers=np.int64(1),
        elements_per_circle=np.array(8),
        order=np.int64(2),  # type: ignore[arg-type]
        cells=np.str_("face"),  # type: ignore[arg-type]
        sheets=np.bool_(False),  # type: ignore[arg-type]
        fields=np.array(["distance"]),  # type: ignore[arg-type]
        timeout=np.float32(100),
    )
    assert mesh.order == 2
    assert list(mesh.point_data) == ["distance"]


SOURCES = (5, None, "", b"x", {"a": 5}, {1: BLOCK}, [BLOCK], ["a"], [])


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("ask", [decomp.Geometry, decomp.skeleton, decomp.mesh])
def test_sources(ask: Callable[[Any], Any], source: Any) -> None:
    with pytest.raises(InputError):
        ask(source)


OTHERS: dict[str, tuple[Callable[[], Any], str]] = {
    **{
        f"tolerance {value!r}, {method}": (
            lambda value=value, method=method: decomp.skeleton(
                BLOCK, tolerance=value, method=method
            ),
            f"tolerance must be {kind}, got",
        )
        for method in get_args(Method)
        for value, kind in [
            *(("x", "a number"), (True, "a number"), (None, "a number"), (0, "positive")),
            *((-1, "positive"), (NAN, "finite"), (0.5, "at most 0.1")),
        ]
    },
    "progress": (lambda: decomp.skeleton(BLOCK, progress=1), "progress must be a function"),  # type: ignore[arg-type]
    "progress, sampled": (
        lambda: decomp.skeleton(BLOCK, progress=1, method="sampled"),  # type: ignore[arg-type]
        "progress must be a function",
    ),
    "no skeleton": (lambda: decomp.mid_surface(BLOCK), "is that of a skeleton"),
    "epsilon": (lambda: check(BLOCK, "a.msh", epsilon=-1), "epsilon must be positive, got -1"),
    "text epsilon": (lambda: check(BLOCK, "a.msh", epsilon="x"), "epsilon must be a number"),  # type: ignore[arg-type]
    "volume error": (lambda: check(BLOCK, "a.msh", volume_error=True), "volume_error must be a"),
    "unprojected": (lambda: check(BLOCK, "a.msh", unprojected=-1), "whole number from 0, got -1"),
    "mesh": (lambda: check(BLOCK, 5), "the mesh's file must be a path, got 5"),  # type: ignore[arg-type]
    "file": (lambda: decomp.load(5), "the model's file must be a path, got 5"),  # type: ignore[arg-type]
    "save": (lambda: decomp.save(BLOCK, 5), "the file to write must be a path, got 5"),  # type: ignore[arg-type]
    "save what": (lambda: decomp.save(5, "x.json"), "a model is made of"),  # type: ignore[arg-type]
    "solids": (lambda: decomp.union(5), "union takes a list of solids, got 5"),  # type: ignore[arg-type]
    "one of them": (lambda: decomp.intersection([1]), "a solid is combined with 1"),  # type: ignore[list-item]
    "solid of a region": (lambda: decomp.Region("a", 5), "region 'a' must be a solid, got 5"),  # type: ignore[arg-type]
    "region": (lambda: decomp.Model((5,)), "5 is no region"),  # type: ignore[arg-type]
    "name": (lambda: BLOCK.named(5), "5 cannot be a name"),
    "true radius": (lambda: decomp.Sphere((0, 0, 0), True), "radius must be a number, got True"),
    "text radius": (lambda: decomp.Sphere((0, 0, 0), "1"), "radius must be a number, got '1'"),  # type: ignore[arg-type]
    "text centre": (lambda: decomp.Sphere(("0", "0", "0"), 1), "must be three numbers"),  # type: ignore[arg-type]
    "text scale": (lambda: BLOCK.scale("2"), "must be a number, got '2'"),
    "true copies": (lambda: BLOCK.linear_copies((1, 0, 0), True), "whole number above zero"),
}


@pytest.mark.parametrize("case", OTHERS)
def test_other_functions(case: str) -> None:
    ask, said = OTHERS[case]
    with pytest.raises(InputError) as caught:
        ask()
    assert said in str(caught.value)


@pytest.mark.parametrize("facing", ["90", True, None, NAN, -1, 180])
def test_facing(facing: Any) -> None:
    skeleton = decomp.skeleton(BLOCK)
    with pytest.raises(InputError, match="facing must be "):
        decomp.mid_surface(skeleton, facing)


@pytest.mark.parametrize("points", ["abc", [["0", "0", "0"]], [[True, True, True]], 5, [[1, 2]]])
def test_points(points: Any) -> None:
    geometry = decomp.Geometry(BLOCK)
    for ask in (geometry.contains, geometry.nearest, geometry.distance, geometry.region_of):
        with pytest.raises(InputError, match="points must be an array"):
            ask(points)


def test_where_a_mesh_is_written(tmp_path: Path) -> None:
    mesh = decomp.mesh(BLOCK, size=0.9)
    for wrong, said in (
        ({"path": 5}, "the file to write must be a path"),
        ({"path": tmp_path / "a.msh", "text": "yes"}, "text must be True or False"),
        ({"path": tmp_path / "a.msh", "version": 4.1}, "4.1 is not written"),
    ):
        with pytest.raises(InputError, match=said):
            mesh.write(**wrong)  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_what_is_a_number() -> None:
    for good in (1, 1.0, np.float32(1), np.int8(1), np.array(1), Fraction(1)):
        assert number(good, "x") == 1.0
    np.testing.assert_array_equal(vector([Fraction(1, 2), 1, np.float32(2)], "x"), [0.5, 1, 2])
