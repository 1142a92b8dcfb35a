"""Skeletons computed once per process, and what tests ask of them."""

from __future__ import annotations

import signal
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import FrameType

import numpy as np
import pytest

import decomp
from decomp.csg.solid import Solid
from decomp.skeletons.model import RegionSkeleton, Sheet, Skeleton
from decomp.vectors import Array
from tests.corpus.files import FILES
from tests.skeletons.machine_parts import PARTS
from tests.skeletons.shapes import SHAPES
from tests.solids import SOLIDS

TOLERANCE = 5e-4
LIMIT = 200
"""Seconds of a processor that a model may take: one that runs on for ever holds up the others."""
SLOW = {
    "hollow sphere",
    "oval ring",
    "torus",
    "torus cut in two ovals",
    "torus cut in one oval",
    "half torus",
    "wide offset tee",
    "netgen/twocyl.geo",
    "bulge",
    "bored corner",
    "cone in a wall",
    "rod and rib",
}
"""Models that take more than a few seconds."""

LONG = {
    "netgen/manyholes2.geo",
    "netgen/matrix.geo",
    "netgen/trafo.geo",
}
"""Models that take half a minute and more."""

UNFINISHED: dict[str, str] = {}
"""Models whose skeleton cannot be computed yet, and why."""


def param(name: str, *values: object) -> pytest.ParameterSet:
    """A test's parameters, marked if the model is known to fail, or to take long."""
    marks = []
    if name in UNFINISHED:
        reason = UNFINISHED[name]
        marks.append(pytest.mark.xfail(reason=reason, strict=True))
    if name in SLOW | LONG:
        marks.append(pytest.mark.slow)
    return pytest.param(name, *values, marks=marks)


def source_of(name: str) -> Solid | Path:
    """A solid of the shared table, a shape or part of these tests or a file of the corpus."""
    if name in SOLIDS:
        return SOLIDS[name].make()
    made = SHAPES | PARTS
    return made[name]() if name in made else FILES[name]


@cache
def skeleton_of(name: str) -> Skeleton:
    """The skeleton of a model, to the default tolerance."""
    limit = 10 * LIMIT if name in LONG else LIMIT
    try:
        with at_most(limit):
            return decomp.skeleton(source_of(name))
    except TimeoutError:
        # where it was stopped may lie in compiled code, which has no line numbers
        pytest.fail(f"not finished in {limit} s", pytrace=False)


@contextmanager
def at_most(seconds: int) -> Iterator[None]:
    """Raises TimeoutError in the main thread when the process has computed for so long."""

    def over(number: int, frame: FrameType | None) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGVTALRM, over)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


class Region:
    """One region of a skeleton, asked by the names of sites."""

    def __init__(self, skeleton: Skeleton, region: int = 0) -> None:
        self.skeleton = skeleton
        self.parts: RegionSkeleton = skeleton.regions[region]
        self.points: Array = skeleton.complex.points

    def names(self, sites: tuple[int, ...]) -> tuple[str, ...]:
        """The sites' names in alphabetical order."""
        return tuple(sorted(self.skeleton.sites[k].name for k in sites))

    def sheets(self, *names: str) -> list[Sheet]:
        """All sheets between two sites."""
        return [s for s in self.parts.sheets if self.names(s.sites) == tuple(sorted(names))]

    def area(self, *names: str) -> float:
        """Area of the sheets between two sites."""
        return sum(sheet.area for sheet in self.sheets(*names))

    def on_sheets(self, *names: str) -> Array:
        """Vertices (k, 3) of the sheets between two sites."""
        patches = self.skeleton.complex.patches
        used = [patches[sheet.patch].triangles.reshape(-1) for sheet in self.sheets(*names)]
        assert used, f"no sheet of {names}"
        return self.points[np.unique(np.concatenate(used))]

    def counts(self) -> tuple[int, int, int]:
        """Numbers of sheets, seams and junctions."""
        parts = self.parts
        return len(parts.sheets), len(parts.seams), len(parts.junctions)

    def inner_junctions(self) -> list[tuple[float, float, float, float]]:
        """Points and radii of the junctions inside, in order."""
        found = [
            (*self.points[j.vertex].round(9).tolist(), round(j.radius, 9))
            for j in self.parts.junctions
            if j.radius > 1e-9
        ]
        return sorted(found)

    def volumes(self) -> dict[str, float]:
        """Volumes of the cells, by the names of their faces."""
        return {"+".join(sorted(cell.faces)): cell.volume for cell in self.parts.cells}

    def kinds(self) -> Counter[tuple[str, str]]:
        """Numbers of sheets by the kinds of their two sites."""
        sites = self.skeleton.sites
        pairs = [sorted(sites[k].kind.value for k in s.sites) for s in self.parts.sheets]
        return Counter((a, b) for a, b in pairs)


def region_of(name: str) -> Region:
    """The first region of a model."""
    return Region(skeleton_of(name))
