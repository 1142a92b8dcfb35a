"""Pieces of one face of one primitive: `base.zmax`, `base.zmax@2`, `base.zmax@3`."""

from __future__ import annotations

import re

NUMBER = re.compile(r"@\d+(?=$|[|&])")


def whole_name(name: str) -> str:
    """The name of a face, interface, edge or vertex without the numbers of pieces."""
    return NUMBER.sub("", name)
