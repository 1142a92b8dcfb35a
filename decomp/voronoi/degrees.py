"""The degree of every pair's Voronoi surface in general position."""

from __future__ import annotations

from decomp.errors import InputError
from decomp.voronoi.conic_site import ConicSite
from decomp.voronoi.elimination import squarefree, without_offset
from decomp.voronoi.exact import Vector
from decomp.voronoi.polynomial import D, X, rational
from decomp.voronoi.sites import CarrierSite

GENERAL_DEGREE: dict[tuple[str, str], int] = {
    ("plane", "plane"): 1,
    ("plane", "sphere"): 2,
    ("plane", "cylinder"): 2,
    ("plane", "cone"): 2,
    ("plane", "torus"): 4,
    ("plane", "point"): 2,
    ("plane", "line"): 2,
    ("plane", "circle"): 4,
    ("sphere", "sphere"): 2,
    ("sphere", "cylinder"): 4,
    ("sphere", "cone"): 4,
    ("sphere", "torus"): 4,
    ("sphere", "point"): 2,
    ("sphere", "line"): 4,
    ("sphere", "circle"): 4,
    ("cylinder", "cylinder"): 4,
    ("cylinder", "cone"): 4,
    ("cylinder", "torus"): 8,
    ("cylinder", "point"): 4,
    ("cylinder", "line"): 4,
    ("cylinder", "circle"): 8,
    ("cone", "cone"): 4,
    ("cone", "torus"): 8,
    ("cone", "point"): 4,
    ("cone", "line"): 4,
    ("cone", "circle"): 8,
    ("torus", "torus"): 8,
    ("torus", "point"): 4,
    ("torus", "line"): 8,
    ("torus", "circle"): 8,
    ("point", "point"): 1,
    ("point", "line"): 2,
    ("point", "circle"): 2,
    ("line", "line"): 2,
    ("line", "circle"): 4,
    ("circle", "circle"): 4,
    ("plane", "ellipse"): 8,
    ("sphere", "ellipse"): 12,
    ("cylinder", "ellipse"): 16,
    ("cone", "ellipse"): 16,
    ("torus", "ellipse"): 24,
    ("point", "ellipse"): 6,
    ("line", "ellipse"): 8,
    ("circle", "ellipse"): 12,
    ("plane", "hyperbola"): 8,
    ("sphere", "hyperbola"): 12,
    ("cylinder", "hyperbola"): 16,
    ("cone", "hyperbola"): 16,
    ("torus", "hyperbola"): 24,
    ("point", "hyperbola"): 6,
    ("line", "hyperbola"): 8,
    ("circle", "hyperbola"): 12,
    ("plane", "parabola"): 6,
    ("sphere", "parabola"): 10,
    ("cylinder", "parabola"): 12,
    ("cone", "parabola"): 12,
    ("torus", "parabola"): 20,
    ("point", "parabola"): 5,
    ("line", "parabola"): 6,
    ("circle", "parabola"): 10,
    ("ellipse", "ellipse"): 28,
    ("ellipse", "parabola"): 22,
    ("ellipse", "hyperbola"): 28,
    ("parabola", "parabola"): 17,
    ("parabola", "hyperbola"): 22,
    ("hyperbola", "hyperbola"): 28,
}
"""By the names of the sites: of the even surface, and of the odd one where there is one.

Where both have the degree n, what eliminating all auxiliary variables of the eight equations of
the paper's section 3.1 gives is their product: for two tori 8 + 8 = 16.
"""


def general_degree(one: str, two: str) -> int:
    """The degree for two kinds of sites in either order.

    Raises:
        InputError: no such pair is tabled.
    """
    try:
        return GENERAL_DEGREE.get((one, two)) or GENERAL_DEGREE[two, one]
    except KeyError:
        raise InputError(f"no degree is known for {one} and {two}") from None


def degree_on_line(
    f: CarrierSite | ConicSite,
    g: CarrierSite | ConicSite,
    e: int,
    start: Vector,
    way: Vector,
) -> int:
    """The degree of s_f = e s_g, found by eliminating d on the line start + t way only.

    It is the degree of the squarefree equation if the line is in general position.
    """
    x, y, z = (rational(a) + rational(b) * X for a, b in zip(start, way, strict=True))
    one, two = (site.compose(x, y, z, D) for site in (f.offset(1), g.offset(e)))
    return int(squarefree(without_offset(one, two)).total_degree())
