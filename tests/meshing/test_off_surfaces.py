"""Report and check count the same nodes off their exact surfaces."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.meshing.tetrahedra import Filled, filled
from tests.meshing.meshes import MODELS
from tests.solids import SOLIDS

OPTIONS: dict[str, dict[str, Any]] = {
    "cells": {},
    "face cells": {"cells": "face"},
    "regions without sheets": {"volumes": "regions", "sheets": False},
    "curved": {"order": 2},
}


@pytest.fixture
def shaken(monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    """Every seventh node of faces and sheets is moved off; tells how many these are."""
    counted = {}

    def spoilt(*arguments: Any) -> Filled:
        made = filled(*arguments)
        points, nodes = np.array(made.fit.points), np.unique(made.fit.tagged.triangles)[::7]
        points[nodes] += np.random.default_rng(0).uniform(1e-5, 1e-4, size=(len(nodes), 3))
        counted["nodes"] = len(nodes)
        return replace(made, fit=replace(made.fit, points=points))

    monkeypatch.setattr("decomp.ways.mesh.filled", spoilt)
    return counted


@pytest.mark.parametrize("options", OPTIONS)
def test_nodes_off_are_counted_alike(options: str, shaken: dict[str, int], tmp_path: Path) -> None:
    geometry = decomp.Geometry(SOLIDS["through hole"].make())
    mesh = decomp.mesh(geometry, size=0.8, **OPTIONS[options])
    mesh.write(tmp_path / "a.msh")
    found = check(geometry, tmp_path / "a.msh")
    assert found.stray == len(mesh.unprojected) > 0
    if options == "cells":
        assert found.stray == shaken["nodes"]


def test_interfaces_and_sheets_of_two_regions(shaken: dict[str, int]) -> None:
    geometry = decomp.Geometry(MODELS["two boxes"])
    mesh = decomp.mesh(geometry, size=0.5)
    assert check(geometry, mesh).stray == len(mesh.unprojected) == shaken["nodes"]
