"""What lies between a model's near end and its far one, in layers of tetrahedra.

The triangles of the near end are scaled up about the centre step by step. Every step makes a prism
over each, of three tetrahedra. All nodes of the last layer are on the far end's exact faces, for
planes stay parallel and a ball a ball.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from decomp.meshes.faces import EDGES, TRIANGLE_EDGES, edges_of
from decomp.meshes.model import Group, GroupKind, TetMesh
from decomp.meshes.quality import volumes
from decomp.meshing.far.nearer import Nearer
from decomp.meshing.repairs.shortening import LONGEST_EDGE
from decomp.vectors import Array, Ints, norm

LAYER_GROWTH = (1.28, 1.22, 1.17, 1.13, 1.1)
"""Layers grow by the first of these factors with which no edge is too long, else by the last."""

TALLEST = 2.5
"""And by so many edges' length at most."""


@dataclass(frozen=True, eq=False)
class _Front:
    """Triangles of one layer.

    Args:
        nodes: (n,) their numbers in the mesh.
        places: (n, 3) at the near end's scale, about the centre.
        triangles: (k, 3) indices of nodes.
        tags: (k,) of each.
        lengths: (n,) wanted at the near end's scale.
    """

    nodes: Ints
    places: Array
    triangles: Ints
    tags: Ints
    lengths: Array


def swept(mesh: TetMesh, given: Nearer, groups: Sequence[Group]) -> TetMesh:
    """Put back what is between the ends.

    Args:
        mesh: of the model with the near end, of straight elements, in the far one's coordinates.
        given: the two.
        groups: as the far model's mesh has them.
    """
    region = mesh.groups[given.region].name
    names = {f"{region}/{face}" for face in given.faces}
    tags = [g.tag for g in mesh.groups if g.dimension == 2 and g.name in names]
    outer = np.isin(mesh.triangle_tags, tags)
    nodes, triangles = np.unique(mesh.triangles[outer], return_inverse=True)
    assert mesh.lengths is not None
    first = _Front(
        nodes,
        mesh.points[nodes] - given.centre,
        triangles.reshape(-1, 3),
        mesh.triangle_tags[outer],
        mesh.lengths[nodes],
    )
    for growth in _growths(first):
        made = _layers(mesh, first, given, growth)
        ends, _ = edges_of(made[1], EDGES)
        longest = norm(made[0][ends[:, 0]] - made[0][ends[:, 1]]).max()
        if longest <= LONGEST_EDGE * given.size:
            break
    points, new, lengths, last = made
    # nodes of the near end that are off it are off the far one
    off = np.isin(mesh.unprojected, nodes)
    row = np.searchsorted(nodes, mesh.unprojected[off])
    unprojected = np.sort(np.append(mesh.unprojected[~off], last.nodes[row]))
    own = mesh.groups[given.region].tag
    return replace(
        mesh,
        points=points,
        tets=np.concatenate([mesh.tets, new]),
        tet_tags=np.append(mesh.tet_tags, np.full(len(new), own)),
        triangles=np.concatenate([mesh.triangles[~outer], last.nodes[last.triangles]]),
        triangle_tags=np.append(mesh.triangle_tags[~outer], last.tags),
        groups=tuple(groups),
        unprojected=unprojected,
        lengths=lengths,
        reason=None if mesh.reason is None else _carried_on(mesh.reason, nodes, len(points)),
    )


def _carried_on(values: Ints, nodes: Ints, count: int) -> Ints:
    """Values (count,) of all nodes: those of layers have those of the near end's."""
    layers = (count - len(values)) // len(nodes)
    return np.concatenate([values, np.tile(values[nodes], layers)])


def _growths(front: _Front) -> list[float]:
    """Factors by which layers may grow: prisms are not much taller than wide."""
    ends = np.sort(front.triangles[:, TRIANGLE_EDGES].reshape(-1, 2), axis=1)
    mean = float(norm(front.places[ends[:, 0]] - front.places[ends[:, 1]]).mean())
    most = 1 + TALLEST * mean / float(norm(front.places).mean())
    return [growth for growth in LAYER_GROWTH if growth <= most] or [LAYER_GROWTH[-1]]


def _layers(
    mesh: TetMesh, front: _Front, given: Nearer, growth: float
) -> tuple[Array, Ints, Array, _Front]:
    """Points and wanted lengths of the whole mesh, the layers' tetrahedra, and the last front."""
    assert mesh.lengths is not None
    points, lengths, tets = [mesh.points], [mesh.lengths], []
    count, steps = len(mesh.points), int(np.ceil(np.log(given.factor) / np.log(growth)))
    for step in range(1, steps + 1):
        scale = given.factor ** (step / steps)
        below, front = front, replace(front, nodes=count + np.arange(len(front.places)))
        count += len(front.places)
        points.append(given.centre + scale * front.places)
        lengths.append(np.minimum(scale * front.lengths, given.size))
        tets.append(_prisms(below, front))
    every, cells = np.concatenate(points), np.concatenate(tets)
    turned = volumes(every, cells) < 0
    cells[turned] = cells[turned][:, [0, 2, 1, 3]]
    return every, cells, np.concatenate(lengths), front


def _prisms(below: _Front, above: _Front) -> Ints:
    """Three tetrahedra over each triangle; each side is cut from its lower number to above."""
    a, b, c = np.sort(below.triangles, axis=1).T
    low, high = below.nodes, above.nodes
    return np.concatenate(
        [
            np.stack([low[a], low[b], low[c], high[c]], axis=1),
            np.stack([low[a], low[b], high[b], high[c]], axis=1),
            np.stack([low[a], high[a], high[b], high[c]], axis=1),
        ]
    )


def far_groups(near: Sequence[Group], volumes_of: Sequence[float], given: Nearer) -> list[Group]:
    """The groups of a mesh with the near end as they are with the far one.

    Args:
        near: groups.
        volumes_of: the regions', in order.
        given: the two.
    """
    region = near[given.region].name
    found = []
    for group in near:
        if group.kind is GroupKind.REGION:
            group = replace(group, volume=volumes_of[group.tag - 1])
        if group.regions == (region,) and group.maxh is None:
            group = replace(group, length=given.size)
        found.append(group)
    return found
