"""Files with six digits: rotations, scales and planes are what those digits stand for."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

import decomp
from decomp.csg.halfspaces import half_space_form
from decomp.csg.model import model
from decomp.csg.primitives import Block
from decomp.csg.solid import union
from decomp.similarity import from_matrix


def written(matrix: np.ndarray, digits: int) -> str:
    rows = [", ".join(f"{float(f'{v:.{digits}g}')!r}" for v in row) for row in matrix]
    return "[" + ", ".join(f"[{row}]" for row in rows) + "]"


def turned(degrees: float, scale: float = 1.0, offset: tuple[float, ...] = (0, 0, 0)) -> np.ndarray:
    c, s = scale * cos(pi * degrees / 180), scale * sin(pi * degrees / 180)
    matrix = np.diag([1.0, 1.0, scale, 1.0])
    matrix[:2, :2] = [[c, -s], [s, c]]
    matrix[:3, 3] = offset
    return matrix


def loaded(tmp_path: Path, text: str) -> decomp.Geometry:
    path = tmp_path / "model.csg"
    path.write_text(text)
    return decomp.Geometry(path)


@pytest.mark.parametrize("digits", [6, 7, 9, 16])
@pytest.mark.parametrize(("count", "away"), [(20, 40), (12, 30), (7, 25)])
def test_a_ring_of_cubes(tmp_path: Path, count: int, away: float, digits: int) -> None:
    cubes = [
        f"multmatrix({written(turned(360 * k / count), digits)})"
        f"{{multmatrix([[1,0,0,{away}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]){{cube(8, center=true);}}}}"
        for k in range(count)
    ]
    region = loaded(tmp_path, "\n".join(cubes)).regions[0]
    assert (region.euler, len(region.faces)) == (count, 6 * count)
    assert region.volume == pytest.approx(512 * count, rel=1e-9)


@pytest.mark.parametrize("turn", [18, 31.7, 72])
def test_parts_that_meet_in_planes_known_to_six_digits(tmp_path: Path, turn: float) -> None:
    """Cubes side by side, each with a matrix of its own: what should be one face is one."""
    c, s = cos(pi * turn / 180), sin(pi * turn / 180)
    cubes = [
        f"multmatrix({written(turned(turn, offset=(8 * k * c, 8 * k * s, 0)), 6)}){{cube(8);}}"
        for k in range(5)
    ]
    region = loaded(tmp_path, "\n".join(cubes)).regions[0]
    assert (region.euler, len(region.faces), len(region.vertices)) == (1, 6, 8)
    assert region.volume == pytest.approx(5 * 512, rel=2e-5)


def test_converted_models_know_of_their_digits(tmp_path: Path) -> None:
    few = np.vectorize(lambda v: float(f"{v:.6g}"))
    blocks = [
        Block((0, 0, 0), (8, 8, 8)).transform(
            few(turned(18, offset=(8 * k * cos(pi / 10), 8 * k * sin(pi / 10), 0)))
        )
        for k in range(3)
    ]
    path = tmp_path / "blocks.json"
    decomp.save(model(union(blocks)), path)
    assert len(decomp.Geometry(path).regions[0].faces) == 6
    path.write_text(path.read_text().replace('"shift": ', '"shift": -'))
    with pytest.raises(decomp.DecompError, match="doubt and shift must not be negative"):
        decomp.load(path)


@pytest.mark.parametrize("scale", [1, 2, 0.5, 25.4, 1.25])
def test_scales_are_the_numbers_that_six_digits_stand_for(scale: float) -> None:
    matrix = turned(18, scale)
    read = from_matrix(np.vectorize(lambda v: float(f"{v:.6g}"))(matrix))
    assert read.scale == scale
    assert from_matrix(matrix).scale == pytest.approx(scale, rel=1e-15)
    assert from_matrix(matrix).doubt == 0


def test_what_was_moved_together_stays_apart(tmp_path: Path) -> None:
    """A gap that is smaller than six digits tell of the place, but the same numbers move both."""
    gap = 2e-5
    pair = f"cube(8); multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,{8 + gap}],[0,0,0,1]]){{cube(8);}}"
    together = loaded(tmp_path, f"multmatrix({written(turned(18), 6)}){{{pair}}}")
    assert together.regions[0].euler == 2
    exact = union([Block((0, 0, 0), (8, 8, 8)), Block((0, 0, 8 + gap), (8, 8, 8))])
    assert decomp.Geometry(exact).regions[0].euler == 2


def test_planes_further_apart_than_the_digits_say_stay_apart() -> None:
    few = np.vectorize(lambda v: float(f"{v:.6g}"))(turned(18))
    for gap, carriers in ((1e-6, 11), (1e-3, 12)):
        blocks = Block((0, 0, 0), (8, 8, 8)).transform(few) | Block((20, 20, -8), (8, 8, 8 + gap))
        assert len(half_space_form(model(blocks)).carriers) == carriers
