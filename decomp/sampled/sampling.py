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

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import monotonic

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.certificate.certificate import VOLUME, Certified, explained, shortcomings
from decomp.complex.refine import refined
from decomp.errors import GeometryError
from decomp.fineness import fine_enough, finer
from decomp.geometry import Geometry
from decomp.medial.result import RegionSkeleton, Skeleton
from decomp.sampled.bisecting import Bisected
from decomp.sampled.contracting import thin
from decomp.sampled.extracted import CLOSE, ONE, Extracted, contracted
from decomp.sampled.extraction import Extractor
from decomp.sampled.interior import Interior, interior
from decomp.sampled.jumps import without_jump
from decomp.sampled.labels import Labeller
from decomp.sampled.loci import pinned_ends
from decomp.sampled.refinement import Refiner
from decomp.sampled.smoothing import unfolded
from decomp.sampled.whole import Described, Drawn, RegionTools, drawn, tools_of
from decomp.tetra.cells import site_owners
from decomp.tetra.child import MeshingError, TimeLimit
from decomp.tracing.queries import region_queries
from decomp.vectors import Array, Ints, norm

FLOORS = (12.0, 18.0, 27.0, 40.0, 60.0)
"""Try after try, edges at walls are no longer than these parts of the model's diagonal, or shorter
where the walls are close to the boundary."""
COARSE = 2.0
"""The tetrahedra that all begins with are so many times as long."""
EPSILON = 0.02
"""How far these may leave the boundary at first, in parts of their edges."""
AGAIN = 7
"""So often tetrahedra are refined around walls that cannot be placed,"""
FINEST = 0.01
"""to this part of the floor at the most."""
FINENESSES = 3
"""How often the tolerance is made finer for the volume's sake."""
LOOSEST = 8.0
"""Where refining cannot reach the tolerance, so many times of it, and of what is allowed for
volumes, are accepted and stated."""
SHARE = 0.7
"""The part of the tolerance that the boundary's edges may use up."""
UNFOLDINGS = 4
"""So often walls are smoothed, and what is still folded then is contracted."""
LIMIT, FILLING = 60.0, 300.0
"""Seconds after which no further try is begun, and that TetWild may compute in each."""

Progress = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class _Try:
    """What has come of a try: a skeleton, or what is wrong with it."""

    skeleton: Skeleton | None
    failures: list[str]


def sampled_skeleton(
    geometry: Geometry, tolerance: float, tell: Progress, limit: float = LIMIT
) -> Skeleton:
    """The skeleton as the walls between labels.

    Args:
        geometry: of the model.
        tolerance: chord tolerance, relative to the model's diagonal.
        tell: of the progress.
        limit: seconds after which no further try is begun.

    Raises:
        GeometryError: no try holds its certificate; says what the first and the last one lacked.
    """
    begun = monotonic()
    reasons: list[str] = []
    fineness = float(fine_enough(geometry, tolerance, SHARE).min())
    for number, floor in enumerate(FLOORS):
        if reasons and monotonic() - begun > limit:
            break
        share = number / len(FLOORS)
        tell(f"sampling{'' if not number else ' more finely'}", share)
        try:
            found = _attempt(geometry, tolerance, fineness, geometry.diagonal / floor, tell, share)
        except (GeometryError, MeshingError) as error:
            reasons.append(str(error))
            continue
        if found.skeleton is not None:
            return found.skeleton
        reasons.append("; ".join(found.failures))
    tried = f"{len(reasons)} tr{'y' if len(reasons) == 1 else 'ies'}"
    last = f"; the last: {reasons[-1]}" if reasons[-1] != reasons[0] else ""
    raise GeometryError(f"no sampled skeleton holds in {tried}; the first: {reasons[0]}{last}")


def _attempt(
    geometry: Geometry,
    tolerance: float,
    fineness: float,
    floor: float,
    tell: Progress,
    share: float,
) -> _Try:
    size = COARSE * floor
    given = interior(
        geometry, size, EPSILON * size, TimeLimit.of_work(FILLING), lambda what: tell(what, share)
    )
    owner = site_owners(geometry.sites, list(geometry.regions))
    tools = [tools_of(geometry, number, owner) for number in range(len(geometry.regions))]
    tell("labelling", share)
    mesh = Bisected(given)
    extracted = _walls(geometry, given, mesh, tools, floor, SHARE * fineness * geometry.diagonal)
    lost = sum(int(found.lost.sum()) for found in extracted)
    if lost:
        at = next(found.points[found.lost][0] for found in extracted if found.lost.any())
        raise GeometryError(f"{lost} points of walls have no place, one near {{at}}", at=at)
    tell("triangulating sheets", share)
    shown = _smooth(geometry, given, mesh, tools, extracted, floor)
    result = _Try(None, ["nothing was tried"])
    for left in reversed(range(FINENESSES)):
        tell("refining", share)
        made, kept = refined(shown.complex, fineness * geometry.diagonal, lenient=True)
        tell("measuring", share)
        described = Described(geometry, given, tools, shown, made, kept)
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
        lines = [str(line) for line in explained(found, stated, geometry.sites, volume)]
        if not lines:
            mesh, radius = described.mesh, described.radius
            lines = without_jump(mesh, radius, region, geometry.sites)
        failures += [f"region {region.name}: {line}" for line in lines]
    if failures:
        return _Try(None, failures)
    return _Try(_skeleton(geometry, stated, described, [region for region, _ in regions]), [])


