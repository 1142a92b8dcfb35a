"""What surface each sheet of a skeleton lies on: kind, degree, equation, canonical parameters."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property

import numpy as np

from decomp.boundary.topology import RegionBoundary
from decomp.complex.model import Complex
from decomp.parity import Parity
from decomp.sites.site import Site, SiteKind
from decomp.skeletons.model import RegionSkeleton, Sheet, Skeleton
from decomp.tolerance import TOLERANCE
from decomp.vectors import Array, Bools, norm
from decomp.voronoi import (
    CarrierSite,
    ConeSite,
    CurveSite,
    Kind,
    Polynomial,
    Shape,
    SphereSite,
    VoronoiSite,
    VoronoiSurface,
    site_of,
    surface,
)
from decomp.voronoi.canonical import equation_of
from decomp.voronoi.shape import shape

EXACT = 1e-10
"""Vertices lie on canonical equations to this part of the size, or the equation is another."""


@dataclass(frozen=True, eq=False)
class SheetKind:
    """What a sheet lies on.

    Args:
        sites: f and g.
        parity: by the sides on which the sheet lies; even between points and curves.
        shape: kind and canonical parameters, None for a general surface.
        surface: Vor(f, g), None for a curve's sheet with itself, and where none is known.
        also: further surfaces of the sheet: where the nearest point of a cone is its apex it goes
            over smoothly to the Voronoi surface of the apex.
        part_of: what Vor(f, g) is as a whole where the sheet lies on a part of it, such as one
            plane of a pair, which has a shape of its own.
        offset: (3,) about which all these are told: `Skeleton.offset`, 0 near the origin.
    """

    sites: tuple[Site, Site]
    parity: Parity
    shape: Shape | None
    surface: VoronoiSurface | None
    also: tuple[SheetKind, ...] = ()
    part_of: VoronoiSurface | None = None
    offset: Array = field(default_factory=lambda: np.zeros(3))

    @property
    def kind(self) -> Kind:
        """In the field's words."""
        return Kind.GENERAL if self.shape is None else self.shape.kind

    @cached_property
    def polynomial(self) -> Polynomial | None:
        """Its equation, None where none is known."""
        if self.surface is not None and self.part_of is None:
            return self.surface.polynomial
        return None if self.shape is None else equation_of(self.shape)

    @property
    def degree(self) -> int | None:
        """Of its equation, as far as that is known."""
        if self.surface is not None and self.part_of is None:
            return self.surface.degree
        return None if self.polynomial is None else self.polynomial.degree

    def equation(self, digits: int = 9) -> str | None:
        """Its equation in coordinates about `offset`, None where none is known."""
        return None if self.polynomial is None else self.polynomial.decimals(digits)


def sheet_kinds(skeleton: Skeleton, region: RegionSkeleton) -> tuple[SheetKind, ...]:
    """What the sheets of a region lie on, in their order."""
    return tuple(sheet_kind(skeleton, region, sheet) for sheet in region.sheets)


def sheet_kind(skeleton: Skeleton, region: RegionSkeleton, sheet: Sheet) -> SheetKind:
    """What one sheet of a region lies on."""
    if skeleton.local is not skeleton:
        number = next(k for k, each in enumerate(skeleton.regions) if each is region)
        local = skeleton.local
        return _about(sheet_kind(local, local.regions[number], sheet), skeleton.offset)
    boundary, size = region.boundary, skeleton.diagonal
    pair = skeleton.sites[sheet.sites[0]], skeleton.sites[sheet.sites[1]]
    sides = {_side(boundary, site) for site in pair}
    parity = Parity.EVEN if len(sides) == 1 else Parity.ODD
    if not all(_in_algebra(boundary, site) for site in pair):
        return SheetKind(pair, parity, None, None)
    one, two = (voronoi_site(boundary, site) for site in pair)
    if _alike(one, two, size):
        used = np.unique(skeleton.complex.patches[sheet.patch].triangles)
        return SheetKind(pair, parity, _plane_through(skeleton.complex.points[used], size), None)
    pieces = []
    pairs = _pieces(one, two, skeleton.complex, sheet.patch)
    for f, g in pairs:
        found = surface(f, g, parity, size=size, exists=True)
        if len(pairs) == 1 and _off(found, skeleton.complex, sheet.patch) > EXACT * size:
            # the sites may be in a special position to the tolerance only, not exactly
            strict = surface(f, g, parity, size=size * EXACT, exists=True)
            better = _off(strict, skeleton.complex, sheet.patch) <= EXACT * size
            found = strict if better else found
        pieces.append(_named(pair, parity, found, skeleton.complex, sheet.patch))
    return replace(pieces[0], also=tuple(pieces[1:]))


