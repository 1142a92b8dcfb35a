"""Carriers: the six kinds of untrimmed surfaces that bound every solid here."""

from decomp.carriers.base import Carrier
from decomp.carriers.cone import Cone
from decomp.carriers.cylinder import Cylinder
from decomp.carriers.elliptic_cylinder import EllipticCylinder
from decomp.carriers.plane import Plane
from decomp.carriers.sphere import Sphere
from decomp.carriers.table import CarrierTable
from decomp.carriers.torus import Torus

__all__ = [
    "Carrier",
    "CarrierTable",
    "Cone",
    "Cylinder",
    "EllipticCylinder",
    "Plane",
    "Sphere",
    "Torus",
]
