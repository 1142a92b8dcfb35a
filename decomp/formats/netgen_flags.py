"""Flags of Netgen's solids and `tlo`s: which become options, and which are ignored.

Source: Netgen, libsrc/csg/csgparser.cpp, `ParseFlags` and what follows `TOK_TLO`; csgeom.cpp,
`CSGeometry::SetFlags`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from decomp.csg.options import Known, Options, checked
from decomp.errors import FileError, InputError

if TYPE_CHECKING:
    from lark import Token


@dataclass(frozen=True)
class Flag:
    """A flag as it is written.

    Args:
        tokens: its name with the dash, then its values.
        value: True where it has none, else a word, a number, or a tuple of them from [ ].
    """

    tokens: tuple[Token, ...]
    value: Any

    @property
    def name(self) -> str:
        """Without the dash."""
        return self.tokens[0][1:].strip()

    def __str__(self) -> str:
        values = [", ".join(token.split(",")) for token in self.tokens[1:]]
        text = ", ".join(re.sub(r"\s+", " ", value).strip() for value in values)
        if isinstance(self.value, tuple):
            text = f"[{text}]"
        return f"-{self.name}={text}" if values else f"-{self.name}"


def plain(token: Token) -> Any:
    """A flag's word, or its numbers as a tuple, whole where they are written so."""
    if token.type != "NUMBERS":
        return str(token)
    texts = "".join(token.split()).split(",")
    return tuple(int(t) if re.fullmatch(r"-?\d{1,18}", t) else float(t) for t in texts)


def options(
    flags: Sequence[Flag],
    known: Mapping[str, Known],
    where: str,
    ignore: Callable[[Flag], None],
    wrong: Callable[[str, Token], FileError],
) -> Options:
    """The options that flags set.

    Args:
        flags: of a solid or a `tlo`.
        known: which options there are.
        where: they stand, for messages.
        ignore: is told of flags that are no options, or hold a value for each of several faces.
        wrong: makes an error with its place.

    Raises:
        ParseError: an option's value is none that it may have.
    """
    found: dict[str, Any] = {}
    for flag in flags:
        if flag.name not in known or (flag.name in LISTS and isinstance(flag.value, tuple)):
            ignore(flag)
            continue
        try:
            found.update(checked({flag.name: flag.value}, known, where))
        except InputError as error:
            raise wrong(str(error), flag.tokens[0]) from None
    return Options(found)


LISTS = ("bc", "bcname")
"""Flags that Netgen knows with a value for each of a solid's faces too."""
