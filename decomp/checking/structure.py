"""What can be wrong with a mesh by itself, whatever it is a mesh of."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from decomp.meshes.faces import EDGES, TRIANGLE_EDGES
from decomp.meshes.files.msh_reader import NONE, SEVERAL, ReadMesh
from decomp.meshes.incidence import faces_of, incidence, row_keys
from decomp.meshes.quality import inverted
from decomp.places import place
from decomp.vectors import Array, Ints


def structural_shortcomings(mesh: ReadMesh) -> Iterator[str]:
    """One line for each kind of fault: turned elements, faces, tags."""
    tet_places = mesh.points[mesh.tets[:, :4]].mean(axis=1)
    turned = np.flatnonzero(inverted(mesh.points, mesh.tets))
    yield from counted(turned, tet_places, "inverted tetrahedra")
    yield from _groups(mesh)
    if len(mesh.triangles):
        keys = row_keys(mesh.triangles[:, :3])
        yield from counted(_repeated(keys), _middles(mesh), "triangles that stand twice in it")
    yield from _faces(mesh)
    if mesh.tets.shape[1] == 10:
        yield from _middle_nodes(mesh)


def counted(rows: Ints, places: Array, what: str) -> Iterator[str]:
    """A line that tells how many there are and where the first one is; none if there are none."""
    if len(rows):
        yield f"{len(rows)} {what}, the first near {place(places[rows[0]])}"


def _middles(mesh: ReadMesh) -> Array:
    return np.asarray(mesh.points[mesh.triangles[:, :3]].mean(axis=1))


def _repeated(keys: Ints) -> Ints:
    """Rows of keys that an earlier row has."""
    _, first = np.unique(keys, return_index=True)
    return np.setdiff1d(np.arange(len(keys)), first)


def _groups(mesh: ReadMesh) -> Iterator[str]:
    for what, elements, tags in (
        ("tetrahedra", mesh.tets, mesh.tet_tags),
        ("triangles", mesh.triangles, mesh.triangle_tags),
    ):
        places = mesh.points[elements[:, :3]].mean(axis=1)
        yield from counted(np.flatnonzero(tags == NONE), places, f"{what} in no physical group")
        several = np.flatnonzero(tags == SEVERAL)
        yield from counted(several, places, f"{what} in several physical groups")


def _faces(mesh: ReadMesh) -> Iterator[str]:
    faces = faces_of(mesh.tets)
    places = mesh.points[faces].mean(axis=1)
    keys = row_keys(faces)
    _, first, which, count = np.unique(
        keys, return_index=True, return_inverse=True, return_counts=True
    )
    yield from counted(first[count > 2], places, "faces in three tetrahedra or more")
    pairs = incidence(mesh.triangles, mesh.tets)
    tagged = np.zeros(len(first), dtype=np.bool_)
    tagged[which.reshape(-1)[pairs.face]] = True
    bare = first[(count == 1) & ~tagged]
    yield from counted(bare, places, "boundary faces without a physical group")
    loose = np.setdiff1d(np.arange(len(mesh.triangles)), pairs.triangle)
    yield from counted(loose, _middles(mesh), "triangles that are faces of no tetrahedron")
    ends = count[which.reshape(-1)[pairs.face]] == 1
    inward = np.unique(pairs.triangle[ends & (pairs.outward == 0)])
    yield from counted(inward, _middles(mesh), "boundary triangles that point inward")


def _middle_nodes(mesh: ReadMesh) -> Iterator[str]:
    edges = mesh.tets[:, EDGES].reshape(-1, 2)
    middles = mesh.tets[:, 4:].reshape(-1)
    if mesh.triangles.shape[1] == 6:
        edges = np.concatenate([edges, mesh.triangles[:, TRIANGLE_EDGES].reshape(-1, 2)])
        middles = np.concatenate([middles, mesh.triangles[:, 3:].reshape(-1)])
    _, first, which = np.unique(row_keys(edges), return_index=True, return_inverse=True)
    other = np.unique(which[middles != middles[first][which.reshape(-1)]])
    places = mesh.points[edges[first]].mean(axis=1)
    yield from counted(other, places, "edges with more than one middle node")
