"""Errors that have a place are told what is near it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress

import numpy as np

from decomp.errors import GeometryError
from decomp.geometry import Geometry


@contextmanager
def located(geometry: Geometry) -> Iterator[None]:
    """Have errors of geometry with a place know the site nearest to it, and the region.

    Sites and regions that they know already are kept.
    """
    try:
        yield
    except GeometryError as error:
        if error.place is not None and np.isfinite(error.place).all():
            # what is lost may be just that
            with suppress(GeometryError):
                near = geometry.nearest([error.place])
                error.sites = error.sites or (geometry.sites[int(near.site[0])].name,)
                if near.region[0] >= 0:
                    error.region = error.region or geometry.regions[int(near.region[0])].name
        raise
