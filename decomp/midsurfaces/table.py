"""The formats of mid-surfaces. A new one is a module, and a line here."""

from __future__ import annotations

from decomp.files.format import Format
from decomp.skeletons.files.table import OBJ, PLY, STL, VTU

FORMATS = (
    Format("ParaView", (".vtu",), VTU),
    Format("binary", (".ply",), PLY),
    Format("text", (".obj",), OBJ),
    Format("single precision", (".stl",), STL),
)
"""Their modules have `encoded(parts, at_points, at_triangles)`, which gives the file's bytes: of
elements that are triangles alone, and values by name. What a format has no room for it leaves
out."""
