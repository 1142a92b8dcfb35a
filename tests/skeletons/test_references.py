"""Skeletons that can be worked out by hand: counts, areas, places, radii and volumes.

Areas of curved sheets are those of chords, so they fall short a little.
"""

from __future__ import annotations

from collections import Counter
from math import acos, pi, sqrt, tan

import numpy as np
import pytest
from scipy.optimize import brentq

from decomp.complex.model import LineKind
from decomp.skeletons.model import Parity
from tests.corpus.files import FILES
from tests.skeletons.computed import region_of

CURVED = 2e-3
"""Relative error allowed to the area or length of something curved."""


def test_block() -> None:
    """13 sheets; 12 junctions with the corners, 24 curves with the edges."""
    block = region_of("block")
    assert block.counts() == (13, 12, 12)
    kinds = [line.kind for line in block.skeleton.complex.lines]
    assert len(kinds) == 24
    assert kinds.count(LineKind.EDGE) == kinds.count(LineKind.SEAM) == 12
    assert block.inner_junctions() == [(1, 1, 1, 1), (1, 2, 1, 1), (3, 1, 1, 1), (3, 2, 1, 1)]
    assert block.volumes() == pytest.approx(
        {
            "block.xmin": 7 / 3,
            "block.xmax": 7 / 3,
            "block.ymin": 10 / 3,
            "block.ymax": 10 / 3,
            "block.zmin": 19 / 3,
            "block.zmax": 19 / 3,
        },
        rel=1e-12,
    )
    for names, area in (
        (("xmin", "ymin"), sqrt(2)),
        (("xmin", "zmin"), 2 * sqrt(2)),
        (("ymin", "zmin"), 3 * sqrt(2)),
        (("zmin", "zmax"), 2),
    ):
        assert block.area(*(f"block.{name}" for name in names)) == pytest.approx(area, rel=1e-12)
    assert {sheet.parity for sheet in block.parts.sheets} == {Parity.EVEN}
    lengths = sorted(seam.length for seam in block.parts.seams)
    assert lengths == pytest.approx([1, 1, *[sqrt(3)] * 8, 2, 2], rel=1e-12)


def test_block_is_as_lean_as_can_be() -> None:
    """34 triangles: 12 on the boundary, 22 on the sheets."""
    patches = region_of("block").skeleton.complex.patches
    assert sum(len(patch.triangles) for patch in patches) == 34


def test_cube_has_one_junction_of_all_sheets() -> None:
    cube = region_of("cube")
    assert cube.counts() == (12, 8, 9)
    assert cube.inner_junctions() == [(1, 1, 1, 1)]
    (middle,) = [j for j in cube.parts.junctions if j.radius > 0]
    assert len(set(middle.sites)) == 6
    patches = cube.skeleton.complex.patches
    assert all(middle.vertex in patches[s.patch].triangles for s in cube.parts.sheets)
    assert [s.area for s in cube.parts.sheets] == pytest.approx([sqrt(2)] * 12)


def test_bar_has_a_seam_of_four() -> None:
    bar = region_of("bar")
    assert bar.counts() == (12, 9, 10)
    (middle,) = [seam for seam in bar.parts.seams if len(seam.sheets) == 4]
    assert len(middle.sites) == 4
    assert middle.length == pytest.approx(1, rel=1e-12)
    assert bar.inner_junctions() == [(0.5, 0.5, 0.5, 0.5), (1.5, 0.5, 0.5, 0.5)]


def test_cylinder() -> None:
    """Two cones of area pi sqrt 2, and an axis of length 1."""
    rod = region_of("cylinder")
    assert rod.counts() == (2, 0, 0)
    for sheet in rod.parts.sheets:
        assert sheet.area == pytest.approx(4.44288, rel=CURVED)
        assert sheet.radius == pytest.approx((0, 1), abs=1e-12)
    (axis,) = rod.parts.reflexive
    assert axis.dimension == 1
    assert axis.length == pytest.approx(1, rel=1e-12)
    ends = rod.points[rod.skeleton.complex.lines[axis.line or 0].vertices[[0, -1]]]
    assert sorted(ends.tolist()) == [pytest.approx([0, 0, 1]), pytest.approx([0, 0, 2])]


