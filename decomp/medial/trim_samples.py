"""What the balls over a curve of normals touch, sample by sample, and where two contacts tie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from decomp.vectors import Array

Contact = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class TrimSample:
    """A ball over a curve of normals.

    Args:
        s: parameter of the curve.
        far: the far contact's sites.
        site: the one of them that was found.
        foot: (3,) the far foot.
        radius: of the ball.
    """

    s: float
    far: Contact
    site: int
    foot: Array
    radius: float


def ties(a: TrimSample, middle: TrimSample, b: TrimSample) -> bool:
    """Whether a sample's contact holds those of both its neighbours.

    It is the change itself then, to the tolerance of contacts.
    """
    return middle.far not in (a.far, b.far) and set(a.far) | set(b.far) <= set(middle.far)


def one_of(a: TrimSample, middle: TrimSample, b: TrimSample) -> TrimSample | None:
    """A sample that ties two contacts with the one that holds its site, None if both do."""
    if a.far == b.far or (middle.site in a.far and middle.site not in b.far):
        return replace(middle, far=a.far)
    if middle.site in b.far and middle.site not in a.far:
        return replace(middle, far=b.far)
    return None


def without_ties(samples: Sequence[TrimSample]) -> list[TrimSample]:
    """First samples, of which none happens to be where the contact changes."""
    found = [samples[0]]
    for k in range(1, len(samples) - 1):
        here: TrimSample | None = samples[k]
        if ties(found[-1], samples[k], samples[k + 1]):
            here = one_of(found[-1], samples[k], samples[k + 1])
        if here is not None:
            found.append(here)
    return [*found, samples[-1]]
