"""Files spoiled at random: the ways in which what is read may be wrong."""

from __future__ import annotations

import random
import re
import struct
from collections.abc import Callable, Sequence

TOKEN = re.compile(rb"[A-Za-z_$][\w$]*|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|\s+|.", re.DOTALL)
NUMBER = re.compile(rb"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
WORD = re.compile(rb"[A-Za-z_$][\w$]*")

MODEST = (b"0", b"-1", b"1", b"1.5", b"2", b"3", b"4", b"5", b"6.25", b"10", b"30", b"-5", b"0.1")
NUMBERS = (
    *(b"0", b"-0", b"-1", b"1", b"2", b"3", b"0.5", b"1e308", b"-1e308", b"1e-308", b"1e400"),
    *(b"nan", b"inf", b"-inf", b"NaN", b"Infinity", b"1e60", b"1e-60", b"1e16", b"1e-9"),
    *(b"99999", b"100000", b"2147483648", b"18446744073709551615", b"9" * 400, b"9" * 5000),
    *(b"1e", b"0x10", b"1_000", b"--1", b"1.2.3", b"true", b"null", b'"1"', b"[1]"),
)
PIECES = (
    *(b"\xff", b"\xc3", b"\xed\xa0\x80", b"\0", b"\x1b[2J", b"\r", b"\x85", "ä€𝄞".encode()),
    *(
        b'"',
        b"'",
        b"\\",
        b"\\ud800",
        b"\\u0000",
        b"\\n",
        b"/*",
        b"//",
        b"#",
        b"$",
        b"$End",
        b"=",
        b"-",
    ),
    *(b"solid a = ", b"tlo a;", b"not ", b" or ", b" and ", b";", b"algebraic3d", b"}", b"{", b"!"),
)
OPENING = (
    *(b"(", b"[", b"{", b"not ", b"translate (1, 0, 0; ", b"multitranslate (1, 0, 0; 9; "),
    *(b"union() {", b"[[", b'{"a":', b"-", b"group() { cube(1); "),
)
WHOLE = (0, 1, -1, 2, 2**31 - 1, -(2**31), 2**63 - 1, -(2**63), 2**40, 255)
REAL = (0.0, float("nan"), float("inf"), -1e308, 1e308, 1e-308)

Mutation = Callable[[random.Random, bytes, Sequence[bytes]], bytes]


def mutated(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """A file spoiled in one to three ways.

    Args:
        chance: decides.
        data: of the file.
        others: files of the same kind, whose pieces are put in.
    """
    for _ in range(chance.choice((1, 1, 1, 1, 1, 2, 3))):
        data = chance.choice(MUTATIONS)(chance, data, others)
    return data


def flip_bits(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Turn a few bits over."""
    spoiled = bytearray(data)
    for _ in range(chance.randint(1, 8) if data else 0):
        spoiled[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return bytes(spoiled)


def put_piece(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Put in what the format, an encoding or a terminal takes amiss."""
    at = chance.randint(0, len(data))
    return data[:at] + chance.choice(PIECES) * chance.choice((1, 1, 2, 50)) + data[at:]


def cut_out(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Leave a stretch out."""
    a, b = _stretch(chance, data)
    return data[:a] + data[b:]


def repeat(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Repeat a stretch."""
    a, b = _stretch(chance, data)
    return data[:b] + data[a:b] * chance.choice((1, 1, 2, 30)) + data[b:]


def break_off(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """End too early."""
    return data[: chance.randint(0, len(data))]


def splice(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Go on as another file does."""
    other = chance.choice(others)
    return data[: chance.randint(0, len(data))] + other[chance.randint(0, len(other)) :]


def change_number(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Put other numbers in the place of some."""
    for _ in range(chance.choice((1, 1, 2, 5))):
        data = _replaced(chance, data, NUMBER, lambda _: chance.choice(NUMBERS))
    return data


def vary_number(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Put numbers that make sense in the place of some."""
    for _ in range(chance.choice((1, 2, 3, 5))):
        data = _replaced(chance, data, NUMBER, lambda _: chance.choice(MODEST))
    return data


def lengthen_word(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Make a word very long."""
    return _replaced(chance, data, WORD, lambda word: word * chance.choice((2, 40, 1000, 100_000)))


def change_word(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Put another word of some file in the place of one."""
    words = WORD.findall(chance.choice(others)[:20_000]) or [b"x"]
    return _replaced(chance, data, WORD, lambda _: chance.choice(words))


def move_tokens(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Exchange, leave out or double some tokens."""
    tokens = TOKEN.findall(data)
    for _ in range(chance.randint(1, 3) if len(tokens) > 1 else 0):
        a, b = chance.randrange(len(tokens)), chance.randrange(len(tokens))
        match chance.randrange(3):
            case 0:
                tokens[a], tokens[b] = tokens[b], tokens[a]
            case 1:
                tokens[a] = b""
            case _:
                tokens[a] *= 2
    return b"".join(tokens)


def nest(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Open, and perhaps close, brackets over and over."""
    opening, deep = chance.choice(OPENING), chance.choice((3, 30, 1000, 30_000))
    pairs = {b"(": b")", b"[": b"]", b"{": b"}"}
    closing = b"".join(pairs.get(c, b"") for c in re.findall(rb"[\[({]", opening)[::-1])
    at, end = sorted(chance.randint(0, len(data)) for _ in range(2))
    if chance.random() < 0.3:
        closing = b""
    return data[:at] + opening * deep + data[at:end] + closing * deep + data[end:]


def change_binary(chance: random.Random, data: bytes, others: Sequence[bytes]) -> bytes:
    """Put whole or real numbers of 4 or 8 bytes over what stands somewhere."""
    kind = chance.choice("iqd")
    value = chance.choice(REAL if kind == "d" else WHOLE)
    if kind == "i":
        value = max(-(2**31), min(2**31 - 1, int(value)))
    number = struct.pack(f"<{kind}", value)
    # counts stand at the beginnings of sections
    starts = [0, *(found.end() for found in re.finditer(rb"\$[A-Z]\w+\n", data))]
    at = chance.choice(starts) + 4 * chance.randrange(16) if chance.random() < 0.7 else None
    at = chance.randint(0, len(data)) if at is None else at
    return data[:at] + number + data[at + len(number) :]


MUTATIONS: tuple[Mutation, ...] = (
    flip_bits,
    put_piece,
    cut_out,
    repeat,
    break_off,
    splice,
    *(change_number,) * 4,
    *(vary_number,) * 8,
    lengthen_word,
    *(change_word,) * 2,
    *(move_tokens,) * 2,
    nest,
    change_binary,
)


def _stretch(chance: random.Random, data: bytes) -> tuple[int, int]:
    length = chance.choice((1, 3, 30, 300, 3000))
    a = chance.randint(0, len(data))
    return a, min(len(data), a + chance.randint(1, length))


def _replaced(
    chance: random.Random, data: bytes, pattern: re.Pattern[bytes], by: Callable[[bytes], bytes]
) -> bytes:
    """The data with one match of a pattern, near a random place, replaced."""
    at = chance.randint(0, len(data))
    found = pattern.search(data, at) or pattern.search(data)
    return data[: found.start()] + by(found[0]) + data[found.end() :] if found else data
