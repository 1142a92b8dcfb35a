"""Tell what the sheets of many models lie on: writes docs/sheets.md.

    python -m benchmarks.sheet_kinds_table SECONDS [NAME ...]

Models are the shared table of solids and the corpus, or some by name, each given so many CPU
seconds. Rows of other models stay as they are. The page is written after every model.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

import decomp
from decomp.errors import DecompError
from decomp.skeletons.model import Skeleton
from decomp.skeletons.sheet_kinds import SheetKind, sheet_kinds
from tests.corpus.files import FILES
from tests.skeletons.computed import at_most, source_of
from tests.solids import SOLIDS

PAGE = Path(__file__).parents[1] / "docs" / "sheets.md"
HEAD = """\
# What the sheets of skeletons lie on

Written by `python -m benchmarks.sheet_kinds_table`; do not edit. For every model its sheets by
kind and degree of the equation (two kinds where a sheet goes over from a cone's side to its apex;
`plane (1) of pair of planes` where the Voronoi surface is a pair and the sheet lies on one plane);
the largest distance of a vertex from the canonical equation of its sheet (kinds that have one) and
the largest difference of its distances from the two sites, both relative to the diagonal; the time
for naming all sheets and finding their degrees, as part of the skeleton's.

| model | sheets | kinds | off equation | off equidistance | naming |
| --- | ---: | --- | ---: | ---: | ---: |
"""


def row(name: str, skeleton: Skeleton, seconds: float) -> str:
    """One line of the table."""
    start = time.process_time()
    kinds = [sheet_kinds(skeleton, region) for region in skeleton.regions]
    words = Counter(_word(kind) for own in kinds for kind in own)
    share = (time.process_time() - start) / seconds
    off, gap = 0.0, 0.0
    for region, own in zip(skeleton.regions, kinds, strict=True):
        for sheet, kind in zip(region.sheets, own, strict=True):
            used = np.unique(skeleton.complex.patches[sheet.patch].triangles)
            p = skeleton.complex.points[used]
            shapes = [piece.shape for piece in (kind, *kind.also)]
            if None not in shapes:
                gaps = [piece.deviation(p) for piece in shapes if piece is not None]
                off = max(off, float(np.min(gaps, axis=0).max()))
            surfaces = [piece.surface for piece in (kind, *kind.also)]
            if None not in surfaces:
                gaps = [np.abs(each.difference(p)) for each in surfaces if each is not None]
                gap = max(gap, float(np.min(gaps, axis=0).max()))
    text = ", ".join(f"{n} {word}" for word, n in words.most_common()) or "none"
    d = skeleton.diagonal
    sheets = sum(words.values())
    return f"| {name} | {sheets} | {text} | {off / d:.1e} | {gap / d:.1e} | {share:.1%} |"


def _word(kind: SheetKind) -> str:
    degree = "" if kind.degree is None else f" ({kind.degree})"
    whole = "" if kind.part_of is None else f" of {kind.part_of.kind.value}"
    return " + ".join([f"{kind.kind.value}{degree}{whole}", *map(_word, kind.also)])


def main(limit: int, names: list[str]) -> None:
    """Compute models and write their rows."""
    decomp.skeleton(SOLIDS["blind hole"].make())  # compiles the kernels
    rows = known_rows()
    for name in names or [*SOLIDS, *FILES]:
        start = time.process_time()
        try:
            with at_most(limit):
                skeleton = decomp.skeleton(source_of(name))
        except (TimeoutError, DecompError) as error:
            print(f"{name}: {str(error) or 'out of time'}", flush=True)
            continue
        rows[name] = row(name, skeleton, time.process_time() - start)
        print(rows[name], flush=True)
        order = [n for n in (*SOLIDS, *FILES) if n in rows]
        lines = "\n".join(rows[n] for n in order)
        PAGE.write_text(f"{HEAD}{lines}\n\n{sums(rows)}", encoding="utf-8")


def known_rows() -> dict[str, str]:
    """The rows of the page as it is, by model."""
    if not PAGE.exists():
        return {}
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    rows = [line for line in lines if line.startswith("| ") and " | " in line][2:]
    return {line.split(" | ")[0][2:]: line for line in rows}


def sums(rows: dict[str, str]) -> str:
    """How many sheets of each kind there are in all rows."""
    total: Counter[str] = Counter()
    for line in rows.values():
        for part in line.split(" | ")[2].split(", "):
            number, _, word = part.partition(" ")
            if word:
                total[word] += int(number)
    listed = "\n".join(f"- {n} {word}" for word, n in total.most_common())
    return f"All together, in {len(rows)} models:\n\n{listed}\n"


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2:])
