"""Nearest-site queries: which region holds a point, and what part of its boundary is nearest."""

from decomp.sites.index import Nearest, SiteIndex
from decomp.sites.site import Site, SiteKind

__all__ = ["Nearest", "Site", "SiteIndex", "SiteKind"]
