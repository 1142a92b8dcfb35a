"""The triangles, segments and points of a skeleton as arrays, for files that hold meshes.

Sheets and seams are numbered through all regions, as they are in the JSON form.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from decomp.complex.model import LineKind
from decomp.skeletons.cells.surface import used_points
from decomp.skeletons.model import Method, Parity, RegionSkeleton, Skeleton, SkeletonLine
from decomp.skeletons.sheet_kinds import SheetKind, sheet_kinds
from decomp.vectors import Array, Ints
from decomp.voronoi import Kind

KINDS = ("sheet", "seam", "trim", "rim", "reflexive", "face", "interface", "edge", "trim surface")
"""The kinds of elements, by number."""

SURFACES = tuple(Kind)
METHODS = tuple(Method)
PARITIES = {None: -1, Parity.EVEN: 0, Parity.ODD: 1}


@dataclass(frozen=True, eq=False)
class Elements:
    """Triangles, then segments, then single points, each with what is known of it.

    Args:
        points: (n, 3), only those that an element uses.
        radius: distance (n,) to the boundary.
        triangles, segments, singles: indices of points (m, 3), (k, 2), (s, 1).
        kind: of each element (m + k + s,), an index into `KINDS`.
        region: of each element, the first of two for an interface.
        sheet: number of the sheet, -1 for what is none.
        seam: number of the seam, -1 for what is none.
        sites: of each element (m + k + s, w), indices into `Skeleton.sites`, -1 where there are
            fewer than w.
        parity: 0 even, 1 odd, -1 none.
        surface: of each element of a sheet what it lies on, an index into the members of
            `decomp.voronoi.Kind`, -1 for what is none.
        degree: of that surface's equation, -1 where none is known.
        sheet_names: `region/sheet-N` by number.
        sheet_kinds: what each sheet lies on, by number; empty where that is not told.
        methods: of each region (r,) an index into `METHODS`; empty where that is not told.
    """

    points: Array
    radius: Array
    triangles: Ints
    segments: Ints
    singles: Ints
    kind: Ints
    region: Ints
    sheet: Ints
    seam: Ints
    sites: Ints
    parity: Ints
    surface: Ints
    degree: Ints
    sheet_names: tuple[str, ...]
    sheet_kinds: tuple[SheetKind, ...]
    methods: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class _Group:
    """Elements with the same data."""

    corners: Ints
    kind: str
    region: int
    sites: tuple[int, ...]
    sheet: int = -1
    seam: int = -1
    parity: Parity | None = None
    surface: int = -1
    degree: int = -1


def elements(skeleton: Skeleton, *, boundary: bool = False, trims: bool = False) -> Elements:
    """Lay out a skeleton's sheets, seams, trims, rims and reflexive loci.

    Args:
        skeleton: to lay out.
        boundary: lay out the boundary's faces and edges too.
        trims: lay out the trim surfaces too.
    """
    kinds = [k for region in skeleton.regions for k in sheet_kinds(skeleton, region)]
    groups = list(_skeleton_groups(skeleton, kinds))
    if boundary:
        groups += _boundary_groups(skeleton)
    if trims:
        groups += _trim_groups(skeleton)
    groups.sort(key=lambda group: -group.corners.shape[1])
    sizes = [len(group.corners) for group in groups]
    width = max([2, *(len(group.sites) for group in groups)])

    def column(values: Sequence[int]) -> Ints:
        return np.repeat(np.array(values, dtype=np.int64), sizes)

    padded = [[*group.sites, *[-1] * (width - len(group.sites))] for group in groups]
    table = np.array(padded, dtype=np.int64).reshape(-1, width)
    corners = [_stacked(groups, count) for count in (3, 2, 1)]
    flat = np.concatenate([part.reshape(-1) for part in corners])
    points, flat, used = used_points(skeleton.complex.points, flat)
    triangles, segments, singles = np.split(flat, np.cumsum([corners[0].size, corners[1].size]))
    return Elements(
        points,
        skeleton.radius[used],
        triangles.reshape(-1, 3),
        segments.reshape(-1, 2),
        singles.reshape(-1, 1),
        column([KINDS.index(group.kind) for group in groups]),
        column([group.region for group in groups]),
        column([group.sheet for group in groups]),
        column([group.seam for group in groups]),
        np.repeat(table, sizes, axis=0),
        column([PARITIES[group.parity] for group in groups]),
        column([group.surface for group in groups]),
        column([group.degree for group in groups]),
        tuple(
            f"{region.name}/sheet-{first + k}"
            for region, first in zip(skeleton.regions, first_sheets(skeleton), strict=True)
            for k in range(len(region.sheets))
        ),
        tuple(kinds),
        tuple(METHODS.index(region.method) for region in skeleton.regions),
    )


def first_sheets(skeleton: Skeleton) -> list[int]:
    """The number of each region's first sheet."""
    return _firsts([len(region.sheets) for region in skeleton.regions])


