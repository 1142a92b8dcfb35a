"""Voronoi surfaces of pairs of sites: what they are, and their equations.

After D. Dutta and C. M. Hoffmann, A Geometric Investigation of the Skeleton of CSG Objects, which
the docstrings call the paper.
"""

from decomp.parity import Parity
from decomp.voronoi.conic_site import ConicSite
from decomp.voronoi.curve_site import CurveSite
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial
from decomp.voronoi.shape import Shape
from decomp.voronoi.sites import (
    CarrierSite,
    ConeSite,
    CylinderSite,
    PlaneSite,
    SphereSite,
    TorusSite,
    VoronoiSite,
)
from decomp.voronoi.surface import VoronoiSurface, site_of, surface

__all__ = [
    "CarrierSite",
    "ConeSite",
    "ConicSite",
    "CurveSite",
    "CylinderSite",
    "Kind",
    "Parity",
    "PlaneSite",
    "Polynomial",
    "Shape",
    "SphereSite",
    "TorusSite",
    "VoronoiSite",
    "VoronoiSurface",
    "site_of",
    "surface",
]
