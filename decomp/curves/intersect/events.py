"""Places where the zeros v(u) of F begin, end, meet or leave the chart."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from decomp.carriers import Carrier
from decomp.curves.intersect.charts import Chart
from decomp.curves.intersect.isolines import DOUBLE, SAME_ISOLINE, fold_candidates, zeros
from decomp.curves.intersect.pulled import Pulled
from decomp.curves.intersect.result import Window
from decomp.curves.polynomial import polynomial_roots
from decomp.errors import ContactError
from decomp.tolerance import TINY
from decomp.vectors import Array, norm

AT_BORDER = 1e-9
"""Roots are on the unit circle if their logarithm is smaller; halves of double ones are not."""
ALONG_BORDER = 1e-6
"""Newton steps along the border that are longer (radians) are not taken."""
LEVEL_BRANCH = 1e-9
"""Slope against the border below which a branch runs along it."""
STEPS_SETTLED = 1e-14
"""Steps in u and v below which Newton's method has come to rest."""
NEARLY, ROUGHLY = 1e-9, 1e-3
"""Its last steps in u and v may be so long where F_u = F_v = 0, and where F = F_v = 0."""
HIGHER_ORDER = 1e-7
"""Part of the larger curvature below which the smaller one is zero."""
GAP_KNOWN = 1e-15
"""Carriers that touch are apart by this part of the size at least, as far as is known."""
SAME_POINT = 1e-7
"""Folds nearer to a node than this part of the radius are of it."""
SAME_FOLD = 1e-10
"""Folds nearer to each other than this part of the radius are one."""


class Kind(Enum):
    """What happens at an event."""

    CUT = "the chart is cut there; nothing happens"
    FOLD = "two zeros meet and vanish"
    NODE = "two branches cross"
    SPLIT = "a branch meets an isoline that lies on the other carrier"
    LOW = "a zero passes v = low"
    HIGH = "a zero passes v = high"


@dataclass(frozen=True, eq=False)
class Event:
    """An event at (u, v).

    Attributes:
        rising: fold: it opens towards greater u; low or high: v grows with u there.
        singular: a curve that ends there has no tangent from the carriers' normals.
        zone: angle about u within which rounding (or a gap below the tolerance) hides what
            happens.
    """

    kind: Kind
    u: float
    v: float
    point: Array
    rising: bool = False
    singular: bool = False
    zone: float = 0.0


NEWTON_ROOM = 0.3
"""How far Newton's method may lead away from an approximate event."""


FLAT_FOLD = 1e-5
"""Second derivative of F (whose coefficients are of size 1) that counts as zero at a fold."""


SINGULAR_SLOPE = 1e-7
"""First derivative of F that counts as zero at a fold: a singular point that is not simple."""


class UnresolvedError(Exception):
    """The chart's cuts happen to touch the intersection: choose others."""


def exits(f: Pulled, chart: Chart, apex: bool) -> list[Event]:
    """Zeros on the chart's two borders; on tube circles only v = low is looked at.

    `apex`: v = low is a cone's apex.
    """
    found = []
    borders = [(chart.low, Kind.LOW)] + ([] if chart.round else [(chart.high, Kind.HIGH)])
    for v, kind in borders:
        w = np.exp(1j * v) if chart.round else v
        border = f.c @ (w ** np.arange(f.n + 1))
        z = polynomial_roots(border)
        z = z[np.abs(z) > 0]
        off = np.abs(np.log(np.abs(z)))
        if apex and kind is Kind.LOW:
            double = _doubles(np.angle(z[off < DOUBLE]))
            found += [_cusp(chart, u) for u in double]
            other = [
                not any(abs(np.sin((u - w) / 2)) < SAME_ISOLINE for w in double)
                for u in np.angle(z)
            ]
            z, off = z[other], off[other]
        if np.any((off > AT_BORDER) & (off < DOUBLE)):
            raise UnresolvedError
        for u in np.angle(z[off <= AT_BORDER]):
            u = float(u)
            for _ in range(3):
                value, slope = (float(d) for d in f.derivatives(np.array(u), np.array(v))[:2])
                u -= value / slope if abs(value) < ALONG_BORDER * abs(slope) else 0.0
            d = f.derivatives(np.array(u), np.array(v))
            if abs(float(d[2])) < LEVEL_BRANCH * (abs(float(d[1])) + TINY):
                raise UnresolvedError
            rising = float(d[1]) * float(d[2]) < 0
            p = chart.point(np.array(u), np.array(v))
            singular = apex and kind is Kind.LOW
            found.append(Event(kind, u % (2 * np.pi), v, p, rising, singular))
    return found


