"""Narrow places of faces: epsilon follows them, or nodes stay off the faces beside them."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.checking.check import check
from decomp.csg.solid import Solid
from decomp.meshing.sizing.necks import narrowest

STEP = decomp.Block((0, 0, 0), (4, 3, 1), name="low") | decomp.Block(
    (1, 0.5, -1), (1.5, 2.488, 2), name="high"
)
"""The lower block's side is 0.012 behind the upper's, over a part of it: no edge is so short."""
SHOULDER = decomp.Block((0, 0, 0), (4, 4, 2), name="box") - (
    decomp.Cylinder((2, 2, -1), (2, 2, 1), 1) | decomp.Cylinder((2, 2, 1), (2, 2, 3), 1.02)
)


@pytest.mark.parametrize(
    ("solid", "width"),
    [(STEP, 0.012), (SHOULDER, 0.02), (decomp.Block((0, 0, 0), (4, 3, 1)), np.inf)],
    ids=["step", "shoulder", "block"],
)
def test_the_narrowest_place(solid: Solid, width: float) -> None:
    (region,) = decomp.Geometry(solid).regions
    assert narrowest(region, 0.1) == pytest.approx(width, rel=0.05)
    assert narrowest(region, 0.01) == np.inf


@pytest.mark.slow
@pytest.mark.parametrize("solid", [STEP, SHOULDER], ids=["step", "shoulder"])
def test_nodes_beside_it_are_exact(solid: Solid) -> None:
    exact = decomp.Geometry(solid)
    mesh = decomp.mesh(exact, cells="none")
    assert check(exact, mesh, unprojected=len(mesh.unprojected)).shortcomings == ()
    assert len(mesh.unprojected) <= 0.002 * len(mesh.points)
