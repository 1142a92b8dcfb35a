"""Names near to one that is not known, for errors. The command line loads it early: it is light."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

MOST_NAMES, NAME_LIKE = 3, 0.7
"""So many names are suggested, and they are at least so like (1 is the same)."""


def near(name: str, known: Iterable[str]) -> str:
    """`; did you mean 'one' or 'two'?`, or nothing if no known name is near.

    Capitals do not count.
    """
    spelled: dict[str, str] = {}
    for each in known:
        spelled.setdefault(each.casefold(), each)
    found = [spelled[k] for k in get_close_matches(name.casefold(), spelled, MOST_NAMES, NAME_LIKE)]
    if not found:
        return ""
    *rest, last = map(repr, found)
    return f"; did you mean {', '.join(rest)}{' or ' if rest else ''}{last}?"


def listed(names: Iterable[str], most: int = 8) -> str:
    """Some names for an error: all, or the first few and how many more."""
    known = list(names)
    told = ", ".join(known[:most])
    return f"{told} and {len(known) - most} more" if len(known) > most else told
