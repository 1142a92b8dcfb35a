"""Vor(f, g): the points that are as far from f as from g."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from decomp.carriers import Carrier
from decomp.curves.base import Curve
from decomp.errors import GeometryError, InputError
from decomp.parity import Parity
from decomp.tolerance import LAST_STEP, TOLERANCE
from decomp.vectors import Array, Bools, dot, norm
from decomp.voronoi.bending import Curvatures, level_curvatures
from decomp.voronoi.conic_site import ConicSite, of_conic
from decomp.voronoi.curve_site import of_curve
from decomp.voronoi.degrees import degree_on_line
from decomp.voronoi.elimination import eliminate
from decomp.voronoi.exact import exact, floats, minus
from decomp.voronoi.existence import degenerate
from decomp.voronoi.kinds import Kind
from decomp.voronoi.polynomial import Polynomial
from decomp.voronoi.recognise import recognise
from decomp.voronoi.shape import Shape
from decomp.voronoi.sites import CarrierSite, ConeSite, SphereSite, VoronoiSite, of_carrier

ALGEBRAIC = (CarrierSite, ConicSite)
"""Sites whose offsets have an equation."""
PROJECTION_STEPS = 40
"""Steps of a projection; it converges quadratically, within about six from close by."""
STEP_HALVINGS = 12
GENERIC_LINE = (
    (Fraction(3, 7), Fraction(-5, 11), Fraction(2, 13)),
    (Fraction(17, 19), Fraction(-23, 29), Fraction(31, 37)),
)
"""A point and a direction without relation to any model."""
NO_SLOPE = 1e-24
"""Square of a gradient below which there is no way to go."""


@dataclass(frozen=True, eq=False)
class VoronoiSurface:
    """The even or odd Voronoi surface of two sites.

    Args:
        f, g: the sites.
        parity: even or odd.
        size: of the model; lengths below `TOLERANCE` times it count as zero.
        shape: canonical parameters, None for a general surface.
        special: shape and polynomial are those of a special position of the sites.
    """

    f: VoronoiSite
    g: VoronoiSite
    parity: Parity
    size: float
    shape: Shape | None
    special: bool
    _known: Polynomial | None

    @property
    def kind(self) -> Kind:
        """What it is."""
        return Kind.GENERAL if self.shape is None else self.shape.kind

    @cached_property
    def polynomial(self) -> Polynomial | None:
        """The implicit polynomial, which vanishes on the surface and perhaps elsewhere.

        None where a special position makes the surface empty, for edge curves whose distance has
        no known equation, and between two conics: it has thousands of terms, and
        `elimination.eliminate` takes a second with short parameters, minutes with floats.
        """
        if self.special:
            return self._known
        if isinstance(self.f, ConicSite) and isinstance(self.g, ConicSite):
            return None
        if isinstance(self.f, ALGEBRAIC) and isinstance(self.g, ALGEBRAIC):
            return eliminate(self.f, self.g, self.parity.sign)
        return None

    @property
    def degree(self) -> int | None:
        """Of the polynomial, between two conics found on a line only; else None."""
        if isinstance(self.f, ConicSite) and isinstance(self.g, ConicSite):
            return degree_on_line(self.f, self.g, self.parity.sign, *GENERIC_LINE)
        return None if self.polynomial is None else self.polynomial.degree

    @property
    def equation(self) -> str | None:
        """The polynomial as text, in the model's coordinates."""
        return None if self.polynomial is None else self.polynomial.text

    @property
    def remark(self) -> str | None:
        """Why no equation is told, None where there is one."""
        if self.polynomial is not None:
            return None
        if self.special:
            return "the surface is empty"
        if isinstance(self.f, ALGEBRAIC) and isinstance(self.g, ALGEBRAIC):
            return f"no equation: of degree {self.degree} between two conics, it is found on demand"
        names = " and ".join(s.name for s in (self.f, self.g) if not isinstance(s, ALGEBRAIC))
        return f"no equation: the distance from an edge ({names}) has none that is known"

    def difference(self, p: Array) -> Array:
        """s_f - e s_g at points (..., 3), e = +1 (even) or -1 (odd): zero on the surface."""
        p = np.asarray(p, dtype=np.float64)
        e = self.parity.sign
        return np.asarray(self.f.signed_distance(p) - e * self.g.signed_distance(p))

    def difference_gradient(self, p: Array) -> Array:
        """Gradients (..., 3) of `difference`."""
        p = np.asarray(p, dtype=np.float64)
        return np.asarray(self.f.gradient(p) - self.parity.sign * self.g.gradient(p))

    def curvatures(self, p: Array) -> Curvatures:
        """Normal, principal curvatures and directions at points (..., 3) of the surface.

        They are those of the surface of points with the same difference if p is not on it.

        Raises:
            GeometryError: the distances change alike: there is no tangent plane.
        """
        p = np.asarray(p, dtype=np.float64)
        hessian = self.f.hessian(p) - self.parity.sign * self.g.hessian(p)
        return level_curvatures(self.difference_gradient(p), hessian, p)

    def contains(self, p: Array) -> Bools:
        """Whether points (..., 3) truly are equidistant with the right parity.

        The polynomial vanishes there, but need not hold a true point where it vanishes.
        """
        return np.asarray(np.abs(self.difference(p)) <= TOLERANCE * self.size)

    def project(self, p: Array) -> Array:
        """Points (..., 3) of the true surface close to p, by Newton's steps along the gradient.

        Raises:
            GeometryError: a point does not reach the surface, as where it is empty.
        """
        q = np.array(p, dtype=np.float64)
        value = self.difference(q)
        for _ in range(PROJECTION_STEPS):
            if float(np.max(np.abs(value), initial=0.0)) <= LAST_STEP * self.size:
                break
            slope = self.difference_gradient(q)
            square = dot(slope, slope)
            steep = square > NO_SLOPE
            step = np.where(steep, value / np.where(steep, square, 1.0), 0.0)
            step = np.clip(step, -self.size, self.size)[..., None] * slope
            # across a reflexive locus the gradient jumps: then a shorter step is taken
            for _ in range(STEP_HALVINGS):
                ahead = self.difference(q - step)
                worse = np.abs(ahead) > np.abs(value)
                if not worse.any():
                    break
                step = np.where(worse[..., None], step / 2, step)
            q, value = q - step, ahead
        lost = ~self.contains(q)
        if lost.any():
            raise GeometryError(
                f"no point of the {self.parity.value} Voronoi surface of {self.f.name} and "
                f"{self.g.name} is found near {{at}}",
                (self.f.name, self.g.name),
                at=np.asarray(p, dtype=np.float64)[lost].reshape(-1, 3)[0],
            )
        return q


