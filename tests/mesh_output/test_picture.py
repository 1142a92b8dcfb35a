"""A picture shows the cells behind the cut, each in one colour, lit from the front."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

from decomp.output.mesh import picture
from tests.mesh_output.shapes import bar


def decoded(data: bytes) -> np.ndarray:
    """The colours (height, width, 3) of a picture as `png` writes it."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, {}
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        kind, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        (check,) = struct.unpack(">I", data[at + 8 + length : at + 12 + length])
        assert check == zlib.crc32(kind + content)
        chunks[kind] = content
        at += 12 + length
    assert list(chunks) == [b"IHDR", b"IDAT", b"IEND"]
    width, height, depth, colour = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert (depth, colour) == (8, 2)
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(height, width, 3)


def large_areas(colours: np.ndarray) -> int:
    """How many colours fill more than a hundredth of the picture, white aside."""
    flat = colours.reshape(-1, 3).astype(np.int64) @ [1 << 16, 1 << 8, 1]
    found, count = np.unique(flat, return_counts=True)
    return int(((count > len(flat) / 100) & (found != 0xFFFFFF)).sum())


def test_a_bar(tmp_path: Path) -> None:
    """Behind y = 1/2 there are two of three cells, each with its top and its front."""
    path = tmp_path / "bar.png"
    bar(4).write(path)
    colours = decoded(path.read_bytes())
    assert colours.shape == (picture.HEIGHT, picture.WIDTH, 3)
    assert (colours[[0, 0, -1, -1], [0, -1, 0, -1]] == 255).all()
    drawn = (colours < 255).any(axis=2)
    # it fills the picture, along one side, but for the margin, to a pixel
    gaps = []
    for axis, size in ((0, picture.WIDTH), (1, picture.HEIGHT)):
        places = np.flatnonzero(drawn.any(axis=axis))
        free = picture.MARGIN * size
        gaps.append(max(abs(places[0] - free), abs(size - 1 - places[-1] - free)))
    assert min(gaps) <= 1
    # front and top of the left and the right, and the right end
    assert large_areas(colours) == 5


def test_what_is_nearer_hides_what_is_behind() -> None:
    """Whichever is drawn first."""
    far = [[10.0, 10, 0], [90, 10, 0], [10, 90, 0]]
    near = [[10.0, 10, 1], [40, 10, 1], [10, 40, 1]]
    for order in ([0, 1], [1, 0]):
        image, depth = np.ones((100, 100, 3)), np.full((100, 100), -np.inf)
        colours = np.array([[1.0, 0, 0], [0, 1, 0]])
        picture.draw(np.array([far, near])[order], colours[order], image, depth)
        assert image[15, 15].tolist() == [0, 1, 0]
        assert image[30, 50].tolist() == [1, 0, 0]
        assert image[70, 70].tolist() == [1, 1, 1]
        # the edge of the far one
        assert image[10, 60].tolist() == [picture.DARK, 0, 0]