def first_seams(skeleton: Skeleton) -> list[int]:
    """The number of each region's first seam."""
    return _firsts([len(region.seams) for region in skeleton.regions])


def _firsts(counts: list[int]) -> list[int]:
    return [sum(counts[:k]) for k in range(len(counts))]


def _stacked(groups: Sequence[_Group], count: int) -> Ints:
    parts = [group.corners for group in groups if group.corners.shape[1] == count]
    return np.concatenate([np.empty((0, count), dtype=np.int64), *parts])


def _skeleton_groups(skeleton: Skeleton, kinds: Sequence[SheetKind]) -> Iterator[_Group]:
    mesh = skeleton.complex
    numbers = zip(skeleton.regions, first_sheets(skeleton), first_seams(skeleton), strict=True)
    for at, (region, first_sheet, first_seam) in enumerate(numbers):
        for k, sheet in enumerate(region.sheets):
            lies_on = kinds[first_sheet + k]
            yield _Group(
                mesh.patches[sheet.patch].triangles,
                "sheet",
                at,
                sheet.sites,
                sheet=first_sheet + k,
                parity=sheet.parity,
                surface=SURFACES.index(lies_on.kind),
                degree=-1 if lies_on.degree is None else lies_on.degree,
            )
        for kind, line, seam in _lines(region, first_seam):
            corners = _pairs(mesh.lines[line.line].vertices)
            yield _Group(corners, kind, at, line.sites, seam=seam)
        for locus in region.reflexive:
            corners = (
                np.array([[locus.vertex]], dtype=np.int64)
                if locus.line is None
                else _pairs(mesh.lines[locus.line].vertices)
            )
            yield _Group(corners, "reflexive", at, (locus.site,))


def _lines(region: RegionSkeleton, first_seam: int) -> Iterator[tuple[str, SkeletonLine, int]]:
    for k, line in enumerate(region.seams):
        yield "seam", line, first_seam + k
    for kind, lines in (("trim", region.trims), ("rim", region.rims)):
        for line in lines:
            yield kind, line, -1


def _pairs(chain: Ints) -> Ints:
    return np.stack([chain[:-1], chain[1:]], axis=1)


def _boundary_groups(skeleton: Skeleton) -> list[_Group]:
    """Each boundary patch once, with the sites of the faces on both its sides, and each edge."""
    owners: dict[int, list[tuple[int, int]]] = {}
    number = {
        (site.region, site.index): k
        for k, site in enumerate(skeleton.sites)
        if site.kind.value == "face"
    }
    for at, region in enumerate(skeleton.regions):
        for face, sides in enumerate(region.face_sides):
            for patch, _ in sides:
                owners.setdefault(patch, []).append((at, number[at, face]))
    groups = [
        _Group(
            skeleton.complex.patches[patch].triangles,
            skeleton.complex.patches[patch].kind.value,
            sides[0][0],
            tuple(site for _, site in sides),
        )
        for patch, sides in owners.items()
    ]
    groups += [
        _Group(_pairs(line.vertices), "edge", -1, ())
        for line in skeleton.complex.lines
        if line.kind is LineKind.EDGE
    ]
    return groups


def _trim_groups(skeleton: Skeleton) -> list[_Group]:
    """Each trim surface once: they are the sides of face cells that no skeleton cell has."""
    found: dict[int, _Group] = {}
    for at, region in enumerate(skeleton.regions):
        kept = {patch for cell in region.cells for patch, _ in cell.sides}
        for cell in region.face_cells:
            for patch, _ in cell.sides:
                if patch not in kept:
                    triangles = skeleton.complex.patches[patch].triangles
                    found.setdefault(patch, _Group(triangles, "trim surface", at, ()))
    return list(found.values())
