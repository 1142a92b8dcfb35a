"""Packages that only some functions need, loaded when these are called."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from decomp.errors import MissingPackageError


def needed(module: str, package: str, what: str) -> Any:
    """A module of a package that may not be installed.

    Args:
        module: to import.
        package: as pip calls it.
        what: needs it, as the subject of a sentence.

    Raises:
        MissingPackageError: it is not installed.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != module.partition(".")[0]:
            raise
        raise MissingPackageError(
            f"{what} needs {package}, which is not installed: pip install {package}"
        ) from None
