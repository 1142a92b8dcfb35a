"""The meshers by name. Nothing else imports what is in their folders."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from decomp.processes.workplace import swept

if TYPE_CHECKING:
    from decomp.meshing.backends.base import Mesher

MESHERS = {"tetwild": "decomp.meshing.backends.tetwild.mesher"}
"""Modules with a `Mesher` called `MESHER`, which are loaded when they are first used. The first one
fills all meshes."""


def mesher() -> Mesher:
    """The mesher that fills all meshes."""
    found: Mesher = import_module(next(iter(MESHERS.values()))).MESHER
    return found


def sweep() -> None:
    """Remove the directories that meshers have left behind whose processes were killed.

    Raises:
        FileError: there is no temporary directory that can be written to.
    """
    for name in MESHERS:
        swept(name)