def _about(kind: SheetKind, offset: Array) -> SheetKind:
    also = tuple(replace(each, offset=offset) for each in kind.also)
    return replace(kind, also=also, offset=offset)


def _named(
    pair: tuple[Site, Site], parity: Parity, found: VoronoiSurface, mesh: Complex, patch: int
) -> SheetKind:
    """A sheet's surface, or the part of it (one of two planes) that holds all its vertices."""
    if found.shape is not None and found.shape.parts:
        p = mesh.points[np.unique(mesh.patches[patch].triangles)]
        gaps = [float(part.deviation(p).max()) for part in found.shape.parts]
        if min(gaps) <= TOLERANCE * found.size:
            part = found.shape.parts[int(np.argmin(gaps))]
            return SheetKind(pair, parity, part, found, part_of=found)
    return SheetKind(pair, parity, found.shape, found)


def _off(found: VoronoiSurface, mesh: Complex, patch: int) -> float:
    """Largest distance of a sheet's vertices from the canonical equation, 0 without one."""
    if found.shape is None:
        return 0.0
    return float(found.shape.deviation(mesh.points[mesh.patches[patch].triangles]).max())


def _alike(one: VoronoiSite, two: VoronoiSite, size: float) -> bool:
    """Whether they are one site, or arcs of one curve: the sheet is the curve's with itself."""
    if isinstance(one, CurveSite) and isinstance(two, CurveSite):
        p = one.curve.point(np.linspace(*one.curve.domain, 5))
        return bool(np.all(two.signed_distance(p) <= TOLERANCE * size))
    if type(one) is not type(two) or not isinstance(one, CarrierSite):
        return False
    assert isinstance(two, CarrierSite)
    return one.two_sided == two.two_sided and bool(
        one.carrier.coincides(two.carrier, TOLERANCE * size, size)
    )


def _pieces(
    one: VoronoiSite, two: VoronoiSite, mesh: Complex, patch: int
) -> list[tuple[VoronoiSite, VoronoiSite]]:
    """The pairs of sites, with an apex for its cone where it is nearest, the largest part first."""
    if not (isinstance(one, ConeSite) or isinstance(two, ConeSite)):
        return [(one, two)]
    centres = mesh.points[mesh.patches[patch].triangles].mean(axis=1)
    by_apex = np.stack([_at_apex(site, centres) for site in (one, two)], axis=-1)
    flags, counts = np.unique(by_apex, axis=0, return_counts=True)
    return [
        (_or_apex(one, bool(flags[k, 0])), _or_apex(two, bool(flags[k, 1])))
        for k in np.argsort(-counts, kind="stable")
    ]


def _at_apex(site: VoronoiSite, points: Array) -> Bools:
    """Whether the apex of a cone is its nearest point."""
    if not isinstance(site, ConeSite):
        return np.zeros(len(points), dtype=bool)
    return np.asarray(norm(site.foot(points) - site.carrier.apex) == 0)


def _or_apex(site: VoronoiSite, apex: bool) -> VoronoiSite:
    return SphereSite(site.apex, Fraction(0)) if apex and isinstance(site, ConeSite) else site


def voronoi_site(boundary: RegionBoundary, site: Site) -> VoronoiSite:
    """A boundary's site as a site of Voronoi surfaces: whole carriers, lines and circles."""
    if site.kind is SiteKind.FACE:
        return site_of(boundary.carriers[boundary.faces[site.index].carrier])
    if site.kind is SiteKind.EDGE:
        return site_of(boundary.edges[site.index].curve)
    return site_of(boundary.vertices[site.index].point)


def _in_algebra(boundary: RegionBoundary, site: Site) -> bool:
    """Whether Voronoi surfaces of a site are known; of others sheets are known by their sites."""
    face = site.kind is SiteKind.FACE
    return not face or boundary.carriers[boundary.faces[site.index].carrier].traceable


def _side(boundary: RegionBoundary, site: Site) -> int:
    """+1 where the region lies outside the site: always for edges and vertices."""
    return -boundary.faces[site.index].outward if site.kind is SiteKind.FACE else 1


def _plane_through(points: Array, size: float) -> Shape | None:
    """The plane of a sheet that an edge has with itself, its plane of symmetry."""
    middle = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - middle, full_matrices=False)
    if float(np.abs((points - middle) @ axes[2]).max()) > TOLERANCE * size:
        return None
    return shape(Kind.PLANE, middle, axes[2])