def test_axis_of_a_square_cylinder_shrinks_to_a_point() -> None:
    """With r = h / 2 the two cones meet in the middle."""
    rod = region_of("square cylinder")
    assert len(rod.parts.sheets) == 2
    assert all(locus.length <= 1e-9 for locus in rod.parts.reflexive)
    assert sum(s.area for s in rod.parts.sheets) == pytest.approx(2 * pi * sqrt(2), rel=CURVED)
    patches = rod.skeleton.complex.patches
    low, high = (set(patches[s.patch].triangles.reshape(-1).tolist()) for s in rod.parts.sheets)
    (middle,) = low & high
    assert rod.points[middle] == pytest.approx([0, 0, 1], abs=1e-12)


def test_disc_has_a_closed_seam() -> None:
    disc = region_of("disc")
    assert disc.counts() == (3, 1, 0)
    (seam,) = disc.parts.seams
    assert seam.closed
    assert seam.length == pytest.approx(pi, rel=CURVED)
    assert disc.area("disc.base", "disc.top") == pytest.approx(pi / 4, rel=2 * CURVED)
    cone = pi * (1 + 0.5) * sqrt(0.5)
    assert disc.area("disc.side", "disc.base") == pytest.approx(cone, rel=CURVED)


def test_sphere_is_a_point() -> None:
    ball = region_of("sphere")
    assert ball.counts() == (0, 0, 0)
    (centre,) = ball.parts.reflexive
    assert (centre.dimension, centre.line) == (0, None)
    assert ball.points[centre.vertex or 0] == pytest.approx([1, 2, 3], abs=1e-14)


@pytest.mark.slow
def test_torus_is_a_circle() -> None:
    ring = region_of("torus")
    assert ring.counts() == (0, 0, 0)
    (spine,) = ring.parts.reflexive
    assert (spine.dimension, spine.closed) == (1, True)
    assert spine.length == pytest.approx(4 * pi, rel=CURVED)
    circle = ring.points[ring.skeleton.complex.lines[spine.line or 0].vertices]
    assert np.hypot(*circle.T[:2]) == pytest.approx(2, abs=1e-14)
    assert circle[:, 2] == pytest.approx(0, abs=1e-14)


def test_capsule_is_a_segment() -> None:
    rod = region_of("capsule")
    assert rod.counts() == (0, 0, 0)
    assert sum(locus.length for locus in rod.parts.reflexive) == pytest.approx(2, rel=1e-12)


def test_cone() -> None:
    """The axis goes from the centre of the inscribed sphere to the apex."""
    cone = region_of("cone")
    r = 2 / (1 + sqrt(5))
    assert len(cone.parts.sheets) == 1
    assert cone.parts.sheets[0].area == pytest.approx(pi * sqrt(1 + r * r), rel=CURVED)
    assert cone.parts.sheets[0].radius[1] == pytest.approx(r, rel=1e-9)
    (axis,) = cone.parts.reflexive
    assert axis.length == pytest.approx(2 - r, rel=1e-9)


def test_frustum() -> None:
    frustum = region_of("frustum")
    angle = acos(0.5 / sqrt(4.25))
    low, high = tan(angle / 2), 2 - 0.5 * tan((pi - angle) / 2)
    assert len(frustum.parts.sheets) == 2
    (axis,) = frustum.parts.reflexive
    assert axis.length == pytest.approx(high - low, rel=1e-9)


@pytest.mark.slow
def test_hollow_sphere() -> None:
    shell = region_of("hollow sphere")
    assert shell.counts() == (1, 0, 0)
    (sheet,) = shell.parts.sheets
    assert sheet.parity is Parity.ODD
    assert sheet.area == pytest.approx(4 * pi * 0.99**2, rel=CURVED)
    assert sheet.radius == pytest.approx((0.01, 0.01), abs=1e-12)