def _doubles(u: Array) -> list[float]:
    """Means of neighbouring angles that differ by rounding errors of a double zero only."""
    means = []
    for i in range(len(u)):
        for j in range(i):
            gap = float(np.angle(np.exp(1j * (u[i] - u[j]))))
            if abs(gap) < DOUBLE:
                means.append(float(u[j]) + gap / 2)
    return means


def _cusp(chart: Chart, u: float) -> Event:
    """The curve touches v = low at a cone's apex: it has a cusp there, and is cut."""
    p = chart.point(np.array(u), np.array(chart.low))
    return Event(Kind.SPLIT, u % (2 * np.pi), chart.low, p, singular=True)


def folds_and_nodes(
    f: Pulled, chart: Chart, a: Carrier, b: Carrier, window: Window
) -> tuple[list[Event], list[Array]]:
    """Folds and nodes as events, and the contact points."""
    candidates = fold_candidates(f, 1e-2)
    events: list[Event] = []
    contacts: list[Array] = []
    for u, v in candidates:
        _singular(f, chart, a, b, (u, v), window, events, contacts)
    marks = [(e.point, e.zone) for e in events] + [(p, 0.0) for p in contacts]
    for u, v in candidates:
        _fold(f, chart, a, b, (u, v), window, events, marks)
    return events, contacts


def _newton(
    f: Pulled, chart: Chart, start: tuple[float, float], critical: bool
) -> tuple[float, float] | None:
    """Solve F_u = F_v = 0 (critical) or F = F_v = 0 near `start`; None if it leads away."""
    u, v = start
    for _ in range(30):
        f0, fu, fv, fuu, fuv, fvv = (float(d) for d in f.derivatives(np.array(u), np.array(v)))
        g0, g1, row = (fu, fv, (fuu, fuv)) if critical else (f0, fv, (fu, fv))
        det = row[0] * fvv - row[1] * fuv
        if det == 0.0:
            return None
        du = -(g0 * fvv - row[1] * g1) / det
        dv = -(row[0] * g1 - fuv * g0) / det
        u, v = u + du, v + dv
        if abs(u - start[0]) > NEWTON_ROOM or abs(v - start[1]) > NEWTON_ROOM:
            return None
        if abs(du) + abs(dv) < STEPS_SETTLED:
            break
    else:
        if abs(du) + abs(dv) > (NEARLY if critical else ROUGHLY):
            return None
    return u, v


def _flat_fold(f: Pulled, u: float, v: float) -> tuple[float, float, bool] | None:
    """Fold where F_vv = 0 as well: F is about alpha u + beta v^3 or alpha u + beta v^4 there.

    With v^3 the zero passes through (None). With v^4, as symmetry brings about, it is a fold.
    """
    third, fourth = (f.along(u, v, k) for k in (3, 4))
    if abs(third) > 0.1 * abs(fourth):
        return None
    for _ in range(3):
        v -= f.along(u, v, 3) / f.along(u, v, 4)
        value, slope = (float(d) for d in f.derivatives(np.array(u), np.array(v))[:2])
        u -= value / slope
    value, slope = (float(d) for d in f.derivatives(np.array(u), np.array(v))[:2])
    return u, v, f.along(u, v, 4) * slope < 0