def _smooth(
    geometry: Geometry,
    given: Interior,
    mesh: Bisected,
    tools: list[RegionTools],
    extracted: list[Extracted],
    floor: float,
) -> Drawn:
    """The complex, smoothed; triangles that stay folded are contracted."""
    boundary = len(given.plan.complex.patches)
    extracted = [
        pinned_ends(tool.incidence, tool.loci, found)
        for tool, found in zip(tools, extracted, strict=True)
    ]
    near: Array | None = None
    for left in reversed(range(UNFOLDINGS)):
        shown = drawn(geometry, given, mesh, tools, extracted, floor / 2)
        smooth, folded = unfolded(
            shown.complex, boundary, _pinned(shown, extracted), _at(shown, near)
        )
        if not left or not len(folded):
            break
        bad = {tuple(row) for row in np.sort(folded, axis=1).tolist()}
        fewer = []
        for found, vertices, tool in zip(extracted, shown.vertices, tools, strict=True):
            moved = replace(found, points=smooth.points[vertices])
            corners = np.sort(vertices[found.triangles], axis=1).tolist()
            wanted = np.array([tuple(row) in bad for row in corners], dtype=np.bool_)
            wanted |= thin(moved.points, moved.sites, moved.triangles, tool.placer)
            least = ONE * geometry.diagonal
            fewer.append(
                contracted(
                    moved, wanted, moved.short_edges(CLOSE * geometry.diagonal), least, tool.placer
                )
            )
        extracted = fewer
        near = smooth.points[np.unique(folded)]
    return replace(shown, complex=smooth)


def _at(shown: Drawn, places: Array | None) -> Ints | None:
    """The points of a complex that are nearest to some places (k, 3)."""
    if places is None:
        return None
    return np.unique(cKDTree(shown.complex.points).query(places)[1])


def _pinned(shown: Drawn, extracted: list[Extracted]) -> Ints:
    """The points that stay where they are."""
    pairs = zip(shown.vertices, extracted, strict=True)
    return np.concatenate([vertices[found.pinned] for vertices, found in pairs])


def _walls(
    geometry: Geometry,
    given: Interior,
    mesh: Bisected,
    tools: list[RegionTools],
    floor: float,
    chord: float,
) -> list[Extracted]:
    """The walls of all regions; tetrahedra around those that cannot be placed are refined."""
    labellers, known = [], []
    for number, tool in enumerate(tools):
        queries = region_queries(geometry.index, number)
        face_of_patch = np.full(len(given.plan.complex.patches), -1, dtype=np.int64)
        sides = given.surface.face_sides(number, len(geometry.regions[number].faces))
        for face, own in enumerate(sides):
            face_of_patch[[patch for patch, _ in own]] = face
        labeller = Labeller(queries, tool.incidence, face_of_patch)
        refiner = Refiner(queries, labeller, tool.placer, number)
        labellers.append((labeller, refiner))
        known.append(labeller.labels(mesh, None))
    found: list[Extracted] = []
    for left in reversed(range(AGAIN)):
        for number, (labeller, refiner) in enumerate(labellers):
            known[number] = refiner.refined(
                mesh, labeller.labels(mesh, known[number]), floor, chord
            )
        found = []
        for number, (labeller, _) in enumerate(labellers):
            known[number] = labeller.labels(mesh, known[number])
            tool = tools[number]
            extractor = Extractor(
                region_queries(geometry.index, number),
                tool.placer,
                tool.owner,
                geometry.regions[number].diagonal,
            )
            found.append(extractor.extracted(mesh, known[number], number))
        if not left or not _refined_where_lost(mesh, found, floor):
            break
    return found


def _refined_where_lost(mesh: Bisected, found: list[Extracted], floor: float) -> bool:
    """Refine the tetrahedra in which walls could not be placed; whether there were any."""
    wanted = np.zeros(len(mesh.tets), dtype=np.bool_)
    for number, walls in enumerate(found):
        rows = np.flatnonzero(mesh.region == number)
        if not len(walls.passed):
            wanted[rows[walls.tet[walls.lost[walls.triangles].any(axis=1)]]] = True
    corners = mesh.points[mesh.tets]
    wanted &= norm(corners - corners[:, [1, 2, 3, 0]]).max(axis=1) > FINEST * floor
    mesh.shorten(wanted)
    return bool(wanted.any()) | _cut_through(mesh, found)


def _cut_through(mesh: Bisected, found: list[Extracted]) -> bool:
    """Put nodes into zones that edges lead through; whether there were any."""
    edges, which = mesh.edges()
    number = {(a, b): k for k, (a, b) in enumerate(edges.tolist())}
    chosen = np.zeros(len(edges), dtype=np.bool_)
    at: Array = mesh.points[edges].mean(axis=1)
    for walls in found:
        for pair, point in zip(np.sort(walls.passed, axis=1).tolist(), walls.passing, strict=True):
            k = number.get((pair[0], pair[1]))
            if k is not None:
                chosen[k], at[k] = True, point
    chosen &= ~mesh.boundary_edges(edges)
    if chosen.any():
        mesh.halve(edges, which, chosen, at)
    return bool(chosen.any())


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
