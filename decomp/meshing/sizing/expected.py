"""How many tetrahedra a mesh will have, before it is made."""

from __future__ import annotations

import numpy as np

from decomp.geometry import Geometry
from decomp.meshing.sizing.wishes import Wishes
from decomp.vectors import Array

REGULAR = 0.118
"""The volume of a regular tetrahedron with edges of length 1."""
POINTS_ASKED = 20_000
"""Points in the model's box at which regions and lengths are asked."""


def least_tets(geometry: Geometry, sizes: Array) -> float:
    """As many regular tetrahedra with the largest edges wanted fill the regions.

    Args:
        geometry: of the model.
        sizes: (r,) the largest length in each region.
    """
    volumes = np.array([region.volume for region in geometry.regions])
    return float((volumes / sizes**3).sum() / REGULAR)


def expected_tets(geometry: Geometry, wish: Wishes, sizes: Array, seed: int = 0) -> float:
    """The integral of the density of regular tetrahedra with the wanted edges over all regions.

    It is taken at random points of each region's box and is right within a factor of two.

    Args:
        geometry: of the model.
        wish: lengths at points.
        sizes: (r,) the largest length in each region.
        seed: of the points.
    """
    random = np.random.default_rng(seed)
    total = 0.0
    for number, region in enumerate(geometry.regions):
        low, high = np.array(region.bounds)
        points = random.uniform(low, high, size=(POINTS_ASKED, 3))
        inside = geometry.index.region_of(points) == number
        length = np.minimum(wish.at(points[inside]), sizes[number])
        density = (length**-3.0).sum() / POINTS_ASKED / REGULAR
        total += float(np.prod(high - low)) * density
    return total
