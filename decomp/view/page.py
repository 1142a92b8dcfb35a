"""A scene as a page that needs nothing else: it opens by double click, without a network.

WebGL is drawn by three.js (MIT licence, `three.LICENSE`), whose minified module is embedded.
"""

from __future__ import annotations

import base64
import json
from importlib.resources import files

import numpy as np

from decomp.vectors import Array
from decomp.view.colours import CATEGORIES, VALUES
from decomp.view.scene import Scene


def encoded(scene: Scene) -> bytes:
    """The contents of a file."""
    here = files("decomp.view")
    library = (here / "three.module.min.js").read_bytes()
    page = (here / "page.html").read_text()
    data = {
        "title": scene.title,
        "values": scene.values,
        "categories": CATEGORIES,
        "scale": VALUES,
        "parts": [
            {
                "group": part.group,
                "name": part.name,
                "kind": part.kind,
                "corners": _packed(part.corners),
                "value": _packed(part.value),
            }
            for part in scene.parts
        ],
    }
    # no name can end the script that holds the data
    text = json.dumps(data).replace("<", "\\u003c")
    page = page.replace("@TITLE@", scene.title.replace("&", "&amp;").replace("<", "&lt;"))
    page = page.replace("@LIBRARY@", base64.b64encode(library).decode())
    return page.replace("@DATA@", text).encode()


def _packed(values: Array) -> str:
    """Little-endian single precision, as base64."""
    return base64.b64encode(np.asarray(values, dtype="<f4").tobytes()).decode()
