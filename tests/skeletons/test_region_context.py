"""What a region's skeleton is computed with."""

from __future__ import annotations

import pickle

import numpy as np

import decomp
from decomp.skeletons.balls.region_context import RegionContext
from tests.solids import SOLIDS


def test_a_context_is_pickled_without_what_was_built_of_it() -> None:
    geometry = decomp.Geometry(SOLIDS["through hole"].make())
    context = RegionContext(geometry.index, 0)
    fresh = len(pickle.dumps(context))
    points = np.random.default_rng(0).uniform(0, 3, (200, 3))
    found = context.queries.nearest(points)
    assert len(pickle.dumps(context.index)) > 2 * fresh
    again = pickle.loads(pickle.dumps(context))
    assert len(pickle.dumps(context)) <= 1.1 * fresh
    other = again.queries.nearest(points)
    assert (other.site == found.site).all()
    assert (other.foot == found.foot).all()
    assert (again.table.data == context.table.data).all()


def test_a_context_is_of_its_own_region() -> None:
    core = decomp.Block((0, 0, 0), (1, 1, 1), name="core")
    box = decomp.Block((-1, -1, -1), (3, 4, 5), name="box")
    geometry = decomp.Geometry({"core": core, "air": box - core})
    one, two = (RegionContext(geometry.index, k) for k in range(2))
    assert one.boundary is geometry.index.boundary(0)
    assert (one.size, two.size) == (one.boundary.diagonal, two.boundary.diagonal)
    assert one.sites is two.sites
    middle = np.array([[0.5, 0.5, 0.4]])
    assert one.queries.nearest(middle).distance[0] == 0.4
    assert two.queries.nearest(middle).region[0] == -1