def site_of(thing: VoronoiSite | Carrier | Curve | ArrayLike) -> VoronoiSite:
    """The site that a carrier, a curve or a point (3,) is.

    Raises:
        InputError: it is none of these.
    """
    if isinstance(thing, VoronoiSite):
        return thing
    if isinstance(thing, Carrier):
        return of_carrier(thing)
    if isinstance(thing, Curve):
        return of_conic(thing) or of_curve(thing)
    values: Any = thing
    if np.ndim(values) != 1 or len(values) != 3:
        raise InputError(f"a site is a carrier, a curve or a point of three numbers, got {thing!r}")
    return SphereSite(values, exact(0))


def surface(
    f: VoronoiSite | Carrier | Curve | ArrayLike,
    g: VoronoiSite | Carrier | Curve | ArrayLike,
    parity: Parity | str | None = None,
    *,
    size: float | None = None,
    exists: bool = False,
) -> VoronoiSurface:
    """The Voronoi surface of two sites: carriers, curves (lines, circles, edges) or points (3,).

    Args:
        parity: even or odd; None means even. Points and curves have no inside: between two of
            them there is no odd surface, and with a carrier the odd one lies inside it.
        size: the model's, by which lengths and angles are judged to be zero; by default the
            largest of the sites' radii and the distance between them.
        exists: the surface is known to have points, so that it need not be found out whether
            one of no special kind is empty.

    Raises:
        InputError: the sites coincide, or are points or curves both and odd is asked for.
    """
    one, two = site_of(f), site_of(g)
    which = Parity(parity.value if isinstance(parity, Parity) else parity or "even")
    if which is Parity.ODD and not (one.two_sided or two.two_sided):
        raise InputError(f"{one.name} and {two.name} have no inside, so no odd Voronoi surface")
    own = max(one.size, two.size, float(norm(floats(minus(one.reference, two.reference))))) or 1.0
    size = own if size is None else size
    found = None
    if isinstance(one, CarrierSite) and isinstance(two, CarrierSite):
        found = recognise(one, two, which.sign, TOLERANCE * size, TOLERANCE)
    bare = None
    # what is recognised by position holds for whole cones, both nappes together
    doubtful = found is None or any(isinstance(site, ConeSite) for site in (one, two))
    if doubtful and not exists and (one.two_sided or two.two_sided):
        bare = degenerate(one, two, which.sign, TOLERANCE * size, own)
    if found is not None:
        return VoronoiSurface(one, two, which, size, bare or found[0], True, found[1])
    return VoronoiSurface(one, two, which, size, bare, False, None)
