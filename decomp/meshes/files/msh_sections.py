"""The sections of a Gmsh file (.msh), and numbers from them, binary or text."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from decomp.errors import FileError
from decomp.meshes.about import About, read_about
from decomp.meshes.files.msh_names import read_names

LARGEST_WHOLE = {4: 2**31 - 1, 8: 2**53}
"""By bytes of the type; beyond 2^53 a number read from text is not exact."""


class Numbers:
    """Takes numbers from a section, one array after the other.

    Args:
        body: of the section.
        binary: whether the numbers are binary, else text.
        swapped: whether binary numbers have the other byte order.
        path: of the file, for messages.
    """

    def __init__(self, body: bytes, binary: bool, swapped: bool, path: str | Path) -> None:
        self._body, self._at, self._path = body, 0, path
        self._swapped = swapped
        self._words: NDArray[np.float64] | None = None
        if not binary:
            self._words = _words(body)

    def take(self, kind: str, count: int) -> NDArray[Any]:
        """The next numbers (count,) of a NumPy type.

        Raises:
            FileError: there are too few, or they are not of this type.
        """
        dtype = np.dtype(kind)
        have = len(self._body) if self._words is None else len(self._words)
        end = self._at + count * (dtype.itemsize if self._words is None else 1)
        if count < 0 or end > have:
            raise FileError("the file ends too early, or its counts are wrong", self._path)
        if self._words is None:
            stored = dtype.newbyteorder("S") if self._swapped else dtype
            found = np.frombuffer(self._body, stored, count, self._at).astype(dtype)
        else:
            found = self.typed(self._words[self._at : end], dtype)
        self._at = end
        return found

    def typed(self, words: NDArray[np.float64], dtype: np.dtype[Any]) -> NDArray[Any]:
        """Numbers read from text (n,), as another type.

        Raises:
            FileError: they are to be whole, and are not, or are too large for it.
        """
        if (
            dtype.kind != "f"
            and not (
                (np.abs(words) <= LARGEST_WHOLE[dtype.itemsize]) & (words == np.rint(words))
            ).all()
        ):
            raise FileError("there is no whole number where one belongs", self._path)
        return words if dtype.kind == "f" else words.astype(np.int64).astype(dtype)

    def one(self, kind: str) -> int:
        """The next number, a whole one."""
        return int(self.take(kind, 1)[0])

    @property
    def rest(self) -> NDArray[np.int64]:
        """What is left of a section of text, (n,) whole numbers."""
        assert self._words is not None
        return self.typed(self._words[self._at :], np.dtype(np.int64))


@dataclass(frozen=True, eq=False)
class Sections:
    """A file taken apart.

    Args:
        path: of the file.
        version: of the format.
        names: of the physical groups, by dimension and tag.
        about: what the comments tell of groups and parts, if they are decomp's.
        data: the kind (`NodeData` or `ElementData`) and body of each field.
        binary: whether numbers are binary, else text.
    """

    path: str | Path
    version: float
    names: dict[tuple[int, int], str]
    about: About | None
    data: tuple[tuple[str, bytes], ...]
    _bodies: dict[str, bytes]
    binary: bool
    _swapped: bool

    def numbers(self, name: str) -> Numbers:
        """A section's numbers.

        Raises:
            FileError: there is no such section.
        """
        if name not in self._bodies:
            raise FileError(f"there is no section ${name}", self.path)
        try:
            return Numbers(self._bodies[name], self.binary, self._swapped, self.path)
        except ValueError:
            raise FileError(f"section ${name} holds what is no number", self.path) from None

    def body_numbers(self, body: bytes) -> Numbers:
        """The numbers of a part of a section.

        Raises:
            FileError: it holds what is none.
        """
        try:
            return Numbers(body, self.binary, self._swapped, self.path)
        except ValueError:
            raise FileError("a field holds what is no number", self.path) from None

    def has(self, name: str) -> bool:
        """Whether the file has a section."""
        return name in self._bodies


def sections(path: str | Path) -> Sections:
    """Read a file.

    Raises:
        FileError: it cannot be read, or is no .msh file.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise FileError(f"cannot be read: {error.strerror or error}", path) from None
    head = re.match(rb"\s*\$MeshFormat\s+(\d+(?:\.\d+)?)\s+([01])\s+(\d+)[ \t]*\r?\n", data)
    if head is None:
        raise FileError("this is no .msh file: it does not begin with $MeshFormat", path)
    binary = head[2] == b"1"
    if binary and head[3] != b"8":
        raise FileError(f"numbers of {head[3].decode()} bytes are not read, only of 8", path)
    one = data[head.end() : head.end() + 4]
    swapped = binary and np.frombuffer(one.ljust(4, b"\0"), "i4")[0] != 1
    found = list(_bodies(data, path))
    bodies = dict(found)
    comments = b"\n".join(body for name, body in found if name == "Comments")
    names = read_names(bodies.get("PhysicalNames", b""), comments)
    fields = tuple(each for each in found if each[0] in ("NodeData", "ElementData"))
    return Sections(
        path, float(head[1]), names, read_about(comments), fields, bodies, binary, bool(swapped)
    )


def _words(body: bytes) -> NDArray[np.float64]:
    """The numbers in a section of text.

    Raises:
        ValueError: there is something else in it.
    """
    with warnings.catch_warnings():
        # what NumPy does at the first word that is no number
        warnings.simplefilter("error", DeprecationWarning)
        try:
            return np.fromstring(body, dtype=np.float64, sep=" ")
        except DeprecationWarning as error:
            raise ValueError(str(error)) from None


def _bodies(data: bytes, path: str | Path) -> Iterator[tuple[str, bytes]]:
    """The names and bytes between $Name and $EndName, each on a line of its own.

    A name of a group may hold such a mark, in quotes.
    """
    at = 0
    mark = re.compile(rb"^[ \t]*\$([A-Za-z]\w*)[ \t]*\r?\n", re.MULTILINE)
    while (start := mark.search(data, at)) is not None:
        name = start[1]
        closing = rb"^[ \t]*\$End" + name + rb"[ \t]*\r?(?:\n|\Z)"
        end = re.compile(closing, re.MULTILINE).search(data, start.end())
        if end is None:
            raise FileError(f"section ${name.decode()} has no end", path)
        yield name.decode(), data[start.end() : end.start()]
        at = end.end()
