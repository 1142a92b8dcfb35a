"""A child's end of a pipe that tells it when its parent has ended, in whatever way.

The parent holds the writing end of the child's standard input, and closes it only when it no
longer needs the child; the system closes it when the parent dies, be it before the child has begun
to look. The child itself may be deep in code that lets no thread of Python run, so a process
forked from it waits at the pipe and ends the group of both. On Linux the system is asked to end the
child with its parent too: it does so even where a copy of the parent keeps the pipe open.

It needs nothing of the package, as it is loaded by path too
(`decomp/meshing/backends/tetwild/worker.py`).
"""

from __future__ import annotations

import ctypes
import os
import select
import signal
import sys

PR_SET_PDEATHSIG = 1


def die_with_parent() -> None:
    """End this process, with its group, when its parent ends or closes the pipe.

    For a process that leads a group of its own, whose standard input is the pipe, before it has
    threads. Where processes cannot be forked (Windows) nothing happens.
    """
    if sys.platform == "win32":
        return
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    own, held = os.pipe()
    if os.fork():
        # `held` stays open, by intent, as long as this process is there
        os.close(own)
        return
    os.close(held)
    try:
        _watch(own)
    finally:
        os._exit(0)


def _watch(own: int) -> None:
    """Wait for the end of the process that has forked this one, or of its parent.

    Args:
        own: the end of a pipe whose other end the process holds.
    """
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    # nobody shall wait for the end of what the process writes because of the watcher
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    parent = 0
    while True:
        ready, _, _ = select.select([parent, own], [], [])
        if own in ready:
            return
        if not os.read(parent, 4096):
            os.killpg(0, signal.SIGKILL)
