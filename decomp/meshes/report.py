"""What a mesh has and how good it is, as values, text and JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from decomp.csg.model import Ignored
from decomp.meshes.deciding import Decider, deciders
from decomp.meshes.edge_lengths import EdgeLengths, edge_lengths
from decomp.meshes.model import Group, GroupKind, TetMesh
from decomp.meshes.pieces import whole_name
from decomp.meshes.quality import dihedral_angles, inverted, radius_ratios, volumes
from decomp.near import listed
from decomp.shown import Shown
from decomp.skeletons.model import Method
from decomp.vectors import Array, Ints

AS_ASKED = 0.02
"""A mean length that was wanted is told if it is below the one asked for by more than this part."""
PLURALS = {"vertex": "vertices"}


@dataclass(frozen=True)
class Volume(Shown):
    """A region or a cell.

    Args:
        name: of it.
        region: that it is, or is in.
        faces: of the boundary that a cell has.
        tets: how many.
        volume: of the tetrahedra.
        exact: the region's, or that of the cell inside the skeleton's complex; None if unknown.
        maxh: what the input asks for.
        number: of a cell, as the field `cell` tells it; of a region, from 1.
        edges: of a region; None for cells.
        method, cause: how a region's skeleton was found, and why it was not traced; None for cells
            and without them.
        deciders: what asks for shorter edges in a region than are asked for all over it.
    """

    name: str
    region: str
    faces: tuple[str, ...]
    tets: int
    volume: float
    exact: float | None
    maxh: float | None
    number: int
    edges: EdgeLengths | None = None
    method: str | None = None
    cause: str | None = None
    deciders: tuple[Decider, ...] = ()

    @property
    def error(self) -> float | None:
        """Relative to the exact volume, with its sign."""
        return None if not self.exact else self.volume / self.exact - 1


@dataclass(frozen=True)
class Surface(Shown):
    """A group of triangles.

    Args:
        name, kind, regions, bc: the group's.
        triangles: how many.
        maxh: what the input asks for on this face, or on one of an interface's faces.
        edges: of a face or interface with a `maxh`; None for others.
    """

    name: str
    kind: str
    regions: tuple[str, ...]
    triangles: int
    bc: int | None
    maxh: float | None = None
    edges: EdgeLengths | None = None


@dataclass(frozen=True)
class Written(Shown):
    """A group as files have it.

    Args:
        name, dimension, tag, members: the group's.
        kind: the group's, of volumes of regions `volume`.
        elements: how many.
    """

    name: str
    dimension: int
    kind: str
    tag: int
    elements: int
    members: tuple[str, ...]


@dataclass(frozen=True)
class Quality:
    """Of all tetrahedra, by their corners; angles in degrees.

    Args:
        least_dihedral: of all.
        greatest_dihedral: of all.
        mean_dihedral: of all six of all.
        mean_least_dihedral: mean of each one's least.
        least_radius_ratio: of all; the ratio is 3 r / R, 1 for regular ones.
        mean_radius_ratio: of all.
        inverted: with a Jacobian of zero or less at a point of integration.
    """

    least_dihedral: float
    greatest_dihedral: float
    mean_dihedral: float
    mean_least_dihedral: float
    least_radius_ratio: float
    mean_radius_ratio: float
    inverted: int


@dataclass(frozen=True)
class Report(Shown):
    """A mesh in figures.

    Args:
        model: its name.
        order: of the elements.
        nodes: how many.
        tets: how many.
        triangles: how many.
        groups: that are written.
        regions: of the model, whatever is written.
        cells: likewise.
        surfaces: that are written.
        edges: of all tetrahedra.
        quality: of the tetrahedra.
        unprojected: nodes that are not on their exact surfaces.
        bridging: tetrahedra with all four corners on the boundary of a region.
        stages: what was done, and for how many seconds.
        ignored: statements of the model's file, and regions without interior.
    """

    model: str
    order: int
    nodes: int
    tets: int
    triangles: int
    groups: tuple[Written, ...]
    regions: tuple[Volume, ...]
    cells: tuple[Volume, ...]
    surfaces: tuple[Surface, ...]
    edges: EdgeLengths
    quality: Quality
    unprojected: int
    bridging: int
    stages: tuple[tuple[str, float], ...]
    ignored: tuple[Ignored, ...]


def report(
    mesh: TetMesh,
    exact: Mapping[str, float] | None = None,
    stages: Sequence[tuple[str, float]] = (),
    ignored: Sequence[Ignored] = (),
) -> Report:
    """Measure a mesh.

    Args:
        mesh: to measure.
        exact: volumes of regions by name, where its groups do not know them.
        stages: what was done to make it, and for how many seconds.
        ignored: statements of the model's file that were not used.
    """
    contents = volumes(mesh.points, mesh.tets)
    parts, of_region = mesh.all_parts, mesh.all_parts.region_of_tets
    ways = {each.region: (each.method, each.cause) for each in mesh.found_by}
    regions = []
    for each in parts.regions:
        found = _volume(each, contents[of_region == each.tag])
        if found.exact is None and exact:
            found = replace(found, exact=exact.get(each.name))
        own = mesh.tets[of_region == each.tag]
        edges = edge_lengths(mesh.points, own, each.length, mesh.lengths)
        method, cause = ways.get(each.name, (None, None))
        why = deciders(mesh, own)
        regions.append(replace(found, edges=edges, method=method, cause=cause, deciders=why))
    return Report(
        mesh.name,
        mesh.order,
        len(mesh.points),
        len(mesh.tets),
        len(mesh.triangles),
        tuple(_written(mesh, group) for group in mesh.groups),
        tuple(regions),
        tuple(_volume(each, contents[parts.of_tets == each.tag]) for each in parts.cells),
        tuple(_surface(mesh, group) for group in mesh.groups if group.dimension == 2),
        edge_lengths(mesh.points, mesh.tets, wanted=mesh.lengths),
        _quality(mesh),
        len(mesh.unprojected),
        _bridging(mesh),
        tuple(stages),
        tuple(ignored),
    )


def _written(mesh: TetMesh, group: Group) -> Written:
    tags = (mesh.node_tags, mesh.line_tags, mesh.triangle_tags, mesh.tet_tags)[group.dimension]
    kind = "volume" if group.kind is GroupKind.REGION else group.kind.value
    count = int((tags == group.tag).sum())
    return Written(group.name, group.dimension, kind, group.tag, count, group.members)


def _bridging(mesh: TetMesh) -> int:
    """How many tetrahedra have all four corners on faces or interfaces."""
    outer = [g.tag for g in mesh.groups if g.kind in (GroupKind.FACE, GroupKind.INTERFACE)]
    on = np.zeros(len(mesh.points), dtype=np.bool_)
    on[mesh.triangles[np.isin(mesh.triangle_tags, outer)]] = True
    return int(on[mesh.tets[:, :4]].all(axis=1).sum())


def _volume(part: Group, contents: Array) -> Volume:
    """A region or cell whose tetrahedra have some volumes (m,)."""
    content = float(contents.sum())
    where = (part.name, part.regions[0], part.faces)
    return Volume(*where, len(contents), content, part.volume, part.maxh, part.tag)


def _surface(mesh: TetMesh, group: Group) -> Surface:
    own = mesh.triangles[mesh.triangle_tags == group.tag]
    edges = None
    if group.maxh is not None:
        edges = edge_lengths(mesh.points, own, group.length, mesh.lengths)
    return Surface(
        group.name, group.kind.value, group.regions, len(own), group.bc, group.maxh, edges
    )


def _quality(mesh: TetMesh) -> Quality:
    angles = dihedral_angles(mesh.points, mesh.tets)
    ratios = radius_ratios(mesh.points, mesh.tets)
    return Quality(
        float(angles.min()),
        float(angles.max()),
        float(angles.mean()),
        float(angles.min(axis=1).mean()),
        float(ratios.min()),
        float(ratios.mean()),
        int(inverted(mesh.points, mesh.tets).sum()),
    )


def as_json(found: Report) -> dict[str, Any]:
    """A report as JSON values; volumes and lengths in the model's units, times in seconds."""
    result = asdict(found)
    for key, values in (("regions", found.regions), ("cells", found.cells)):
        for entry, value in zip(result[key], values, strict=True):
            entry["error"] = value.error
    result["stages"] = [{"stage": what, "seconds": seconds} for what, seconds in found.stages]
    result["seconds"] = sum(seconds for _, seconds in found.stages)
    result["tets_per_cell"] = _spread([cell.tets for cell in found.cells])
    return result


