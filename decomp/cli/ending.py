"""SIGTERM and SIGHUP end a command as Ctrl-C does: children are ended, temporary files removed."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import NoReturn

RAISED_AGAIN, AT_LAST = 1, 2
"""Seconds after which the error is raised once more, and those after which the system ends us."""


class EndedError(BaseException):
    """The process was asked to end. No error to be caught: what cleans up lets it pass.

    Args:
        number: of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number
        self.exit_code = 128 + number


@contextmanager
def endings() -> Iterator[None]:
    """Raise an error where a signal asks this process to end, and make sure that it ends.

    A second signal ends it at once. Signals that are ignored (by `nohup`) or that another program
    handles are left as they are.

    Raises:
        EndedError: for SIGTERM and SIGHUP.
        KeyboardInterrupt: for SIGINT.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    ending = _Ending()
    try:
        yield
    except BaseException:
        # code that was interrupted may have made another error of it
        if ending.received:
            raise ending.error() from None
        raise
    else:
        if ending.received:
            raise ending.error()
    finally:
        ending.close()


def leave(code: int) -> NoReturn:
    """End this process at once, without what Python does at its end, which takes long.

    Args:
        code: its exit code.
    """
    for stream in (sys.stdout, sys.stderr):
        # who read it may have gone
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(code)


class _Ending:
    """The handlers of signals, and the signal that has come."""

    def __init__(self) -> None:
        self.received = 0
        defaults = {signal.SIGTERM: signal.SIG_DFL, signal.SIGINT: signal.default_int_handler}
        if sys.platform != "win32":
            defaults[signal.SIGHUP] = signal.SIG_DFL
        self._old = {n: old for n, old in defaults.items() if signal.getsignal(n) is old}
        for number in self._old:
            signal.signal(number, self._end)

    def error(self) -> BaseException:
        """What tells of the signal that has come."""
        if self.received == signal.SIGINT:
            return KeyboardInterrupt()
        return EndedError(self.received)

    def close(self) -> None:
        """Undo it all."""
        if self.received and sys.platform != "win32":
            signal.alarm(0)
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
        self._restore()

    def _restore(self) -> None:
        for number, old in self._old.items():
            signal.signal(number, old)

    def _end(self, number: int, frame: FrameType | None) -> None:
        self.received = number
        self._restore()
        if number != signal.SIGINT and sys.platform != "win32":
            # an error raised in a callback of compiled code is lost
            signal.signal(signal.SIGALRM, self._end_again)
            signal.alarm(RAISED_AGAIN)
        raise self.error()

    def _end_again(self, number: int, frame: FrameType | None) -> None:
        if sys.platform != "win32":
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.alarm(AT_LAST)
        raise self.error()