def test_lens_is_a_disc() -> None:
    lens = region_of("lens")
    assert lens.counts() == (1, 0, 0)
    assert lens.parts.sheets[0].area == pytest.approx(0.75 * pi, rel=CURVED)
    assert lens.on_sheets("left.surface", "right.surface")[:, 0] == pytest.approx(0.5, abs=1e-14)


def test_a_lens_is_thickest_in_its_middle() -> None:
    """Where its disc, which is flat, has no vertex."""
    lens = region_of("lens")
    assert lens.parts.sheets[0].radius == pytest.approx((0, 0.5), abs=1e-12)


@pytest.mark.slow
def test_oval_ring_is_a_band() -> None:
    """Between two tori with tubes of radius 1 about circles of 3 and 3.8."""
    ring = region_of("oval ring")
    assert ring.counts() == (1, 0, 0)
    assert ring.parts.sheets[0].radius == pytest.approx((0, 0.6), abs=1e-12)
    assert ring.area("inner.surface", "outer.surface") == pytest.approx(
        2 * pi * 3.4 * 2 * sqrt(0.84), rel=CURVED
    )
    rho = np.hypot(*ring.on_sheets("inner.surface", "outer.surface").T[:2])
    assert rho == pytest.approx(3.4, abs=1e-12)


def test_washer_has_two_closed_seams() -> None:
    washer = region_of("washer")
    assert washer.counts() == (5, 2, 0)
    lengths = sorted(seam.length for seam in washer.parts.seams)
    assert lengths == pytest.approx([3 * pi, 9 * pi], rel=CURVED)
    flat = washer.area("disc.base", "disc.top")
    assert flat == pytest.approx(pi * (4.5**2 - 1.5**2), rel=CURVED)


@pytest.mark.parametrize("name", ["through hole", "eccentric hole"])
def test_through_hole(name: str) -> None:
    """12 sheets from the edges, one of the hole with each side; bottom and top meet nowhere."""
    plate = region_of(name)
    assert plate.counts() == (18, 20, 16)
    centre = {"through hole": 2.0, "eccentric hole": 1.3}[name]
    near = brentq(lambda x: np.hypot(centre - x, 2 - x) - 1 - x, 0, 1)
    far = brentq(lambda x: np.hypot(4 - centre - x, 2 - x) - 1 - x, 0, 1)
    expected = [
        (x, y, z, r)
        for x, r in ((near, near), (4 - far, far))
        for y in (r, 4 - r)
        for z in (r, 2 - r)
    ]
    assert plate.inner_junctions() == [pytest.approx(p, abs=2e-9) for p in sorted(expected)]
    for side in ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax"):
        (sheet,) = plate.sheets("hole.side", f"plate.{side}")
        assert sheet.parity is Parity.ODD
    assert not plate.sheets("plate.zmin", "plate.zmax")
    assert sum(plate.volumes().values()) == pytest.approx(32 - 2 * pi, rel=1e-3)