def _spread(counts: Sequence[int]) -> dict[str, float] | None:
    if not counts:
        return None
    values: Ints = np.array(counts)
    return {
        "least": int(values.min()),
        "median": float(np.median(values)),
        "greatest": int(values.max()),
    }


def as_text(found: Report) -> list[str]:
    """A report as lines for people."""
    lines = [
        f"model {found.model}: {found.tets} tetrahedra of order {found.order}, "
        f"{found.nodes} nodes, {found.triangles} tagged triangles"
    ]
    for region in found.regions:
        cells = sum(cell.region == region.name for cell in found.cells)
        inside = f" in {_plural(cells, 'cell')}" if cells else ""
        lines.append(
            f"  region {region.name}: {region.tets} tetrahedra{inside}, volume "
            f"{region.volume:.9g}{_error(region)}"
        )
        if region.edges is not None:
            lines.append(f"    {edges_text(region.edges)}")
            lines += _decided(region.deciders, region.edges.asked)
        if region.method == Method.SAMPLED.value:
            why = "" if region.cause is None else f": tracing failed, as {region.cause}"
            lines.append(f"    skeleton sampled{why}")
    if found.cells:
        spread = _spread([cell.tets for cell in found.cells])
        errors = [abs(cell.error) for cell in found.cells if cell.error is not None]
        worst = f", volumes within {max(errors):.1e} of the skeleton's" if errors else ""
        assert spread is not None
        lines.append(
            f"  tetrahedra per cell: {spread['least']} to {spread['greatest']}, "
            f"median {spread['median']:g}{worst}"
        )
    kinds = [group.kind for group in found.groups]
    counted = [_plural(kinds.count(kind), kind) for kind in dict.fromkeys(kinds)]
    lines.append(f"  groups: {', '.join(counted)}")
    lines += [
        f"    {surface.name}: {edges_text(surface.edges)}"
        for surface in found.surfaces
        if surface.edges is not None
    ]
    if len(found.regions) > 1:
        lines.append(f"  all {edges_text(found.edges)}")
    quality = found.quality
    lines += [
        f"  dihedral angles {quality.least_dihedral:.1f} to {quality.greatest_dihedral:.1f} "
        f"degrees, mean of the least {quality.mean_least_dihedral:.1f}",
        f"  radius ratios from {quality.least_radius_ratio:.3f}, "
        f"mean {quality.mean_radius_ratio:.3f}; {quality.inverted} inverted",
        f"  nodes left off their exact surfaces: {found.unprojected}; tetrahedra with all corners "
        f"on the boundary: {found.bridging}",
    ]
    lines += [
        f"  group {group.name}: {listed(group.members)}"
        for group in found.groups
        if group.members
        and (group.dimension == 3 or set(map(whole_name, group.members)) != {group.name})
    ]
    lines += [
        f"  cell {cell.name}: {', '.join(cell.faces)}"
        for cell in found.cells
        if GroupKind.CELL.value in kinds
        and "+".join(cell.faces) != cell.name.removeprefix(f"{cell.region}/")
    ]
    lines += [f"  ignored: {each}" for each in found.ignored]
    if found.stages:
        lines.append("  " + _times(found.stages))
    return lines


