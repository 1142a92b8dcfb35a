"""Text for people: what would steer a terminal, or cannot be written at all, is spelled out."""

from __future__ import annotations


def plain(text: str) -> str:
    r"""The text on one line, its characters that do not print as escapes: `\x1b`, `\n`, `\ud800`.

    Names come from files, and may hold terminal escapes, marks that turn the direction of writing,
    and halves of surrogate pairs, which have no form in UTF-8.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
