"""Netgen's `.geo` files of solids (`algebraic3d`).

Names: a solid that is one primitive gives it its own name (`hole.side`); the primitives written
directly in any other solid are numbered by kind within it (`cube.plane1`). Flags of a solid go
to its faces, those of a solid inside it win; flags of a `tlo` are the region's options.
"""

from __future__ import annotations

import copy
import re
from collections import Counter
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from decomp.csg.counting import MOST_PRIMITIVES
from decomp.csg.model import Ignored, Model, Region
from decomp.csg.options import OF_FACES, OF_REGIONS, Known, Options
from decomp.csg.solid import (
    Complement,
    Copies,
    Intersection,
    Labelled,
    Solid,
    Transformed,
    Union,
    checked_name,
)
from decomp.errors import FileError, InputError
from decomp.formats.grammar import (
    ENDS,
    MARKS,
    MARKS_WITHIN,
    NUMBER,
    Language,
    numbers,
    parse,
    token_pattern,
    tokens,
)
from decomp.formats.netgen_flags import Flag, options, plain
from decomp.formats.netgen_solids import COPIES, PRIMITIVES, STEPS, WRITTEN, Vector
from decomp.formats.source import Source
from decomp.near import near
from decomp.similarity import Similarity

if TYPE_CHECKING:
    from lark import Token

MOVES = ("translate", "rotate", "multitranslate", "multirotate")
UNSUPPORTED = (
    "ellipsoid",
    "ellipticcone",
    "polyhedron",
    "extrusion",
    "revolution",
    "tube",
    "gencyl",
)
STATEMENTS = (
    "boundingbox",
    "identify",
    "singular",
    "point",
    "boundarycondition",
    "boundaryconditionname",
    "boundarycolor",
    "curve2d",
    "curve3d",
)

COMMENT = r"#[^\n]*+"

LANGUAGE = Language(
    grammar="netgen.lark",
    comment=re.compile(COMMENT),
    token=token_pattern(
        COMMENT,
        NUMBER,
        r"(?P<NAME>[A-Za-z_][A-Za-z0-9_]*+)|(?P<FLAG>-\s*+[A-Za-z_][A-Za-z0-9_]*+)"
        r"|(?P<MARK>[;,()=\[\]])",
    ),
    kinds={
        "algebraic3d": "_ALGEBRAIC3D",
        "solid": "_SOLID",
        "tlo": "TLO",
        "and": "_AND",
        "or": "_OR",
        "not": "_NOT",
        "define": "DEFINE",
        **MARKS,
        **dict.fromkeys(STATEMENTS, "STATEMENT"),
        **dict.fromkeys(UNSUPPORTED, "UNSUPPORTED"),
        **{word: "MOVE" if word in MOVES else "PRIMITIVE" for word in WRITTEN},
    },
    words={
        "_ALGEBRAIC3D": "the word 'algebraic3d'",
        "_SOLID": "'solid'",
        "TLO": "'tlo'",
        "STATEMENT": "another statement",
        "PRIMITIVE": "a primitive such as sphere",
        "NAME": "a name",
        "NUMBERS": "a number, or numbers with commas between them",
        "_NOT": "'not'",
        "_AND": "'and'",
        "_OR": "'or'",
        **MARKS_WITHIN,
        "FLAG": "a flag such as -maxh=0.5",
        **ENDS,
    },
)


RESERVED = {word for word in LANGUAGE.kinds if word.isalnum()}
NO_SOLID = "the file defines no solid; add a line such as 'solid main = sphere (0, 0, 0; 1);'"


def read(source: Source, name: str = "model") -> Model:
    """Read a model.

    Raises:
        ParseError: the text is no `algebraic3d` file, or a value, name or statement is wrong.
        UnsupportedError: a solid uses an ellipsoid, an extrusion or the like.
    """
    reader = _Reader(source)
    parse(LANGUAGE, source, reader, reader.refuse)
    if not reader.regions:
        raise source.wrong(
            "the file names no solid to be meshed; add a line such as 'tlo main;'"
            if reader.solids
            else NO_SOLID,
            len(source.text.rstrip()),
        )
    return Model(tuple(reader.regions.values()), name, tuple(reader.ignored))


