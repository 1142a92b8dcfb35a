"""What is tried again when it fails: ways as data, and a failure that keeps its first cause."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Generic, TypeVar

from decomp.errors import GeometryError, Try

T = TypeVar("T")


@dataclass(frozen=True)
class Way(Generic[T]):
    """A way to get something.

    Args:
        what: it is, or changes: `steps of at most 0.005`.
        run: gets it.
        after: errors of this way after which the next one is tried.
    """

    what: str
    run: Callable[[], T]
    after: tuple[type[GeometryError], ...] = (GeometryError,)


def first_of(ways: Iterable[Way[T]]) -> T:
    """What the first way that does not fail gives.

    Args:
        ways: at least one; later ones are asked for only where the ones before have failed.

    Raises:
        GeometryError: the first way's error, with what every way said (`GeometryError.tries`).
    """
    failed: list[tuple[str, GeometryError]] = []
    for way in ways:
        try:
            return way.run()
        except GeometryError as error:
            failed.append((way.what, error))
            if not isinstance(error, way.after):
                break
    raise first_cause(failed)


def first_cause(failed: Sequence[tuple[str, GeometryError]]) -> GeometryError:
    """The first of some errors, which knows what was tried after it, and what that gave."""
    _, first = failed[0]
    tries: list[Try] = []
    for what, error in failed:
        tries.append(Try(what, type(error).__name__, str(error)))
        tries += [Try(f"{what}: {each.what}", each.kind, each.error) for each in error.tries]
    first.tries = tuple(tries) if len(tries) > 1 else ()
    return first


@contextmanager
def stage(name: str, region: str = "") -> Iterator[None]:
    """Have errors of geometry know in which stage, and of which region, they arose."""
    try:
        yield
    except GeometryError as error:
        error.stage, error.region = error.stage or name, error.region or region
        raise
