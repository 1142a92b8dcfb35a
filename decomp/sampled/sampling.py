"""The sampled skeleton of a model: all steps in order.

1. Tetrahedra fill the regions and conform to their exact boundaries; they are made fine where the
   labels of their nodes, the nearest sites, ask for it.
2. The walls between labels are extracted, their vertices placed exactly, what has no width
   contracted, and folds smoothed. Reflexive loci are known exactly and become lines between them.
3. Boundary and walls become one complex, which is refined to the chord tolerance as far as that
   goes.
4. Cells are put together, and the certificate is measured: the one that traced skeletons have to
   hold. The tolerance that is reached is stated. Across every sheet the nearest point must jump. If
   something falls short, all is done again with finer tetrahedra.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from decomp.attempts import first_cause, stage
from decomp.complex.model import Complex
from decomp.complex.refining.refine import refined
from decomp.errors import GeometryError
from decomp.geometry import Geometry
from decomp.meshing.backends.base import MeshingError, TimeLimit
from decomp.sampled.beside import TetrahedraBoundary, with_traced
from decomp.sampled.bisecting import Bisected
from decomp.sampled.drawing import smoothly_drawn
from decomp.sampled.interior import Interior, interior
from decomp.sampled.jumps import without_jump
from decomp.sampled.region_walls import region_walls
from decomp.sampled.whole import Described, Drawn, RegionTools, tools_of
from decomp.skeletons.cells.owners import site_owners
from decomp.skeletons.certificate.certificate import VOLUME, Certified, explained, shortcomings
from decomp.skeletons.certificate.shortcoming import refusal
from decomp.skeletons.curves.region_curves import RegionCurves
from decomp.skeletons.drafts import SHARE
from decomp.skeletons.fineness import fine_enough, finer
from decomp.skeletons.model import Method, RegionSkeleton, Skeleton
from decomp.skeletons.traced_region import TracedRegion

FLOORS = (12.0, 18.0)
"""Try after try, edges at walls are no longer than these parts of the model's diagonal, or shorter
where the walls are close to the boundary."""
COARSE_START = 2.0
"""The tetrahedra that all begins with are so many times as long."""
START_TOLERANCE = 0.02
"""How far these may leave the boundary at first, in parts of their edges."""
SAMPLED_FINENESSES = 3
"""How often the tolerance is made finer for the volume's sake."""
LOOSEST = 8.0
"""Where refining cannot reach the tolerance, so many times of it, and of what is allowed for
volumes, are accepted and stated."""
FILLING = 30.0
"""Seconds that the mesher may compute in each try."""

Progress = Callable[[str, float], None]
Curves = Mapping[int, RegionCurves]


@dataclass(frozen=True, eq=False)
class Sampled:
    """A skeleton, and what it was made of.

    Args:
        skeleton: it.
        given: what the tetrahedra conform to.
        mesh: the tetrahedra.
        tools: of each region.
        shown: boundary and walls before they were refined.
        curves: of the regions that are traced.
        along: chord tolerance along these, in model units.
    """

    skeleton: Skeleton
    given: Interior
    mesh: Bisected
    tools: Sequence[RegionTools]
    shown: Drawn
    curves: Curves
    along: float


@dataclass(frozen=True, eq=False)
class _Try:
    """What has come of a try: a skeleton, or what is wrong with it."""

    skeleton: Skeleton | None
    failures: list[str]


def sampled_skeleton(
    geometry: Geometry, tolerance: float, tell: Progress, curves: Curves | None = None
) -> Sampled:
    """The skeleton as the walls between labels.

    Args:
        geometry: of the model.
        tolerance: chord tolerance, relative to the model's diagonal.
        tell: of the progress.
        curves: of regions that are not sampled, as their curves are traced already.

    Raises:
        GeometryError: no try holds its certificate, or a traced region's sheets cannot be made;
            it knows the region then.
    """
    reasons: list[tuple[str, GeometryError]] = []
    fineness = float(fine_enough(geometry, tolerance, SHARE).min())
    for number, floor in enumerate(FLOORS):
        share = number / len(FLOORS)
        tell(f"sampling{'' if not number else ' more finely'}", share)
        attempt = _Attempt(geometry, tolerance, curves or {}, partial(_told, tell, share))
        try:
            with stage("sampling"):
                return attempt.result(fineness, geometry.diagonal / floor)
        except MeshingError as error:
            reasons.append((f"edges of 1/{floor:g} of the size", GeometryError(str(error))))
        except TracedRegionError:
            raise
        except GeometryError as error:
            reasons.append((f"edges of 1/{floor:g} of the size", error))
    cause = first_cause(reasons)
    tried = f"{len(reasons)} tr{'y' if len(reasons) == 1 else 'ies'}"
    raise cause.retold(f"no sampled skeleton holds in {tried}; the first: {cause}")


def _told(tell: Progress, done: float, what: str) -> None:
    tell(what, done)


class TracedRegionError(GeometryError):
    """A region that was traced cannot be finished; `region` tells which."""


