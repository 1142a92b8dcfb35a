"""Why a length of edges was wanted."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Reason:
    """Why a length is wanted.

    Args:
        what: decides, such as `curvature of part/hole.side`.
        asked: whether it is a length that was asked for all over a region.
    """

    what: str
    asked: bool = False
