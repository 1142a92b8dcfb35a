"""Tables of a page, sorted by their columns when a heading is clicked."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape


@dataclass(frozen=True)
class Link:
    """The name of a part, which the view shows when it is clicked.

    Args:
        name: of the part, or of a region.
        group: of the part, as in `decomp.drawing.scene`; "" for any.
    """

    name: str
    group: str = ""


@dataclass(frozen=True)
class Figure:
    """A number, and how it is written.

    Args:
        value: that it is sorted by; None for none.
        form: of the text, such as `.4g`, with what follows it.
    """

    value: float | None
    form: str = "{:.4g}"


Entry = str | int | Link | Figure


def table(heads: Sequence[str], rows: Iterable[Sequence[Entry]]) -> str:
    """A table."""
    head = "".join(
        f'<th scope="col"><button type="button">{escape(each)}</button></th>' for each in heads
    )
    body = "".join(f"<tr>{''.join(_cell(entry) for entry in row)}</tr>" for row in rows)
    inner = f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody>"
    return f'<div class="wide"><table>{inner}</table></div>'


def _cell(entry: Entry) -> str:
    if isinstance(entry, Link):
        name = escape(entry.name)
        data = f'data-name="{name}" data-group="{entry.group}"'
        return f'<td><a href="#view" {data}>{name}</a></td>'
    if isinstance(entry, int):
        return f'<td data-value="{entry}">{entry}</td>'
    if isinstance(entry, Figure):
        if entry.value is None:
            return "<td></td>"
        return f'<td data-value="{entry.value!r}">{entry.form.format(entry.value)}</td>'
    return f"<td>{escape(entry)}</td>"
