"""What a command prints on stdout, which may be full or closed as any file may."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from typing import TextIO

from decomp.errors import FileError
from decomp.files.targets import reason


class ReaderGoneError(Exception):
    """The reader of our output has gone (as `head` does): nothing is left to say."""


@contextmanager
def printed_at_end() -> Iterator[None]:
    """Have all that is printed written when the body ends, in whatever way it does.

    Raises:
        FileError: stdout cannot be written.
        ReaderGoneError: nobody reads it any more.
    """
    said = io.StringIO()
    try:
        with redirect_stdout(said):
            yield
    finally:
        _write(sys.stdout, said.getvalue())


@contextmanager
def flushed() -> Iterator[None]:
    """Have what is printed arrive before the body ends; raises the same."""
    try:
        yield
    finally:
        _write(sys.stdout, "")


def complain(text: str) -> None:
    """A line on stderr. Where that cannot be written either, the exit code alone tells."""
    with suppress(OSError):
        print(text, file=sys.stderr, flush=True)


def _write(stream: TextIO | None, text: str) -> None:
    if stream is None:  # closed before the process began
        return
    try:
        stream.write(text)
        stream.flush()
    except BrokenPipeError:
        _drop(stream)
        raise ReaderGoneError from None
    except UnicodeEncodeError as error:
        raise FileError(
            f"cannot be written: its encoding, {error.encoding}, has no "
            f"{error.object[error.start : error.end]!r}; set PYTHONIOENCODING=utf-8",
            "standard output",
        ) from None
    except OSError as error:
        _drop(stream)
        raise FileError(f"cannot be written: {reason(error)}", "standard output") from None


def _drop(stream: TextIO) -> None:
    """Have what the stream still holds go nowhere, as Python writes it once more when it ends."""
    with suppress(OSError):  # a stream without a descriptor is nothing that Python writes then
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            os.dup2(nowhere, stream.fileno())
        finally:
            os.close(nowhere)
