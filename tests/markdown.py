"""What a Markdown file says, as CommonMark with GitHub's tables has it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token


@dataclass
class Said:
    """The parts of a page, in its order: what they look like to a reader."""

    headings: list[str] = field(default_factory=list)
    cells: list[str] = field(default_factory=list)
    items: int = 0
    codes: list[str] = field(default_factory=list)
    titles: list[str] = field(default_factory=list)
    pictures: list[str] = field(default_factory=list)


def said(path: Path) -> Said:
    """Read a page."""
    found = Said()
    before = None
    for token in MarkdownIt().enable("table").parse(path.read_text(encoding="utf-8")):
        if token.type == "fence":
            found.codes.append(token.content)
            found.titles += re.findall(r'title="(.*)"', token.info)
        elif token.type == "list_item_open":
            found.items += 1
        elif token.type == "inline":
            pictures = [part for part in token.children or [] if part.type == "image"]
            found.pictures += [picture.content for picture in pictures]
            if before == "heading_open":
                found.headings.append(_text(token))
            elif before in ("th_open", "td_open"):
                found.cells.append(_text(token))
        before = token.type
    return found


def _text(inline: Token) -> str:
    words = "".join(
        part.content if part.type in ("text", "code_inline") else " " * (part.type == "softbreak")
        for part in inline.children or []
    )
    return " ".join(words.split())
