"""How results show themselves: a short text in a console, a table in a notebook.

What has `Shown` as its base is shown by its `_facts`, in so many words that no array is printed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

LONGEST_LINE, LONGEST_VALUE, MOST_ROWS = 300, 60, 40


class Shown:
    """Shows what it is in one line, and as a table of HTML."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "__repr__" not in vars(cls):  # dataclasses leave a class's own
            cls.__repr__ = Shown.__repr__  # type: ignore[method-assign]

    def _facts(self) -> Mapping[str, Any]:
        """What is shown, by name; a `name` stands in front. Fields, if a class tells no others."""
        return {each.name: getattr(self, each.name) for each in fields(self)}  # type: ignore[arg-type]

    def _table(self) -> tuple[Sequence[str], Iterable[Sequence[Any]]]:
        """Heads and rows of a table that a notebook shows below the facts; none by default."""
        return (), ()

    def __repr__(self) -> str:
        facts = {key: short(value) for key, value in self._facts().items() if value is not None}
        name = f" {facts.pop('name')}" if "name" in facts else ""
        told = ", ".join(f"{key} {value}" for key, value in facts.items())
        text = f"<{type(self).__name__}{name}: {told}>"
        return text if len(text) <= LONGEST_LINE else f"{text[: LONGEST_LINE - 4]}...>"

    def _repr_html_(self) -> str:
        facts = [(key, short(value)) for key, value in self._facts().items() if value is not None]
        heads, rows = self._table()
        below = list(rows)
        parts = [f"<b>{escape(type(self).__name__)}</b>", html_table((), facts)]
        if below:
            parts.append(html_table(heads, [[short(v) for v in row] for row in below[:MOST_ROWS]]))
        if len(below) > MOST_ROWS:
            parts.append(f"<p>and {len(below) - MOST_ROWS} more</p>")
        return "".join(parts)


def html_table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of texts."""

    def line(tag: str, values: Sequence[str]) -> str:
        cells = (f'<{tag} style="text-align:left">{escape(v)}</{tag}>' for v in values)
        return f"<tr>{''.join(cells)}</tr>"

    head = line("th", heads) if heads else ""
    return f"<table>{head}{''.join(line('td', row) for row in rows)}</table>"


def short(value: Any) -> str:
    """A value in a few words: the shape of an array, the number of things in a collection."""
    if isinstance(value, str):
        return _cut(value)
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if isinstance(value, (float, np.floating)):
        return f"{float(value):.7g}"
    if isinstance(value, np.ndarray):
        if value.size <= 3:
            return f"({', '.join(short(each) for each in value.reshape(-1).tolist())})"
        return " x ".join(map(str, value.shape))
    if isinstance(value, (tuple, list)):
        return _several(value)
    if isinstance(value, Mapping):
        return _cut(", ".join(f"{key}={short(each)}" for key, each in value.items())) or "none"
    if isinstance(value, Path):
        return _cut(str(value))
    if is_dataclass(value) and not isinstance(value, Shown):
        return type(value).__name__  # its fields may be large
    return _cut(repr(value))


def _several(values: Sequence[Any]) -> str:
    if not values:
        return "none"
    plain = all(isinstance(each, (str, int, float, Enum, type(None))) for each in values)
    text = ", ".join(map(short, values)) if plain else ""
    return f"({text})" if plain and len(text) <= LONGEST_VALUE else str(len(values))


def _cut(text: str) -> str:
    text = text if text.isprintable() else ascii(text)[1:-1]
    return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 3]}..."
