"""Netgen's `.geo` files of solids (`algebraic3d`).

Names: a solid that is one primitive gives it its own name (`hole.side`); the primitives written
directly in any other solid are numbered by kind within it (`cube.plane1`). Flags of a solid go
to its faces, those of a solid inside it win; flags of a `tlo` are the region's options.
"""

from __future__ import annotations

import copy
import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from decomp import similarity
from decomp.csg.model import Ignored, Model, Region
from decomp.csg.options import OF_FACES, OF_REGIONS, Known, Options
from decomp.csg.primitives import (
    Block,
    HalfSpace,
    InfiniteCone,
    InfiniteCylinder,
    Primitive,
    Sphere,
    Torus,
)
from decomp.csg.solid import (
    Complement,
    Copies,
    Intersection,
    Labelled,
    Solid,
    Transformed,
    Union,
)
from decomp.errors import FileError, InputError
from decomp.formats.grammar import NUMBER, Language, numbers, parse, token_pattern
from decomp.formats.netgen_flags import Flag, options, plain
from decomp.formats.source import Source
from decomp.similarity import Similarity

if TYPE_CHECKING:
    from lark import Token

Vector = list[float]

# what a primitive is made from: how it is written, the count of numbers in each of its lists
WRITTEN: dict[str, tuple[str, tuple[int, ...]]] = {
    "plane": ("plane (x, y, z of a point; normal)", (3, 3)),
    "sphere": ("sphere (centre; radius)", (3, 1)),
    "cylinder": ("cylinder (point of the axis; second point; radius)", (3, 3, 1)),
    "cone": ("cone (point of the axis; radius; second point; radius)", (3, 1, 3, 1)),
    "orthobrick": ("orthobrick (corner; opposite corner)", (3, 3)),
    "torus": ("torus (centre; axis; major radius; minor radius)", (3, 3, 1, 1)),
    "translate": ("translate (vector; solid)", (3,)),
    "rotate": ("rotate (centre; three Euler angles; solid)", (3, 3)),
    "multitranslate": ("multitranslate (vector; number of copies; solid)", (3, 1)),
    "multirotate": ("multirotate (centre; three Euler angles; number; solid)", (3, 3, 1)),
}
MOST_COPIES = 100_000
MOVES = ("translate", "rotate", "multitranslate", "multirotate")
UNSUPPORTED = (
    "ellipsoid",
    "ellipticcylinder",
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
        ";": "SEMI",
        ",": "_COMMA",
        "(": "_LPAR",
        ")": "_RPAR",
        "[": "_LSQB",
        "]": "_RSQB",
        "=": "_EQUALS",
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
        "_EQUALS": "'='",
        "_COMMA": "','",
        "_LPAR": "'('",
        "_RPAR": "')'",
        "_LSQB": "'['",
        "_RSQB": "']'",
        "FLAG": "a flag such as -maxh=0.5",
        "SEMI": "';'",
        "$END": "the end of the file",
    },
)


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
            "the file names no solid to be meshed; add a line such as 'tlo main;'",
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
        self.counts: Counter[str] = Counter()
        self.last: Solid | None = None

    def start(self, parts: list[Any]) -> None:
        """All is noted by then."""

    def heading(self, parts: list[Token]) -> None:
        (name,) = parts
        if name in self.solids:
            raise self.wrong(f"the solid {str(name)!r} is defined a second time", name)
        self.current, self.last = str(name), None
        self.counts.clear()

    def solid(self, parts: list[Any]) -> None:
        _, body, *flags, _ = parts
        if isinstance(body, Labelled) and body is self.last and self.counts.total() == 1:
            body = _renamed(body.part, self.current)
        found = self.options(flags, OF_FACES, f"solid {self.current}")
        self.solids[self.current] = Labelled(body, None, found) if found else body
        self.current = ""

    def region(self, parts: list[Any]) -> None:
        _, name, *flags, _ = parts
        solid = self.reference([name])
        if name in self.regions:
            raise self.wrong(f"the solid {str(name)!r} is a tlo already", name)
        found = self.options(flags, OF_REGIONS, f"tlo {name}")
        self.regions[str(name)] = Region(str(name), solid, found)

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
        if count != round(min(count, MOST_COPIES)) or count < 0:
            raise self.wrong(
                f"{word!s} takes a whole number of copies from 0 to {MOST_COPIES:,}, got {count:g}",
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

    def refuse(self, token: Token, expected: Collection[str]) -> FileError | None:
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
                "sphere, cylinder, cone, orthobrick and torus",
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


def _cone(a: Vector, ra: Vector, b: Vector, rb: Vector) -> Primitive:
    if ra == rb and ra[0] > 0:
        return InfiniteCylinder(a, np.subtract(b, a), ra[0])
    return InfiniteCone.through(a, ra[0], b, rb[0])


PRIMITIVES: dict[str, Callable[..., Primitive]] = {
    "plane": HalfSpace,
    "sphere": lambda centre, radius: Sphere(centre, radius[0]),
    "cylinder": lambda a, b, radius: InfiniteCylinder(a, np.subtract(b, a), radius[0]),
    "cone": _cone,
    "orthobrick": lambda a, b: Block.between(np.minimum(a, b), np.maximum(a, b)),
    "torus": lambda centre, axis, major, minor: Torus(centre, axis, major[0], minor[0]),
}


def _rotation(centre: Vector, angles: Vector) -> Similarity:
    """Netgen's rotation: Euler angles z, x, z in radians, each turning clockwise.

    Source: Netgen, libsrc/gprim/transform3d.hpp, `Transformation` and `SetAxisRotation`.
    """
    turns = [
        similarity.rotation(axis, -float(np.degrees(angle)), centre)
        for axis, angle in zip(((0, 0, 1), (1, 0, 0), (0, 0, 1)), angles, strict=True)
    ]
    return turns[2].after(turns[1]).after(turns[0])


def _translations(step: Vector, count: int) -> tuple[Similarity, ...]:
    """The solid itself and `count` copies (Netgen, libsrc/csg/csgparser.cpp)."""
    return tuple(similarity.translation(np.multiply(k, step)) for k in range(count + 1))


def _rotations(centre: Vector, angles: Vector, count: int) -> tuple[Similarity, ...]:
    """The solid itself and `count` - 1 copies, as Netgen's first copy lies on the solid itself."""
    step = _rotation(centre, angles)
    result = [similarity.translation((0, 0, 0))]
    for _ in range(count - 1):
        result.append(step.after(result[-1]))
    return tuple(result)


STEPS: dict[str, Callable[..., Similarity]] = {
    "translate": similarity.translation,
    "rotate": _rotation,
}
COPIES: dict[str, Callable[..., tuple[Similarity, ...]]] = {
    "multitranslate": _translations,
    "multirotate": _rotations,
}
