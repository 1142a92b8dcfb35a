"""The one hierarchy of errors that users of `decomp` meet.

Library code raises these and never prints or exits; the command line turns each class
into one line on stderr and its `exit_code`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from decomp.places import in_users, place
from decomp.plain import plain

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LONGEST_ERROR = 1000
"""Characters of an error that are shown."""


class DecompError(Exception):
    """Base of every error that `decomp` raises on purpose.

    Its text is one line of bounded length: names out of files are shown with their control
    characters escaped, and very long ones in part.
    """

    exit_code = 1

    def __str__(self) -> str:
        text = str(self.args[0]) if len(self.args) == 1 else super().__str__()
        if len(text) > LONGEST_ERROR:  # a name or a value out of a file is that long
            text = f"{text[: LONGEST_ERROR - 300]} ... {text[-300:]}"
        return plain(text)


class InputError(DecompError):
    """The user's input is wrong: a parameter, a file, a name."""

    exit_code = 2


class UnknownNameError(InputError, KeyError):
    """There is nothing of a name; says which names are near."""


class MissingPackageError(InputError, ImportError):
    """What was asked for needs a package that is not installed; says how to install it."""


class FileError(InputError):
    """A model file cannot be used, at a known place where there is one.

    Args:
        message: what is wrong and what to do about it.
        path: the file, if the text came from one.
        line: 1-based line, if known.
        column: 1-based column, if known.
    """

    def __init__(
        self,
        message: str,
        path: str | Path | None = None,
        line: int | None = None,
        column: int | None = None,
    ) -> None:
        self.message, self.path, self.line, self.column = message, path, line, column
        place = [str(part) for part in (path, line, column) if part is not None]
        super().__init__(f"{':'.join(place)}: {message}" if place else message)


class ParseError(FileError):
    """The text does not follow its format's grammar, or refers to something undefined."""


class UnsupportedError(FileError):
    """A construct lies outside the primitives and similarities that are supported."""


@dataclass(frozen=True)
class Try:
    """What was tried, and how it failed.

    Args:
        what: it was.
        kind: of the error.
        error: its text.
    """

    what: str
    kind: str
    error: str


class GeometryError(DecompError):
    """The model is well-formed, but its geometry is not a solid that can be handled.

    Args:
        message: what is wrong; `{at}` in it stands for the place.
        sites: names of the faces, edges and vertices that are concerned.
        at: (3,) where it is wrong, in the coordinates in which it is computed.

    Attributes:
        sites: as given.
        place: (3,) where it is wrong, in the user's coordinates; None if that is not known.
        stage: of the work in which it arose: `boundary`, `tracing`, `sheets`, `refining`,
            `certificate` or `sampling`; empty if unknown.
        region: the region's name, empty if it is none's or unknown.
        tries: where several ways were tried, all of them; the error's text is the first one's.
    """

    exit_code = 3

    def __init__(
        self, message: str, sites: Iterable[str] = (), at: NDArray[np.float64] | None = None
    ) -> None:
        super().__init__(message if at is None else message.replace("{at}", place(at)))
        self.sites = tuple(sites)
        self.place = None if at is None else in_users(at)
        self.stage, self.region = "", ""
        self.tries: tuple[Try, ...] = ()

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (type(self), self.args, self.__dict__)

    def advised(self, advice: str) -> GeometryError:
        """The same error with what to do about it at its end."""
        return self.retold(f"{self}; {advice}")

    def retold(self, text: str, kind: type[GeometryError] | None = None) -> GeometryError:
        """The same error with another text, and maybe of another kind."""
        result = (kind or GeometryError)(text, self.sites)
        result.place, result.tries = self.place, self.tries
        result.stage, result.region = self.stage, self.region
        return result

    def as_json(self) -> dict[str, Any]:
        """What is known of it, as JSON values."""
        return {
            "kind": type(self).__name__,
            "error": str(self),
            "stage": self.stage,
            "region": self.region,
            "place": self.place,
            "sites": self.sites,
            "tries": [asdict(each) for each in self.tries],
        }


def _unpickled(
    kind: type[GeometryError], args: tuple[Any, ...], state: dict[str, Any]
) -> GeometryError:
    """An error as it was pickled, whatever its kind is made of."""
    error = kind.__new__(kind, *args)
    error.__dict__.update(state)
    return error


class EmptyRegionError(GeometryError):
    """A region has no interior."""


class UnboundedRegionError(GeometryError):
    """A region reaches infinity."""


class OverlapError(GeometryError):
    """Two regions share interior points."""


class ContactError(GeometryError):
    """Parts of a boundary touch in a way that leaves it no manifold."""
