"""The complexes that meshes conform to, from skeletons found in either way."""

from __future__ import annotations

from collections.abc import Callable

from decomp.errors import ContactError, GeometryError
from decomp.geometry import Geometry
from decomp.meshing.surface.surface import MeshSurface, SurfaceMaker, Surfaces
from decomp.sampled.sampling import sampled_skeleton
from decomp.sampled.surfaces import SampledSurfaces
from decomp.tolerance import CHORDS
from decomp.ways.skeleton import Method, sampled_where_refused

Progress = Callable[[str, float], None]


def surfaces_by(method: Method) -> Surfaces:
    """What makes the complexes of a model.

    Args:
        method: how the skeleton is found, as of `decomp.skeleton`.
    """
    ways: dict[Method, Surfaces] = {
        "traced": SurfaceMaker,
        "sampled": _sampled,
        "auto": _Auto,
    }
    return ways[method]


def _sampled(geometry: Geometry, tell: Progress) -> SampledSurfaces:
    return SampledSurfaces(geometry, sampled_skeleton(geometry, CHORDS, tell))


class _Auto:
    """Traced, and sampled from where that fails."""

    def __init__(self, geometry: Geometry, tell: Progress) -> None:
        self._geometry, self._tell = geometry, tell
        self._sampled: SampledSurfaces | None = None
        self._traced: SurfaceMaker | None = None
        try:
            self._traced = SurfaceMaker(geometry, tell)
        except ContactError:
            raise
        except GeometryError as error:
            self._sample(error)

    def made(self, tolerance: float, by_face: bool) -> MeshSurface:
        """As of `SurfaceMaker`.

        Raises:
            GeometryError: neither way gives a skeleton; says what tracing did.
        """
        if self._sampled is None:
            assert self._traced is not None
            try:
                return self._traced.made(tolerance, by_face)
            except GeometryError as error:
                self._sample(error)
        assert self._sampled is not None
        return self._sampled.made(tolerance, by_face)

    def _sample(self, cause: GeometryError) -> None:
        found = sampled_where_refused(self._geometry, CHORDS, self._tell, cause)
        self._sampled = SampledSurfaces(self._geometry, found)
