"""Random carriers, and independent ways to find points common to two of them."""

from __future__ import annotations

from math import pi

import numpy as np
from hypothesis import strategies as st

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere, Torus
from decomp.curves import Curve, Intersection, intersect
from decomp.vectors import Array, Bools, frame, norm

ORIGIN = np.zeros(3)
X, Y, Z = np.eye(3)
WINDOW = 3.0
TOLERANCE = 1e-9
KINDS = ("plane", "sphere", "cylinder", "cone", "torus")


def unit(*v: float) -> Array:
    """Unit vector along v."""
    a = np.array(v, dtype=np.float64)
    return np.asarray(a / np.linalg.norm(a))


def meet(a: Carrier, b: Carrier, radius: float = 5.0) -> Intersection:
    """Intersection in a ball about the origin; checks it before it is returned."""
    found = intersect(a, b, ORIGIN, radius, TOLERANCE)
    for one in found.curves:
        on_both(one.curve, a, b, radius)
    for p in (*found.contacts, *found.nodes):
        assert abs(float(a.signed_distance(p))) < TOLERANCE
        assert abs(float(b.signed_distance(p))) < TOLERANCE
    return found


def on_both(curve: Curve, a: Carrier, b: Carrier, size: float, bound: float = 1e-12) -> None:
    """Samples of the curve are on both carriers to 1e-12 of the size."""
    p = curve.point(np.linspace(*curve.domain, 203))
    for c in (a, b):
        assert np.abs(c.signed_distance(p)).max() <= bound * size


def kinds(found: Intersection) -> list[str]:
    """Sorted names of the curves, with a ~ for tangent ones."""
    return sorted(one.curve.kind + "~" * one.tangent for one in found.curves)


def distance_to(found: Intersection, p: Array) -> Array:
    """Distances of points from the nearest curve or contact."""
    gaps = [norm(one.curve.point(one.curve.parameter(p)) - p) for one in found.curves]
    gaps += [norm(p - q) for q in found.contacts]
    return np.min(gaps, axis=0) if gaps else np.full(len(p), np.inf)


def surface(c: Carrier, s: Array, t: Array) -> Array:
    """Points of a carrier at parameters in [0, 1]^2: a chart that is not the package's."""
    a = 2 * pi * s
    if isinstance(c, Plane):
        x, y = frame(c.normal_vector)
        reach = 2 * WINDOW * (s[..., None] - 0.5) * x + 2 * WINDOW * (t[..., None] - 0.5) * y
        return c.foot(ORIGIN) + reach
    if isinstance(c, Sphere):
        z = 2 * t - 1
        r = np.sqrt(1 - z**2)
        return c.centre + c.radius * np.stack([r * np.cos(a), r * np.sin(a), z], axis=-1)
    assert isinstance(c, Cylinder | Cone | Torus)
    x, y = frame(c.axis)
    out = np.cos(a)[..., None] * x + np.sin(a)[..., None] * y
    t = t[..., None]
    if isinstance(c, Cylinder):
        base = c.point - (c.point @ c.axis) * c.axis
        return base + c.radius * out + 2 * WINDOW * (t - 0.5) * c.axis
    if isinstance(c, Cone):
        return c.apex + 5 * t * (np.sin(c.angle) * out + np.cos(c.angle) * c.axis)
    tube = np.cos(2 * pi * t) * out + np.sin(2 * pi * t) * c.axis
    return c.centre + c.major * out + c.minor * tube


def common_points(a: Carrier, b: Carrier, flip: bool, lines: int = 60, cells: int = 150) -> Array:
    """Points of a on b, by bisection along isolines of a."""
    rng = np.random.default_rng(5)
    s, t = np.broadcast_arrays(rng.random(lines)[:, None], np.linspace(0, 1, cells)[None])

    def f(s: Array, t: Array) -> tuple[Array, Array]:
        p = surface(a, t, s) if flip else surface(a, s, t)
        return p, b.signed_distance(p)

    value = f(s, t)[1]
    clear = np.minimum(np.abs(value[:, 1:]), np.abs(value[:, :-1])) > TOLERANCE
    i, j = np.nonzero((value[:, 1:] * value[:, :-1] < 0) & clear)
    low, high, left = t[i, j], t[i, j + 1], value[i, j]
    for _ in range(55):
        middle = (low + high) / 2
        same: Bools = f(s[i, j], middle)[1] * left > 0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    p = f(s[i, j], low)[0]
    return p[norm(p) < 0.999 * WINDOW]


def complete(found: Intersection, a: Carrier, b: Carrier) -> None:
    """Every independently found common point is on some curve."""
    for one, two in ((a, b), (b, a)):
        for flip in (False, True):
            p = common_points(one, two, flip)
            if len(p):
                assert distance_to(found, p).max() < 1e-6


lengths = st.floats(-1.0, 1.0, allow_subnormal=False)
vectors = st.tuples(lengths, lengths, lengths).map(np.array)
directions = vectors.filter(lambda v: np.linalg.norm(v) > 0.1).map(lambda v: unit(*v))


@st.composite
def carriers(draw: st.DrawFn, kind: str) -> Carrier:
    """A carrier of one kind near the origin."""
    p = draw(vectors)
    if kind == "sphere":
        return Sphere(p, draw(st.floats(0.2, 1.5)))
    d = draw(directions)
    if kind == "plane":
        return Plane(p, d)
    if kind == "cylinder":
        return Cylinder(p, d, draw(st.floats(0.1, 1.2)))
    if kind == "cone":
        return Cone(p, d, draw(st.floats(0.1, 1.3)))
    return Torus(p, d, draw(st.floats(0.7, 1.8)), draw(st.floats(0.1, 0.6)))
