"""In which domain the sheets of two sites are drawn: a footprint, or a plane that holds them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree  # type: ignore[import-untyped]

from decomp.carriers.axial import axial_split
from decomp.complex.footprints.domains import Domain, domain_of
from decomp.curves.circle import Circle
from decomp.curves.line import Line
from decomp.errors import GeometryError
from decomp.sites.site import SiteKind
from decomp.skeletons.balls.loci import locus_gap
from decomp.skeletons.curves.incidence import Incidence
from decomp.skeletons.sheets.about_centre import about_centre, lengths_along
from decomp.skeletons.sheets.polar import around_locus
from decomp.skeletons.sheets.sheet_surface import SheetSurface
from decomp.skeletons.sheets.sheet_tests import SheetTests
from decomp.skeletons.sheets.unrolled import unrolled
from decomp.vectors import Array, cross, norm

RANKS = {"plane": 0, "cone": 3, "cylinder": 2, "sphere": 4, "torus": 5}
FLAT = 1e-10
WAYS = 2000
"""Directions from a sphere's centre among which a pole is looked for."""


@dataclass(frozen=True, eq=False)
class Drawing:
    """Where sheets are drawn.

    Args:
        uv: coordinates (k, 2) of the points that border them.
        domain: None for a plane that the sheets are projected to.
        column: of which site the domain is the footprint.
    """

    uv: Array
    domain: Domain | None
    column: int


