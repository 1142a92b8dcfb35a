"""Colours that colour-blind eyes tell apart, given to parts so that neighbours differ.

Categories: Okabe and Ito, Color Universal Design, 2008, without black. Values: cividis (Nunez,
Anderton and Renslow, 2018, doi:10.1371/journal.pone.0199239), at nine places.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array  # type: ignore[import-untyped]

from decomp.vectors import Ints

CATEGORIES = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#CC79A7",
    "#56B4E9",
    "#D55E00",
    "#F0E442",
    "#4D4D4D",
)
_CIVIDIS = "#00224E #213D6B #434E6C #5D616F #757575 #8F8B73 #B2A267 #D8BF52 #FDEA45"
VALUES = tuple(_CIVIDIS.split())
LIGHTER, DARKER = 0.5, 0.4
"""Shares of white and black in the colours that are taken where the eight do not suffice."""
MEETING = 2
"""Parts are neighbours if they share so many points, the ends of an edge."""


def rgb(colour: str) -> tuple[float, float, float]:
    """Red, green and blue from 0 to 1 of a colour such as #0072B2."""
    return tuple(int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))  # type: ignore[return-value]


def _mixed(colour: str, share: float, other: float) -> str:
    parts = (round(255 * ((1 - share) * value + share * other)) for value in rgb(colour))
    return "#" + "".join(f"{part:02X}" for part in parts)


PALETTE = (
    *CATEGORIES,
    *(_mixed(colour, LIGHTER, 1.0) for colour in CATEGORIES),
    *(_mixed(colour, DARKER, 0.0) for colour in CATEGORIES),
)


def spread(pieces: Sequence[Ints], count: int) -> list[int]:
    """Numbers into `PALETTE` of pieces, no two neighbours alike while the palette suffices.

    All differ if the palette has so many. Pieces with many neighbours choose first: the colour that
    is least used so far, if it can be one whose lighter and darker forms are not beside it either.

    Args:
        pieces: the points of each, as numbers, any number of times.
        count: of all points.
    """
    points = [np.unique(piece) for piece in pieces]
    rows = np.repeat(np.arange(len(points)), [len(own) for own in points])
    columns = np.concatenate([np.empty(0, dtype=np.int64), *points])
    ones = np.ones(len(rows), dtype=np.int64)
    has = csr_array((ones, (rows, columns)), shape=(len(points), count))
    shared = (has @ has.T).tocsr()
    near = [_beside(shared, k) for k in range(len(points))]
    result = [-1] * len(points)
    used = [0] * len(PALETTE)
    for k in sorted(range(len(points)), key=lambda k: -len(near[k])):
        around = {result[other] for other in near[k]}
        hues = {colour % len(CATEGORIES) for colour in around}
        free = [c for c in range(len(PALETTE)) if c not in around] or range(len(PALETTE))
        chosen = _least(free, used, hues)
        result[k], used[chosen] = chosen, used[chosen] + 1
    return result


def _least(free: Sequence[int], used: Sequence[int], hues: set[int]) -> int:
    """The colour that is used least, then one of a hue that is none of `hues`, then the first."""
    return min(free, key=lambda c: (used[c], c % len(CATEGORIES) in hues, c))


def _beside(shared: csr_array, piece: int) -> list[int]:
    """The neighbours of a piece."""
    row = slice(shared.indptr[piece], shared.indptr[piece + 1])
    found = shared.indices[row][shared.data[row] >= MEETING]
    return [int(other) for other in found if other != piece]
