"""A periodic domain cut open where no sheet passes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from decomp.complex.footprints.domains import Domain
from decomp.complex.plane.planar import Period
from decomp.vectors import Array, Bools

GAPS = 3
ALONG = 48
WIDE = 1e-3
"""A gap wide enough for a cut, as a part of the period."""


@dataclass(frozen=True, eq=False)
class Unrolled(Domain):
    """A domain whose coordinates start at chosen values, so that they need not be periodic.

    Args:
        whole: the periodic domain.
        start: for each coordinate where it starts, None if it is left as it is.
    """

    whole: Domain
    start: tuple[float | None, float | None]

    @property
    def period(self) -> Period:
        one, two = (
            period if start is None else None
            for period, start in zip(self.whole.period, self.start, strict=True)
        )
        return (one, two)

    def to_plane(self, feet: Array, toward: Array) -> Array:
        uv = np.array(self.whole.to_plane(feet, toward))
        for k, (period, start) in enumerate(zip(self.whole.period, self.start, strict=True)):
            if start is not None and period is not None:
                uv[:, k] = start + np.mod(uv[:, k] - start, period)
        return uv

    def lift(self, uv: Array) -> tuple[Array, Array]:
        return self.whole.lift(uv)


def unrolled(domain: Domain, uv: Array, passes: Callable[[Array], Bools]) -> Domain:
    """Cut a domain open along lines that no sheet crosses, where there are such.

    Args:
        domain: that may be periodic.
        uv: (k, 2) coordinates of the points that border the sheets.
        passes: tells at which of some coordinates (n, 2) there is a sheet.
    """
    start: list[float | None] = [None, None]
    for k, period in enumerate(domain.period):
        if period is None:
            continue
        other = 1 - k
        span = domain.period[other]
        low, high = float(uv[:, other].min()), float(uv[:, other].max())
        if span is not None:
            high = low + span
        across = low + (high - low) * (np.arange(ALONG) + 0.5) / ALONG
        values = np.sort(np.mod(uv[:, k], period))
        gap = np.append(np.diff(values), values[0] + period - values[-1])
        for i in np.argsort(-gap)[:GAPS]:
            at = float(values[i] + gap[i] / 2)
            line = np.empty((ALONG, 2))
            line[:, k], line[:, other] = at, across
            if gap[i] > WIDE * period and not passes(line).any():
                start[k] = at
                break
    if start == [None, None]:
        return domain
    return Unrolled(domain, (start[0], start[1]))
