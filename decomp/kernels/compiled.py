"""How numerical kernels are compiled.

Compiling takes long, most of it for what surrounds the arithmetic: code that takes arguments from
Python, copies for arguments of another type, tuples of many arrays (see `records`). So functions
that only kernels call get no such code, and each is compiled for one kind of arguments.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NoReturn, TypeVar, cast

from numba import njit, types

from decomp.kernels.cache import KernelCache

F = TypeVar("F", bound=Callable[..., Any])
PACKAGE = Path(__file__).parent.parent
FOLDERS = ("kernels", "carriers", "sites", "skeletons/balls", "skeletons/seams/steps")
"""Folders with kernels that are called from other folders, each from those after it."""
CONSTANTS = PACKAGE / "tolerance.py"
"""Kernels have its numbers in them."""


def kernel(function: F) -> F:
    """Compile a function on first use, without the GIL, and cache it where that can be done.

    The machine code is kept beside the source or in the user's cache directory
    (`decomp.kernels.cache`). Where neither can be written it is compiled again in every process.
    """
    return _compiled(function)


def scalar(function: F) -> F:
    """A kernel that makes no arrays, only reads and fills given ones.

    Numba counts references to every array of a tuple whenever the tuple is touched, which can
    cost more than the arithmetic; without new arrays there is nothing to count.
    """
    return _compiled(function, _nrt=False)


def inner_kernel(function: F) -> F:
    """A kernel that only kernels can call."""
    return _only_from_kernels(_compiled(function, no_cpython_wrapper=True))


def inner(function: F) -> F:
    """A scalar kernel that only kernels can call."""
    return _only_from_kernels(_compiled(function, _nrt=False, no_cpython_wrapper=True))


def inlined(function: F) -> F:
    """A scalar kernel that is compiled into the kernels that call it."""
    options = {"_nrt": False, "no_cpython_wrapper": True, "forceinline": True}
    return _only_from_kernels(_compiled(function, **options))


def spliced(function: F) -> F:
    """A scalar kernel that is put into the kernels that call it before they are compiled.

    Each kernel that is compiled by itself is optimised with all that it calls, which takes seconds
    where that is the search for the nearest site. This one is not: a step of a larger kernel.
    """
    options = {"_nrt": False, "no_cpython_wrapper": True}
    return _only_from_kernels(_compiled(function, **options, inline="always"))


def _compiled(function: F, **options: bool | str) -> F:
    common: dict[str, Any] = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
    common.update(options)
    compiled: Any = njit(**common)(function)
    cache = _cache(function)
    if cache is not None:
        compiled._cache = cache
        _restamp(compiled)
    return cast(F, _without_collecting(_for_plain_types(compiled)))


def _cache(function: Callable[..., Any]) -> KernelCache | None:
    """Where its machine code is kept; None if numba finds no directory to write to."""
    try:
        return KernelCache(function)
    except RuntimeError:
        return None


def _without_collecting(compiled: Any) -> Any:
    """Have it compiled with the garbage collector at rest, which finds next to nothing then."""
    plain = compiled.compile

    def at_rest(signature: Any) -> Any:
        if not gc.isenabled():
            return plain(signature)
        gc.disable()
        try:
            return plain(signature)
        finally:
            gc.enable()

    compiled.compile = at_rest
    return compiled


def _for_plain_types(compiled: Any) -> Any:
    """Have kernels call it with 64-bit integers instead of constants and shorter integers.

    Numba would compile it for each constant again.
    """
    template = compiled.get_call_template

    def plain(kind: types.Type) -> types.Type:
        kind = types.unliteral(kind)
        return types.int64 if kind == types.int32 else kind

    def for_plain(args: Any, keywords: dict[str, Any]) -> Any:
        return template(tuple(map(plain, args)), {k: plain(v) for k, v in keywords.items()})

    compiled.get_call_template = for_plain
    return compiled


def _only_from_kernels(compiled: F) -> F:
    """Have calls from Python refused, for which there is no code."""
    dispatcher: Any = compiled

    def known_to_kernels(result: Any) -> None:
        dispatcher.overloads[tuple(result.signature.args)] = result

    def refused(*_: Any) -> NoReturn:
        raise TypeError(f"only compiled kernels can call {dispatcher.py_func.__name__}")

    dispatcher.add_overload = known_to_kernels
    dispatcher._compile_for_args = refused
    return compiled


def _restamp(compiled: Any) -> None:
    """Have a cached kernel renewed when its own file or one that it may call a kernel of changes.

    Numba by itself renews it when its own file changes, but not when a kernel changes that it
    calls in another file.
    """
    own = Path(getattr(compiled, "py_func", compiled).__code__.co_filename)
    files = [(file.stat().st_mtime, file.stat().st_size) for file in (own, CONSTANTS)]
    stamps = [*files, *(_stamp(folder) for folder in _called_from(own.parent))]
    with suppress(AttributeError):
        compiled._cache._cache_file._source_stamp = (
            max(changed for changed, _ in stamps),
            sum(size for _, size in stamps),
        )


def _called_from(folder: Path) -> list[Path]:
    """The folders whose kernels those of a folder may call: its own, and those before it."""
    shared = [PACKAGE / name for name in FOLDERS]
    return shared[: shared.index(folder) + 1] if folder in shared else [folder, *shared]


@cache
def _stamp(folder: Path) -> tuple[float, int]:
    """Latest change and total size of the files of a folder."""
    stats = [file.stat() for file in folder.glob("*.py")]
    return max((s.st_mtime for s in stats), default=0.0), sum(s.st_size for s in stats)