def test_blind_hole() -> None:
    """The paper's figure 4: under the hole a plane, then a parabolic torus, above it a cone."""
    plate = region_of("blind hole")
    assert plate.counts() == (23, 24, 16)
    edge = "hole.base|hole.side"
    high = (2 * sqrt(2) - 1) / (1 + sqrt(2))
    assert plate.area("hole.base", "plate.zmin") == pytest.approx(pi, rel=2 * CURVED)
    assert plate.on_sheets("hole.base", "plate.zmin")[:, 2] == pytest.approx(0.5, abs=1e-14)
    x, y, z = (plate.on_sheets(edge, "plate.zmin") - [2, 2, 0]).T
    assert np.hypot(np.hypot(x, y) - 1, z - 1) == pytest.approx(z, abs=1e-12)
    x, y, z = (plate.on_sheets("hole.side", "plate.zmax") - [2, 2, 0]).T
    assert np.hypot(x, y) - 1 == pytest.approx(2 - z, abs=1e-12)
    for side in ("xmin", "xmax", "ymin", "ymax"):
        (wall,) = plate.sheets("hole.side", f"plate.{side}")
        assert wall.radius == pytest.approx((0.5, high), abs=1e-12)  # thinnest between vertices
        assert len(plate.sheets(edge, f"plate.{side}")) == 1
    assert not plate.sheets(edge, "plate.zmax")
    # where sheets go on from face to edge: a circle below, four arcs at the height of the base
    (circle,) = [trim for trim in plate.parts.trims if trim.closed]
    assert circle.length == pytest.approx(2 * pi, rel=CURVED)
    assert len(plate.parts.trims) == 5
    low = brentq(lambda t: np.hypot(sqrt(2) * (2 - t) - 1, 1 - t) - t, 0, 1)
    radii = [radius for *_, radius in plate.inner_junctions()]
    assert sorted(radii) == pytest.approx([high] * 4 + [low] * 4, abs=2e-9)
    assert len(plate.parts.cells) == 7
    assert len(plate.parts.face_cells) == 8


def test_equal_angle() -> None:
    foot = region_of("equal angle")
    assert foot.counts() == (23, 21, 16)
    r = 2 - sqrt(2)  # a ball in the corner, touching the reentrant edge
    corner = [p for p in foot.inner_junctions() if p[3] > 0.51]
    assert corner == [pytest.approx((r, r, z, r), abs=2e-9) for z in (r, 2 - r)]
    exact = sqrt(2) * (2 * r - r * r)
    assert foot.area("foot.xmin", "foot.ymin") == pytest.approx(exact, rel=1e-9)
    assert foot.area("foot.xmin", "leg.xmax") == pytest.approx(1.5, rel=1e-9)
    edge = "foot.ymax|leg.xmax"
    sheets = [foot.area(edge, f"foot.{side}") for side in ("xmin", "ymin", "zmin", "zmax")]
    assert sheets[0] == pytest.approx(sheets[1], rel=1e-3)
    assert sheets[2] == pytest.approx(sheets[3], rel=1e-3)
    assert "foot.ymax+leg.xmax" in foot.volumes()


@pytest.mark.parametrize(("name", "thick"), [("unequal angle", 0.6), ("half angle", 0.5)])
def test_unequal_angle(name: str, thick: float) -> None:
    foot = region_of(name)
    edge = "foot.ymax|leg.xmax"
    assert len(foot.parts.face_cells) == 8
    assert foot.area("foot.xmin", "leg.xmax") == pytest.approx(
        (2 - thick) * (3 - 1 - thick / 2), rel=1e-9
    )
    for side in ("xmin", "zmin", "zmax"):
        assert len(foot.sheets(edge, f"foot.{side}")) == 1
    x, y, _ = foot.on_sheets(edge, "foot.xmin").T
    assert np.hypot(x - thick, y - 1) == pytest.approx(x, abs=1e-12)
    # at half the thickness the ball between the foot's sides touches the edge and xmin at once
    assert (max(len(s.sheets) for s in foot.parts.seams) == 3) is (
        len(foot.sheets(edge, "foot.ymin")) == (thick == 0.6)
    )


def test_fichera() -> None:
    cube = region_of("fichera")
    assert cube.kinds() == {("face", "face"): 21, ("edge", "face"): 9, ("face", "vertex"): 3}
    r = sqrt(3) / (1 + sqrt(3))
    (largest,) = [p for p in cube.inner_junctions() if p[3] > 0.6]
    assert largest == pytest.approx((r - 1, r - 1, r - 1, r), abs=2e-9)
    on_edges = [p for p in cube.inner_junctions() if 0.51 < p[3] < 0.6]
    assert [p[3] for p in on_edges] == pytest.approx([2 - sqrt(2)] * 3, abs=2e-9)


