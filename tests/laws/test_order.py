"""The order in which operands and regions are written changes nothing."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, reject

import decomp
from decomp.csg.primitives import Block, Cylinder, HalfSpace
from decomp.csg.solid import Difference, Intersection, Solid, Transformed, Union
from decomp.errors import GeometryError
from tests.laws.effort import FACTOR, examples
from tests.laws.strategies import solids


def shuffled(solid: Solid, rng: np.random.Generator) -> Solid:
    """The same solid with the operands of unions and intersections in another order."""
    match solid:
        case Union(parts=parts) | Intersection(parts=parts):
            order = rng.permutation(len(parts))
            return type(solid)(tuple(shuffled(parts[k], rng) for k in order))
        case Difference(base=base, tool=tool):
            return Difference(shuffled(base, rng), shuffled(tool, rng))
        case Transformed(part=part, by=by):
            return Transformed(shuffled(part, rng), by)
    return solid


def figures(source: Solid | dict[str, Solid]) -> dict[str, tuple[float, ...]]:
    """What is told of each region; nothing of a model that is refused."""
    try:
        g = decomp.Geometry(source)
    except GeometryError:
        return {}
    return {
        r.name: (r.euler, len(r.faces), len(r.edges), len(r.vertices), r.volume, r.area)
        for r in g.regions
    }


def same(one: dict[str, tuple[float, ...]], other: dict[str, tuple[float, ...]]) -> None:
    assert one.keys() == other.keys()
    for name in one:
        assert one[name][:4] == other[name][:4]
        assert np.allclose(one[name][4:], other[name][4:], rtol=1e-9)


def test_a_rib_whose_slope_ends_in_the_walls_top_edge() -> None:
    rib, wall = Block((6, 16, 6), (34, 8, 34)), Block((0, 0, 0), (6, 40, 40))
    slope = HalfSpace((40, 0, 6), (1, 0, 1))
    for solid in (wall | (rib & slope), (slope & rib) | wall, (rib & slope) | wall):
        found = figures(solid)["solid"]
        assert found[:2] == (1, 8 + 2)
        assert found[4] == pytest.approx(14224, rel=1e-12)


def ribbed(rng: np.random.Generator) -> Solid:
    """Walls, ribs, slopes and posts of round numbers, of which many end in one line."""

    def pick(*values: float) -> float:
        return float(rng.choice(values))

    high, deep = pick(2, 3, 4), pick(1, 2, 4)
    parts: list[Solid] = [Block((0, 0, 0), (1, 4, high)), Block((0, 0, 0), (4, deep, 1))]
    for _ in range(int(rng.integers(1, 4))):
        foot, thick = pick(3, 4, high + 1), pick(0.5, 1)
        rib = Block((1, pick(0, 1, 1.5), 1), (3, thick, pick(high - 1, 3)))
        lean = HalfSpace((foot, 0, 1), (high - 1, 0, foot - 1))
        parts.append(rib & lean)
    if rng.random() < 0.5:
        parts.append(Cylinder((0.5, pick(1, 2), 0), (0.5, 2, high + 1), 0.5) & parts[0])
    if rng.random() < 0.5:
        parts.append(Block((1, 0, 1), (pick(1, 2), deep, pick(1, high - 1))))
    return Union(tuple(parts))


@pytest.mark.parametrize("seed", range(int(12 * FACTOR)))
def test_order_of_walls_and_ribs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    solid = ribbed(rng)
    first = figures(solid)
    for _ in range(3):
        same(first, figures(shuffled(solid, rng)))


@examples(12)
@given(solids(special=True, leaves=5))
def test_order_of_operands(solid: Solid) -> None:
    first = figures(solid)
    if not first:
        reject()
    for seed in range(2):
        same(first, figures(shuffled(solid, np.random.default_rng(seed))))


@examples(6)
@given(solids(special=True, leaves=3))
def test_order_of_regions(solid: Solid) -> None:
    box = Block((-4, -4, -4), (8, 8, 8))
    first = figures({"part": solid, "around": box - solid})
    same(first, figures({"around": box - shuffled(solid, np.random.default_rng(1)), "part": solid}))
