"""A model: named regions, and what its file said beyond them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

from decomp.csg.solid import Options, Solid, checked_name, checked_text, no_options
from decomp.errors import InputError

EMPTY = "empty: its Boolean expression leaves no interior"


@dataclass(frozen=True, eq=False)
class Region:
    """A named solid with the options its file gave it (`maxh`, `bc`, `col`, `material`...).

    Args:
        name: of the region.
        solid: what it fills.
        options: by name.
        line: of its file that makes it a region, if there is one.
    """

    name: str
    solid: Solid
    options: Options = field(default_factory=no_options)
    line: int | None = None


@dataclass(frozen=True)
class Ignored:
    """A statement that makes no region and is not used; its line, if it stands in a file."""

    statement: str
    line: int | None

    def __str__(self) -> str:
        return self.statement if self.line is None else f"line {self.line}: {self.statement}"


@dataclass(frozen=True, eq=False)
class Model:
    """One or more regions with disjoint interiors, which may touch.

    Args:
        regions: at least one; names must differ.
        name: what to call the model in reports.
        ignored: statements of the file that were not used.

    Raises:
        InputError: no region, two of the same name, or a name that cannot be one.
    """

    regions: tuple[Region, ...]
    name: str = "model"
    ignored: tuple[Ignored, ...] = ()

    def __post_init__(self) -> None:
        if not self.regions:
            raise InputError(f"model {self.name!r} has no region: define at least one solid")
        checked_text(self.name, "the model's name")
        counts = Counter(checked_name(region.name) for region in self.regions)
        name, count = counts.most_common(1)[0]
        if count > 1:
            raise InputError(f"{count} regions are named {name!r}: give each its own name")


def without_empty(model: Model, empty: Collection[int]) -> Model:
    """The same model without some regions (by index), which have no interior and are ignored."""
    left_out = tuple(
        Ignored(f"region {region.name} ({EMPTY})", region.line)
        for k, region in enumerate(model.regions)
        if k in empty
    )
    kept = tuple(region for k, region in enumerate(model.regions) if k not in empty)
    return Model(kept, model.name, (*model.ignored, *left_out))


def model(solids: Solid | dict[str, Solid] | Sequence[Region], name: str = "model") -> Model:
    """Make a model from one solid, from named solids, or from regions.

    A single solid becomes the region `solid`.
    """
    if isinstance(solids, Solid):
        return Model((Region("solid", solids),), name)
    if isinstance(solids, dict):
        return Model(tuple(Region(key, solid) for key, solid in solids.items()), name)
    return Model(tuple(solids), name)