def test_pocket() -> None:
    """Reentrant vertices: each has a sheet with the bottom and with two sides."""
    plate = region_of("pocket")
    assert plate.counts() == (53, 40, 16)
    assert plate.kinds() == {("face", "face"): 21, ("edge", "face"): 20, ("face", "vertex"): 12}
    r = sqrt(3) / (1 + sqrt(3))
    assert sorted(p[3] for p in plate.inner_junctions())[-4:] == pytest.approx([r] * 4, abs=2e-9)
    assert plate.area("plate.zmin", "pocket.zmin") == pytest.approx(4, rel=1e-9)
    assert plate.area("plate.xmin", "pocket.xmin") == pytest.approx(1, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "counts", "cells"),
    [
        ("cross-drilled block", (28, 36, 24), 9),
        ("equally cross-drilled block", (28, 30, 20), 10),
    ],
)
def test_cross_drilled_block(name: str, counts: tuple[int, int, int], cells: int) -> None:
    block = region_of(name)
    assert block.counts() == counts
    assert len(block.parts.cells) == cells
    assert block.kinds() == {("face", "face"): 28}


def test_unequal_tee() -> None:
    """The edge between the run and its thinner branch has a sheet with itself: the plane y = 0."""
    tee = region_of("unequal tee")
    edge = "branch.side|run.side"
    (own,) = tee.sheets(edge, edge)
    # thinnest where the ball's foot is the edge's highest point, between a rim's ends
    assert own.radius == pytest.approx((0.6 / sqrt(1.36), 1), abs=1e-12)
    assert tee.on_sheets(edge, edge)[:, 1] == pytest.approx(0, abs=1e-12)


def test_equal_tee() -> None:
    """Both edges have a sheet with themselves: triangles between the two axes and their rims."""
    tee = region_of("equal tee")
    edge = "branch.side|run.side"
    assert sorted(sheet.area for sheet in tee.sheets(edge, edge)) == pytest.approx([0.5, 0.5])
    assert tee.on_sheets(edge, edge)[:, 1] == pytest.approx(0, abs=1e-12)
    assert sum(tee.volumes().values()) == pytest.approx(8 * pi - 8 / 3, rel=1e-3)


def test_offset_tee() -> None:
    """The edge has three feet along a seam in the plane of symmetry, from the branch's axis.

    The axis is touched by two arcs of the branch down to the height of its near side, and by one
    further down to that of its far side, where the flat sheet of the edge with itself begins.
    """
    tee = region_of("offset tee")
    edge = "branch.side|run.side"
    flat, bent = sorted(tee.sheets(edge, edge), key=lambda sheet: sheet.area)
    (seam,) = tee.parts.seams
    assert tee.names(seam.sites) == (edge,)
    patches = tee.skeleton.complex.patches
    on_flat = tee.points[np.unique(patches[flat.patch].triangles)]
    assert on_flat[:, 0] == pytest.approx(0, abs=1e-12)
    heights = sorted(float(tee.points[j.vertex, 2]) for j in tee.parts.junctions)
    assert any(z == pytest.approx(0.96**0.5, abs=1e-8) for z in heights)
    assert on_flat[:, 2].max() == pytest.approx(0.96**0.5, abs=1e-8)
    # it is its own mirror image
    on_bent = tee.points[np.unique(patches[bent.patch].triangles)]
    assert on_bent[:, 0].max() == pytest.approx(0.5, abs=1e-9)
    assert on_bent[:, 0].min() == pytest.approx(-0.5, abs=1e-9)


