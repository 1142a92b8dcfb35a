"""What commands print, all of it through here."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterable

from decomp.plain import plain


def say(lines: Iterable[str], *, to_errors: bool = False) -> None:
    """Print lines for people, on stdout or stderr.

    Whatever names they hold, a line stays one line, steers no terminal, and can be printed: what
    the stream's encoding has not is escaped.
    """
    stream = sys.stderr if to_errors else sys.stdout
    if isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
        stream.reconfigure(errors="backslashreplace")
    print("\n".join(map(plain, lines)), file=stream)
