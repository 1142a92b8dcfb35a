"""Abaqus and CalculiX input (.inp): nodes, C3D4 or C3D10 elements, sets and surfaces by name.

Each volume is an element set, and so is each region of several cells. Each surface is a node set
(*NSET) and, for loads and contact, a list of element faces (*SURFACE), of the elements that its
normals leave. Curves and points are node sets. Names are made valid: letters, digits and `_`, in
capitals, at most 80, each once among the element sets and once among the others; comments at the
file's head tell which is which. Sections, materials and steps are for the user.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

import numpy as np

from decomp.meshes.incidence import incidence
from decomp.meshes.model import Group, GroupKind, TetMesh
from decomp.meshes.ordering import in_vtk_order
from decomp.vectors import Ints

LONGEST = 80
PER_LINE = 12
FIELD = 20
"""So many characters of a number are read; CalculiX stops where an exponent is cut in two."""
SIDES = (1, 2, 3, 4)
"""Abaqus's number of each face of `incidence.FACES`: 1-2-3, 1-4-2, 2-4-3, 3-4-1."""


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file."""
    volumes = [group for group in mesh.groups if group.dimension == 3]
    surfaces = [group for group in mesh.groups if group.dimension == 2]
    regions = _joined_regions(volumes)
    sets = valid_names([*(group.name for group in volumes), *regions])
    own, joined = sets[: len(volumes)], sets[len(volumes) :]
    thin = [group for group in mesh.groups if group.dimension < 2]
    outer = valid_names(group.name for group in (*surfaces, *thin))
    lines = ["*HEADING", f"{re.sub(r'[^ -~]', '_', mesh.name)}, by decomp"]
    named = [*(group.name for group in volumes), *regions]
    lines += [f"** ELSET {short}: {name}" for short, name in zip(sets, named, strict=True)]
    for short, group in zip(outer, (*surfaces, *thin), strict=True):
        what = "NSET, SURFACE" if group.dimension == 2 else "NSET"
        lines.append(f"** {what} {short}: {group.name}")
    lines += ["*NODE, NSET=NALL", *_nodes(mesh)]
    kind = "C3D4" if mesh.order == 1 else "C3D10"
    tets = in_vtk_order(mesh.tets) + 1
    for group, name in zip(volumes, own, strict=True):
        rows = np.flatnonzero(mesh.tet_tags == group.tag)
        lines.append(f"*ELEMENT, TYPE={kind}, ELSET={name}")
        lines += [
            ", ".join(map(str, row)) for row in np.column_stack([rows + 1, tets[rows]]).tolist()
        ]
    lines += ["*ELSET, ELSET=EALL", *own]
    for region, name in zip(regions, joined, strict=True):
        lines.append(f"*ELSET, ELSET={name}")
        lines += [n for g, n in zip(volumes, own, strict=True) if region in g.regions]
    lines += _surfaces(mesh, surfaces, outer[: len(surfaces)])
    lines += _node_sets(mesh, thin, outer[len(surfaces) :])
    return ("\n".join(lines) + "\n").encode()


def valid_names(names: Iterable[str]) -> list[str]:
    """Names that Abaqus takes, all different."""
    seen = {"NALL", "EALL"}
    result = []
    for name in names:
        base = re.sub(r"[^A-Z0-9]+", "_", name.upper()).strip("_")
        if not base or not base[0].isalpha():
            base = f"G_{base}".rstrip("_")
        short, count = base[:LONGEST], 1
        while short in seen:
            count += 1
            end = f"_{count}"
            short = base[: LONGEST - len(end)] + end
        seen.add(short)
        result.append(short)
    return result


def _joined_regions(volumes: list[Group]) -> list[str]:
    """The regions that consist of cells."""
    of_cells = {name for g in volumes if g.kind is GroupKind.CELL for name in g.regions}
    return sorted(of_cells)


def _nodes(mesh: TetMesh) -> Iterator[str]:
    for number, point in enumerate(mesh.points.tolist(), 1):
        yield ", ".join([str(number), *map(number_field, point)])


def number_field(value: float) -> str:
    """The number with as many digits as a field takes."""
    exact = repr(value)
    if len(exact) <= FIELD:
        return exact
    fitting = (f"{value:.{digits}g}" for digits in range(16, 0, -1))
    return next(text for text in fitting if len(text) <= FIELD)


def _surfaces(mesh: TetMesh, surfaces: list[Group], names: list[str]) -> Iterator[str]:
    pairs = incidence(mesh.triangles, mesh.tets)
    tags = np.where(pairs.outward > 0, mesh.triangle_tags[pairs.triangle], 0)
    for group, name in zip(surfaces, names, strict=True):
        nodes = np.unique(mesh.triangles[mesh.triangle_tags == group.tag])
        yield f"*NSET, NSET={name}"
        yield from _rows(nodes + 1)
        faces = pairs.face[tags == group.tag]
        yield f"*SURFACE, NAME={name}, TYPE=ELEMENT"
        for face in faces.tolist():
            yield f"{face // 4 + 1}, S{SIDES[face % 4]}"


def _node_sets(mesh: TetMesh, groups: list[Group], names: list[str]) -> Iterator[str]:
    for group, name in zip(groups, names, strict=True):
        elements, tags = (
            (mesh.lines, mesh.line_tags)
            if group.dimension == 1
            else (mesh.nodes[:, None], mesh.node_tags)
        )
        yield f"*NSET, NSET={name}"
        yield from _rows(np.unique(elements[tags == group.tag]) + 1)


def _rows(numbers: Ints) -> Iterator[str]:
    listed = numbers.tolist()
    for start in range(0, len(listed), PER_LINE):
        yield ", ".join(map(str, listed[start : start + PER_LINE]))
