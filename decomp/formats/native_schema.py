"""What stands in the native JSON form: the nodes' types and their keys."""

from __future__ import annotations

from decomp.csg.primitives import (
    Block,
    Cone,
    Cylinder,
    EllipticCylinder,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    InfiniteEllipticCylinder,
    Primitive,
    Sphere,
    Torus,
)

VERSION = 1

# each primitive's fields: p a point or vector, d a unit vector, n a number
PRIMITIVES: dict[str, tuple[type[Primitive], dict[str, str]]] = {
    "block": (Block, {"corner": "p", "size": "p"}),
    "sphere": (Sphere, {"centre": "p", "radius": "n"}),
    "cylinder": (Cylinder, {"base": "p", "top": "p", "radius": "n"}),
    "cone": (Cone, {"base": "p", "base_radius": "n", "top": "p", "top_radius": "n"}),
    "elliptic_cylinder": (
        EllipticCylinder,
        {"base": "p", "top": "p", "first": "p", "second": "n"},
    ),
    "torus": (Torus, {"centre": "p", "axis": "d", "major": "n", "minor": "n"}),
    "half_space": (HalfSpace, {"point": "p", "normal": "d"}),
    "infinite_cylinder": (InfiniteCylinder, {"point": "p", "axis": "d", "radius": "n"}),
    "infinite_elliptic_cylinder": (
        InfiniteEllipticCylinder,
        {"point": "p", "first": "p", "second": "p"},
    ),
    "infinite_cone": (InfiniteCone, {"apex": "p", "axis": "d", "half_angle": "n"}),
}
TYPE_OF = {cls: name for name, (cls, _) in PRIMITIVES.items()}
# the keys of every other node
NODES: dict[str, tuple[str, ...]] = {
    "union": ("parts",),
    "intersection": ("parts",),
    "difference": ("base", "tool"),
    "complement": ("part",),
    "transformed": ("part", "by"),
    "copies": ("part", "by"),
    "labelled": ("part", "name", "options"),
}
OPEN = ("doubt", "shift")
"""Keys of a similarity that stand there if it is known to few digits, see `Similarity`."""
FIXED = "fixed"
"""Key of a similarity that stands there if it has a fixed point, see `Similarity`."""
KNOWN = (*PRIMITIVES, *NODES)
