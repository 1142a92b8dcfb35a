"""Exact boundaries and interior skeletons of solids defined by constructive solid geometry.

>>> import decomp
>>> plate = decomp.Block((0, 0, 0), (4, 4, 2), name="plate")
>>> hole = decomp.Cylinder((2, 2, -1), (2, 2, 3), 1, name="hole")
>>> part = decomp.Geometry(plate - hole)
>>> [face.name for face in part.regions[0].faces]
['plate.xmin', 'plate.xmax', 'plate.ymin', 'plate.ymax', 'plate.zmin', 'plate.zmax', 'hole.side']
>>> round(part.regions[0].volume, 6)
25.716815
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from decomp.boundary.topology import Convexity as Convexity
    from decomp.boundary.topology import Edge as Edge
    from decomp.boundary.topology import Face as Face
    from decomp.boundary.topology import RegionBoundary as RegionBoundary
    from decomp.boundary.topology import Vertex as Vertex
    from decomp.checking.check import Checked as Checked
    from decomp.checking.check import check as check
    from decomp.csg.model import Ignored as Ignored
    from decomp.csg.model import Model as Model
    from decomp.csg.model import Region as Region
    from decomp.csg.model import model as model
    from decomp.csg.primitives import Block as Block
    from decomp.csg.primitives import Cone as Cone
    from decomp.csg.primitives import Cylinder as Cylinder
    from decomp.csg.primitives import EllipticCylinder as EllipticCylinder
    from decomp.csg.primitives import HalfSpace as HalfSpace
    from decomp.csg.primitives import InfiniteCone as InfiniteCone
    from decomp.csg.primitives import InfiniteCylinder as InfiniteCylinder
    from decomp.csg.primitives import InfiniteEllipticCylinder as InfiniteEllipticCylinder
    from decomp.csg.primitives import Sphere as Sphere
    from decomp.csg.primitives import Torus as Torus
    from decomp.csg.solid import Solid as Solid
    from decomp.csg.solid import intersection as intersection
    from decomp.csg.solid import union as union
    from decomp.errors import DecompError as DecompError
    from decomp.errors import FileError as FileError
    from decomp.errors import GeometryError as GeometryError
    from decomp.errors import InputError as InputError
    from decomp.errors import MissingPackageError as MissingPackageError
    from decomp.errors import UnknownNameError as UnknownNameError
    from decomp.formats import load as load
    from decomp.formats import save as save
    from decomp.geometry import Geometry as Geometry
    from decomp.meshes.files.reading import read as read
    from decomp.meshes.group import Group as Group
    from decomp.meshes.group import GroupKind as GroupKind
    from decomp.meshes.model import TetMesh as TetMesh
    from decomp.meshes.parts import Parts as Parts
    from decomp.meshes.reasons import Reason as Reason
    from decomp.meshes.report import Quality as Quality
    from decomp.meshes.report import Report as Report
    from decomp.meshes.report import report as report
    from decomp.meshing.backends.base import MeshingError as MeshingError
    from decomp.midsurfaces.facing import MidSurface as MidSurface
    from decomp.midsurfaces.facing import mid_surface as mid_surface
    from decomp.outside import with_outside as with_outside
    from decomp.parity import Parity as Parity
    from decomp.sites import Nearest as Nearest
    from decomp.sites import Site as Site
    from decomp.sites import SiteKind as SiteKind
    from decomp.skeletons.model import Cell as Cell
    from decomp.skeletons.model import Certificate as Certificate
    from decomp.skeletons.model import Junction as Junction
    from decomp.skeletons.model import Reflexive as Reflexive
    from decomp.skeletons.model import RegionSkeleton as RegionSkeleton
    from decomp.skeletons.model import Sheet as Sheet
    from decomp.skeletons.model import Skeleton as Skeleton
    from decomp.skeletons.model import SkeletonLine as SkeletonLine
    from decomp.ways.mesh import mesh as mesh
    from decomp.ways.skeleton import skeleton as skeleton

_HOMES = {
    "decomp.boundary.topology": ("Convexity", "Edge", "Face", "RegionBoundary", "Vertex"),
    "decomp.csg.model": ("Ignored", "Model", "Region", "model"),
    "decomp.csg.primitives": (
        "Block",
        "Cone",
        "Cylinder",
        "EllipticCylinder",
        "HalfSpace",
        "InfiniteCone",
        "InfiniteCylinder",
        "InfiniteEllipticCylinder",
        "Sphere",
        "Torus",
    ),
    "decomp.csg.solid": ("Solid", "intersection", "union"),
    "decomp.errors": (
        "DecompError",
        "FileError",
        "GeometryError",
        "InputError",
        "MissingPackageError",
        "UnknownNameError",
    ),
    "decomp.formats": ("load", "save"),
    "decomp.geometry": ("Geometry",),
    "decomp.midsurfaces.facing": ("MidSurface", "mid_surface"),
    "decomp.skeletons.model": (
        "Cell",
        "Certificate",
        "Junction",
        "Reflexive",
        "RegionSkeleton",
        "Sheet",
        "Skeleton",
        "SkeletonLine",
    ),
    "decomp.ways.mesh": ("mesh",),
    "decomp.outside": ("with_outside",),
    "decomp.meshes.parts": ("Parts",),
    "decomp.meshes.reasons": ("Reason",),
    "decomp.parity": ("Parity",),
    "decomp.sites": ("Nearest", "Site", "SiteKind"),
    "decomp.checking.check": ("Checked", "check"),
    "decomp.meshing.backends.base": ("MeshingError",),
    "decomp.meshes.group": ("Group", "GroupKind"),
    "decomp.meshes.model": ("TetMesh",),
    "decomp.meshes.files.reading": ("read",),
    "decomp.meshes.report": ("Quality", "Report", "report"),
    "decomp.ways.skeleton": ("skeleton",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = sorted(_HOME_OF)


def __getattr__(name: str) -> Any:
    """Import a public name where it is first used, so that the command line starts fast."""
    if name == "__version__":
        from importlib.metadata import version

        return version("decomp")
    if name not in _HOME_OF:
        from decomp.near import near

        raise AttributeError(f"module 'decomp' has no attribute {name!r}{near(name, __all__)}")
    return getattr(import_module(_HOME_OF[name]), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
