"""Intersection of two carriers by the isolines of one of them.

1. Choose the carrier that gives the isolines: torus before cylinders before cone.
2. Divide out whole isolines that lie on the other carrier.
3. Find all events: folds, nodes, contacts, and passages through the chart's borders.
4. Sample the arcs between events, join them, and bring them onto both carriers.

Events are zeros of polynomials, so no component is missed however small.
"""

from __future__ import annotations

import numpy as np

from decomp.carriers import Carrier, Cone, Torus
from decomp.curves.base import Curve
from decomp.curves.circle import Circle
from decomp.curves.intersect.arcs import network
from decomp.curves.intersect.chains import chains
from decomp.curves.intersect.charts import Chart, Rulings, chart_of
from decomp.curves.intersect.events import (
    Event,
    Kind,
    UnresolvedError,
    exits,
    folds_and_nodes,
    on_isoline,
)
from decomp.curves.intersect.isolines import SAME_ISOLINE
from decomp.curves.intersect.nappe import on_nappe
from decomp.curves.intersect.pulled import Pulled, pulled
from decomp.curves.intersect.result import (
    Intersection,
    PairCurve,
    Window,
    clipped_line,
    inside,
    points,
    ray,
)
from decomp.curves.line import Line
from decomp.curves.polynomial import polynomial_roots
from decomp.curves.traced import TracedCurve
from decomp.errors import ContactError
from decomp.vectors import Array, dot, norm

CHART_TURNS = (0.7345, 1.9213, 0.2817, 2.6431, 1.3579)
"""Angles at which the chart is cut, tried in turn: any generic numbers."""
HELD = 1e-5
"""F vanishes on an isoline if it is below this part of its largest coefficient."""


RANK = {"torus": 0, "cylinder": 1, "elliptic cylinder": 2, "cone": 3}
"""Which of two carriers rather gives the isolines, by kind."""


def general(a: Carrier, b: Carrier, window: Window) -> Intersection:
    """The whole intersection.

    Raises:
        ContactError: it cannot be resolved.
    """
    reason = ContactError(f"{a.kind} and {b.kind} touch in a way that cannot be resolved")
    for chart_carrier, other in _orders(a, b, window):
        for turn in CHART_TURNS:
            try:
                return _resolve(chart_carrier, other, window, turn)
            except UnresolvedError:
                continue
            except ContactError as error:
                reason = error
                break
    raise reason


def _orders(a: Carrier, b: Carrier, window: Window) -> list[tuple[Carrier, Carrier]]:
    """Which carrier gives the isolines: the better choice first."""
    orders = [(c, d) for c, d in ((b, a), (a, b)) if c.kind in RANK]

    def cost(order: tuple[Carrier, Carrier]) -> tuple[bool, int]:
        c, d = order
        bad = isinstance(c, Cone) and abs(float(d.signed_distance(c.apex))) <= window.tolerance
        return bad, RANK[c.kind]

    orders.sort(key=cost)
    return [o for o in orders if not isinstance(o[1], Torus) or isinstance(o[0], Torus)]


def _resolve(a: Carrier, b: Carrier, window: Window, turn: float) -> Intersection:
    """Intersection by the isolines of `a`."""
    chart = chart_of(a, b, window, turn)
    f = pulled(chart, b)
    curves: list[PairCurve] = []
    nodes: list[Array] = []
    events: list[Event] = []
    apex = isinstance(a, Cone) and abs(float(b.signed_distance(a.apex))) <= window.tolerance
    if apex:
        f = f.without_apex()
    for u in _whole_isolines(f, chart, b, window):
        f = f.without(u)
        tangent = _holds(f, u)
        if tangent:
            f = f.without(u)
        curve = _isoline(chart, u, window)
        if curve is not None:
            curves += [PairCurve(part, tangent) for part in on_nappe(curve, b, window)]
        split = on_isoline(f, chart, u)
        events += split
        nodes += [e.point for e in split]
    found, contacts = folds_and_nodes(f, chart, a, b, window)
    nodes += [e.point for e in found if e.kind is Kind.NODE]
    borders = exits(f, chart, apex)
    events += found + borders
    net = network(f, chart, b, events)
    size = window.radius + float(np.abs(window.centre).max())
    with np.errstate(invalid="ignore", divide="ignore"):
        found_curves = chains(net, a, b, size)
        for curve in found_curves:
            _check(curve, window)
    for curve in found_curves:
        if inside(curve, window):
            curves.append(PairCurve(curve))
    if apex:
        tip = chart.point(np.zeros(()), np.zeros(()))
        ends = [one.curve.point(np.array(one.curve.domain)) for one in curves]
        met = any(float(norm(p - tip).min()) <= window.tolerance for p in ends)
        (nodes if met else contacts).append(tip)
    return Intersection(tuple(curves), points(contacts), points(nodes))


def _check(curve: TracedCurve, window: Window) -> None:
    """Make sure that Newton's method has not led astray.

    Raises:
        UnresolvedError: points between the samples are not on both carriers.
    """
    t, chords = (curve.knots[1:] + curve.knots[:-1]) / 2, np.diff(curve.knots)
    p = curve.point(t)
    off = np.maximum(*(np.abs(c.signed_distance(p)) for c in (curve.a, curve.b)))
    away = norm(p - (curve.samples[1:] + curve.samples[:-1]) / 2)
    if not np.all((off <= 2 * window.tolerance) & (away <= chords)):  # NaN fails as well
        raise UnresolvedError


def _whole_isolines(f: Pulled, chart: Chart, b: Carrier, window: Window) -> list[float]:
    """Angles u whose isoline lies on the other carrier (or a cone's double) within tolerance."""
    top = int(np.argmax(np.abs(f.c).max(axis=0)))
    column = f.c[:, top]
    k = np.arange(len(column)) - (len(column) - 1) / 2
    # a zero of the largest column, or of its derivative if the zero is double
    angles: list[float] = []
    for coefficients in (k * column, column):
        z = polynomial_roots(coefficients)
        z = z[np.abs(z) > 0]
        angles += [float(u) for u in np.angle(z[np.abs(np.log(np.abs(z))) < 1e-3])]
    v = np.linspace(chart.low, chart.high, 33)
    kept: list[float] = []
    for u in angles:
        if not _holds(f, u):
            continue
        gap = np.abs(b.signed_distance(chart.point(np.full(33, u), v)))
        if (gap.min() if isinstance(b, Cone) else gap.max()) > window.tolerance:
            continue
        if all(abs(np.sin((u - w) / 2)) > SAME_ISOLINE for w in kept):
            kept.append(u)
    return kept


def _holds(f: Pulled, u: float) -> bool:
    """Whether F still vanishes on the isoline u."""
    return bool(np.abs(f.columns(np.array([u]))).max() <= HELD * np.abs(f.c).max())


def _isoline(chart: Chart, u: float, window: Window) -> Curve | None:
    """The isoline as a line or a circle."""
    if isinstance(chart, Rulings):
        p, q = chart.point(np.full(2, u), np.array([0.0, chart.high]))
        d = (q - p) / norm(q - p)
        line: Line | None = ray(p, d, window) if chart.radius == 0.0 else clipped_line(p, d, window)
        return line
    p, q = chart.point(np.full(2, u), np.array([0.0, np.pi]))
    centre, x = (p + q) / 2, (p - q) / norm(p - q)
    torus = chart.torus  # type: ignore[attr-defined]
    return Circle(centre, x - dot(x, torus.axis) * torus.axis, torus.axis, torus.minor)
