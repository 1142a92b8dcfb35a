"""A scene as a page that needs nothing else: it opens by double click, without a network.

WebGL is drawn by three.js (MIT licence, `three.LICENSE`), whose minified module is embedded, as are
the page's own modules in `script/`: an import map gives each the address of its text.
"""

from __future__ import annotations

import base64
import json
import re
from html import escape
from importlib.resources import files
from typing import Any

import numpy as np

from decomp.drawing.colouring import colouring
from decomp.drawing.colours import CATEGORIES, PALETTE, VALUES
from decomp.drawing.scene import Body, Scene

SCRIPTS = (
    *("data", "elements", "colours", "parts", "section", "looking", "pointing", "values"),
    *("names", "main"),
)


def encoded(scene: Scene) -> bytes:
    """The contents of a file."""
    here = files("decomp.view")
    modules = {"three": (here / "three.module.min.js").read_bytes()}
    modules |= {f"decomp/{name}": (here / "script" / f"{name}.js").read_bytes() for name in SCRIPTS}
    parts = {
        "TITLE": escape(scene.title),
        "STYLE": (here / "page.css").read_text(encoding="utf-8"),
        "MODULES": json.dumps(
            {"imports": {name: _address(text) for name, text in modules.items()}}
        ),
        # no name can end the script that holds the data
        "DATA": json.dumps(_data(scene)).replace("<", "\\u003c"),
    }
    page = (here / "page.html").read_text(encoding="utf-8")
    return re.sub("@([A-Z]+)@", lambda found: parts[found[1]], page).encode()


def _data(scene: Scene) -> dict[str, Any]:
    colours = colouring(scene)
    in_body = scene.body is not None
    return {
        "title": scene.title,
        "first": scene.opaque,
        "palette": PALETTE,
        "categories": len(CATEGORIES),
        "scale": VALUES,
        "origin": scene.origin.tolist(),
        "points": _packed(scene.points, "<f4"),
        "regions": [{"name": name, "colour": k} for name, k in colours.regions.items()],
        "parts": [
            {
                "group": part.group,
                "region": part.region,
                "name": part.name,
                "kind": part.kind,
                "colour": colour,
                # the page finds the surface of tetrahedra itself
                "triangles": None
                if in_body and part.group == "cell"
                else _packed(part.triangles, "<i4"),
            }
            for part, colour in zip(scene.parts, colours.parts, strict=True)
        ],
        "fields": [
            {
                "name": field.name,
                "at_points": field.at_points,
                "values": _packed(field.values, "<f4"),
            }
            for field in scene.fields
        ],
        "body": None if scene.body is None else _tetrahedra(scene.body),
    }


def _tetrahedra(body: Body) -> dict[str, str]:
    values = {"tets": body.tets, "part": body.part, "neighbours": body.neighbours}
    return {name: _packed(each, "<i4") for name, each in values.items()}


def _packed(values: Any, kind: str) -> str:
    """Numbers of a little-endian type of four bytes, as base64."""
    return base64.b64encode(np.asarray(values, dtype=kind).tobytes()).decode()


def _address(text: bytes) -> str:
    return f"data:text/javascript;base64,{base64.b64encode(text).decode()}"
