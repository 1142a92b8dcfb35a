"""Programs for libraries that this Python may lack and another of the system may have."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PYTHONS = (sys.executable, "/usr/bin/python3")
"""Debian's packages are for the second."""


def said_by(text: str, modules: str, place: Path) -> str:
    """What a program prints, run by a Python that has the modules; without one the test is skipped.

    Args:
        text: the program.
        modules: to import, as `a, b`.
        place: the directory to run it in.
    """
    able = [python for python in PYTHONS if _ran(python, f"import {modules}", place) is not None]
    if not able:
        pytest.skip(f"{modules} not installed")
    said = _ran(able[0], text, place)
    assert said is not None
    return said


def _ran(python: str, text: str, place: Path) -> str | None:
    """What a program prints, None if it fails."""
    if not Path(python).exists():
        return None
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    run = subprocess.run(
        [python, "-c", text],
        cwd=place,
        env=environment,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    return run.stdout if run.returncode == 0 else None
