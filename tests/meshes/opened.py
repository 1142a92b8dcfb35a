"""A file as Gmsh's own library reads it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Gmsh's module with a file loaded; any warning of Gmsh's fails."""
    try:
        import gmsh
    except OSError as error:
        pytest.skip(f"Gmsh's library lacks one of the system's: {error}")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        gmsh.open(str(path))
        loud = [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]
        assert not loud, loud
        gmsh.logger.stop()
        yield gmsh
    finally:
        gmsh.finalize()


def named_sizes(gmsh: Any) -> dict[tuple[int, str], int]:
    """How many elements each physical group has, by dimension and name."""
    found = {}
    for dimension, tag in gmsh.model.getPhysicalGroups():
        count = 0
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
            assert gmsh.model.getPhysicalGroupsForEntity(dimension, entity).tolist() == [tag]
            count += sum(map(len, gmsh.model.mesh.getElements(dimension, entity)[1]))
        found[dimension, gmsh.model.getPhysicalName(dimension, tag)] = count
    return found
