"""Meshers of the tests' own, put into the table in TetWild's place."""

from __future__ import annotations

import sys
from types import ModuleType

import pytest

from decomp.meshing.backends import table
from decomp.meshing.backends.base import Mesher


def put_in_place(mesher: Mesher, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make a mesher the table's only entry, as a module that it is loaded from."""
    module = ModuleType("mesher_of_the_tests")
    module.MESHER = mesher  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setattr(table, "MESHERS", {"tests": module.__name__})