class _Reader:
    """The actions of the grammar's rules."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.solids: dict[str, Solid] = {}
        self.regions: dict[str, Region] = {}
        self.ignored: list[Ignored] = []
        self.current = ""
        self.defined: dict[str, tuple[int, int]] = {}
        self.heading_at = 0
        self.copies = 0
        self.counts: Counter[str] = Counter()
        self.last: Solid | None = None

    def start(self, parts: list[Any]) -> None:
        """All is noted by then."""

    def heading(self, parts: list[Token]) -> None:
        (name,) = parts
        try:
            checked_name(name)
        except InputError as error:
            raise self.wrong(str(error), name) from None
        self.current, self.last = str(name), None
        self.heading_at = name.start_pos or 0
        self.counts.clear()

    def solid(self, parts: list[Any]) -> None:
        _, body, *flags, end = parts
        place = self.heading_at, end.start_pos
        if self.current in self.defined:
            self.defined_again(self.current, place)
            self.current = ""
            return
        self.defined[self.current] = place
        if isinstance(body, Labelled) and body is self.last and self.counts.total() == 1:
            body = _renamed(body.part, self.current)
        found = self.options(flags, OF_FACES, f"solid {self.current}")
        self.solids[self.current] = Labelled(body, None, found) if found else body
        self.current = ""

    def defined_again(self, name: str, place: tuple[int, int]) -> None:
        """Netgen takes a second definition; here it must say what the first one says."""
        first, again = (
            [
                numbers(token) if token.type == "NUMBERS" else "".join(token.split())
                for token in tokens(LANGUAGE, self.source.text, *span)
            ]
            for span in (self.defined[name], place)
        )
        if first != again:
            lines = [self.source.line(start) for start, _ in (self.defined[name], place)]
            raise self.source.wrong(
                f"the solid {name!r} is defined in line {lines[0]}, and with another body in line "
                f"{lines[1]}: give each its own name",
                place[0],
            )

    def region(self, parts: list[Any]) -> None:
        _, name, *flags, end = parts
        solid = self.reference([name])
        line = self.source.line(name.start_pos)
        known = self.regions.get(name)
        if known is None:
            found = self.options(flags, OF_REGIONS, f"tlo {name}")
            self.regions[str(name)] = Region(str(name), solid, found, line)
        elif known.options == options(flags, OF_REGIONS, f"tlo {name}", _dropped, self.wrong):
            self.ignore(parts[0], end.start_pos)
        else:
            raise self.wrong(
                f"the solid {str(name)!r} is a tlo in line {known.line}, and with other flags in "
                f"line {line}: keep one of them",
                name,
            )

    def patch(self, parts: list[Any]) -> None:
        for name in parts[1:3]:
            self.reference([name])
        self.skipped([parts[0], parts[-1]])

    def skipped(self, parts: list[Token]) -> None:
        self.ignore(parts[0], parts[-1].start_pos or 0)

    def constant(self, parts: list[Token]) -> None:
        if parts[1] != "constant":
            raise self.wrong(
                f"{str(parts[1])!r} does not belong here; expected 'constant'", parts[1]
            )
        self.ignore(parts[0], (parts[-1].start_pos or 0) + len(parts[-1]))

    def union(self, parts: list[Solid]) -> Solid:
        return Union(tuple(parts))

    def intersection(self, parts: list[Solid]) -> Solid:
        return Intersection(tuple(parts))

    def complement(self, parts: list[Solid]) -> Solid:
        return Complement(parts[0])

    def reference(self, parts: list[Token]) -> Solid:
        (name,) = parts
        found = self.solids.get(name)
        if found is not None:
            return found
        if name == self.current:
            raise self.wrong(f"the solid {str(name)!r} refers to itself", name)
        message = f"the solid {str(name)!r} is not defined"
        message += near(str(name), map(str, self.solids))
        if not self.solids and not self.current:
            message += f": {NO_SOLID}"
        later = re.compile(rf"\bsolid\s+{re.escape(name)}\s*=").search(
            self.source.text, name.start_pos or 0
        )
        if later:
            line = self.source.line(later.start())
            message = f"the solid {str(name)!r} is used here, but defined only in line {line}"
        raise self.wrong(message, name)

    def primitive(self, parts: list[Token]) -> Solid:
        word = parts[0]
        values = self.lists(word, parts[1:])
        self.counts[word] += 1
        made = self.checked(word, lambda: PRIMITIVES[word](*values))
        self.last = Labelled(_renamed(made, f"{word}{self.counts[word]}"), self.current)
        return self.last

    def moved(self, parts: list[Any]) -> Solid:
        word, *rest, solid = parts
        values = self.lists(word, rest)
        if not word.startswith("multi"):
            step: Similarity = self.checked(word, lambda: STEPS[word](*values))
            return Transformed(solid, step)
        count = values.pop()[0]
        if count != round(min(count, MOST_PRIMITIVES)) or count < 0:
            raise self.wrong(
                f"{word!s} takes a whole number of copies from 0 to {MOST_PRIMITIVES:,}, got "
                f"{count:g}",
                word,
            )
        self.copies += int(count)
        if self.copies > MOST_PRIMITIVES:
            raise self.wrong(
                f"here the file has made {self.copies:,} copies, but at most {MOST_PRIMITIVES:,} "
                "are computed with: make fewer",
                word,
            )
        return Copies(solid, self.checked(word, lambda: COPIES[word](*values, int(count))))

    def switch(self, parts: list[Token]) -> Flag:
        return Flag(tuple(parts), True)

    def value(self, parts: list[Token]) -> Flag:
        flag, value = parts
        found = plain(value)
        if isinstance(found, tuple):
            if len(found) > 1:
                raise self.wrong(f"{flag} takes one number, or several in [ ]", value)
            (found,) = found
        return Flag(tuple(parts), found)

    def values(self, parts: list[Token]) -> Flag:
        found = [plain(part) for part in parts[1:]]
        return Flag(tuple(parts), found[0] if isinstance(found[0], tuple) else tuple(found))

    def options(self, flags: list[Flag], known: Mapping[str, Known], where: str) -> Options:
        """What flags set; those that are no options are noted as ignored."""

        def ignore(flag: Flag) -> None:
            line = self.source.line(flag.tokens[0].start_pos or 0)
            self.ignored.append(Ignored(f"{flag} of {where}", line))

        return options(flags, known, where, ignore, self.wrong)

    def lists(self, word: Token, parts: list[Token]) -> list[Vector]:
        """The numbers in a primitive's or a move's parentheses, checked for their count."""
        values = [numbers(part) for part in parts if part.type == "NUMBERS"]
        written, counts = WRITTEN[word]
        if tuple(len(value) for value in values) != counts:
            shape = "; ".join(str(count) for count in counts)
            found = "; ".join(str(len(value)) for value in values)
            raise self.wrong(
                f"{word} is written {written}: expected lists of {shape} numbers, got {found}",
                word,
            )
        return values

    def checked(self, word: Token, make: Callable[[], Any]) -> Any:
        """What `make` returns; its complaint about a value gets the place."""
        try:
            return make()
        except InputError as error:
            raise self.wrong(f"{error} (in solid {self.current!r})", word) from None

    def ignore(self, first: Token, end: int) -> None:
        start = first.start_pos or 0
        statement = LANGUAGE.comment.sub(" ", self.source.text[start:end])
        words = Source(statement).line_of_text(0, len(statement))
        self.ignored.append(Ignored(words, self.source.line(start)))

    def wrong(self, message: str, token: Token) -> FileError:
        return self.source.wrong(message, token.start_pos or 0)

    def refuse(self, token: Token, expected: set[str]) -> FileError | None:
        """Errors that say more than which tokens were expected."""
        position = token.start_pos or 0
        if "_ALGEBRAIC3D" in expected:
            return self.source.wrong(
                "no 'algebraic3d' at the start: this is not a Netgen file of solids "
                "(other programs use .geo too)",
                len(self.source.text.rstrip()) if token.type == "$END" else position,
            )
        if token.type == "UNSUPPORTED" and "PRIMITIVE" in expected:
            headings = re.findall(r"\bsolid\s+(\w+)\s*=", self.source.text[:position])
            return self.source.unsupported(
                f"{token} (in solid {headings[-1]!r}) is not supported: solids are made of plane, "
                "sphere, cylinder, ellipticcylinder, cone, orthobrick and torus",
                position,
            )
        if token in RESERVED and "NAME" in expected and not expected & {"PRIMITIVE", "SEMI"}:
            return self.source.wrong(
                f"{str(token)!r} is a word of the format, in Netgen too, and cannot be a name; "
                "expected a name of your own",
                position,
            )
        if token.type == "NAME" and "_SOLID" in expected:
            return self.source.wrong(
                f"{str(token)!r} starts no statement; expected 'solid', 'tlo', 'boundingbox' "
                "or the like",
                position,
            )
        return None


def _renamed(primitive: Solid, name: str) -> Solid:
    """The same primitive with another name."""
    result = copy.copy(primitive)
    object.__setattr__(result, "name", name)
    return result


def _dropped(flag: Flag) -> None:
    """An unknown flag of a line that is ignored as a whole."""
