"""Machine code of kernels kept in files, as numba does it, but for the time when files go wrong.

Numba ends with an error where its files are cut off or a disk is full, and takes for its own what
an interrupted run, or one beside it, has left under the same name. Here the index holds a digest of
the code that belongs to it, and of itself. What does not match is compiled anew; what cannot be
written is compiled again next time.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from numba.core.caching import FunctionCache, IndexDataCacheFile

from decomp.kernels.news import compiling

DIGEST = hashlib.sha256().digest_size


class KernelCache(FunctionCache):  # type: ignore[misc]
    """The cache of one kernel.

    Args:
        function: the kernel before it is compiled.

    Raises:
        RuntimeError: numba finds no directory to write to.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        stamp = self._impl.locator.get_source_stamp()
        self._cache_file = CheckedFiles(self._cache_path, self._impl.filename_base, stamp)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The kept machine code for a signature; None where it has to be compiled."""
        found = super().load_overload(sig, target_context)
        if found is None:
            compiling()
        return found

    @contextmanager
    def _guard_against_spurious_io_errors(self) -> Iterator[None]:
        """Numba reads and writes in here: files that fail it are as good as none."""
        with suppress(OSError):
            yield


class CheckedFiles(IndexDataCacheFile):  # type: ignore[misc]
    """The index of a kernel, and a file with machine code for each kind of arguments.

    The index tells for each kind the name of its file, and the digest of what must be in it.
    """

    def save(self, key: Any, data: Any) -> None:
        """Write the code first: an index never tells of code that is not there yet.

        Raises:
            OSError: a file cannot be written.
        """
        known = self._load_index()
        names = {name for name, _ in known.values()}
        name = known[key][0] if key in known else self._free(names)
        code = self._dump(data)
        with self._open_for_write(self._data_path(name)) as file:
            file.write(code)
        known[key] = name, hashlib.sha256(code).digest()
        self._save_index(known)

    def load(self, key: Any) -> Any:
        """The code, or None where there is none or not the right one.

        Raises:
            OSError: the index cannot be read.
        """
        name, digest = self._load_index().get(key, (None, None))
        if name is None:
            return None
        code = _content(self._data_path(name))
        return _unpacked(code) if hashlib.sha256(code).digest() == digest else None

    def _free(self, names: set[str]) -> str:
        number = 1
        while self._data_name(number) in names:
            number += 1
        return str(self._data_name(number))

    def _load_index(self) -> dict[Any, tuple[str, bytes]]:
        whole = _content(self._index_path)
        digest, packed = whole[:DIGEST], whole[DIGEST:]
        if hashlib.sha256(packed).digest() != digest:
            return {}
        version, stamp, known = _unpacked(packed) or (None, None, {})
        return known if (version, stamp) == (self._version, self._source_stamp) else {}

    def _save_index(self, overloads: dict[Any, tuple[str, bytes]]) -> None:
        packed = self._dump((self._version, self._source_stamp, overloads))
        with self._open_for_write(self._index_path) as file:
            file.write(hashlib.sha256(packed).digest() + packed)


def _content(path: str) -> bytes:
    """What is in a file; nothing if it is not there."""
    try:
        return Path(path).read_bytes()
    except FileNotFoundError:
        return b""


def _unpacked(packed: bytes) -> Any:
    """What was packed; None if other versions of libraries packed it, which may fail in any way."""
    try:
        return pickle.loads(packed)
    except Exception:
        return None
