"""A boundary that is assembled wrongly is refused: each check is shown a wrong one."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import decomp
from benchmarks.membership import held
from decomp import carriers
from decomp.boundary import assembled, faces, integrals, loops
from decomp.carriers import Carrier
from decomp.csg.primitives import Block, Cone, Cylinder, EllipticCylinder, Sphere, Torus
from decomp.csg.solid import Solid
from decomp.errors import GeometryError
from decomp.vectors import Array

TWO_TOPS = Block((0, 0, 0), (6, 2, 1)) | Block((0, 0, 1), (1, 1, 1)) | Block((4, 0, 1), (1, 1, 1))
CROSS = Cylinder((-3, 0, 0), (3, 0, 0), 1) | Cylinder((0, -3, 0), (0, 3, 0), 1)


def test_faces_that_were_taken_for_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(faces, "_groups", lambda walker: [list(range(len(walker.loops.loops)))])
    with pytest.raises(GeometryError, match=r"region 'solid': .* characteristic 2, not 0"):
        decomp.Geometry(TWO_TOPS)


def test_a_hole_that_was_taken_for_a_face(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(faces, "_groups", lambda w: [[k] for k in range(len(w.loops.loops))])
    with pytest.raises(GeometryError, match=r"could not be joined|characteristic"):
        decomp.Geometry(Block((0, 0, 0), (4, 4, 1)) - Cylinder((2, 2, -1), (2, 2, 2), 1))


def test_edges_that_were_linked_across_a_vertex(monkeypatch: pytest.MonkeyPatch) -> None:
    original: Callable[..., dict[Any, Any]] = loops._Linker._linked_by_angle

    def crossed(self: Any, vertex: int, into: list[Any], out: list[Any]) -> dict[Any, Any]:
        links = original(self, vertex, into, out)
        ends = list(links.values())
        return dict(zip(links, ends[1:] + ends[:1], strict=True))

    monkeypatch.setattr(loops._Linker, "_linked_by_angle", crossed)
    with pytest.raises(GeometryError, match="540 degrees together at"):
        decomp.Geometry(CROSS)


@pytest.mark.parametrize(
    ("carrier", "solid"),
    [
        (carriers.Cylinder, Cylinder((0, 0, 0), (0, 0, 2), 1)),
        (carriers.EllipticCylinder, EllipticCylinder((0, 0, 0), (0, 0, 2), (2, 0, 0), 1)),
        (carriers.Sphere, Sphere((0, 0, 0), 1) - Block((0, -2, -2), (2, 4, 4))),
    ],
)
def test_an_area_that_is_wrong(
    carrier: type[Carrier], solid: Solid, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = carrier.border_terms

    def wrong(*args: Any) -> tuple[float, float]:
        area, support = right(*args)
        return 1.001 * area, 1.001 * support

    monkeypatch.setattr(carrier, "border_terms", wrong)
    with pytest.raises(GeometryError, match=r"by one vector field and .* by another") as error:
        decomp.Geometry(solid)
    told = re.search(r"volume is (\S+) by one vector field and (\S+) by", str(error.value))
    assert told is not None
    assert float(told[1]) != float(told[2])


@pytest.mark.parametrize("cut", [False, True])
def test_a_torus_too_many(cut: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    right: Callable[..., tuple[float, float, int]] = integrals._torus_integrals

    def wrong(torus: Torus, border: Any) -> tuple[float, float, int]:
        area, cosine, wholes = right(torus, border)
        whole = 4 * np.pi**2 * torus.major * torus.minor
        return area + whole, cosine, wholes

    monkeypatch.setattr(integrals, "_torus_integrals", wrong)
    ring = Torus((0, 0, 0), (0, 0, 1), 2, 0.5)
    with pytest.raises(GeometryError, match=r"by one vector field and .* by another"):
        decomp.Geometry(ring - Block((0, -3, -1), (3, 6, 2)) if cut else ring)


@pytest.mark.parametrize(
    "cutter",
    [
        Block((0, -3, -1), (3, 6, 2)),
        Block((-3, -3, 0.2), (6, 6, 2)),
        Cylinder((0, 0, -2), (0, 0, 2), 2.1),
        Sphere((2, 0, 0.3), 0.6),
        Block((1.6, -3, -0.1), (2, 6, 2)),
    ],
    ids=["tubes", "top", "middle", "bite", "bow"],
)
def test_volumes_of_cut_tori(cutter: Solid) -> None:
    ring = Torus((0, 0, 0), (0, 0, 1), 2, 0.5)
    whole = 2 * np.pi**2 * 2 * 0.25
    parts = [decomp.Geometry(s).regions[0].volume for s in (ring - cutter, ring & cutter)]
    assert sum(parts) == pytest.approx(whole, rel=1e-10)


def test_nothing_is_checked_away(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both checks are made of every region."""
    calls: list[str] = []
    for name in ("refuse_wrong_turning", "refuse_wrong_volume"):
        check: Callable[..., None] = getattr(assembled, name)

        def counted(*args: Any, name: str = name, check: Any = check) -> None:
            calls.append(name)
            check(*args)

        monkeypatch.setattr(assembled, name, counted)
    decomp.Geometry({"one": Sphere((0, 0, 0), 1), "other": Block((2, 0, 0), (1, 1, 1))})
    assert sorted(calls) == ["refuse_wrong_turning"] * 2 + ["refuse_wrong_volume"] * 2


@pytest.mark.parametrize(
    "solid",
    [
        Cone((0, 0, 0), 1, (0, 0, 2), 0),
        Cone((0, 0, 0), 1, (0, 0, 2), 0) & Block((0, -1, 0), (2, 2, 3)),
        Block((-2, -2, 0), (4, 4, 2)) - Cone((0, 0, 2), 1, (0, 0, 0.5), 0),
        Sphere((0, 0, 0), 1) - Block((-0.2, -0.2, -2), (0.4, 0.4, 4)),
        Torus((0, 0, 0), (0, 0, 1), 2, 0.5) - Block((0, -3, -1), (3, 6, 2)),
        Cylinder((0, 0, 0), (0, 0, 1), 1) - Block((-1, -1, -1), (1, 2, 3)),
        Block((1, 1, 0), (1, 1, 1)) - Cylinder((1, 1, -1), (1, 1, 2), 1),
    ],
    ids=["cone", "half a cone", "pit", "drilled ball", "half a ring", "half a disc", "cusps"],
)
def test_apexes_poles_and_cusps_are_counted(solid: Solid) -> None:
    """What is right passes, and its volume is that of random points."""
    region = decomp.Geometry(solid).regions[0]
    low, high = region.bounds
    points: Array = np.random.default_rng(1).uniform(low, high, (200_000, 3))
    part = held(solid, points).mean()
    assert region.volume == pytest.approx(part * np.prod(high - low), rel=0.02)
