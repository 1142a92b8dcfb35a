"""Random solids from few different numbers: faces coincide, surfaces touch or share points."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from decomp.csg.primitives import Block, Cone, Cylinder, HalfSpace, Sphere, Torus
from decomp.csg.solid import Solid

places = st.tuples(*[st.integers(-2, 2)] * 3)
sizes = st.sampled_from([0.5, 1.0, 2.0])
axes = st.sampled_from([(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1), (1, 1, 0), (1, 2, 2)])
bounded = st.one_of(
    st.builds(Block, places, st.tuples(sizes, sizes, sizes)),
    st.builds(Sphere, places, sizes),
    st.builds(lambda p, d, r: Cylinder(p, np.add(p, d), r), places, axes, sizes),
    st.builds(lambda p, d, r: Cone(p, r, np.add(p, d), 0.25), places, axes, sizes),
    st.builds(lambda p, d: Torus(p, d, 1.5, 0.5), places, axes),
)
half_spaces = st.builds(HalfSpace, places, axes)


def _combined(parts: st.SearchStrategy[Solid]) -> st.SearchStrategy[Solid]:
    pairs = st.tuples(parts, parts)
    return st.one_of(
        pairs.map(lambda p: p[0] | p[1]),
        pairs.map(lambda p: p[0] & p[1]),
        pairs.map(lambda p: p[0] - p[1]),
    )


def _with_complements(parts: st.SearchStrategy[Solid]) -> st.SearchStrategy[Solid]:
    return st.one_of(_combined(parts), parts.map(lambda p: ~p))


trees = st.recursive(st.one_of(bounded, half_spaces), _with_complements, max_leaves=10)
solids = st.recursive(bounded, _combined, max_leaves=4)
