"""What is known of a format of files before what reads and writes it is loaded.

Packages that read or write files have a table of such records: suffixes, help and errors are made
of it, and a new format is a module and a line there. Modules have functions of fixed names, which
the table's record tells of.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar

from decomp.errors import InputError
from decomp.files.suffixes import known_suffix


@dataclass(frozen=True)
class Format:
    """A format of files.

    Args:
        words: whose it is, or what for; may be empty.
        suffixes: that files' names end in, in lower case, with the dot.
        module: that reads or writes it; it is loaded when it is first used.
    """

    words: str
    suffixes: tuple[str, ...]
    module: str

    @property
    def name(self) -> str:
        """The first suffix without its dot."""
        return self.suffixes[0][1:]

    def loaded(self) -> Any:
        """The module.

        Raises:
            DecompError: it needs a library that is not installed.
        """
        return import_module(self.module)


Of = TypeVar("Of", bound=Format)


def suffixes(formats: Sequence[Format]) -> tuple[str, ...]:
    """The suffixes of formats, in order."""
    return tuple(suffix for form in formats for suffix in form.suffixes)


def format_of(path: str | Path, formats: Sequence[Of], what: str) -> Of:
    """The format that a file is to be written in.

    Args:
        path: of the file; devices, pipes and open streams without a suffix get the first format.
        formats: that can be written.
        what: is to be written, in the plural.

    Raises:
        InputError: its suffix is none of theirs.
    """
    suffix = known_suffix(path, suffixes(formats), what)
    return next(form for form in formats if suffix in form.suffixes)


def format_named(name: object, formats: Sequence[Of], what: str) -> Of:
    """The format of a name.

    Args:
        name: of it.
        formats: that there are.
        what: they are for.

    Raises:
        InputError: none is called so.
    """
    for form in formats:
        if form.name == name:
            return form
    raise InputError(
        f"{name!r} is no format for {what}; use {', '.join(form.name for form in formats)}"
    )


def told(formats: Sequence[Format]) -> str:
    """Formats as help tells them: `.msh (Gmsh), .vtu (ParaView)`."""
    return ", ".join(
        "/".join(form.suffixes) + (f" ({form.words})" if form.words else "") for form in formats
    )
