"""A skeleton's contents as JSON: everything but the triangles.

Areas, lengths and radii are in the model's units, those of the certificate relative to its
diagonal. Sheets and seams are numbered through all regions. Of a model far from the origin
`equations_from` is the point from which the equations count x, y and z; all else is the model's.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from decomp.skeletons.files.elements import first_seams, first_sheets
from decomp.skeletons.files.labels import site_labels
from decomp.skeletons.files.surfaces import surface_values
from decomp.skeletons.model import Reflexive, RegionSkeleton, Skeleton


def encoded(skeleton: Skeleton) -> bytes:
    """The text of a file."""
    return (json.dumps(contents(skeleton), indent=1, ensure_ascii=False) + "\n").encode()


def contents(skeleton: Skeleton) -> dict[str, Any]:
    """The values."""
    labels = site_labels(skeleton.sites)
    numbers = zip(skeleton.regions, first_sheets(skeleton), first_seams(skeleton), strict=True)
    return {
        "model": skeleton.name,
        "diagonal": skeleton.diagonal,
        **counted_from(skeleton),
        "regions": [
            _region(skeleton, region, labels, first_sheet, first_seam)
            for region, first_sheet, first_seam in numbers
        ],
    }


def counted_from(skeleton: Skeleton) -> dict[str, Any]:
    """Where the equations' x, y and z are counted from, if that is not the model's own origin."""
    offset = skeleton.offset
    return {"equations_from": offset.tolist()} if offset.any() else {}


def _region(
    skeleton: Skeleton,
    region: RegionSkeleton,
    labels: tuple[str, ...],
    first_sheet: int,
    first_seam: int,
) -> dict[str, Any]:
    def named(sites: tuple[int, ...]) -> list[str]:
        return [labels[site] for site in sites]

    return {
        "name": region.name,
        "method": region.method.value,
        "cause": region.cause,
        "sheets": [
            {
                "id": first_sheet + k,
                "sites": named(sheet.sites),
                "parity": None if sheet.parity is None else sheet.parity.value,
                "area": sheet.area,
                "radius": list(sheet.radius),
                "surface": surface_values(skeleton, region, sheet),
            }
            for k, sheet in enumerate(region.sheets)
        ],
        "seams": [
            {
                "id": first_seam + k,
                "sites": named(seam.sites),
                "sheets": [first_sheet + sheet for sheet in seam.sheets],
                "length": seam.length,
                "closed": seam.closed,
            }
            for k, seam in enumerate(region.seams)
        ],
        "junctions": [
            {
                "point": skeleton.complex.points[junction.vertex].tolist(),
                "radius": junction.radius,
                "sites": named(junction.sites),
            }
            for junction in region.junctions
        ],
        "reflexive": [_reflexive(skeleton, locus, labels) for locus in region.reflexive],
        "cells": [
            {"name": cell.name, "faces": list(cell.faces), "volume": cell.volume}
            for cell in region.cells
        ],
        "certificate": asdict(region.certificate),
    }


def _reflexive(skeleton: Skeleton, locus: Reflexive, labels: tuple[str, ...]) -> dict[str, Any]:
    common = {"site": labels[locus.site], "dimension": locus.dimension}
    if locus.dimension == 1:
        return {**common, "length": locus.length}
    return {**common, "point": skeleton.complex.points[locus.vertex].tolist()}
