"""XDMF 3 (.xdmf) with its numbers in it as text, for ParaView and meshio.

Cell data: `gmsh:physical`, the tags of the groups. meshio's own writer drops the groups' names and
reads them all the same; they are written here where it looks for them.
Format: https://www.xdmf.org/index.php/XDMF_Model_and_Format
"""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr

import numpy as np

from decomp.plain import plain
from decomp.tetra.mesh import TetMesh
from decomp.tetra.ordering import in_vtk_order
from decomp.vectors import Array, Ints

TYPES = {3: 4, 6: 36, 4: 6, 10: 38}
"""XDMF's numbers of element types by number of nodes."""


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file: triangles first, then tetrahedra."""
    blocks = [mesh.triangles, in_vtk_order(mesh.tets)]
    topology = np.concatenate([_typed(block).reshape(-1) for block in blocks])
    tags = np.concatenate([mesh.triangle_tags, mesh.tet_tags])
    lines = [
        '<?xml version="1.0"?>',
        '<Xdmf Version="3.0">',
        f"<Domain><Grid Name={quoteattr(plain(mesh.name))}>",
        f'<Geometry GeometryType="XYZ">{_item(mesh.points)}</Geometry>',
        f'<Topology TopologyType="Mixed" NumberOfElements="{len(tags)}">{_item(topology)}'
        "</Topology>",
        f'<Attribute Name="gmsh:physical" AttributeType="Scalar" Center="Cell">{_item(tags)}'
        "</Attribute>",
        f'<Information Name="names" Value="">{escape(_names(mesh))}</Information>',
        "</Grid></Domain>",
        "</Xdmf>",
        "",
    ]
    return "\n".join(lines).encode()


def _typed(elements: Ints) -> Ints:
    return np.insert(elements, 0, TYPES[elements.shape[1]], axis=1)


def _names(mesh: TetMesh) -> str:
    ordered = sorted(mesh.groups, key=lambda group: -group.dimension)
    entries = (
        f'<map key={quoteattr(plain(group.name))} dim="{group.dimension}">{group.tag}</map>'
        for group in ordered
    )
    return f"<main>{''.join(entries)}</main>"


def _item(values: Array | Ints) -> str:
    kind = "Float" if values.dtype.kind == "f" else "Int"
    shape = " ".join(map(str, values.shape))
    words = " ".join(map(repr, values.reshape(-1).tolist()))
    return (
        f'<DataItem DataType="{kind}" Dimensions="{shape}" Format="XML" Precision="8">'
        f"{words}</DataItem>"
    )
