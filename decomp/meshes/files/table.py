"""The formats of meshes. A new one is a module beside this one, and a line here."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.files.format import Format


@dataclass(frozen=True)
class MeshFormat(Format):
    """A format of meshes.

    Its module has `encoded(mesh)`, which gives the file's bytes; of a format with versions
    `encoded(mesh, text=..., version=...)`. If meshes are read from it, `read(path)` gives a
    `ReadMesh`.

    Args:
        versions: that it can be written in, the usual one first; none for a format that has no
            such choice.
        fields: whether values on the mesh are written.
        is_read: whether meshes are read from it too.
    """

    versions: tuple[str, ...] = ()
    fields: bool = False
    is_read: bool = False


FORMATS = (
    MeshFormat(
        "Gmsh",
        (".msh",),
        "decomp.meshes.files.msh",
        versions=("4.1", "2.2"),
        fields=True,
        is_read=True,
    ),
    MeshFormat("ParaView", (".vtu",), "decomp.meshes.files.vtu", fields=True),
    MeshFormat("FEniCSx", (".xdmf",), "decomp.meshes.files.xdmf"),
    MeshFormat("Abaqus, CalculiX", (".inp",), "decomp.meshes.files.inp"),
    MeshFormat("Medit, MFEM", (".mesh",), "decomp.meshes.files.medit"),
    # what draws pictures reads meshes: it is above this package
    MeshFormat("a picture", (".png",), "decomp.drawing.mesh_picture"),
)
READ = tuple(form for form in FORMATS if form.is_read)
