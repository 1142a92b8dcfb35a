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


def without_passing_ties(
    samples: list[TrimSample],
    cuts: Sequence[tuple[TrimSample, TrimSample]],
    own: Contact,
    closed: bool,
    longest: float,
) -> list[tuple[TrimSample, TrimSample]]:
    """Changes of the far contact, without those at which sites only join or leave those at a foot.

    Over a curve of normals the balls that touch one far site are analytic: another site holds its
    foot all along, or in points. A short stretch with more sites than the one beside it is what
    tolerances make of such a point, one with fewer what they leave out; it is given the contact of
    the longer one.

    Args:
        samples: in ascending order; the first gets its stretch's contact.
        cuts: samples before and behind each change.
        own: the contact of balls that stop at the near sites' own locus, which is another matter.
        closed: whether the first and the last stretch are one.
        longest: stretches, in units of the parameter, that tolerances can make.
    """
    cuts = list(cuts)
    k = 0
    while k < len(cuts):
        low, high = cuts[k]
        few, many = sorted((set(low.far), set(high.far)), key=len)
        if own in (low.far, high.far) or not few < many:
            k += 1
            continue
        before = low.s - (cuts[k - 1][1].s if k else samples[0].s)
        behind = (cuts[k + 1][0].s if k + 1 < len(cuts) else samples[-1].s) - high.s
        if closed and k == 0:
            before += samples[-1].s - cuts[-1][1].s
        if closed and k + 1 == len(cuts):
            behind += cuts[0][0].s - samples[0].s
        if min(before, behind) > longest:
            k += 1
            continue
        far = low.far if before >= behind else high.far
        if k:
            cuts[k - 1] = cuts[k - 1][0], replace(cuts[k - 1][1], far=far)
        if k == 0 or (closed and k + 1 == len(cuts)):
            samples[0] = replace(samples[0], far=far)
        if k + 1 < len(cuts):
            cuts[k + 1] = replace(cuts[k + 1][0], far=far), cuts[k + 1][1]
        del cuts[k]
        k = max(k - 1, 0)
    return cuts
