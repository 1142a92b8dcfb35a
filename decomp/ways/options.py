"""What users ask of a mesh, as one value: the same for the command line, a batch and Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from decomp.meshes.grouping import Volumes
    from decomp.meshing.preparation import Cells
    from decomp.vectors import Array
    from decomp.ways.skeleton import Method

    SizeAt = Sequence[tuple[Any, ...]]
    SizeEverywhere = Callable[[Array], Array] | tuple[ArrayLike, ArrayLike]
    Groups = Mapping[str, str | Sequence[str]]


@dataclass(frozen=True, eq=False)
class MeshOptions:
    """The options of `decomp.mesh`, which tells what each is, and checks them."""

    size: float | None = None
    sizes: Mapping[str, float] | None = None
    size_at: SizeAt | None = None
    size_field: SizeEverywhere | None = None
    layers: int | None = None
    elements_per_circle: float | None = None
    order: int = 1
    cells: Cells = "skeleton"
    volumes: Volumes = "regions"
    sheets: bool = False
    groups: Groups | None = None
    split_faces: bool = False
    edges: bool = False
    fields: Sequence[str] = ()
    timeout: float | None = None
    method: Method = "traced"

    @property
    def with_cells(self) -> bool:
        """Whether the mesh has cells."""
        return self.cells != "none"