class SheetDomains:
    """Chooses the domains of one region's sheets."""

    def __init__(self, incidence: Incidence, tests: SheetTests) -> None:
        self._incidence, self._tests = incidence, tests
        self._boundary, self._size = incidence.boundary, incidence.boundary.diagonal
        self._tolerances = incidence.boundary.tolerances

    def drawn(
        self, pair: tuple[int, int], points: Array, feet: Array, surface: SheetSurface
    ) -> Drawing:
        """Draw the sheets of a pair of sites, given points (k, 3) on them and feet (k, 2, 3).

        Sheets between edges and vertices are drawn in their plane if they have one; so are those
        whose feet on both sites merge, for there the footprint has too little room.
        """
        flat = self._flat(pair, points)
        faces = [self._incidence.sites[site].kind is SiteKind.FACE for site in pair]
        if flat is not None and not any(faces):
            return Drawing(flat, None, 0)
        column = self._better(pair, points)
        own, other = pair[column], pair[1 - column]
        around = self._about_centre(own, points, feet[:, column])
        if around is not None:
            return Drawing(around, None, column)
        domain = self._domain(own, points, feet[:, column], surface)
        domain = unrolled(
            domain,
            domain.to_plane(feet[:, column], points),
            lambda at: self._tests.touches(own, other, *domain.lift(at)),
        )
        uv = domain.to_plane(feet[:, column], points)
        domain = around_locus(domain, uv, self._locus_gap(own, points) <= self._tolerances.on_locus)
        uv = domain.to_plane(feet[:, column], points)
        if not self.merged(uv) and not self._hidden(pair[column], points, feet[:, column]):
            return Drawing(uv, domain, column)
        if flat is not None:
            return Drawing(flat, None, 0)
        return self.beside(pair, points, feet) or Drawing(uv, domain, column)

    def others(self, pair: tuple[int, int], points: Array, feet: Array) -> list[Drawing]:
        """Drawings for sheets whose footprint is too uneven: beside an edge, or seen from afar."""
        _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
        seen = Drawing(points @ axes[:2].T, None, 0)
        beside = self.beside(pair, points, feet)
        return [seen] if beside is None else [beside, seen]

    def beside(self, pair: tuple[int, int], points: Array, feet: Array) -> Drawing | None:
        """A drawing by lengths along an edge and distances from it, None if that merges points.

        So sheets can be drawn of which a whole line has one foot and one direction from it: below a
        vertex at which two reentrant edges of one round face meet.
        """
        column = self._better(pair, points)
        for k in (column, 1 - column):
            uv = self._along_and_away(pair[k], points, feet[:, k])
            if uv is not None and not self.merged(uv):
                return Drawing(uv, None, k)
        return None

    def _about_centre(self, site: int, points: Array, feet: Array) -> Array | None:
        """A drawing about the centre of a ball on whose face an edge lies, None without one."""
        it = self._incidence.sites[site]
        if it.kind is not SiteKind.EDGE:
            return None
        edge = self._boundary.edges[it.index]
        uv = about_centre(self._boundary, edge, points, feet, self._tolerances.on_locus)
        return None if uv is None or self.merged(uv) else uv

    def merged(self, uv: Array) -> bool:
        """Whether points that border sheets have run together in a drawing (k, 2)."""
        return bool(cKDTree(uv).query_pairs(self._tolerances.same))

    def _hidden(self, site: int, points: Array, feet: Array) -> bool:
        """Whether a point on an edge, which no direction tells from it, is a foot of others."""
        if self._incidence.sites[site].kind is not SiteKind.EDGE:
            return False
        on = norm(points - feet) <= self._tolerances.same
        if not on.any() or on.all():
            return False
        gaps = cKDTree(feet[on]).query(feet[~on])[0]
        return bool(gaps.min() <= self._tolerances.same)

    def _along_and_away(self, site: int, points: Array, feet: Array) -> Array | None:
        """Lengths along an open edge and distances from it, as plane coordinates (k, 2)."""
        it = self._incidence.sites[site]
        if it.kind is not SiteKind.EDGE or self._boundary.edges[it.index].closed:
            return None
        along, _ = lengths_along(self._boundary.edges[it.index], feet)
        return np.stack([along, norm(points - feet)], axis=1)

    def _flat(self, pair: tuple[int, int], points: Array) -> Array | None:
        """Plane coordinates of points that all lie in a plane."""
        middle = points.mean(axis=0)
        _, spread, axes = np.linalg.svd(points - middle, full_matrices=False)
        if spread[-1] > FLAT * self._size * np.sqrt(len(points)):
            return None
        return np.asarray((points - middle) @ axes[:2].T)

    def _rank(self, site: int) -> int:
        it = self._incidence.sites[site]
        if it.kind is SiteKind.FACE:
            return RANKS[self._boundary.carriers[self._boundary.faces[it.index].carrier].kind]
        if it.kind is SiteKind.EDGE:
            return 6 if isinstance(self._boundary.edges[it.index].curve, Line) else 7
        return 8

    def _better(self, pair: tuple[int, int], points: Array) -> int:
        """Which site's footprint to use: simple carriers first, none whose locus is reached."""

        def cost(column: int) -> int:
            reached = self._locus_gap(pair[column], points).min() <= self._tolerances.on_locus
            return self._rank(pair[column]) + (10 if reached else 0)

        return min((0, 1), key=cost)

    def _locus_gap(self, site: int, points: Array) -> Array:
        """Distance (k,) of points from a site's reflexive locus, or from a round edge's axis."""
        it = self._incidence.sites[site]
        if it.kind is SiteKind.EDGE:
            curve = self._boundary.edges[it.index].curve
            if isinstance(curve, Circle):
                return axial_split(points, curve.centre, cross(curve.x, curve.y))[1]
        return locus_gap(self._incidence.context, (site,), points)

    def _domain(self, site: int, points: Array, feet: Array, surface: SheetSurface) -> Domain:
        it = self._incidence.sites[site]
        if it.kind is SiteKind.FACE and self._rank(site) == RANKS["sphere"]:
            return domain_of(self._boundary, it, pole=self._pole(site, surface, feet))
        if it.kind is SiteKind.EDGE:
            return domain_of(self._boundary, it, reach=float(np.median(norm(points - feet))))
        return domain_of(self._boundary, it)

    def _pole(self, site: int, surface: SheetSurface, feet: Array) -> Array:
        """A direction from a sphere's centre in which no sheet of the pair lies."""
        face = self._boundary.faces[self._incidence.sites[site].index]
        sphere = self._boundary.carriers[face.carrier]
        centre, radius = sphere.place, sphere.width
        rng = np.random.default_rng(0)
        ways = rng.normal(size=(WAYS, 3))
        ways /= norm(ways)[:, None]
        q = centre + radius * ways
        clear = np.min(norm(q[:, None] - feet[None]), axis=1)
        order = np.argsort(-clear)
        other = surface.sites[1] if surface.sites[0] == site else surface.sites[0]
        ok = ~self._tests.touches(site, other, q[order], -face.outward * sphere.normal(q[order]))
        if not ok.any():
            raise GeometryError("the sheet around the sphere at {at} has no boundary", at=centre)
        return np.asarray(ways[order[int(np.argmax(ok))]])
