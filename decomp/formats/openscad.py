"""OpenSCAD's `.csg` files: the flattened dump that `openscad -o model.csg model.scad` writes.

Everything at the top is one region, `solid`. Primitives are named by kind and number in the
file (`cube1.xmin`, `cylinder2.side`). What is empty in OpenSCAD is empty here; faceting ($fn)
is reported and not followed, as surfaces are exact.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from decomp.csg.model import Model, Region
from decomp.csg.solid import Solid
from decomp.errors import FileError
from decomp.formats.grammar import (
    ENDS,
    MARKS,
    MARKS_WITHIN,
    NUMBER,
    Language,
    numbers,
    parse,
    token_pattern,
)
from decomp.formats.openscad_shapes import EMPTY, PARAMETERS, Call, Circle, Fault, Shape, Shapes
from decomp.formats.source import Source

if TYPE_CHECKING:
    from lark import Token

WORDS: dict[str, Any] = {"true": True, "false": False, "undef": None}
COMMENT = r"//[^\n]*+|/\*.*?\*/"

LANGUAGE = Language(
    grammar="openscad.lark",
    comment=re.compile(COMMENT, re.DOTALL),
    token=token_pattern(
        COMMENT,
        rf"{NUMBER}|(?:inf|nan)\b",
        r'(?P<NAME>\$?[^\W\d]\w*+)|(?P<STRING>"(?:[^"\\]|\\.)*+")|(?P<OPEN>(?:/\*|").*)'
        r"|(?P<MARK>[;,()=\[\]{}%#*!])",
    ),
    kinds={
        **MARKS,
        "{": "_LBRACE",
        "}": "_RBRACE",
        **dict.fromkeys("%#*!", "MODIFIER"),
    },
    words={
        "NAME": "a name such as cube",
        "NUMBERS": "a number",
        **MARKS_WITHIN,
        "_LBRACE": "'{'",
        "_RBRACE": "'}'",
        **ENDS,
    },
)


def read(source: Source, name: str = "model") -> Model:
    """Read a model.

    Raises:
        ParseError: the text is no `.csg` file, a value is wrong, or nothing is left in it.
        UnsupportedError: a construct or a transform that lies outside the primitives.
    """
    reader = _Reader(source)
    solid = parse(LANGUAGE, source, reader, reader.refuse)
    return Model((Region("solid", solid),), name, tuple(reader.ignored.values()))


class _Reader(Shapes):
    """The actions of the grammar's rules."""

    def __init__(self, source: Source) -> None:
        super().__init__(source)
        self.roots: list[tuple[int, Shape]] = []

    def start(self, parts: list[Any]) -> Solid:
        shape = min(self.roots, key=lambda r: r[0])[1] if self.roots else self.union(_shapes(parts))
        if isinstance(shape, Circle):
            shape = self.flat(shape)
        if isinstance(shape, Fault):
            raise shape.error
        if shape is EMPTY:
            raise self.source.wrong(
                "the file holds no solid: nothing is left but empty groups or objects of no size",
                0,
            )
        return shape

    def call(self, parts: list[Any]) -> Call:
        parts = [part for part in parts if part is not None]
        tokens = [part for part in parts if not isinstance(part, tuple)]
        arguments = [part for part in parts if isinstance(part, tuple)]
        name = str(tokens[-1])
        order = list(PARAMETERS.get(name, ((), ()))[0])
        values: dict[str, Any] = {}
        for key, value in arguments:
            if key is not None:
                values[key] = value
                continue
            for each in value if isinstance(value, _Numbers) else [value]:
                values[order.pop(0) if order else f"argument {len(values) + 1}"] = each
        position = tokens[-1].start_pos
        return Call("".join(tokens[:-1]), name, values, position)

    def named(self, parts: list[Any]) -> tuple[str, Any]:
        key, value = parts
        if isinstance(value, _Numbers):
            if len(value) > 1:
                raise self.source.wrong(
                    f"{key} takes one value, or several in [ ], but {len(value)} are given",
                    key.start_pos,
                )
            value = value[0]
        return str(key), value

    def positional(self, parts: list[Any]) -> tuple[None, Any]:
        return None, parts[0]

    def numbers(self, parts: list[Token]) -> _Numbers:
        return _Numbers(numbers(parts[0]))

    def string(self, parts: list[Token]) -> str:
        return str(parts[0])

    def word(self, parts: list[Token]) -> Any:
        return WORDS.get(parts[0], str(parts[0]))

    def array(self, parts: list[Any]) -> list[Any]:
        values: list[Any] = []
        for part in parts:
            if isinstance(part, _Numbers):
                values.extend(part)
            elif part is not None:
                values.append(part)
        return values

    def node(self, parts: list[Any]) -> Shape | None:
        call: Call = parts[0]
        if "*" in call.modifiers:
            self.roots = [root for root in self.roots if root[0] < call.position]
            return None
        shape = self.shape(call, _shapes(parts[1:]))
        if "!" in call.modifiers:
            self.roots.append((call.position, shape))
        return None if "%" in call.modifiers else shape

    def refuse(self, token: Token, expected: set[str]) -> FileError | None:
        """Errors that say more than which tokens were expected."""
        position = token.start_pos or 0
        if token.type == "_EQUALS" and "_LPAR" in expected:
            return self.source.wrong(
                "assignments belong to .scad files; write the flattened form with "
                "'openscad -o model.csg model.scad'",
                position,
            )
        return None


class _Numbers(list[float]):
    """Numbers with commas between them and no brackets around them."""


def _shapes(parts: list[Any]) -> list[Shape]:
    """The children among a rule's parts."""
    return [part for part in parts if isinstance(part, (Solid, Circle, Fault))]