def _singular(
    f: Pulled,
    chart: Chart,
    a: Carrier,
    b: Carrier,
    start: tuple[float, float],
    window: Window,
    events: list[Event],
    contacts: list[Array],
) -> None:
    """Add a node or contact if F has a critical point within tolerance of zero near `start`."""
    place = _newton(f, chart, start, critical=True)
    if place is None or not _within(chart, place[1]):
        return
    u, v = _wrapped(chart, *place)
    p = chart.point(np.array(u), np.array(v))
    gap = abs(float(b.signed_distance(p)))
    if gap > window.tolerance:
        return
    if any(float(norm(p - q)) <= window.tolerance for q in contacts) or any(
        float(norm(p - e.point)) <= window.tolerance for e in events if e.kind is Kind.NODE
    ):
        return
    hu, hv = chart.metric(u, v)
    _, _, _, fuu, fuv, fvv = (float(d) for d in f.derivatives(np.array(u), np.array(v)))
    hessian = np.array([[fuu / hu**2, fuv / hu / hv], [fuv / hu / hv, fvv / hv**2]])
    least, most = sorted(np.linalg.eigvalsh(hessian), key=abs)
    if abs(least) <= HIGHER_ORDER * abs(most):
        raise _higher_order(a, b, p)
    if least * most > 0:
        contacts.append(p)
        return
    size = window.radius
    zone = 10 * float(np.sqrt(max(gap, GAP_KNOWN * size) * size * abs(most / least)))
    events.append(Event(Kind.NODE, u, v, p, zone=zone / hu))


def _higher_order(a: Carrier, b: Carrier, p: Array) -> ContactError:
    place = ", ".join(f"{c:.6g}" for c in p)
    return ContactError(f"{a.kind} and {b.kind} touch to a higher order at ({place})")


def _fold(
    f: Pulled,
    chart: Chart,
    a: Carrier,
    b: Carrier,
    start: tuple[float, float],
    window: Window,
    events: list[Event],
    marks: list[tuple[Array, float]],
) -> None:
    """Add the fold near `start`, unless it belongs to a node or contact."""
    place = _newton(f, chart, start, critical=False)
    if place is None or not _within(chart, place[1]):
        return
    u, v = _wrapped(chart, *place)
    _, fu, _, _, _, fvv = (float(d) for d in f.derivatives(np.array(u), np.array(v)))
    rising = fvv * fu < 0
    flat = abs(fvv) < FLAT_FOLD
    p = chart.point(np.array(u), np.array(v))
    hu, _ = chart.metric(u, v)
    near = 10 * float(np.sqrt(2 * window.tolerance * window.radius))
    for q, zone in marks:
        gap = float(norm(p - q))
        if gap <= max(zone * hu, SAME_POINT * window.radius) or (zone == 0.0 and gap <= near):
            return
    if abs(fu) < SINGULAR_SLOPE:
        raise _higher_order(a, b, p)
    if flat:
        better = _flat_fold(f, u, v)
        if better is None:
            return
        u, v, rising = better
        p = chart.point(np.array(u), np.array(v))
    for e in events:
        if e.kind is Kind.FOLD and float(norm(p - e.point)) <= SAME_FOLD * window.radius:
            return
    events.append(Event(Kind.FOLD, u, v, p, rising=rising))


def _within(chart: Chart, v: float) -> bool:
    return chart.round or chart.low <= v <= chart.high


def _wrapped(chart: Chart, u: float, v: float) -> tuple[float, float]:
    turn = 2 * np.pi
    return u % turn, chart.low + (v - chart.low) % turn if chart.round else v


def on_isoline(f: Pulled, chart: Chart, u: float) -> list[Event]:
    """Points where the rest of the intersection meets the isoline u (already divided out)."""
    found = zeros(f, np.array([u]), chart.low, chart.high)[0]
    return [
        Event(Kind.SPLIT, u % (2 * np.pi), float(v), chart.point(np.array(u), np.array(float(v))))
        for v in found
    ]
