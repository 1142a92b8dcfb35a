"""Points at which sites meet are placed exactly, where edges end in one vertex too."""

from __future__ import annotations

import numpy as np
import pytest

import decomp
from decomp.sampled.placing import Placer
from decomp.skeletons.balls.queries import region_queries
from decomp.skeletons.balls.region_context import RegionContext
from decomp.skeletons.curves.incidence import Incidence


def placer_of(solid: decomp.Solid) -> tuple[Placer, dict[str, int]]:
    geometry = decomp.Geometry(solid)
    incidence = Incidence(RegionContext(geometry.index, 0))
    names = {site.name: k for k, site in enumerate(geometry.sites)}
    return Placer(incidence, region_queries(geometry.index, 0)), names


def boss() -> decomp.Solid:
    """A plate with a square boss, at whose foot reentrant edges meet in four vertices."""
    plate = decomp.Block((0, 0, 0), (4, 4, 1), name="plate")
    return plate | decomp.Block((1, 1, 0.5), (2, 2, 1.5), name="boss")


def at_the_foot(names: dict[str, int]) -> tuple[int, int, int]:
    edges = [
        next(k for name, k in names.items() if set(name.split("|")) == {"plate.zmax", side})
        for side in ("boss.ymin", "boss.xmin")
    ]
    return names["plate.zmax"], edges[0], edges[1]


@pytest.mark.parametrize("start", [(1.01, 1.02, 0.4), (1.05, 1.12, 0.4), (1.1, 1.1, 0.3)])
def test_a_face_and_two_edges_of_it_meet_on_the_normal_at_their_vertex(
    start: tuple[float, float, float],
) -> None:
    """Also from where the feet on them are a fifth of the radius apart."""
    placer, names = placer_of(boss())
    sites = at_the_foot(names)
    placed = placer.place(tuple(sorted(sites)), np.array([start]))
    assert placed.good.all()
    assert placed.points[0] == pytest.approx([1, 1, start[2]], abs=1e-12)
    assert placed.radius[0] == pytest.approx(1 - start[2], abs=1e-12)


def test_of_two_edges_neither_takes_over_from_the_other() -> None:
    """They are as near on the normal at their vertex, which is on no trim surface of theirs."""
    placer, names = placer_of(boss())
    face, one, two = at_the_foot(names)
    point = np.array([1.0, 1.0, 0.4])
    assert placer.holds(point, 0.6, (one, two), True)
    assert not placer.holds(point, 0.6, (one, two), False)
    assert placer.holds(point, 0.6, (face, one), False)


def test_meetings_are_where_no_other_site_is_nearer() -> None:
    placer, names = placer_of(decomp.Block((0, 0, 0), (4, 3, 2), name="b"))
    sites = tuple(names[f"b.{side}"] for side in ("xmin", "ymin", "zmin", "zmax"))
    found = placer.meetings(sites, np.array([0.5, 0.6, 0.7]), 1.0)
    # of three sides each; the middle of z ends beside a side that is nearer
    assert np.sort(found, axis=0) == pytest.approx(np.array([[0.6, 0.6, 0.6], [0.8, 0.8, 1.2]]))
    assert len(placer.meetings(sites, np.array([0.5, 0.6, 0.7]), 1e-3)) == 0
