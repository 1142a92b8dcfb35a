"""The certificate of a skeleton: every figure measured, and what it has to be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np

from decomp.complex.model import Complex
from decomp.complex.refining.errors_of import chord_error, flipped
from decomp.errors import GeometryError
from decomp.places import place
from decomp.sites.site import Site
from decomp.skeletons.cells.surface import side_triangles
from decomp.skeletons.certificate.coverage import coverage
from decomp.skeletons.certificate.evidence import Evidence, Worst
from decomp.skeletons.certificate.placement import intrusion, residual
from decomp.skeletons.certificate.shortcoming import Shortcoming
from decomp.skeletons.certificate.topology import euler, open_cells, volume_error
from decomp.skeletons.model import Certificate

BALLS = 20_000
"""How many maximal balls look for what the skeleton misses."""

RESIDUAL, INTRUSION, VOLUME = 1e-12, 1e-9, 1e-3
"""The most that is allowed, lengths relative to the model's diagonal."""


@dataclass(frozen=True, eq=False)
class Certified:
    """A certificate, and where its figures are attained, by the figures' names."""

    certificate: Certificate
    where: Mapping[str, Worst]


def certified(evidence: Evidence, balls: int = BALLS, seed: int = 0) -> Certified:
    """Measure a region's skeleton.

    Args:
        evidence: the skeleton.
        balls: how many maximal balls have to end on it.
        seed: of the random points from which they start.

    Raises:
        GeometryError: a ball does not come to rest, or a vertex is not finite.
    """
    if not np.isfinite(evidence.complex.points).all():
        raise GeometryError(
            f"the skeleton of region {evidence.boundary.name} has a point at no place"
        )
    own = region_complex(evidence)
    where = {
        "residual": residual(evidence),
        "open_cells": open_cells(evidence),
        "intrusion": intrusion(evidence),
        "coverage": coverage(evidence, balls, seed),
    }
    certificate = Certificate(
        residual=where["residual"].value,
        chord_error=float(chord_error(own)) / evidence.diagonal,
        flipped=int(flipped(own)),
        open_cells=int(where["open_cells"].value),
        volume_error=volume_error(evidence),
        euler=euler(evidence),
        expected_euler=evidence.boundary.euler,
        intrusion=where["intrusion"].value,
        coverage=where["coverage"].value,
    )
    return Certified(certificate, where)


def limits(tolerance: float, volume: float = VOLUME) -> dict[str, float]:
    """The most that each figure may be, with a chord tolerance relative to the diagonal."""
    return {
        "residual": RESIDUAL,
        "chord_error": tolerance,
        "flipped": 0,
        "open_cells": 0,
        "volume_error": volume,
        "intrusion": INTRUSION,
        "coverage": 2 * tolerance,
    }


def shortcomings(
    certificate: Certificate, tolerance: float, volume: float = VOLUME
) -> tuple[str, ...]:
    """The names of the figures that are not what they have to be.

    Args:
        certificate: with the figures.
        tolerance: of chords, relative to the model's diagonal.
        volume: how far the sum of the cells' volumes may be off, relative to the region's.
    """
    # written so that a figure that is no number fails
    short = [
        name
        for name, most in limits(tolerance, volume).items()
        if not getattr(certificate, name) <= most
    ]
    if certificate.euler != certificate.expected_euler:
        short.append("euler")
    order = [field.name for field in fields(Certificate)]
    return tuple(sorted(short, key=order.index))


def explained(
    found: Certified, tolerance: float, sites: Sequence[Site], volume: float = VOLUME
) -> list[Shortcoming]:
    """Each figure that is not what it has to be: its value, the limit, the place."""
    most = limits(tolerance, volume) | {"euler": found.certificate.expected_euler}
    lines = []
    for name in shortcomings(found.certificate, tolerance, volume):
        line = f"{name} is {getattr(found.certificate, name):.3g}, allowed {most[name]:.3g}"
        worst = found.where.get(name)
        if worst is not None and worst.point is not None:
            names = tuple(sites[k].name for k in worst.sites)
            of = f" of {' and '.join(names)}" if names else ""
            lines.append(Shortcoming(f"{line}, at {place(worst.point)}{of}", worst.point, names))
        else:
            lines.append(Shortcoming(line))
    return lines


def region_complex(evidence: Evidence) -> Complex:
    """The patches and lines of one region alone, over the same points."""
    sides = {side for cell in evidence.face_cells for side in cell.sides}
    patches = sorted({patch for patch, _ in sides} | {sheet.patch for sheet in evidence.sheets})
    held = np.zeros(len(evidence.complex.points), dtype=np.bool_)
    held[side_triangles(evidence.complex, [(patch, 1) for patch in patches])] = True
    curves = {locus.line for locus in evidence.reflexive}
    lines = [
        line
        for number, line in enumerate(evidence.complex.lines)
        if number in curves or held[line.vertices].all()
    ]
    return Complex(
        evidence.complex.points,
        tuple(evidence.complex.patches[patch] for patch in patches),
        tuple(lines),
    )
