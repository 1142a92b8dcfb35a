"""A model: named regions, and what its file said beyond them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from decomp.csg.solid import Options, Solid, checked_name, no_options
from decomp.errors import InputError


@dataclass(frozen=True, eq=False)
class Region:
    """A named solid with the options its file gave it (`maxh`, `bc`, `col`, `material`...)."""

    name: str
    solid: Solid
    options: Options = field(default_factory=no_options)


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
        InputError: no region, or two of the same name.
    """

    regions: tuple[Region, ...]
    name: str = "model"
    ignored: tuple[Ignored, ...] = ()
    source: Path | None = None

    def __post_init__(self) -> None:
        if not self.regions:
            raise InputError(f"model {self.name!r} has no region: define at least one solid")
        counts = Counter(checked_name(region.name) for region in self.regions)
        name, count = counts.most_common(1)[0]
        if count > 1:
            raise InputError(f"{count} regions are named {name!r}: give each its own name")


def model(solids: Solid | dict[str, Solid] | Sequence[Region], name: str = "model") -> Model:
    """Make a model from one solid, from named solids, or from regions.

    A single solid becomes the region `solid`.

    Raises:
        InputError: these are no solids, a name cannot be one, or there is no region.
    """
    if isinstance(solids, Solid):
        return Model((Region("solid", solids),), name)
    if isinstance(solids, dict):
        regions = tuple(Region(key, solid) for key, solid in solids.items())
    elif isinstance(solids, Sequence) and all(isinstance(region, Region) for region in solids):
        regions = tuple(solids)
    else:
        raise InputError(
            f"a model is made of a solid, of named solids or of regions, not {solids!r}"
        )
    for region in regions:
        if not isinstance(region.name, str) or not isinstance(region.solid, Solid):
            raise InputError(f"{region.name!r}: {region.solid!r} is no named solid")
    return Model(regions, name)
