"""What holds for every skeleton: covariance, complements, thin features."""

from __future__ import annotations

import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

import decomp
from decomp.csg.solid import Solid
from decomp.skeletons.model import RegionSkeleton, Skeleton
from tests.skeletons.computed import Region, param, skeleton_of, source_of
from tests.skeletons.shapes import SHAPES
from tests.solids import SOLIDS

ROOT = Path(__file__).parents[2]
SCALE = 0.25
FINER = {
    "ball on a corner": 1e-4,
    "boss at a ledge": 2e-5,
    "boss on a wall": 2e-5,
    "crossing blocks": 1e-4,
    "ridge": 2e-5,
    "slot": 2e-5,
    "washer": 1e-4,
}
"""Tolerances where small areas and thin cells differ by the chord error along their borders."""
NOT_MOVED = {
    "bar in a wall",
    "bored corner",
    "bulge",
    "narrow joint",
    "offset tee",
    "wide offset tee",
}
"""Rounding decides in some positions of these what is found, see docs/decisions.md."""
MOVED = sorted({*SOLIDS, *SHAPES} - NOT_MOVED)


def moved(solid: Solid) -> Solid:
    """Mirrored, turned, shrunk and shifted."""
    return solid.mirror((1, 2, 0)).rotate((1, 2, 3), 40).scale(SCALE).translate((7, -3, 2))


def solid_of(name: str) -> Solid:
    source = source_of(name)
    assert isinstance(source, Solid)
    return source


def pairs(skeleton: Skeleton, region: RegionSkeleton) -> Counter[tuple[str, ...]]:
    """Numbers of sheets by the names of their sites."""
    return Counter(
        tuple(sorted(skeleton.sites[k].name for k in sheet.sites)) for sheet in region.sheets
    )


@pytest.mark.parametrize("name", [param(name) for name in MOVED])
def test_similar_solids_have_similar_skeletons(name: str) -> None:
    if name in FINER:
        both = [solid_of(name), moved(solid_of(name))]
        plain, other = (Region(decomp.skeleton(s, tolerance=FINER[name])) for s in both)
    else:
        plain, other = Region(skeleton_of(name)), Region(decomp.skeleton(moved(solid_of(name))))
    assert other.counts() == plain.counts()
    assert len(other.parts.reflexive) == len(plain.parts.reflexive)
    assert len(other.parts.trims) == len(plain.parts.trims)
    assert pairs(other.skeleton, other.parts) == pairs(plain.skeleton, plain.parts)
    assert _parities(other.parts) == _parities(plain.parts)
    for names in pairs(plain.skeleton, plain.parts):
        area = SCALE**2 * plain.area(*names)
        assert other.area(*names) == pytest.approx(area, rel=5e-3, abs=1e-6)
    assert [p[3] for p in sorted(other.inner_junctions(), key=lambda p: p[3])] == pytest.approx(
        sorted(SCALE * p[3] for p in plain.inner_junctions()), abs=2e-9
    )
    volumes = {name: SCALE**3 * volume for name, volume in plain.volumes().items()}
    assert other.volumes() == pytest.approx(volumes, rel=2e-3)


def _parities(region: RegionSkeleton) -> Counter[object]:
    return Counter(sheet.parity for sheet in region.sheets)


@pytest.mark.parametrize(
    "part",
    [
        decomp.Block((1, 1, 1), (2, 1.5, 1), name="part"),
        decomp.Cylinder((2, 2, 0.5), (2, 2, 1.5), 0.8, name="part"),
    ],
    ids=["block", "cylinder"],
)
def test_the_sheets_outside_are_those_of_the_complement(part: Solid) -> None:
    """As the second region of a model, the air around a part has the skeleton it has alone."""
    box = decomp.Block((0, 0, 0), (5, 4, 3), name="box")
    alone = decomp.skeleton({"air": box - part})
    both = decomp.skeleton({"part": part, "air": box - part})
    assert [region.name for region in both.regions] == ["part", "air"]
    outside, complement = Region(both, 1), Region(alone, 0)
    assert outside.counts() == complement.counts()
    assert pairs(both, outside.parts) == pairs(alone, complement.parts)
    assert _parities(outside.parts) == _parities(complement.parts)
    for names in pairs(alone, complement.parts):
        assert outside.area(*names) == pytest.approx(complement.area(*names), rel=5e-3)
    off = 2e-3 * complement.parts.boundary.volume
    assert outside.volumes() == pytest.approx(complement.volumes(), abs=off)
    within = Region(decomp.skeleton(part))
    assert Region(both, 0).counts() == within.counts()


def test_a_thin_wall_needs_little_memory() -> None:
    """A wall of 1/1000 of the diagonal: its sheet is there, in less than 2 GB."""
    code = (
        "import decomp; from tests.skeletons.computed import region_of;"
        "block = region_of('walled block');"
        "print(len(block.sheets('block.xmin', 'slot.xmin')), block.skeleton.diagonal,"
        " block.sheets('block.xmin', 'slot.xmin')[0].radius[1],"
        " sum(len(p.triangles) for p in block.skeleton.complex.patches),"
        " next(x.split()[1] for x in open('/proc/self/status') if x.startswith('VmHWM')))"
    )
    for _ in range(2):
        # The first process may have to compile kernels, which takes memory of its own. The peak is
        # read from the system, as getrusage counts the parent's memory before exec too.
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
        )
    count, diagonal, radius, triangles, kilobytes = map(float, done.stdout.split())
    assert count == 1
    assert radius == pytest.approx(diagonal / 2000, rel=1e-9)
    assert triangles < 5000
    assert kilobytes < 2e6
