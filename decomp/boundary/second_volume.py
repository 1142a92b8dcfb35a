"""The volume once more, from another vector field.

`integrals` uses the field p, under which each face needs its area and vector area. Here it is the
field (p . e) e for one direction e: V is the sum over faces of the integral of (p . e)(n . e). In
the coordinates of `integrals` the integrand is integrated over v in closed form to G(u, v), and
Green's theorem makes the rest - integral of G du along the edges. The two have no term in common,
so a face that is not what its loops bound makes them differ.

A is a carrier's point less the origin; r(u) is the unit vector across the axis k at angle u.

    plane     v across u in the plane; A.e v + (u x.e) v + (y.e) v^2 / 2, times n.e
    cylinder  n.e ((A.e + s.e) v + k.e v^2 / 2), s the point of the section
    cone      sin(angle) n.e (A.e v^2 / 2 + d.e v^3 / 3), d the ruling
    sphere    powers of sin v and cos v, see `Sphere.second_term`
    torus     the same, see `torus_flux`
"""

from __future__ import annotations

import numpy as np

from decomp.boundary.integrals import TorusBorder, Track
from decomp.carriers import Carrier, Torus
from decomp.carriers.base import Border
from decomp.vectors import Array, frame

E = np.array([0.48, 0.6, 0.64])
"""The direction of the field: a unit vector along no axis."""


def second_flux(
    carrier: Carrier, border: Track, origin: Array, pole: Array | None, wholes: int
) -> float:
    """The integral of ((p - origin) . e)(n . e) over a face, n the carrier's normal.

    Args:
        carrier: the face's carrier, no torus.
        border: quadrature along the face's loops, with the face on the left seen along the
            carrier's normal.
        origin: (3,).
        pole: on a sphere with edges, a unit direction away from them.
        wholes: 1 if the pole is inside the face, or the face is the whole sphere.
    """
    term = carrier.second_term(Border(border.points, border.steps), origin, pole, E)
    # over a whole closed carrier each direction has a third of the integral of (p - c) . n
    return term + wholes * carrier.whole[1] / 3 if wholes else term


def torus_flux(torus: Torus, border: TorusBorder, origin: Array, wholes: int) -> float:
    """The same on a torus.

    With n = cos v r + sin v k, a = r.e, b = k.e, m = n.e and K = A.e + R a, the integrand is
    small (K + small m) m (R + small cos v), whose parts integrate over v to

        m        a s - b c                                   s = sin v, c = cos v
        m c      a (v + s c) / 2 + b s^2 / 2
        m^2      a^2 (v + s c) / 2 + a b s^2 + b^2 (v - s c) / 2
        m^2 c    a^2 (s - s^3 / 3) - 2 a b c^3 / 3 + b^2 s^3 / 3

    Args:
        torus, border: the face.
        origin: (3,).
        wholes: how many whole tori are to be added.
    """
    big, small = torus.major, torus.minor
    x, y = frame(torus.axis)
    first, second, b = float(x @ E), float(y @ E), float(torus.axis @ E)
    start = float((torus.centre - origin) @ E)
    u, v = border.around, border.tube
    a, s, c = np.cos(u) * first + np.sin(u) * second, np.sin(v), np.cos(v)
    height = start + big * a
    once, once_cosine = a * s - b * c, a * (v + s * c) / 2 + b * s**2 / 2
    twice = a**2 * (v + s * c) / 2 + a * b * s**2 + b**2 * (v - s * c) / 2
    twice_cosine = a**2 * (s - s**3 / 3) - 2 * a * b * c**3 / 3 + b**2 * s**3 / 3
    inner = height * (big * once + small * once_cosine)
    inner += small * (big * twice + small * twice_cosine)
    flux = wholes * 2 * np.pi**2 * big * small**2 - small * float(inner @ border.steps)

    def along_cut(angle: float) -> float:
        """The integral over u of what stands before v: small^2 (A.e a + 2 R a^2 + R b^2) / 2."""
        sine, cosine = np.sin(angle), np.cos(angle)
        square = (first**2 + second**2) * angle + (first**2 - second**2) * sine * cosine
        square = square / 2 + first * second * sine**2
        line = start * (first * sine - second * cosine)
        return float(small**2 / 2 * (line + 2 * big * square + big * b**2 * angle))

    low, high, turns = border.cut
    return flux - 2 * np.pi * turns * (along_cut(high) - along_cut(low))
