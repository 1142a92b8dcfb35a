"""Two quadrics whose pencil holds a pair of planes: conics in these planes.

All quadrics Q1 + x Q2 pass through the intersection of Q1 and Q2. If one of these symmetric
4 x 4 matrices has rank 2 with eigenvalues of opposite sign it is a pair of real planes (rank 1:
one plane counted twice, along which the carriers touch), and the intersection is the conics
that Q1 cuts from them. This is so for equal crossing cylinders, and for any two quadrics of
revolution with a common inscribed sphere (Monge). J. Levin, A parametric algorithm for drawing
pictures of solid objects composed of quadric surfaces, Comm. ACM 19 (1976).
"""

from __future__ import annotations

from itertools import combinations
from math import cos, sin

import numpy as np

from decomp.carriers import Carrier, Cone, Cylinder, Plane, Sphere
from decomp.curves.base import Curve
from decomp.curves.crossings import crossings
from decomp.curves.intersect.coaxial import coaxial, common_axis
from decomp.curves.intersect.nappe import on_nappe
from decomp.curves.intersect.planes import plane_cone, plane_cylinder, plane_plane
from decomp.curves.intersect.result import Intersection, PairCurve, Window, points
from decomp.curves.newton import cross_direction
from decomp.vectors import Array, norm

EIGENVALUE_RANK = 1e-11
"""Eigenvalues below this part of the largest count as zero."""

TOUCH = 1e-6
"""Sine of the angle between the carriers below which they touch."""
DOUBLE_PLANE = 1e-9
"""Part of the largest eigenvalue below which the second is zero: two planes are one."""
NO_QUARTIC = 1e-15
"""Coefficients below which a determinant vanishes: all members of the pencil are singular."""
NO_RANGE = 1e-12
"""Singular values below which a direction is in the kernel of both quadrics."""
REAL_ROOT = 1e-4
"""Imaginary part, relative to the root, up to which a multiple root counts as real."""
SINGULAR_STEP = 1e-9
"""Singular values below this part of the largest are left out of a Newton step."""
NO_NORMAL = 1e-9
"""Part of a plane's coefficients below which its normal is zero: it is the plane at infinity."""


def plane_pair(a: Carrier, b: Carrier, window: Window) -> Intersection | None:
    """Conics of the planes in the pencil; None if it holds none."""
    if not all(isinstance(c, Sphere | Cylinder | Cone) for c in (a, b)):
        return None
    if isinstance(a, Cone):
        a, b = b, a
    origin, unit = _scale(a, b, window)
    qa, qb = (_matrix(c, origin, unit) for c in (a, b))
    planes = _planes(qa, qb)
    if planes is None:
        return None
    found: list[PairCurve] = []
    contacts: list[Array] = []
    carriers = [_plane(row, origin, unit) for row in planes]
    real = [p for p in carriers if p is not None]
    for plane in real:
        section = _section(plane, a, window)
        if section is None:
            return None
        contacts += list(section.contacts)
        for one in section.curves:
            parts = on_nappe(one.curve, b, window)
            found += [PairCurve(part, _touches(part, a, b)) for part in parts]
    nodes = _nodes(found, real, a, b, window)
    kept = [
        p
        for p in contacts
        if abs(float(b.signed_distance(p))) <= window.tolerance
        and all(float(norm(p - q)) > window.tolerance for q in nodes)
    ]
    if not _accurate(found, a, b, window):
        return None
    return Intersection(tuple(found), points(_distinct(kept, window)), points(nodes))


def _scale(a: Carrier, b: Carrier, window: Window) -> tuple[Array, float]:
    """An origin and a unit of length that suit both carriers."""
    unit = min(float(getattr(c, "radius", window.radius)) for c in (a, b))
    for c in (a, b):
        if isinstance(c, Sphere):
            return c.centre, unit
        if isinstance(c, Cone):
            return c.apex, unit
    assert isinstance(a, Cylinder)
    assert isinstance(b, Cylinder)
    system = np.stack([a.axis, -b.axis], axis=1)
    s = np.linalg.lstsq(system, b.point - a.point, rcond=None)[0]
    return np.asarray(a.point + s[0] * a.axis), unit


