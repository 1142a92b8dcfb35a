"""Parts of a curve that are on one nappe of a cone."""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier, Cone
from decomp.curves.base import Curve
from decomp.curves.intersect.result import Window
from decomp.curves.line import Line
from decomp.vectors import norm


def on_nappe(curve: Curve, b: Carrier, window: Window) -> list[Curve]:
    """The parts of a conic on b's quadric that are on b itself.

    Only a line can pass from one nappe to the other: it is cut at the apex.
    """
    pieces: list[Curve] = [curve]
    if isinstance(curve, Line) and isinstance(b, Cone):
        t = float(curve.parameter(b.apex))
        low, high = curve.domain
        if float(norm(curve.point(np.array(t)) - b.apex)) <= window.tolerance and low < t < high:
            pieces = [
                Line(curve.origin, curve.direction, domain=ends) for ends in ((low, t), (t, high))
            ]
    kept = []
    for piece in pieces:
        low, high = piece.domain
        p = piece.point(low + (high - low) * (np.arange(9) + 0.5) / 9)
        if np.abs(b.signed_distance(p)).max() <= window.tolerance:
            kept.append(piece)
    return kept
