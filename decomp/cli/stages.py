"""How long each stage of a long computation takes."""

from __future__ import annotations

import time
from collections.abc import Callable


class Stages:
    """Passes progress on, and remembers when what was done changed.

    Args:
        tell: is told everything.
    """

    def __init__(self, tell: Callable[[str, float], None]) -> None:
        self._tell = tell
        self._spent: dict[str, float] = {}
        self._what = ""
        self._since = time.perf_counter()

    def __call__(self, what: str, done: float) -> None:
        """Something else is being done, of which `done` (0 to 1) is behind."""
        stage = "tracing" if what.startswith("tracing ") else what
        if stage != self._what:
            self._close()
            self._what = stage
        self._tell(what, done)

    def spent(self) -> tuple[tuple[str, float], ...]:
        """What was done and for how many seconds, until now, in order."""
        self._close()
        return tuple(self._spent.items())

    def _close(self) -> None:
        now = time.perf_counter()
        if self._what:
            self._spent[self._what] = self._spent.get(self._what, 0.0) + now - self._since
        self._since = now
