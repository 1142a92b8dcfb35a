"""From a model to a tetrahedral mesh with a name on every cell, face, interface and sheet.

1. The exact skeleton, as one complex of triangles.
2. fTetWild fills the box around it with tetrahedra that conform to it.
3. Each tetrahedron is told its cell, each triangle between cells its patch, by exact queries.
4. Nodes are moved onto the exact surfaces, curves and points that they belong to.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from decomp.complex.refine_elements import Elements
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import InputError
from decomp.geometry import Geometry
from decomp.tetra.cells import cell_map
from decomp.tetra.child import MeshingError, Settings, TimeLimit, tetrahedralized
from decomp.tetra.classify import classified
from decomp.tetra.conforming import Conformed, conformed
from decomp.tetra.expected import expected_tets, least_tets
from decomp.tetra.features import fitting_epsilon, usual_epsilon
from decomp.tetra.field import first_length, size_field
from decomp.tetra.fields import checked_fields, with_fields
from decomp.tetra.groups import cell_groups, region_groups, surface_groups
from decomp.tetra.layout import layout
from decomp.tetra.memory import check_memory
from decomp.tetra.mesh import TetMesh
from decomp.tetra.quadratic import quadratic
from decomp.tetra.sizes import Wanted, region_sizes, wishes
from decomp.tetra.soup import soup
from decomp.tetra.splitting import freed
from decomp.tetra.strayed import strayed
from decomp.tetra.surface import MeshSurface, SurfaceMaker
from decomp.tetra.tagging import Tagger
from decomp.tetra.targets import Finder
from decomp.vectors import Array, Ints

CHORD, COARSEST = 0.4, 0.6
"""How far triangles are made to be off their surfaces, and may be, in parts of epsilon."""
SHORTEST = 7.0
"""The shortest edges are at least so many epsilons long."""
FAR, AGAIN = 3.0, 0.9
"""Nodes farther off their faces than so many epsilons tell that TetWild has failed to insert a
triangle. It does so by chance, and is tried once more, with this part of epsilon."""
LIMIT, LIMIT_PER_TET = 600.0, 5e-3
"""Seconds that TetWild may compute, in all and for each expected tetrahedron."""

SURFACE = 0.3
"""Which part of the whole is behind when there is a complex."""

Progress = Callable[[str, float], None]


def mesh(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    *,
    size: float | None = None,
    layers: int | None = None,
    elements_per_circle: float | None = None,
    order: int = 1,
    cells: Literal["skeleton", "face"] = "skeleton",
    volumes: Literal["cells", "regions"] = "cells",
    sheets: bool = True,
    fields: Sequence[str] = (),
    timeout: float | None = None,
    progress: Progress | None = None,
) -> TetMesh:
    """Mesh a model.

    Args:
        source: a geometry, or what one can be made of.
        size: largest edge length wanted, in model units.
        layers: at least so many elements across thin parts.
        elements_per_circle: at least so many edges around a full circle of a curved face.
        order: 1 for straight elements, 2 for quadratic ones.
        cells: `skeleton`, or `face` for one cell for each boundary face.
        volumes: `cells`, or `regions` for one physical volume for each region.
        sheets: whether triangles between the cells of a region are tagged.
        fields: values wanted on the mesh: `distance`, `thickness`, `nearest`, `cell`, `region`
            (`decomp.tetra.fields`).
        timeout: seconds that TetWild may take; by default ten minutes of computing, or 5 ms for
            each expected tetrahedron where that is more, and four times as long by the clock.
        progress: told what is being done, and which part of the whole (0 to 1) is behind.

    Raises:
        InputError: an option is out of its range, or the mesh would not fit into memory.
        FileError: the file cannot be read.
        GeometryError: the solid or its skeleton cannot be computed.
        MeshingError: TetWild fails.
    """
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    tell = progress or (lambda what, done: None)
    for value, allowed, what in (
        (order, (1, 2), "order"),
        (cells, ("skeleton", "face"), "cells"),
        (volumes, ("cells", "regions"), "volumes"),
    ):
        if value not in allowed:
            raise InputError(f"{what} must be one of {allowed}, got {value!r}")
    asked = checked_fields(fields)
    wanted = Wanted(size, layers, elements_per_circle)
    maker = SurfaceMaker(geometry, lambda what, done: tell(what, SURFACE * done))
    sizes = region_sizes(geometry, wanted)
    check_memory(least_tets(geometry, sizes), float(sizes.max()))
    by_face = cells == "face"
    made, epsilon = _surface(geometry, maker, float(sizes.min()), by_face)
    tell("sizing", SURFACE)
    wish = wishes(geometry, made, wanted)
    epsilon = min(epsilon, float(wish.lengths.min()) / SHORTEST)
    if made.tolerance > COARSEST * epsilon:
        made = maker.made(CHORD * epsilon, by_face)
    field = size_field(geometry, wish, sizes)
    settings = Settings(first_length(wish, field), epsilon)
    known = cell_map(made)
    plan = layout(made, known)
    expected = expected_tets(geometry, wish, sizes)
    check_memory(expected)
    tell("TetWild", 0.4)
    work = max(LIMIT, LIMIT_PER_TET * expected)
    limit = TimeLimit(timeout) if timeout else TimeLimit.of_work(work)
    elements = Elements(plan.complex)
    given = soup(plan, wish, settings)

    def filled(settings: Settings) -> tuple[Conformed, Finder, Ints]:
        raw = tetrahedralized(*given, settings, field, limit, lambda note: tell(note, 0.5))
        tell("naming", 0.8)
        epsilon = raw.settings.epsilon
        part = classified(geometry, known, raw.points, raw.tets, epsilon)
        points, tets = _used(raw.points, raw.tets[part >= 0])
        points, tets, part = freed(points, tets, part[part >= 0], known.region[known.cell])
        tell("projecting", 0.85)
        tagger = Tagger(geometry, made, known, plan, epsilon)
        finder = Finder(geometry, made, known, plan, elements, epsilon)
        fit = conformed(points, tets, part, tagger, finder, plan, elements, geometry.diagonal)
        return fit, finder, strayed(fit.points, fit.tagged, plan, elements, FAR * epsilon)

    fit, finder, far = filled(settings)
    if len(far):
        tell("TetWild again", 0.4)
        with suppress(MeshingError):  # the first mesh is whole, and tells of its nodes
            again = filled(replace(settings, epsilon=AGAIN * settings.epsilon))
            fit, finder, far = min((fit, finder, far), again, key=lambda found: len(found[2]))
    points, tets, part, tagged, left = fit.points, fit.tets, fit.part, fit.tagged, fit.left
    triangles = tagged.triangles
    if order == 2:
        tell("curving", 0.95)
        curved = quadratic(points, tets, tagged, finder, elements, plan.complex.points)
        points, tets, triangles = curved.points, curved.tets, curved.triangles
        left = np.concatenate([left, curved.left])
    groups, tags = surface_groups(geometry, made, known, plan, tagged, sheets)
    if volumes == "cells":
        solid, tet_tags = cell_groups(geometry, known), known.cell_of(part) + 1
    else:
        solid, tet_tags = region_groups(geometry), known.region_of(part) + 1
    result = TetMesh(
        geometry.model.name,
        points,
        tets,
        tet_tags,
        triangles[tags > 0],
        tags[tags > 0],
        (*solid, *groups),
        left,
    )
    return with_fields(geometry, result, asked, known.cell_of(part) + 1) if asked else result


def _surface(
    geometry: Geometry, maker: SurfaceMaker, length: float, by_face: bool
) -> tuple[MeshSurface, float]:
    """The complex, and the epsilon that it is fine enough for."""
    epsilon = usual_epsilon(geometry, length)
    made = maker.made(CHORD * epsilon, by_face)
    fitting = fitting_epsilon(geometry, made, epsilon)
    if made.tolerance > COARSEST * fitting:
        made = maker.made(CHORD * fitting, by_face)
    return made, fitting


def _used(points: Array, cells: Ints) -> tuple[Array, Ints]:
    """The points that triangles or tetrahedra use, and these renumbered."""
    used = np.unique(cells)
    return points[used], np.searchsorted(used, cells)
