"""A model: named regions, and what its file said beyond them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from decomp.csg.options import OF_REGIONS, Options, checked
from decomp.csg.packing import Packed, packed, unpacked
from decomp.csg.solid import Solid, checked_name, checked_text
from decomp.errors import InputError
from decomp.shown import Shown

EMPTY = "empty: its Boolean expression leaves no interior"


@dataclass(frozen=True, eq=False)
class Region(Shown):
    """A named solid with options, such as `maxh`, the largest edge length wanted in it.

    Args:
        name: of the region.
        solid: what it fills.
        options: by name (`decomp.csg.options.OF_REGIONS`).
        line: of its file that makes it a region, if there is one.

    Raises:
        InputError: it is of no solid; an option is unknown, or its value wrong.
    """

    name: str
    solid: Solid
    options: Mapping[str, Any] = field(default_factory=Options)
    line: int | None = None

    def __post_init__(self) -> None:
        where = f"region {self.name!r}"
        if not isinstance(self.solid, Solid):
            raise InputError(f"{where} must be a solid, got {self.solid!r}")
        object.__setattr__(self, "options", checked(self.options, OF_REGIONS, where))


@dataclass(frozen=True)
class Ignored:
    """A statement that makes no region and is not used; its line, if it stands in a file."""

    statement: str
    line: int | None

    def __str__(self) -> str:
        return self.statement if self.line is None else f"line {self.line}: {self.statement}"


@dataclass(frozen=True, eq=False)
class Model(Shown):
    """One or more regions with disjoint interiors, which may touch.

    Args:
        regions: at least one; names must differ.
        name: what to call the model in reports.
        ignored: statements of the file that were not used.
        source: the file that it was read from, None if from none; no output may replace it.

    Raises:
        InputError: no region, what is none, two of the same name, or a name that cannot be one.
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
        checked_text(self.name, "the model's name")
        counts = Counter(checked_name(region.name) for region in self.regions)
        name, count = counts.most_common(1)[0]
        if count > 1:
            raise InputError(f"{count} regions are named {name!r}: give each its own name")

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied so that regions go on sharing solids."""
        rest = tuple((region.name, region.options, region.line) for region in self.regions)
        solids = packed([region.solid for region in self.regions])
        return _unpickled, (solids, rest, self.name, self.ignored, self.source)


def _unpickled(
    solids: Packed,
    rest: Sequence[tuple[str, Mapping[str, Any], int | None]],
    name: str,
    ignored: tuple[Ignored, ...],
    source: Path | None,
) -> Model:
    regions = (
        Region(each, solid, options, line)
        for solid, (each, options, line) in zip(unpacked(solids), rest, strict=True)
    )
    return Model(tuple(regions), name, ignored, source)


def without_empty(model: Model, empty: Collection[int]) -> Model:
    """The same model without some regions (by index), which have no interior and are ignored."""
    left_out = tuple(
        Ignored(f"region {region.name} ({EMPTY})", region.line)
        for k, region in enumerate(model.regions)
        if k in empty
    )
    kept = tuple(region for k, region in enumerate(model.regions) if k not in empty)
    return Model(kept, model.name, (*model.ignored, *left_out), model.source)


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
