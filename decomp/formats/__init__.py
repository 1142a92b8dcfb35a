"""Models from and to files, in the formats of `table.py`.

The readers are loaded when they are first used, as they bring in a parser library.
"""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from decomp.errors import FileError, InputError, ParseError
from decomp.files.format import format_named, format_of
from decomp.files.targets import check_outputs, is_stream, reason
from decomp.formats.foreign import advice
from decomp.formats.table import FORMATS, WRITTEN, ModelFormat, listed
from decomp.paths import path_of

if TYPE_CHECKING:
    from decomp.csg.model import Model
    from decomp.csg.solid import Solid

MAX_BYTES = 64_000_000
"""Of a model file; read as JSON, it takes up to twenty times as much memory."""
EXPECTED = f"expected {listed(keywords=True)}"


def load(path: str | Path) -> Model:
    """Read a model file; the extension tells its format, or else its first words.

    Raises:
        FileError: the file cannot be read.
        ParseError: its text is wrong.
        UnsupportedError: it uses what lies outside the primitives and similarities.
    """
    file = path_of(path, "the model's file")
    data = _bytes(file)
    suffix = file.suffix.lower()
    form = next((known for known in FORMATS if suffix in known.suffixes), None)
    text = _text(data, file, form)
    if not text.strip():
        raise ParseError(f"the file is empty; {EXPECTED}", file)
    # bytes of a file's name that are no UTF-8 stand for themselves in no text
    name = os.fsencode(file.stem).decode("utf-8", "replace")
    return loads(text, (form or _sniffed(text, file)).name, name, file)


def loads(text: str, form: str, name: str = "model", path: str | Path | None = None) -> Model:
    """Read a model from text; a native model's own name goes before `name`.

    Args:
        text: of a file.
        form: the name of its format, one of `FORMATS`.
        name: of the model.
        path: where the text came from, for error messages and for the model to remember.

    Raises:
        InputError: there is no such format.
        ParseError: the text is wrong.
        UnsupportedError: it uses other surfaces or maps than those that solids are made of here.
    """
    from decomp.formats.source import Source

    known = format_named(form, FORMATS, "models")
    source = Source(text.replace("\r\n", "\n").replace("\r", "\n"), path)
    try:
        found: Model = known.loaded().read(source, name)
    except FileError:
        raise
    except InputError as error:  # of the model as a whole, such as two regions of one name
        raise ParseError(str(error), path) from None
    return found if path is None else replace(found, source=Path(path).absolute())


def save(source: Model | Solid | dict[str, Solid], path: str | Path) -> None:
    """Write a model, a solid or named solids, at once or not at all.

    Args:
        source: to write.
        path: ends in a suffix of a format that is written, and is not the file that the model was
            read from.

    Raises:
        InputError: the suffix is another, or a name cannot be written.
        FileError: the file cannot be written.
    """
    from decomp.csg.model import Model, model
    from decomp.files.whole_file import write_whole

    path = path_of(path, "the file to write")
    made = source if isinstance(source, Model) else model(source)
    form = check_saving(path, made.source)
    data: bytes = form.loaded().encoded(made)
    write_whole(path, data)


def check_saving(path: str | Path, source: str | Path | None) -> ModelFormat:
    """The format that a model is to be saved in.

    Args:
        path: of the file to write.
        source: the file that the model is read from, if any.

    Raises:
        InputError: its suffix is of none that is written.
        FileError: it cannot be written, or is the source.
    """
    form = format_of(path, WRITTEN, "models")
    check_outputs([path], [source])
    return form


def _bytes(file: Path) -> bytes:
    try:
        if file.is_dir():
            raise FileError("this is a directory; give the name of a model file", file)
        if not file.exists():
            raise FileError("no such file", file)
        if not file.is_file() and not is_stream(file):
            raise FileError("this is no regular file; give the name of a model file", file)
        with file.open("rb") as stream:
            found = stream.read(MAX_BYTES + 1)
        if len(found) > MAX_BYTES:
            raise FileError(f"the file has more than {MAX_BYTES:,} bytes, which is the most", file)
        return found
    except (OSError, ValueError) as error:
        raise FileError(f"cannot be read: {reason(error)}", file) from None


def _text(data: bytes, file: Path, form: ModelFormat | None) -> str:
    """The file's text: UTF-8, or the old encoding of its format, which comments may be in."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise ParseError("the file is in UTF-16; save it as UTF-8", file, 1, 1)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        known = form or _with_keyword(data)
        if known is not None and known.old is not None:
            return data.decode(known.old)
        if form is None and b"\0" in data:
            raise _no_model("this is no text that describes a model", file) from None
        before = data[: error.start]
        line = before.count(b"\n") + 1
        column = len(before[before.rfind(b"\n") + 1 :].decode("utf-8", "replace")) + 1
        raise ParseError(
            f"byte 0x{data[error.start]:02x} is not UTF-8; save the file as UTF-8",
            file,
            line,
            column,
        ) from None


def _with_keyword(data: bytes) -> ModelFormat | None:
    """The first format whose keyword is in a file."""
    for form in FORMATS:
        if form.keyword and re.search(rf"\b{form.keyword}\b".encode(), data):
            return form
    return None


def _sniffed(text: str, file: Path) -> ModelFormat:
    """The format that the text's first words tell, comments passed over."""
    for form in FORMATS:
        if re.match(form.begins, text):
            return form
    raise _no_model("the file's format is unknown", file)


def _no_model(what: str, file: Path) -> ParseError:
    """An error that tells what to do about the file, if its suffix tells what it is."""
    known = advice(file)
    return ParseError(
        f"{what}; {EXPECTED}" + (f". {known[0].upper()}{known[1:]}" if known else ""), file
    )
