"""Tell what the sheets of many models lie on: writes docs/sheets.md.

    python -m benchmarks.sheet_kinds_table [SECONDS]

Models are the shared table of solids and the corpus, each given so many CPU seconds (default 20).
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

import decomp
from decomp.errors import DecompError
from decomp.medial.result import Skeleton
from decomp.medial.sheet_kinds import SheetKind, sheet_kinds
from tests.corpus.files import FILES
from tests.skeleton.computed import at_most, source_of
from tests.solids import SOLIDS

PAGE = Path(__file__).parents[1] / "docs" / "sheets.md"
HEAD = """\
# What the sheets of skeletons lie on

Written by `python -m benchmarks.sheet_kinds_table`; do not edit. For every model its sheets by
kind and degree of the equation (two kinds where a sheet goes over from a cone's side to its apex);
the largest distance of a vertex from the canonical equation of its sheet (kinds that have one) and
the largest difference of its distances from the two sites, both relative to the diagonal; the time
for naming all sheets and finding their degrees, as part of the skeleton's.

| model | sheets | kinds | off equation | off equidistance | naming |
| --- | ---: | --- | ---: | ---: | ---: |
"""


def row(name: str, skeleton: Skeleton, seconds: float, total: Counter[str]) -> str:
    """One line of the table."""
    start = time.process_time()
    kinds = [sheet_kinds(skeleton, region) for region in skeleton.regions]
    words = Counter(_word(kind) for own in kinds for kind in own)
    share = (time.process_time() - start) / seconds
    total.update(words)
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
    return " + ".join([f"{kind.kind.value}{degree}", *map(_word, kind.also)])


def main(limit: int) -> None:
    """Compute all models and write the page."""
    decomp.skeleton(SOLIDS["blind hole"].make())  # compiles the kernels
    lines, missing, total = [], [], Counter[str]()
    for name in (*SOLIDS, *FILES):
        start = time.process_time()
        try:
            with at_most(limit):
                skeleton = decomp.skeleton(source_of(name))
        except TimeoutError:
            missing.append(f"{name} (not within {limit} s)")
            continue
        except DecompError as error:
            missing.append(f"{name} ({str(error).splitlines()[0]})")
            continue
        lines.append(row(name, skeleton, time.process_time() - start, total))
        print(lines[-1], flush=True)
    sums = "\n".join(f"- {n} {word}" for word, n in total.most_common())
    text = f"{HEAD}{chr(10).join(lines)}\n\n## All together\n\n{sums}\n"
    if missing:
        text += "\n## Not computed\n\n" + "\n".join(f"- {m}" for m in missing) + "\n"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
