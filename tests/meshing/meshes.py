"""Meshes made once per process, and the models that tests of meshing share."""

from __future__ import annotations

from functools import cache

import decomp
from decomp.csg.solid import Solid
from decomp.meshes.model import TetMesh
from tests.solids import SOLIDS

MODELS: dict[str, dict[str, Solid]] = {
    "two boxes": {
        "left": decomp.Block((0, 0, 0), (2, 2, 2), name="a"),
        "right": decomp.Block((2, 0, 0), (2, 2, 2), name="b"),
    },
    "ball in a box": {
        "ball": decomp.Sphere((0, 0, 0), 1, name="ball"),
        "air": decomp.Block((-2, -2, -2), (4, 4, 4), name="box")
        - decomp.Sphere((0, 0, 0), 1, name="ball"),
    },
}


@cache
def geometry(name: str) -> decomp.Geometry:
    return decomp.Geometry(MODELS[name] if name in MODELS else SOLIDS[name].make())


@cache
def meshed(name: str, **options: object) -> TetMesh:
    every = {"volumes": "cells", "sheets": True, **options}
    return decomp.mesh(geometry(name), **every)  # type: ignore[arg-type]
