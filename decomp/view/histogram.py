"""A histogram as an inline picture (SVG)."""

from __future__ import annotations

import numpy as np

from decomp.drawing.colours import CATEGORIES
from decomp.vectors import Array

BINS, CHART_WIDTH, HIGH, CHART_FOOT = 36, 560, 110, 22


def histogram(values: Array, low: float, high: float, what: str) -> str:
    """Bars of how many values (n,) lie where from `low` to `high`."""
    counts, _ = np.histogram(np.clip(values, low, high), BINS, (low, high))
    most, step = max(int(counts.max(initial=0)), 1), CHART_WIDTH / BINS
    bars = "".join(
        f'<rect x="{k * step:.1f}" y="{HIGH * (1 - count / most):.1f}" width="{step - 1:.1f}" '
        f'height="{HIGH * count / most:.1f}" fill="{CATEGORIES[0]}"><title>{count}</title></rect>'
        for k, count in enumerate(counts.tolist())
    )
    marks = "".join(
        f'<text x="{CHART_WIDTH * share:.0f}" y="{HIGH + 15}" text-anchor="{anchor}">'
        f"{low + share * (high - low):g}</text>"
        for share, anchor in ((0, "start"), (0.5, "middle"), (1, "end"))
    )
    return (
        f"<figure><figcaption>{what}; the highest bar is {most}</figcaption>"
        f'<svg viewBox="0 0 {CHART_WIDTH} {HIGH + CHART_FOOT}" role="img" aria-label="{what}">'
        f'{bars}<line x1="0" y1="{HIGH}" x2="{CHART_WIDTH}" y2="{HIGH}" stroke="#222"/>'
        f"{marks}</svg></figure>"
    )
