"""Reading a text by an LALR(1) grammar: tokens, the parser's run, errors in plain words.

The actions run during the parse, so no syntax tree is made and nothing recurses: the depth of
nesting is bound by memory alone. Commas between numbers belong to one token, which makes the
long lists of coordinates in model files cheap to read.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from decomp.errors import FileError
from decomp.formats.source import Source

if TYPE_CHECKING:
    from lark import Token

# A million tokens are some 50,000 primitives or more. A longer text is looked at only so far as
# to find an error near its start.
MAX_TOKENS = 1_000_000
PROBED_TOKENS = 20_000

NUMBER = r"(?:[0-9]++\.?[0-9]*+|\.[0-9]++)(?:[eE][+-]?[0-9]++)?+"

MARKS: dict[str, str] = {
    "=": "_EQUALS",
    ",": "_COMMA",
    "(": "_LPAR",
    ")": "_RPAR",
    "[": "_LSQB",
    "]": "_RSQB",
    ";": "SEMI",
}
"""Signs that are tokens in all formats, as their grammars call them."""
MARKS_WITHIN: dict[str, str] = {kind: f"'{mark}'" for mark, kind in MARKS.items() if mark != ";"}
"""What an error says for those that end no statement."""
ENDS: dict[str, str] = {"SEMI": "';'", "$END": "the end of the file"}
"""What an error says for what a statement, and the text, end with."""


def token_pattern(comment: str, number: str, others: str) -> re.Pattern[str]:
    """The pattern of one token after blanks and comments, with a named group per kind.

    NUMBERS is one number, or up to 64 with commas between them; STRAY is a character that
    starts no token; END is the end of the text. It matches everywhere, in linear time.
    """
    gap = rf"(?:\s++|{comment})*+"
    signed = rf"(?:-{gap})?(?:{number})"
    numbers = rf"(?P<NUMBERS>{signed}(?:{gap},{gap}{signed}){{0,63}}+)"
    return re.compile(rf"{gap}(?:{numbers}|{others}|(?P<END>\Z)|(?P<STRAY>.))", re.DOTALL)


@dataclass(frozen=True)
class Language:
    """What the tokens of a format are and how its errors call them.

    Args:
        grammar: file name of the grammar, next to this module.
        comment: pattern of a comment.
        token: what `token_pattern` makes. A group OPEN matches what has no end.
        kinds: words and signs that are tokens of their own kind.
        words: what an error says for each kind of token, in this order; kinds left out are not
            mentioned as expected.
    """

    grammar: str
    comment: re.Pattern[str]
    token: re.Pattern[str]
    kinds: Mapping[str, str]
    words: Mapping[str, str]


Refusal = Callable[["Token", set[str]], FileError | None]


def parse(language: Language, source: Source, actions: object, refuse: Refusal) -> Any:
    """Read the source; `actions` has a method per rule that takes the list of its parts.

    Args:
        refuse: may give an error of its own for a token in the wrong place, from the token
            and the kinds that are expected there.

    Raises:
        ParseError: the text does not follow the grammar, or is too long.
    """
    text = source.text
    if len(text) > MAX_TOKENS:
        start = itertools.islice(tokens(language, text), PROBED_TOKENS)
        _run(language, source, start, None, refuse, whole=False)
        _refuse_long(language, source)
    return _run(language, source, tokens(language, text), actions, refuse)


def _run(
    language: Language,
    source: Source,
    read: Iterator[Token],
    actions: Any,
    refuse: Refusal,
    whole: bool = True,
) -> Any:
    """Feed the tokens to the grammar's parser; return the value of the start rule."""
    from lark import Lark, Token, UnexpectedToken

    grammar = Path(__file__).with_name(language.grammar).read_text(encoding="utf-8")
    parser = Lark(grammar, parser="lalr", lexer="basic", transformer=actions)
    run = parser.parse_interactive()
    feed = run.parser_state.feed_token
    try:
        for token in read:
            feed(token)
        return feed(Token("$END", "", len(source.text.rstrip())), True) if whole else None
    except UnexpectedToken as error:
        expected: set[str] = run.accepts()  # type: ignore[no-untyped-call]
        refusal = refuse(error.token, expected)
        raise refusal or _unexpected(language, source, error.token, expected) from None


def numbers(token: str) -> list[float]:
    """The values of a NUMBERS token."""
    return [float(part) for part in "".join(token.split()).split(",")]


def tokens(
    language: Language, text: str, start: int = 0, end: int | None = None
) -> Iterator[Token]:
    """The tokens of a text, or of a stretch of it that begins and ends between two of them."""
    from lark import Token

    kinds = language.kinds
    for match in language.token.finditer(text, start, len(text) if end is None else end):
        kind = match.lastgroup or ""
        if kind == "END":
            return
        value = match[kind]
        if kind == "NUMBERS" and ("#" in value or "/" in value):
            value = language.comment.sub(" ", value)
        yield Token(kinds.get(value, kind), value, match.start(kind))


def _refuse_long(language: Language, source: Source) -> None:
    """Count the tokens without making them."""
    beyond = next(itertools.islice(language.token.finditer(source.text), MAX_TOKENS, None), None)
    if beyond:
        raise source.wrong(
            f"the model goes on beyond {MAX_TOKENS:,} words, signs and lists of numbers, "
            "which is more than decomp reads: split it up",
            beyond.end(),
        )


def _unexpected(
    language: Language, source: Source, token: Token, expected: Collection[str]
) -> FileError:
    hopes = [words for kind, words in language.words.items() if kind in expected]
    wanted = ", ".join(hopes[:-1]) + (" or " if hopes[:-1] else "") + hopes[-1] if hopes else ""
    if token.type == "$END":
        found, position = "the file ends here", len(source.text.rstrip())
    else:
        position = token.start_pos or 0
        if token.type == "OPEN":
            what = "text" if token.startswith('"') else "comment"
            return source.wrong(f"the {what} that starts here has no end", position)
        shown = token if len(token) <= 30 else token[:27] + "..."
        found = f"{str(shown)!r} does not belong here"
    return source.wrong(f"{found}; expected {wanted}" if wanted else found, position)