def test_square_boss() -> None:
    """Under the boss run sheets between two edges of one face; below its corners they end freely.

    The ball in the middle touches all four sides of the boss, its top and the plate's bottom.
    """
    plate = region_of("square boss")
    sides = ("xmin", "xmax", "ymin", "ymax")
    for first, second in ((a, b) for a in sides[:2] for b in sides[2:]):
        edges = f"boss.{first}|plate.zmax", f"boss.{second}|plate.zmax"
        (sheet,) = plate.sheets(*edges)
        assert sheet.radius == pytest.approx((0, 1), abs=1e-9)
        x, y, _ = (plate.on_sheets(*edges) - [2, 2, 0]).T
        assert np.abs(x) == pytest.approx(np.abs(y), abs=1e-12)
    assert len(plate.parts.rims) == 4
    assert [rim.length for rim in plate.parts.rims] == pytest.approx([0.5] * 4, rel=1e-9)
    assert plate.counts() == (29, 20, 21)
    assert (2, 2, 1, 1) in plate.inner_junctions()
    corners = [(x, y, 0.5, 0.5) for x in (0.5, 1, 3, 3.5) for y in (x, 4 - x)]
    assert plate.inner_junctions() == sorted([*corners, (2, 2, 1, 1)])


def test_round_boss() -> None:
    """The round edge is its own partner on an axis, below the axis of the boss's side."""
    plate = region_of("round boss")
    edge = "boss.side|plate.zmax"
    lengths = {plate.names((locus.site,))[0]: locus.length for locus in plate.parts.reflexive}
    # up to the ball that touches the top; down to the one that touches the bottom
    below = 1 - (1 + 0.7**2) / 2
    assert lengths == pytest.approx({"boss.side": 0.3, edge: below}, rel=1e-9)
    x, y, z = (plate.on_sheets(edge, "plate.zmin") - [2, 2, 0]).T
    assert np.hypot(np.hypot(x, y) - 0.7, z - 1) == pytest.approx(z, abs=1e-12)
    (circle,) = plate.parts.trims
    assert circle.closed
    assert circle.length == pytest.approx(1.4 * pi, rel=CURVED)


def test_countersink() -> None:
    """Sheets at acute edges of 26 degrees end there."""
    plate = region_of("countersink")
    assert len(plate.sheets("plate.zmin", "sink.side")) == 1
    assert len(plate.sheets("plate.zmax", "sink.side")) == 1
    assert plate.kinds().keys() == {("face", "face")}


def test_thin_wall() -> None:
    """A wall of 0.002 of the diagonal has a sheet in its middle."""
    block = region_of("thin wall")
    (sheet,) = block.sheets("block.xmin", "slit.xmin")
    assert sheet.parity is Parity.ODD
    assert sheet.radius == pytest.approx((0.005, 0.005), abs=1e-12)
    # bounded by the seams with bottom and top and the trims of the slit's edges
    assert sheet.area == pytest.approx(1.99, rel=1e-9)
    edge = "slit.xmin|slit.ymin"
    x, y, _ = block.on_sheets("block.xmin", edge).T
    assert np.hypot(x - 0.01, y - 1) == pytest.approx(x, abs=1e-12)


@pytest.mark.skipif("netgen/shaft.geo" not in FILES, reason="Netgen's models are not here")
def test_crankshaft_has_a_closed_curve_of_seams_in_each_web() -> None:
    """Each web's outline has two arcs, two lines and four reentrant edges between them."""
    shaft = region_of("netgen/shaft.geo")
    assert len(shaft.parts.seams) == 4 * 8
    lines = [shaft.skeleton.complex.lines[seam.line].vertices for seam in shaft.parts.seams]
    along = [shaft.points[line][:, 0] for line in lines]
    webs = Counter(round(float(x.mean()), 9) for x in along)
    assert webs == {5: 8, 40: 8, 85: 8, 120: 8}
    assert max(float(np.ptp(x)) for x in along) <= 1e-12 * shaft.skeleton.diagonal
    ends = Counter(int(end) for line in lines for end in line[[0, -1]])
    assert set(ends.values()) == {2}
    assert {len(seam.sheets) for seam in shaft.parts.seams} == {3}
    assert not shaft.parts.junctions
