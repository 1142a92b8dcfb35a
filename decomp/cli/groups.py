"""Names for groups, from the command line and from a file."""

from __future__ import annotations

import argparse
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from decomp.errors import FileError

Given = tuple[str, list[str]]


def named_patterns(text: str) -> Given:
    """`NAME=PATTERN,PATTERN...` as the name and the patterns.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    name, equals, rest = text.partition("=")
    patterns = [each.strip() for each in rest.split(",")]
    if not equals or not name.strip() or not all(patterns):
        raise argparse.ArgumentTypeError(
            f"must be NAME=PATTERN or NAME=PATTERN,PATTERN..., not {text!r}"
        )
    return name.strip(), patterns


def all_groups(given: Iterable[Given], path: Path | None) -> dict[str, list[str]]:
    """Patterns by name, those of a file first; the patterns of one name are put together.

    Raises:
        FileError: the file cannot be read, or holds something else.
    """
    groups = _of_file(path) if path is not None else {}
    for name, patterns in given:
        groups.setdefault(name, []).extend(patterns)
    return groups


def _of_file(path: Path) -> dict[str, list[str]]:
    try:
        values = tomllib.loads(path.read_bytes().decode())
    except OSError as error:
        raise _error(f"cannot be read: {error.strerror or error}", path) from None
    except UnicodeDecodeError:
        raise _error("this is no text in UTF-8", path) from None
    except tomllib.TOMLDecodeError as error:
        raise _error(f"this is no TOML: {error}", path) from None
    groups = {}
    for name, value in values.items():
        patterns = [value] if isinstance(value, str) else value
        right = isinstance(patterns, list) and patterns and name.strip()
        if not right or not all(isinstance(each, str) and each.strip() for each in patterns):
            raise _error(
                f"{name!r} must have a pattern or a list of some, such as "
                f'{name} = ["*/bolt*.side"], not {value!r}',
                path,
            )
        groups[name] = [each.strip() for each in patterns]
    return groups


def _error(message: str, path: Path) -> FileError:
    from decomp.errors import FileError

    return FileError(message, path)
