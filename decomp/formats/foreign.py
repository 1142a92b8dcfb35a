"""Files of other programs that are taken for models, and what serves instead."""

from __future__ import annotations

from pathlib import Path

MESH = (
    "this is a mesh, not a model: 'decomp view' shows .msh files, 'decomp check MODEL MESH' "
    "verifies them"
)
TRIANGLES = (
    "a file of triangles does not tell which planes, spheres, cylinders, elliptic ones, cones and "
    "tori a solid is made of, which decomp needs: write the solid as CSG"
)
SURFACES = (
    "a file of a solid's surfaces holds no CSG, which decomp needs: write the solid as blocks, "
    "spheres, cylinders, elliptic ones, cones and tori"
)
SCAD = "flatten an OpenSCAD program first: openscad -o model.csg model.scad"

WHAT_SERVES = {
    **dict.fromkeys((".msh", ".vtk", ".vtu", ".xdmf", ".inp", ".mesh", ".vol", ".med"), MESH),
    **dict.fromkeys((".stl", ".obj", ".ply", ".off", ".3mf"), TRIANGLES),
    **dict.fromkeys((".step", ".stp", ".iges", ".igs", ".brep"), SURFACES),
    ".scad": SCAD,
    ".py": "a model made in Python is meshed there: decomp.mesh(solid)",
}


def advice(file: Path) -> str | None:
    """What to do about a file that is no model, by its suffix; None where that tells nothing."""
    return WHAT_SERVES.get(file.suffix.lower())
