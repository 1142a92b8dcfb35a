"""A model's exact geometry in one object: its regions' boundaries, and queries at points."""

from __future__ import annotations

from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from decomp.boundary.build import Boundaries, boundaries
from decomp.boundary.topology import RegionBoundary
from decomp.csg.model import Model, model
from decomp.csg.solid import Solid
from decomp.formats import load
from decomp.vectors import Array, Bools

if TYPE_CHECKING:
    from decomp.sites import Nearest, Site, SiteIndex


class Geometry:
    """Exact boundary and nearest-site queries of a model.

    Regions without interior are left out: `model` is what is left, and its `ignored` names them.

    Args:
        source: a model, a solid, a dict of named solids, or the path of a model file.

    Raises:
        InputError: the source is none of these.
        FileError: the file cannot be read; its subclasses say where.
        GeometryError: all regions are empty, or one is unbounded, overlaps another, or cannot be
            resolved.
    """

    def __init__(self, source: Model | Solid | dict[str, Solid] | str | Path) -> None:
        if isinstance(source, (str, Path)):
            source = load(source)
        self.boundaries: Boundaries = boundaries(
            source if isinstance(source, Model) else model(source)
        )
        self.model: Model = self.boundaries.model

    @property
    def regions(self) -> tuple[RegionBoundary, ...]:
        """The boundary of each region, in the model's order."""
        return self.boundaries.regions

    @property
    def diagonal(self) -> float:
        """Length of the diagonal of the box around all regions."""
        return self.boundaries.diagonal

    @property
    def sites(self) -> tuple[Site, ...]:
        """What a point can be nearest to; `nearest` gives indices into it."""
        return self.index.sites

    @cached_property
    def index(self) -> SiteIndex:
        """The spatial structure behind the queries, built on first use."""
        from decomp.sites import SiteIndex

        found = self.boundaries
        # no lambda, as a geometry may be pickled
        return SiteIndex(
            found.form, found.regions, partial(getattr, found, "outside"), found.face_at
        )

    def contains(self, points: ArrayLike) -> Bools:
        """Whether points (n, 3) lie in some region: (n,) bool.

        A point within rounding of a boundary goes to either side.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        return self.index.contains(points)

    def region_of(self, points: ArrayLike) -> NDArray[np.int32]:
        """The index (n,) of the region that holds each point (n, 3), -1 outside all.

        A point within rounding of a boundary goes to either side.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        return self.index.region_of(points)

    def nearest(self, points: ArrayLike) -> Nearest:
        """The nearest site of the boundary of each point's own region, or of the outside.

        Args:
            points: (n, 3), in a region or outside.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        return self.index.nearest(points)

    def distance(self, points: ArrayLike) -> Array:
        """Signed distance (n,) of points (n, 3) to the boundary of their region, negative in one.

        Outside all regions it is the distance to the nearest boundary, above 0.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        return self.index.distance(points)
