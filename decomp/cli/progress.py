"""Signs of life on stderr while something takes long; silence where stderr is no terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from decomp.plain import plain


@contextmanager
def working(what: str, quiet: bool) -> Iterator[None]:
    """Show a spinner with a text and the time taken, while the body runs."""
    if quiet or not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        progress.add_task(plain(what), total=None)
        yield
