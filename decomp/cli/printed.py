"""What a command prints on stdout, which may be full or closed as any file may."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from typing import Any, TextIO, cast

from decomp.errors import FileError
from decomp.files.targets import reason
from decomp.plain import plain


class ReaderGoneError(Exception):
    """The reader of our output has gone (as `head` does): nothing is left to say."""


@contextmanager
def printing() -> Iterator[None]:
    """Have a stdout that cannot be written told of as any other file; it is flushed at the end.

    Raises:
        FileError: stdout cannot be written.
        ReaderGoneError: nobody reads it any more.
    """
    stream = sys.stdout
    if stream is None:  # closed before the process began: nothing is printed
        yield
        return
    if isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
        # what its encoding has not is escaped
        stream.reconfigure(errors="backslashreplace")
    guarded = _Guarded(stream)
    try:
        with redirect_stdout(cast(TextIO, guarded)):
            yield
    finally:
        guarded.flush()


def complain(text: str) -> None:
    """A line on stderr. Where that cannot be written either, the exit code alone tells."""
    if sys.stderr is None:  # closed before the process began
        return
    with suppress(OSError):
        print(plain(text), file=sys.stderr, flush=True)


class _Guarded:
    """A stream whose writing fails with the errors that `printing` tells of."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write a text."""
        with _failing(self._stream):
            return self._stream.write(text)

    def flush(self) -> None:
        """Write what is left."""
        with _failing(self._stream):
            self._stream.flush()


@contextmanager
def _failing(stream: TextIO) -> Iterator[None]:
    try:
        yield
    except BrokenPipeError:
        _drop(stream)
        raise ReaderGoneError from None
    except UnicodeEncodeError as error:
        raise FileError(
            f"cannot be written: its encoding, {error.encoding}, has no "
            f"{error.object[error.start : error.end]!a}; set PYTHONIOENCODING=utf-8",
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
