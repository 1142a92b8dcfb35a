"""A model's exact geometry in one object: its regions' boundaries, and queries at points."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from decomp.boundary.build import Boundaries, boundaries
from decomp.boundary.moved import moved_boundary
from decomp.boundary.topology import RegionBoundary
from decomp.csg.model import Model, model
from decomp.csg.solid import Solid
from decomp.formats import load
from decomp.places import seen_from
from decomp.shown import Shown
from decomp.vectors import Array, Bools

if TYPE_CHECKING:
    from decomp.sites import Nearest, Site, SiteIndex


class Geometry(Shown):
    """Exact boundary and nearest-site queries of a model.

    Regions without interior are left out: `model` is what is left, and its `ignored` names them.

    Args:
        source: a model, a solid, a dict of named solids, or the path of a model file.

    Attributes:
        offset: (3,), 0 near the origin. A model that is farther than some diagonals away from it
            is computed about this point, which is near its centre, so that nothing is lost to
            rounding: all that is given back is rounded once, and is the model's own otherwise.
        local: the same geometry in coordinates about `offset`; itself where that is 0.
        boundaries: of all regions, in coordinates about `offset`.

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
        self.offset: Array = self.boundaries.offset
        self.local: Geometry = self if not self.offset.any() else _in_place(self.boundaries)

    @cached_property
    def regions(self) -> tuple[RegionBoundary, ...]:
        """The boundary of each region, in the model's order."""
        return tuple(moved_boundary(each, self.offset) for each in self.boundaries.regions)

    @property
    def diagonal(self) -> float:
        """Length of the diagonal of the box around all regions."""
        return self.boundaries.diagonal

    @property
    def sites(self) -> tuple[Site, ...]:
        """What a point can be nearest to; `nearest` gives indices into it."""
        return self.index.sites

    @property
    def index(self) -> SiteIndex:
        """The spatial structure behind the queries, in coordinates about `offset`."""
        return self.local._index

    @cached_property
    def _index(self) -> SiteIndex:
        from decomp.sites import SiteIndex

        found = self.boundaries
        # no lambda, as a geometry may be pickled
        return SiteIndex(
            found.form, found.regions, partial(getattr, found, "outside"), found.face_at
        )

    def _facts(self) -> Mapping[str, Any]:
        own = self.boundaries.regions
        return {
            "name": self.model.name,
            "regions": tuple(each.name for each in own),
            "faces": sum(len(each.faces) for each in own),
            "edges": sum(len(each.edges) for each in own),
            "vertices": sum(len(each.vertices) for each in own),
            "diagonal": self.diagonal,
        }

    def _table(self) -> tuple[Sequence[str], Iterable[Sequence[Any]]]:
        rows = ((r.name, r.volume, r.area, len(r.faces), r.euler) for r in self.boundaries.regions)
        return ("region", "volume", "area", "faces", "Euler characteristic"), rows

    def plot(self, **options: Any) -> Any:
        """Show its faces with PyVista, in a window or in a notebook.

        Args:
            options: of `pyvista.DataSet.plot`, such as `off_screen`, `screenshot`, `cpos`.

        Raises:
            MissingPackageError: pyvista is not installed.
        """
        from decomp.view.plot import plot_geometry

        return plot_geometry(self, options)

    def contains(self, points: ArrayLike) -> Bools:
        """Whether points (n, 3) lie in some region: (n,) bool.

        A point within rounding of a boundary goes to either side.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        with self.frame():
            return self.index.contains(self._local(points))

    def region_of(self, points: ArrayLike) -> NDArray[np.int32]:
        """The index (n,) of the region that holds each point (n, 3), -1 outside all.

        A point within rounding of a boundary goes to either side.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        with self.frame():
            return self.index.region_of(self._local(points))

    def nearest(self, points: ArrayLike) -> Nearest:
        """The nearest site of the boundary of each point's own region, or of the outside.

        Args:
            points: (n, 3), in a region or outside.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        with self.frame():
            found = self.index.nearest(self._local(points))
        if self.local is self:
            return found
        return replace(found, foot=found.foot + self.offset)

    def distance(self, points: ArrayLike) -> Array:
        """Signed distance (n,) of points (n, 3) to the boundary of their region, negative in one.

        Outside all regions it is the distance to the nearest boundary, above 0.

        Raises:
            InputError: these are no finite numbers, three for each point.
        """
        with self.frame():
            return self.index.distance(self._local(points))

    def frame(self) -> AbstractContextManager[None]:
        """Inside, messages about `local` tell places in the model's coordinates."""
        return nullcontext() if self.local is self else seen_from(self.offset, self.diagonal)

    def _local(self, points: ArrayLike) -> ArrayLike:
        if self.local is self:
            return points
        from decomp.sites.points import checked_points

        return checked_points(points) - self.offset


def _in_place(found: Boundaries) -> Geometry:
    """The geometry of boundaries in their own coordinates."""
    result = object.__new__(Geometry)
    result.boundaries, result.model = found, found.model
    result.offset, result.local = np.zeros(3), result
    return result
