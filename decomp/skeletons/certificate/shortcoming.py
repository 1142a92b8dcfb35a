"""What is wrong with a skeleton, told with its places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from decomp.errors import GeometryError
from decomp.vectors import Array


@dataclass(frozen=True, eq=False)
class Shortcoming:
    """A figure that is not what it has to be.

    Args:
        text: its value and limit, and where.
        at: (3,) where it is worst, None if it is nowhere.
        sites: names of the sites there.
    """

    text: str
    at: Array | None = None
    sites: tuple[str, ...] = ()

    def __str__(self) -> str:
        return self.text


class CertificateError(GeometryError):
    """A skeleton was made, but not all that is measured on it is as it must be."""


def refusal(wrong: Sequence[Shortcoming]) -> CertificateError:
    """The error that tells all shortcomings; its place and sites are of the first that has some."""
    first = next((each for each in wrong if each.at is not None), Shortcoming(""))
    text = f"the skeleton fails its certificate: {'; '.join(each.text for each in wrong)}"
    return CertificateError(text, first.sites, first.at)
