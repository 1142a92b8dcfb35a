"""How numerical kernels are compiled."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import njit

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a function on first use, without the GIL, and cache it where that can be done.

    Numba keeps the machine code beside the source or in the user's cache directory. Where
    neither is writable it is compiled again in every process.
    """
    return _compiled(function)


def scalar(function: F) -> F:
    """A kernel that makes no arrays, only reads and fills given ones.

    Numba counts references to every array of a tuple whenever the tuple is touched, which can
    cost more than the arithmetic; without new arrays there is nothing to count.
    """
    return _compiled(function, _nrt=False)


def inlined(function: F) -> F:
    """A scalar kernel that is compiled into its callers."""
    return _compiled(function, _nrt=False, forceinline=True)


def _compiled(function: F, **options: bool) -> F:
    common: dict[str, Any] = {
        "nogil": True,
        "error_model": "numpy",
        "no_cfunc_wrapper": True,
        **options,
    }
    try:
        compiled: Any = njit(cache=True, **common)(function)
    except RuntimeError:  # numba found no directory to write to
        return cast(F, njit(**common)(function))
    _plain(compiled)
    restamp(compiled, Path(__file__).parent)
    return cast(F, compiled)


def restamp(compiled: Any, *folders: Path) -> None:
    """Have a cached kernel renewed when its own file or any file of some folders changes.

    Numba by itself renews it when its own file changes, but not when a kernel changes that it
    calls in another file.
    """
    own = Path(getattr(compiled, "py_func", compiled).__code__.co_filename).stat()
    stamps = [(own.st_mtime, own.st_size), *(_stamp(folder) for folder in folders)]
    with suppress(AttributeError):
        compiled._cache._cache_file._source_stamp = (
            max(changed for changed, _ in stamps),
            sum(size for _, size in stamps),
        )


@cache
def _stamp(folder: Path) -> tuple[float, int]:
    """Latest change and total size of the files of a folder."""
    stats = [file.stat() for file in folder.glob("*.py")]
    return max((s.st_mtime for s in stats), default=0.0), sum(s.st_size for s in stats)


def _plain(compiled):
    from numba import types

    original = compiled.get_call_template

    def plain(t):
        t = types.unliteral(t)
        return types.int64 if t == types.int32 else t

    def get(args, kws):
        return original(tuple(plain(a) for a in args), {k: plain(v) for k, v in kws.items()})

    compiled.get_call_template = get
