"""Deep nesting and big garbage: answers in time, and no recursion."""

from __future__ import annotations

import random
import re
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from decomp.csg.solid import Union, walk
from decomp.errors import ParseError
from decomp.formats import FORMATS, load, loads
from decomp.formats.native import dumps

DEPTH = 10_000
BALL = "sphere (0,0,0; 1)"
MOVE = "multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {"


def netgen(body: str) -> str:
    return f"algebraic3d\nsolid a = {body};\ntlo a;"


CHAIN = "".join(f"solid a{k + 1} = a{k} or {BALL};\n" for k in range(DEPTH))
DEEP: dict[str, tuple[str, str, int]] = {
    "geo parentheses": ("geo", netgen("(" * DEPTH + BALL + ")" * DEPTH), 1),
    "geo not": ("geo", netgen("not " * DEPTH + BALL), DEPTH),
    "geo left": ("geo", netgen("(" * DEPTH + BALL + f" and {BALL})" * DEPTH), DEPTH),
    "geo right": ("geo", netgen(f"{BALL} or (" * DEPTH + BALL + ")" * DEPTH), DEPTH),
    "geo moves": ("geo", netgen("translate (1,0,0; " * DEPTH + BALL + ")" * DEPTH), DEPTH),
    "geo flat": ("geo", netgen(" or ".join([BALL] * DEPTH)), DEPTH),
    "geo chain": ("geo", f"algebraic3d\nsolid a0 = {BALL};\n{CHAIN}tlo a{DEPTH};", DEPTH),
    "csg groups": ("csg", "group() {" * DEPTH + "cube(1);" + "}" * DEPTH, 1),
    "csg left": ("csg", "difference() {" * DEPTH + "cube(1);" + "sphere(1);}" * DEPTH, DEPTH),
    "csg right": ("csg", "union() {sphere(1);" * DEPTH + "cube(1);" + "}" * DEPTH, DEPTH),
    "csg moves": ("csg", MOVE * DEPTH + "cube(1);" + "}" * DEPTH, DEPTH),
    "csg flat": ("csg", "cube(1);" * DEPTH, DEPTH),
}


@pytest.mark.parametrize("case", DEEP)
def test_deep_nesting(case: str) -> None:
    form, text, least = DEEP[case]
    model = loads(text, form)
    assert least <= len(list(walk([model.regions[0].solid]))) <= 3 * DEPTH + 2
    written = dumps(model)
    assert dumps(loads(written, "json")) == written


def test_lists_make_one_node() -> None:
    (region,) = loads(DEEP["geo flat"][1], "geo").regions
    assert isinstance(region.solid, Union)
    assert len(region.solid.parts) == DEPTH


@pytest.mark.parametrize("form", ["geo", "csg"])
def test_deep_and_never_closed(form: str) -> None:
    text = "algebraic3d solid a = " + "(" * 10 * DEPTH if form == "geo" else "group(){" * DEPTH
    with pytest.raises(ParseError, match="the file ends here; expected"):
        loads(text, form)


BYTES = 10_000_000


def repeated(head: str, body: str) -> str:
    return head + body * ((BYTES - len(head)) // len(body))


def noise() -> str:
    return random.Random(1).randbytes(BYTES).decode("latin-1")


def printable() -> str:
    return "".join(map(chr, random.Random(2).choices(range(32, 127), k=BYTES // 10))) * 10


GARBAGE: dict[str, Callable[[], str]] = {
    "noise": noise,
    "printable": printable,
    "parentheses": lambda: "(" * BYTES,
    "brackets": lambda: "[" * BYTES,
    "blanks": lambda: " " * BYTES,
    "signs": lambda: "#" * BYTES,
    "digits": lambda: "1" * BYTES,
    "numbers": lambda: "1," * (BYTES // 2),
    "exponents": lambda: "1e" * (BYTES // 2),
    "escapes": lambda: '"\\' * (BYTES // 2),
    "open comments": lambda: repeated("cube(1);", "/* "),
    "comment marks": lambda: repeated("cube(1) ", "/**/"),
    "objects": lambda: repeated("", '{"a":'),
    "geo header": lambda: "algebraic3d\n" + noise()[: BYTES - 12],
    "geo parentheses": lambda: repeated("algebraic3d solid a = ", "("),
    "geo not": lambda: repeated("algebraic3d solid a = ", "not "),
    "geo minus": lambda: repeated("algebraic3d solid a = sphere (", "- "),
    "geo numbers": lambda: repeated("algebraic3d solid a = sphere (", "1,"),
    "geo words": lambda: repeated("algebraic3d ", "solid tlo plane ( ) ; , = 1 and or not "),
    "geo balls": lambda: repeated("algebraic3d solid a = ", BALL + " or "),
    "geo flags": lambda: repeated(f"algebraic3d solid a = {BALL} ", "-bc=1 "),
    "geo statements": lambda: repeated("algebraic3d ", "point (1;"),
    "csg groups": lambda: repeated("", "group() {"),
    "csg cubes": lambda: repeated("", "cube(1);"),
    "csg moves": lambda: repeated("", MOVE),
    "csg arguments": lambda: repeated("cube(", "a = 1, "),
    "csg lists": lambda: repeated("cube(size = ", "["),
    "csg modifiers": lambda: "%" * BYTES,
}


@pytest.mark.parametrize("case", GARBAGE)
def test_ten_megabytes_of_garbage(case: str) -> None:
    text = GARBAGE[case]()
    for form in (known.name for known in FORMATS):
        start = time.process_time()
        with pytest.raises(ParseError):
            loads(text, form)
        assert time.process_time() - start < 2.0, form


@pytest.mark.parametrize("name", ["x.geo", "x.csg", "x.json", "x"])
@pytest.mark.parametrize(
    "content",
    [
        random.Random(3).randbytes(BYTES),
        b"\n" * BYTES + b"\xff",
        b"\n" * BYTES + b"x",
        b"/* " * (BYTES // 3),
        b"a" * BYTES,
        b"#" * BYTES + b"\n\xff",
    ],
    ids=["noise", "lines", "blank", "comments", "word", "signs"],
)
def test_ten_megabytes_of_garbage_in_a_file(tmp_path: Path, name: str, content: bytes) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    start = time.process_time()
    with pytest.raises(ParseError, match=re.escape(str(path))):
        load(path)
    assert time.process_time() - start < 2.0


def test_the_length_of_a_model_has_a_bound_with_a_reason() -> None:
    with pytest.raises(ParseError, match="the model goes on beyond 1,000,000 words"):
        loads("cube(1);" * 400_000, "csg")
