"""The formats of models. A new one is a module beside this one, and a line here."""

from __future__ import annotations

from dataclasses import dataclass

from decomp.files.format import Format


@dataclass(frozen=True)
class ModelFormat(Format):
    """A format of models.

    Its module has `read(source, name)`, which gives a `Model`; if models are written in it,
    `encoded(model)`, which gives the file's bytes.

    Args:
        begins: a pattern that the text of a file matches at its start, comments passed over.
        keyword: that its files have, and no others; "" where there is none.
        old: the encoding of files that are no UTF-8; None where these are refused.
        written: whether models are written in it.
    """

    begins: str
    keyword: str = ""
    old: str | None = None
    written: bool = False

    def __str__(self) -> str:
        return f"{self.words} {'/'.join(self.suffixes)}"


FORMATS = (
    ModelFormat(
        "Netgen",
        (".geo",),
        "decomp.formats.netgen",
        begins=r"(?:\s|#[^\n]*+)*+algebraic3d\b",
        keyword="algebraic3d",
        old="latin-1",
    ),
    ModelFormat(
        "OpenSCAD",
        (".csg",),
        "decomp.formats.openscad",
        begins=r"(?s:\s|//[^\n]*+|/\*.*?\*/)*+[%#*!\s]*+\w++\s*+\(",
    ),
    ModelFormat("decomp", (".json",), "decomp.formats.native", begins=r"\s*+\{", written=True),
)
"""Where a text matches several, the first one counts."""
WRITTEN = tuple(form for form in FORMATS if form.written)


def listed(*, keywords: bool = False, last: str = " or ") -> str:
    """All formats in words: `Netgen .geo, OpenSCAD .csg or decomp .json`.

    Args:
        keywords: whether those that have a keyword are told with it.
        last: what stands before the last one.
    """
    names = [
        f"{form} ({form.keyword})" if keywords and form.keyword else str(form) for form in FORMATS
    ]
    return ", ".join(names[:-1]) + last + names[-1]