def _decided(found: Sequence[Decider], asked: float | None) -> list[str]:
    """What decides, a line for each."""
    than = "" if asked is None else f" where {asked:.4g} was asked"
    return [
        f"    {each.what} decides at {each.share:.0%} of its nodes: {each.length:.3g}{than}"
        for each in found
    ]


def edges_text(edges: EdgeLengths) -> str:
    """Lengths of edges in words."""
    text = f"edges: mean {edges.mean:.4g}, longest {edges.longest:.4g}"
    if edges.asked is None:
        return text
    less = edges.wanted is not None and edges.wanted < (1 - AS_ASKED) * edges.asked
    return f"{text} (asked {edges.asked:.4g}" + (
        f", {edges.wanted:.4g} in the mean with curvature and thin places)" if less else ")"
    )


def _times(stages: Sequence[tuple[str, float]]) -> str:
    total = sum(seconds for _, seconds in stages)
    parts = ", ".join(f"{what} {seconds:.1f}" for what, seconds in stages if seconds >= 0.05)
    return f"{total:.1f} s: {parts}" if parts else f"{total:.1f} s"


def _error(volume: Volume) -> str:
    if volume.exact is None or volume.error is None:
        return ""
    return f" (exact {volume.exact:.9g}, off by {volume.error:+.1e})"


def _plural(count: int, noun: str) -> str:
    return f"1 {noun}" if count == 1 else f"{count} {PLURALS.get(noun, f'{noun}s')}"
