"""PNG pictures from arrays of colours.

Format: https://www.w3.org/TR/png-3/
"""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray


def encoded(colours: NDArray[np.uint8]) -> bytes:
    """The contents of a file.

    Args:
        colours: red, green, blue (height, width, 3), first row on top.
    """
    height, width, _ = colours.shape
    # each row is preceded by the number of its filter, 0 for none
    rows = np.zeros((height, 3 * width + 1), dtype=np.uint8)
    rows[:, 1:] = colours.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        _chunk(kind, data)
        for kind, data in (
            (b"IHDR", header),
            (b"IDAT", zlib.compress(rows.tobytes(), 9)),
            (b"IEND", b""),
        )
    )


def _chunk(kind: bytes, data: bytes) -> bytes:
    check = zlib.crc32(kind + data)
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)
