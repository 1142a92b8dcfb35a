"""Colours that colour-blind eyes tell apart.

Categories: Okabe and Ito, Color Universal Design, 2008, without black. Values: cividis (Nunez,
Anderton and Renslow, 2018, doi:10.1371/journal.pone.0199239), at nine places.
"""

from __future__ import annotations

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


def rgb(colour: str) -> tuple[float, float, float]:
    """Red, green and blue from 0 to 1 of a colour such as #0072B2."""
    return tuple(int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))  # type: ignore[return-value]