def _matrix(c: Carrier, origin: Array, unit: float) -> Array:
    """Symmetric 4 x 4 matrix of the quadric in the scaled coordinates, of norm 1."""
    if isinstance(c, Sphere):
        part, at, rest = np.eye(3), c.centre, (c.radius / unit) ** 2
    elif isinstance(c, Cylinder):
        part, at = np.eye(3) - np.outer(c.axis, c.axis), c.point
        rest = (c.radius / unit) ** 2
    else:
        assert isinstance(c, Cone)
        part = cos(c.angle) ** 2 * np.eye(3) - np.outer(c.axis, c.axis)
        at, rest = c.apex, 0.0
        assert sin(c.angle) > 0
    at = (at - origin) / unit
    q = np.zeros((4, 4))
    q[:3, :3] = part
    q[:3, 3] = q[3, :3] = -part @ at
    q[3, 3] = at @ part @ at - rest
    return np.asarray(q / np.linalg.norm(q))


def _planes(qa: Array, qb: Array) -> list[Array] | None:
    """Coefficient rows of the plane pair (the same twice for a double plane), or None.

    A member of rank 2 is a double root of det(qa + x qb); the mean of the computed roots that
    belong together is accurate to rounding.
    """
    for x in _members(qa, qb):
        q = qa + x * qb
        values, vectors = np.linalg.eigh(q)
        order = np.argsort(-np.abs(values))
        values, vectors = values[order], vectors[:, order]
        if abs(values[2]) > EIGENVALUE_RANK * abs(values[0]):
            continue
        if abs(values[1]) <= DOUBLE_PLANE * abs(values[0]):
            return [vectors[:, 0]]
        if values[0] * values[1] < 0:
            p = np.sqrt(abs(values[0])) * vectors[:, 0]
            q1 = np.sqrt(abs(values[1])) * vectors[:, 1]
            return _improved(qa, qb, x, p + q1, p - q1, float(np.sign(values[0])))
    return None


def _members(qa: Array, qb: Array) -> list[float]:
    """Candidates x for members of low rank: roots of det(qa + x qb) and means of them.

    The determinant is interpolated on x = tan(t), where it is a trigonometric polynomial.
    """
    t = np.pi * np.arange(8) / 8
    c = np.linalg.det(np.cos(t)[:, None, None] * qa + np.sin(t)[:, None, None] * qb)
    spectrum = np.fft.fft(c) / 8
    poly = spectrum[[-2, -1, 0, 1, 2]]
    found = [-1.0, 1.0]
    if np.abs(poly).max() > NO_QUARTIC:
        roots = np.roots(poly[::-1])
        for k in (1, 2, 3, 4):
            for group in combinations(roots, min(k, len(roots))):
                z = np.mean(group)
                spread = max(abs(w - z) for w in group)
                if abs(z) > 0 and spread < 0.05 and abs(np.log(abs(z))) < 0.05:
                    found.append(float(np.tan(np.angle(z) / 2)))
    else:
        # every member is singular: look at the eigenvalues of the parts
        found += _singular_members(qa, qb)
    return [x for x in found if np.isfinite(x)]


def _singular_members(qa: Array, qb: Array) -> list[float]:
    """Candidates if all members are singular (common apex): the same in the common range."""
    _, s, vt = np.linalg.svd(np.concatenate([qa, qb]))
    basis = vt[s > NO_RANGE].T
    if basis.shape[1] != 3:
        return []
    ra, rb = (basis.T @ q @ basis for q in (qa, qb))
    t = np.pi * np.arange(7) / 7
    c = np.linalg.det(np.cos(t)[:, None, None] * ra + np.sin(t)[:, None, None] * rb)
    # homogeneous cubic in (cos, sin): fit its four coefficients
    v = np.stack([np.cos(t) ** (3 - k) * np.sin(t) ** k for k in range(4)], axis=1)
    poly = np.linalg.lstsq(v, c, rcond=None)[0]
    roots = np.roots(poly[::-1])
    found = [float(z.real) for z in roots if abs(z.imag) < REAL_ROOT * (1 + abs(z))]
    return found + [float((p + q).real / 2) for p, q in combinations(roots, 2)]


