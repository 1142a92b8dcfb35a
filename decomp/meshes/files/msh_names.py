r"""Names of physical groups in Gmsh's files (.msh), in quotes on lines of their own.

A quote would end the name and a line break the line: both, and all else that does not print, are
written as in Python (`\x22`, `\x0a`, `\u2028`), and read back so. Gmsh itself reads lines of some
255 bytes: of a longer name the beginning stands there, with a check sum, and the whole of it in a
section of comments, `$Comments`, which Gmsh passes over.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from hashlib import sha256

LONGEST = 240
"""Bytes of a name that Gmsh reads, with something to spare."""

CODE = "x[0-9a-f]{2}|u[0-9a-f]{4}"
UNFIT = re.compile(rf'["\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]|\\(?={CODE})')
ESCAPED = re.compile(rf"\\(?:{CODE})")
LINE = re.compile(rb'^\s*(\d)\s+(-?\d{1,10})\s+"(.*)"\s*$')

Key = tuple[int, int]
"""Dimension and tag of a group."""


def names_section(names: Iterable[tuple[Key, str]], more: Iterable[bytes] = ()) -> bytes:
    """The sections for some names, in their order; the comments hold some lines more."""
    lines, whole = [], []
    for (dimension, tag), name in names:
        text = _escaped(name).encode()
        if len(text) > LONGEST:
            whole.append(b'%d %d "%s"' % (dimension, tag, text))
            text = _cut(text)
        lines.append(b'%d %d "%s"' % (dimension, tag, text))
    count = str(len(lines)).encode()
    parts = [b"$PhysicalNames", count, *lines, b"$EndPhysicalNames", b""]
    comments = [*whole, *more]
    if comments:
        parts[-1:] = [b"$Comments", *comments, b"$EndComments", b""]
    return b"\n".join(parts)


def read_names(section: bytes, comments: bytes) -> dict[Key, str]:
    """The names in a section, those cut off made whole from the comments."""
    found = _lines(section)
    whole = _lines(comments)
    return {
        key: _unescaped(whole[key] if text == _cut(whole.get(key, b"")) else text)
        for key, text in found.items()
    }


def _lines(section: bytes) -> dict[Key, bytes]:
    matches = (LINE.match(line) for line in section.split(b"\n"))
    return {(int(m[1]), int(m[2])): m[3] for m in matches if m}


def _cut(text: bytes) -> bytes:
    """The beginning of a long name; its check sum tells names apart that begin alike."""
    head = text[: LONGEST - 20].decode(errors="ignore").encode()
    return head + b"~" + sha256(text).hexdigest()[:16].encode()


def _escaped(name: str) -> str:
    def escape(found: re.Match[str]) -> str:
        code = ord(found[0])
        return f"\\x{code:02x}" if code < 256 else f"\\u{code:04x}"

    return UNFIT.sub(escape, name)


def _unescaped(text: bytes) -> str:
    return ESCAPED.sub(lambda found: chr(int(found[0][2:], 16)), text.decode(errors="replace"))
