"""One region of a model, with all that its skeleton is computed with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from decomp.boundary.topology import RegionBoundary
from decomp.sites import SiteIndex
from decomp.sites.site import Site
from decomp.skeletons.balls.queries import RegionQueries, region_queries
from decomp.skeletons.balls.supports import SupportTable, support_table
from decomp.tolerance import Tolerances


@dataclass(frozen=True, eq=False)
class RegionContext:
    """A region: made once, and passed on to everything that is found in it.

    Args:
        index: nearest-site queries of the model.
        region: its number.
    """

    index: SiteIndex
    region: int

    def __getstate__(self) -> dict[str, Any]:
        """What is built of it can be built again: sheets hold it, and skeletons are pickled."""
        return {"index": self.index.unbuilt(), "region": self.region}

    @cached_property
    def boundary(self) -> RegionBoundary:
        """The region's exact boundary."""
        return self.index.boundary(self.region)

    @property
    def sites(self) -> tuple[Site, ...]:
        """All sites of the model, into which numbers of sites point."""
        return self.index.sites

    @property
    def size(self) -> float:
        """The region's diagonal."""
        return self.boundary.diagonal

    @property
    def tolerances(self) -> Tolerances:
        """Of the region, as lengths."""
        return self.boundary.tolerances

    @cached_property
    def table(self) -> SupportTable:
        """The supports of its sites, edges and vertices."""
        return support_table(self.boundary, self.index.sites)

    @cached_property
    def queries(self) -> RegionQueries:
        """Its nearest-site queries, with little to do per call."""
        return region_queries(self.index, self.region)
