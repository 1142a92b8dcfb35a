"""What every sheet lies on, as arrays with a row for each sheet, by the sheets' numbers.

All arrays are numbers, which every reader of .vtu files takes; their columns have names.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from decomp.skeletons.files.surfaces import lies_on
from decomp.skeletons.sheet_kinds import SheetKind
from decomp.vectors import Array
from decomp.voronoi import Kind, Polynomial

HIGHEST = 8
"""Equations of a higher degree are told in the text only: degree 8 has 165 coefficients."""


@dataclass(frozen=True, eq=False)
class Table:
    """An array with names for its columns, if it has more than one.

    Args:
        values: (rows,) or (rows, columns).
        columns: their names.
    """

    values: NDArray[Any]
    columns: tuple[str, ...] = ()


def region_tables(methods: Sequence[int]) -> dict[str, Table]:
    """The table `region_method`: 0 for each region that was traced, 1 for one that was sampled."""
    return {"region_method": Table(np.array(methods, dtype=np.int32))} if methods else {}


def sheet_tables(kinds: Sequence[SheetKind], labels: Sequence[str]) -> dict[str, Table]:
    """The tables by name, none if there are no sheets.

    `sheet_surface` is an index into the columns of `surface_counts`, which tells how many sheets of
    each kind there are; `sheet_degree` is -1 where no equation is known; `sheet_origin`,
    `sheet_axes` and `sheet_parameters` are those of the canonical equation; `sheet_equation` holds
    the coefficients by the powers of x, y, z, the largest 1 (NaN where there is no equation), and
    these are counted from `equation_origin`, which is there where that is not 0;
    `sheets` is the JSON of all that as UTF-8 bytes, with the equations as text.
    """
    if not kinds:
        return {}
    numbers = np.array([list(Kind).index(kind.kind) for kind in kinds], dtype=np.int32)
    degrees = np.array([-1 if kind.degree is None else kind.degree for kind in kinds])
    rows = [{"name": label, **lies_on(kind)} for label, kind in zip(labels, kinds, strict=True)]
    text = np.frombuffer(json.dumps(rows, ensure_ascii=False).encode(), dtype=np.uint8)
    counts = np.bincount(numbers, minlength=len(Kind)).astype(np.int32)
    return {
        "surface_counts": Table(counts[None], tuple(kind.value for kind in Kind)),
        "sheet_surface": Table(numbers),
        "sheet_degree": Table(degrees.astype(np.int32)),
        **_frames(kinds),
        "sheet_equation": _coefficients([kind.polynomial for kind in kinds]),
        **_counted_from(kinds[0].offset),
        "sheets": Table(text),
    }


def _counted_from(offset: Array) -> dict[str, Table]:
    return {"equation_origin": Table(offset[None], tuple("xyz"))} if offset.any() else {}


def _frames(kinds: Sequence[SheetKind]) -> dict[str, Table]:
    """Origin, axes and parameters of the canonical equations, NaN where there is none."""
    names = tuple(sorted({n for k in kinds if k.shape is not None for n in k.shape.parameters}))
    origin, axes = np.full((len(kinds), 3), np.nan), np.full((len(kinds), 9), np.nan)
    values = np.full((len(kinds), max(len(names), 1)), np.nan)
    for row, kind in enumerate(kinds):
        if kind.shape is None:
            continue
        origin[row] = kind.shape.origin + kind.offset
        axes[row] = kind.shape.axes.reshape(9)
        for name, value in kind.shape.parameters.items():
            values[row, names.index(name)] = value
    return {
        "sheet_origin": Table(origin, ("x", "y", "z")),
        "sheet_axes": Table(axes, tuple(f"{axis}.{c}" for axis in "xyz" for c in "xyz")),
        "sheet_parameters": Table(values, names),
    }


def _coefficients(polynomials: Sequence[Polynomial | None]) -> Table:
    told = [None if p is None or p.degree > HIGHEST else p for p in polynomials]
    degree = max((p.degree for p in told if p is not None), default=0)
    powers = [
        (i, j, n - i - j)
        for n in range(degree, -1, -1)
        for i in range(n, -1, -1)
        for j in range(n - i, -1, -1)
    ]
    place = {power: k for k, power in enumerate(powers)}
    values = np.full((len(told), len(powers)), np.nan)
    for row, p in enumerate(told):
        if p is not None:
            values[row] = 0.0
            largest = max(map(abs, p.terms.values()), default=1)
            for power, number in p.terms.items():
                values[row, place[power]] = number / largest
    return Table(values, tuple(_monomial(power) for power in powers))


def _monomial(power: tuple[int, int, int]) -> str:
    factors = zip("xyz", power, strict=True)
    return "*".join(v if n == 1 else f"{v}^{n}" for v, n in factors if n) or "1"
