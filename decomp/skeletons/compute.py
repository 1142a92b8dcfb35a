"""The skeleton of a model: curves, sheets, one complex, cells and certificate.

1. The boundaries of all regions are triangulated as one conforming complex.
2. For each region all curves of the skeleton are traced (seams, trims, rims, reflexive loci).
3. The curves are sampled; sheets are triangulated between them.
4. The complex is refined to the chord tolerance.
5. Cells are put together, and the certificate is measured. If it falls short, everything is done
   again more finely.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from decomp.arguments import called
from decomp.attempts import Way, first_cause, first_of, stage
from decomp.csg.model import Model
from decomp.csg.solid import Solid
from decomp.errors import GeometryError, InputError
from decomp.geometry import Geometry
from decomp.located import located
from decomp.skeletons.certificate.certificate import VOLUME
from decomp.skeletons.certificate.shortcoming import CertificateError, refusal
from decomp.skeletons.drafts import SAMPLES, SHARE, drafted, traced
from decomp.skeletons.fineness import fine_enough, finer, volume_errors
from decomp.skeletons.model import Skeleton
from decomp.skeletons.moved import moved_skeleton
from decomp.skeletons.sheets.component_votes import MissingCurveError
from decomp.skeletons.whole import Whole
from decomp.tolerance import CHORDS, COARSEST_CHORDS
from decomp.vectors import positive

TRACING = 0.6
"""The part of the whole that tracing is taken for."""
FINENESSES = 7
"""How often the tolerance is made finer for the volume's sake."""
STUCK = 0.02
"""A volume's error that has changed by less than this part of it asks for twice as fine chords."""
COARSE = 3.0
"""Where sheets cannot be drawn or refined triangles count as so many times too coarse, once."""

Progress = Callable[[str, float], None]


def skeleton(
    source: Geometry | Model | Solid | dict[str, Solid] | str | Path,
    tolerance: float = CHORDS,
    progress: Progress | None = None,
) -> Skeleton:
    """The exact interior skeleton of a model.

    Args:
        source: a geometry, or what one can be made of.
        tolerance: largest distance of triangles from their exact surfaces, relative to the
            model's diagonal: above 0 and at most 0.1.
        progress: told what is being done, and which part of the whole (0 to 1) is behind.

    Raises:
        InputError: the tolerance is no number above zero, or larger than a tenth.
        FileError: the file cannot be read.
        GeometryError: the solid, or its skeleton, cannot be computed; says where and what was
            tried.
    """
    tolerance = checked(tolerance, progress)
    geometry = source if isinstance(source, Geometry) else Geometry(source)
    tell = progress or (lambda what, done: None)

    def way(samples: int) -> Way[Skeleton]:
        attempt = _Attempt(geometry.local, tolerance, samples, tell)
        again = (MissingCurveError, CertificateError)
        return Way(f"seams looked for from {samples} boundary points", attempt.result, again)

    with geometry.frame(), located(geometry):
        found = first_of([way(samples) for samples in SAMPLES])
    return moved_skeleton(found, geometry.offset)


def checked(tolerance: object, progress: object) -> float:
    """A skeleton's options as they are given: the tolerance as a number.

    Raises:
        InputError: the tolerance is no number above zero, or larger than a tenth; or the progress
            cannot be called.
    """
    number = positive(tolerance, "tolerance")
    if number > COARSEST_CHORDS:
        raise InputError(f"tolerance must be at most {COARSEST_CHORDS:g}, got {number:g}")
    called(progress, "progress")
    return number


class _Attempt:
    """One try at a skeleton, with seams looked for from `samples` boundary points."""

    def __init__(self, geometry: Geometry, tolerance: float, samples: int, tell: Progress) -> None:
        self._geometry, self._relative, self._samples = geometry, tolerance, samples
        self._tell = tell

    def result(self) -> Skeleton:
        """The skeleton.

        Raises:
            CertificateError: it is not sound; says what is wrong.
            GeometryError: there is none.
        """
        geometry = self._geometry
        curves = traced(
            geometry, self._samples, lambda what, done: self._tell(what, TRACING * done)
        )
        fineness = fine_enough(geometry, self._relative, SHARE)
        refused: list[tuple[str, GeometryError]] = []
        errors = np.full(len(fineness), np.inf)
        for left in reversed(range(FINENESSES)):
            self._tell("triangulating sheets", TRACING)
            try:
                with stage("sheets"):
                    draft = drafted(geometry, curves, fineness * geometry.diagonal)
                self._tell("refining", 0.7)
                with stage("refining"):
                    whole = Whole(geometry, self._relative, fineness, curves, draft)
            except MissingCurveError:
                raise
            except GeometryError as error:
                refused.append((f"chords of {fineness.min():.2g} of the size", error))
                if len(refused) > 1 or not left:
                    raise first_cause(refused) from None
                fineness = finer(fineness, np.full(len(fineness), COARSE))
                continue
            errors, before = volume_errors(geometry, draft.surface, whole.complex), errors
            if errors.max() > VOLUME and left:
                # chords can be well within their limit already
                stuck = np.where(np.abs(errors - before) <= STUCK * errors, 2.0, 1.0)
                fineness = finer(fineness, stuck * errors / VOLUME)
                continue
            self._tell("measuring", 0.9)
            result = whole.result()
            if not result.excess.any():
                break
            fineness = finer(fineness, result.excess)
        if result.skeleton is None:
            with stage("certificate"):
                raise refusal(result.failures)
        return result.skeleton
