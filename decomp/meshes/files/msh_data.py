"""Fields in Gmsh's files, sections NodeData and ElementData: a number at each node or element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from decomp.errors import FileError
from decomp.meshes.files.msh_sections import Sections
from decomp.vectors import Array, Ints

HEADS = 3
"""Lists before the values: texts, reals, whole numbers; each after a line with its length."""
LONGEST_HEAD = 100


@dataclass(frozen=True, eq=False)
class Data:
    """A field.

    Args:
        name: of it.
        at_nodes: whether its values are at nodes, else of elements.
        tags: (n,) of these.
        values: (n,).
    """

    name: str
    at_nodes: bool
    tags: Ints
    values: Array

    def of(self, tags: Ints) -> Array | None:
        """The values (k,) for some tags (k,), None if one has none."""
        order = np.argsort(self.tags, kind="stable")
        place = np.minimum(np.searchsorted(self.tags[order], tags), max(len(order) - 1, 0))
        if not len(order) or not (self.tags[order][place] == tags).all():
            return None
        return np.asarray(self.values[order][place])


def read_data(parts: Sections) -> list[Data]:
    """The fields of a file; those of several numbers at a place are passed over.

    Raises:
        FileError: one is cut off, or holds what is no number.
    """
    found = (_read(parts, kind, body) for kind, body in parts.data)
    return [each for each in found if each is not None]


def _read(parts: Sections, kind: str, body: bytes) -> Data | None:
    texts, rest = _list(parts, body)
    _, rest = _list(parts, rest)
    whole, rest = _list(parts, rest)
    if len(whole) < HEADS or not texts:
        raise FileError(f"section ${kind} has no name, or does not tell how long it is", parts.path)
    width, count = int(whole[1]), int(whole[2])
    if width != 1:
        return None
    numbers = parts.body_numbers(rest)
    if parts.binary:
        row = np.frombuffer(numbers.take("u1", 12 * count).tobytes(), "u1").reshape(count, 12)
        tags = parts.body_numbers(row[:, :4].tobytes()).take("i4", count)
        values = parts.body_numbers(row[:, 4:].tobytes()).take("f8", count)
    else:
        table = numbers.take("f8", 2 * count).reshape(count, 2)
        tags, values = numbers.typed(table[:, 0], np.dtype(np.int64)), table[:, 1]
    name = texts[0].decode(errors="replace").strip().strip('"')
    return Data(name, kind == "NodeData", tags.astype(np.int64), values)


def _list(parts: Sections, body: bytes) -> tuple[list[bytes], bytes]:
    """The lines of a list, and what follows them."""
    first, _, rest = body.partition(b"\n")
    if not first.strip().isdigit() or int(first) > LONGEST_HEAD:
        raise FileError("a field does not begin with its name and numbers", parts.path)
    lines = []
    for _ in range(int(first)):
        line, _, rest = rest.partition(b"\n")
        lines.append(line.strip())
    return lines, rest
