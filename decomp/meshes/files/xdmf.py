"""XDMF 3 (.xdmf) with its numbers in it as text, for ParaView and meshio.

Cell data: `gmsh:physical`, the tags of the groups. Points are left out: meshio reads no file with
elements of one node. meshio's own writer drops the groups' names and
reads them all the same; they are written here where it looks for them.
Format: https://www.xdmf.org/index.php/XDMF_Model_and_Format
"""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr

import numpy as np

from decomp.meshes.convert import VTK_TYPES
from decomp.meshes.lower import lower_blocks
from decomp.meshes.model import TetMesh
from decomp.meshes.ordering import in_vtk_order
from decomp.plain import plain
from decomp.vectors import Array, Ints

TYPES = {3: 2, 21: 34, 5: 4, 22: 36, 10: 6, 24: 38}
"""XDMF's numbers of element types by VTK's."""
COUNTED = 2
"""The type of XDMF's before whose nodes their number stands."""


def encoded(mesh: TetMesh) -> bytes:
    """The contents of a file: lines and triangles first, then tetrahedra."""
    lower = [block for block in lower_blocks(mesh) if block.dimension]
    blocks = [(each.vtk, each.elements) for each in lower]
    blocks.append((VTK_TYPES[mesh.tets.shape[1]], in_vtk_order(mesh.tets)))
    topology = np.concatenate([_typed(*block).reshape(-1) for block in blocks])
    tags = np.concatenate([*(each.tags for each in lower), mesh.tet_tags])
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


def _typed(vtk: int, elements: Ints) -> Ints:
    kind = TYPES[vtk]
    head = [kind, elements.shape[1]] if kind == COUNTED else [kind]
    return np.insert(elements, [0] * len(head), head, axis=1)


def _names(mesh: TetMesh) -> str:
    kept = (group for group in mesh.groups if group.dimension)
    ordered = sorted(kept, key=lambda group: -group.dimension)
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
