"""A model: named regions, and what its file said beyond them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from decomp.csg.options import OF_REGIONS, Options, checked
from decomp.csg.packing import Packed, packed, unpacked
from decomp.csg.solid import Solid, checked_name
from decomp.errors import InputError


@dataclass(frozen=True, eq=False)
class Region:
    """A named solid with options, such as `maxh`, the largest edge length wanted in it.

    Raises:
        InputError: it is of no solid; an option is unknown, or its value wrong
            (`decomp.csg.options.OF_REGIONS`).
    """

    name: str
    solid: Solid
    options: Mapping[str, Any] = field(default_factory=Options)

    def __post_init__(self) -> None:
        where = f"region {self.name!r}"
        if not isinstance(self.solid, Solid):
            raise InputError(f"{where} must be a solid, got {self.solid!r}")
        object.__setattr__(self, "options", checked(self.options, OF_REGIONS, where))


@dataclass(frozen=True)
class Ignored:
    """A statement of a file that makes no region and is not used."""

    statement: str
    line: int


@dataclass(frozen=True, eq=False)
class Model:
    """One or more regions with disjoint interiors, which may touch.

    Args:
        regions: at least one; names must differ.
        name: what to call the model in reports.
        ignored: statements of the file that were not used.
        source: the file that it was read from, None if from none; no output may replace it.

    Raises:
        InputError: no region, what is none, or two of the same name.
    """

    regions: tuple[Region, ...]
    name: str = "model"
    ignored: tuple[Ignored, ...] = ()
    source: Path | None = None

    def __post_init__(self) -> None:
        if not self.regions:
            raise InputError(f"model {self.name!r} has no region: define at least one solid")
        for region in self.regions:
            if not isinstance(region, Region):
                raise InputError(f"{region!r} is no region; decomp.Region(name, solid) makes one")
        counts = Counter(checked_name(region.name) for region in self.regions)
        name, count = counts.most_common(1)[0]
        if count > 1:
            raise InputError(f"{count} regions are named {name!r}: give each its own name")

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied so that regions go on sharing solids."""
        rest = tuple((region.name, region.options) for region in self.regions)
        solids = packed([region.solid for region in self.regions])
        return _unpickled, (solids, rest, self.name, self.ignored)


def _unpickled(
    solids: Packed,
    rest: Sequence[tuple[str, Mapping[str, Any]]],
    name: str,
    ignored: tuple[Ignored, ...],
) -> Model:
    regions = (
        Region(each, solid, options)
        for solid, (each, options) in zip(unpacked(solids), rest, strict=True)
    )
    return Model(tuple(regions), name, ignored)


def model(solids: Solid | dict[str, Solid] | Sequence[Region], name: str = "model") -> Model:
    """Make a model from one solid, from named solids, or from regions.

    A single solid becomes the region `solid`.

    Raises:
        InputError: it is none of these.
    """
    if isinstance(solids, Solid):
        return Model((Region("solid", solids),), name)
    if isinstance(solids, dict):
        return Model(tuple(Region(key, solid) for key, solid in solids.items()), name)
    given: object = solids
    if not isinstance(given, Iterable) or isinstance(given, (str, bytes)):
        raise InputError(
            f"a model is made of a solid, of solids by name, or of regions in a list, got {given!r}"
        )
    return Model(tuple(solids), name)