def _improved(qa: Array, qb: Array, x: float, p: Array, q: Array, sign: float) -> list[Array]:
    """Gauss-Newton on qa + x qb = sign (p q^T + q p^T)/2, which removes the rounding of x."""
    upper = np.triu_indices(4)
    for _ in range(3):
        rest = (qa + x * qb - sign * (np.outer(p, q) + np.outer(q, p)) / 2)[upper]
        columns = [qb[upper]]
        for i in range(4):
            e = np.eye(4)[i]
            columns.append(-sign * ((np.outer(e, q) + np.outer(q, e)) / 2)[upper])
        for i in range(4):
            e = np.eye(4)[i]
            columns.append(-sign * ((np.outer(e, p) + np.outer(p, e)) / 2)[upper])
        step = np.linalg.lstsq(np.stack(columns, axis=1), -rest, rcond=SINGULAR_STEP)[0]
        x, p, q = x + step[0], p + step[1:5], q + step[5:]
    return [p, q]


def _plane(row: Array, origin: Array, unit: float) -> Plane | None:
    """The plane row . (p, 1) = 0 of the scaled coordinates; None for the one at infinity."""
    size = float(norm(row[:3]))
    if size <= NO_NORMAL * float(norm(row)):
        return None
    n = row[:3] / size
    return Plane(origin - row[3] / size * unit * n, n)


def _section(plane: Plane, a: Carrier, window: Window) -> Intersection | None:
    if isinstance(a, Cylinder):
        return plane_cylinder(plane, a, window)
    if isinstance(a, Cone):
        return plane_cone(plane, a, window)
    axis = common_axis(plane, a, window)
    assert axis is not None
    return coaxial(plane, a, axis[0], axis[1], window)


def _touches(curve: Curve, a: Carrier, b: Carrier) -> bool:
    """Whether the carriers' normals are parallel all along the curve."""
    low, high = curve.domain
    p = curve.point(low + (high - low) * (np.arange(9) + 0.5) / 9)
    return bool(cross_direction(a, b, p)[1].max() < TOUCH)


def _nodes(
    found: list[PairCurve], planes: list[Plane], a: Carrier, b: Carrier, window: Window
) -> list[Array]:
    """Where conics of the two planes meet: on the planes' common line; and a shared apex."""
    rows: list[Array] = []
    if len(planes) == 2 and found:
        for one in plane_plane(planes[0], planes[1], window).curves:
            hit = crossings(one.curve, a, window.tolerance)
            rows += list(one.curve.point(hit.parameters))
    rows += [c.apex for c in (a, b) if isinstance(c, Cone)]
    on = [
        p
        for p in rows
        if all(abs(float(c.signed_distance(p))) <= window.tolerance for c in (a, b))
        and any(_near(one.curve, p, window) for one in found)
    ]
    return _distinct(on, window)


def _near(curve: Curve, p: Array, window: Window) -> bool:
    gap = float(norm(curve.point(curve.parameter(p)) - p))
    return gap <= window.tolerance


def _distinct(rows: list[Array], window: Window) -> list[Array]:
    kept: list[Array] = []
    for p in rows:
        if all(float(norm(p - q)) > window.tolerance for q in kept):
            kept.append(p)
    return kept


def _accurate(found: list[PairCurve], a: Carrier, b: Carrier, window: Window) -> bool:
    """Whether the conics are on both carriers to rounding."""
    for one in found:
        p = one.curve.point(np.linspace(*one.curve.domain, 9))
        gap = max(float(np.abs(c.signed_distance(p)).max()) for c in (a, b))
        if gap > 5 * window.exact:
            return False
    return True