class _Attempt:
    """One try."""

    def __init__(
        self, geometry: Geometry, tolerance: float, curves: Curves, tell: Callable[[str], None]
    ) -> None:
        self._geometry, self._tolerance, self._curves = geometry, tolerance, curves
        self._tell = tell

    def result(self, fineness: float, floor: float) -> Sampled:
        """The skeleton.

        Args:
            fineness: chord tolerance to begin with, relative to the diagonal.
            floor: edges at walls are no longer.
        """
        geometry = self._geometry
        size = COARSE_START * floor
        given = interior(
            geometry, size, START_TOLERANCE * size, TimeLimit.of_work(FILLING), self._tell
        )
        owner = site_owners(geometry.sites, list(geometry.regions))
        tools = [
            tools_of(geometry, number, owner, number not in self._curves)
            for number in range(len(geometry.regions))
        ]
        self._tell("labelling")
        mesh = Bisected(given)
        along = SHARE * fineness * geometry.diagonal
        feet = [foot for own in self._curves.values() for foot in own.turning_feet()]
        TetrahedraBoundary(geometry, given, mesh).put_nodes(feet)
        extracted = region_walls(geometry, given, mesh, tools, floor, along)
        lost = sum(int(found.lost.sum()) for found in extracted)
        if lost:
            at = next(found.points[found.lost][0] for found in extracted if found.lost.any())
            raise GeometryError(f"{lost} points of walls have no place, one near {{at}}", at=at)
        self._tell("triangulating sheets")
        shown = smoothly_drawn(geometry, given, mesh, tools, extracted, floor)
        whole, traced = self._with_traced(given, mesh, shown, along)
        made = self._refined(given, tools, shown, whole, traced, fineness)
        if made.skeleton is None:
            raise GeometryError("; ".join(made.failures))
        return Sampled(made.skeleton, given, mesh, tools, shown, self._curves, along)

    def _with_traced(
        self, given: Interior, mesh: Bisected, shown: Drawn, along: float
    ) -> tuple[Complex, dict[int, TracedRegion]]:
        try:
            return with_traced(self._geometry, given, mesh, self._curves, shown.complex, along)
        except GeometryError as error:
            raise error.retold(str(error), TracedRegionError) from error

    def _refined(
        self,
        given: Interior,
        tools: Sequence[RegionTools],
        shown: Drawn,
        whole: Complex,
        traced: dict[int, TracedRegion],
        fineness: float,
    ) -> _Try:
        """Refine and measure, more finely as long as volumes ask for it."""
        geometry, tolerance = self._geometry, self._tolerance
        result = _Try(None, ["nothing was tried"])
        for left in reversed(range(SAMPLED_FINENESSES)):
            self._tell("refining")
            made, kept = refined(whole, fineness * geometry.diagonal, lenient=True)
            self._tell("measuring")
            described = Described(geometry, given, tools, shown, made, kept, traced)
            regions = [described.region(number) for number in range(len(geometry.regions))]
            result = _judged(geometry, tolerance, described, regions)
            figures = [found.certificate for _, found in regions]
            short = {name for each in figures for name in shortcomings(each, tolerance)}
            if not left or not short or not short <= {"volume_error", "chord_error"}:
                break
            excess = max(
                max(each.volume_error / VOLUME, each.chord_error / tolerance) for each in figures
            )
            fineness = float(finer(np.array([fineness]), np.array([excess]))[0])
        return result


def _judged(
    geometry: Geometry,
    tolerance: float,
    described: Described,
    regions: list[tuple[RegionSkeleton, Certified]],
) -> _Try:
    """The skeleton with the tolerance that it holds, if that is no more than `LOOSEST` allows."""
    times = max(
        max(
            found.certificate.chord_error / tolerance,
            found.certificate.coverage / (2 * tolerance),
            found.certificate.volume_error / VOLUME,
            1.0,
        )
        for _, found in regions
    )
    times = min(times, LOOSEST)
    stated, volume = times * tolerance, times * VOLUME
    failures = []
    for region, found in regions:
        wrong = explained(found, stated, geometry.sites, volume)
        if region.method is Method.TRACED:
            if wrong:
                error = refusal(wrong)
                error.region = region.name
                raise error.retold(str(error), TracedRegionError)
            continue
        lines = [str(line) for line in wrong]
        if not lines:
            mesh, radius = described.mesh, described.radius
            lines = without_jump(mesh, radius, region, geometry.sites)
        failures += [f"region {region.name}: {line}" for line in lines]
    if failures:
        return _Try(None, failures)
    return _Try(_skeleton(geometry, stated, described, [region for region, _ in regions]), [])


def _skeleton(
    geometry: Geometry, tolerance: float, described: Described, regions: list[RegionSkeleton]
) -> Skeleton:
    return Skeleton(
        geometry.model.name,
        geometry.diagonal,
        tolerance * geometry.diagonal,
        geometry.sites,
        described.mesh,
        described.radius,
        tuple(regions),
        geometry.model.source,
    )
