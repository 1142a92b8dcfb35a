"""A scene in a window of PyVista's: turn, explode, slice, point at parts to see their names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from decomp.drawing.colouring import shown
from decomp.drawing.scene import Part, Scene
from decomp.vectors import Array

EXPLODED = 0.8
"""The farthest that parts are moved out, in parts of their distance from the middle."""
CREASE = 25.0
"""Lines are drawn where triangles of skeletons meet at more than this angle in degrees."""
DRAWN_NEARER = -4.0
"""Lines are drawn as if nearer to the eye by so many steps, in front of their surface."""
HELP = "drag: turn   wheel: zoom   x, y, z: slice across   q: close"


@dataclass(frozen=True, eq=False)
class Shown:
    """A part in the window: its actors (surface and lines) and the way from the middle to it."""

    name: str
    actors: tuple[Any, ...]
    way: Array


class Window:
    """All parts of a scene in a `pyvista.Plotter`: sheets (else cells) opaque, faces as glass.

    Args:
        scene: to show.
        pyvista: the module.
        options: of the plotter.

    Attributes:
        plotter: `plotter.show()` opens the window.
        shown: the parts in it, with their actors.
    """

    def __init__(self, scene: Scene, pyvista: Any, **options: Any) -> None:
        self.plotter = pyvista.Plotter(title=f"{scene.title} - decomp", **options)
        self._pyvista = pyvista
        self._points = scene.points
        self._low, self._high = scene.points.min(axis=0), scene.points.max(axis=0)
        self._plane = _plane()
        self._axis, self._share = 1, 1.0
        self.shown = self._parts(scene)
        self._names = {actor: part.name for part in self.shown for actor in part.actors[:1]}
        self.plotter.add_axes(viewport=(0.0, 0.0, 0.18, 0.18))
        self.plotter.add_text(HELP, position="upper_edge", font_size=8, color="#555555")
        self._add_controls()
        self.slice(1.0)
        self.plotter.view_isometric()
        self.plotter.camera.zoom(0.85)

    def explode(self, share: float) -> None:
        """Move the parts away from the middle, by a share of REACH."""
        for part in self.shown:
            for actor in part.actors:
                actor.position = share * EXPLODED * part.way
        self.plotter.render()

    def slice(self, share: float) -> None:
        """Hide what lies beyond a share of the extent along the axis that is chosen."""
        self._share = share
        extent = self._high[self._axis] - self._low[self._axis]
        origin, normal = np.zeros(3), np.zeros(3)
        # a little more than all of it, so that nothing that is whole is scratched
        origin[self._axis] = self._low[self._axis] + (1.01 * share - 0.005) * extent
        normal[self._axis] = -1.0
        self._plane.SetOrigin(*origin)
        self._plane.SetNormal(*normal)
        self.plotter.render()

    def slice_across(self, axis: int) -> None:
        """Choose the axis (0, 1, 2) that is sliced across."""
        self._axis = axis
        self.slice(self._share)

    def name_at(self, x: int, y: int) -> str:
        """What is seen at a pixel, counted from the lower left; nothing if it is background."""
        self._picker.Pick(x, y, 0, self.plotter.renderer)
        return self._names.get(self._picker.GetActor(), "")

    def _parts(self, scene: Scene) -> tuple[Shown, ...]:
        is_mesh = scene.body is not None
        found = [self._part(each.part, each.colour, is_mesh) for each in shown(scene)]
        if scene.opaque == "sheet":
            for part in scene.parts:
                if part.group == "face":
                    self.plotter.add_mesh(
                        self._surface(part), color="#999999", opacity=0.15, pickable=False
                    )
        return tuple(found)

    def _part(self, part: Part, colour: str, is_mesh: bool) -> Shown:
        surface = self._surface(part)
        actors = [self.plotter.add_mesh(surface, color=colour, ambient=0.25)]
        lines = surface.clean()
        lines = lines.extract_all_edges() if is_mesh else lines.extract_feature_edges(CREASE)
        if lines.n_cells:
            drawn = self.plotter.add_mesh(lines, color="#333333", line_width=1, pickable=False)
            drawn.mapper.SetResolveCoincidentTopologyToPolygonOffset()
            drawn.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, DRAWN_NEARER)
            actors.append(drawn)
        for actor in actors:
            actor.mapper.AddClippingPlane(self._plane)
        box = self._points[part.triangles].reshape(-1, 3)
        centre = (box.min(axis=0) + box.max(axis=0)) / 2
        return Shown(part.name, tuple(actors), centre - (self._low + self._high) / 2)

    def _surface(self, part: Part) -> Any:
        corners = self._points[part.triangles].reshape(-1, 3)
        triangles = np.arange(len(corners)).reshape(-1, 3)
        return self._pyvista.PolyData.from_regular_faces(corners, triangles)

    def _add_controls(self) -> None:
        from vtkmodules.vtkRenderingCore import vtkCellPicker

        self._picker = vtkCellPicker()
        self._picker.SetTolerance(0.0)
        self._add_slider("explode", self.explode, 0.0, 0.22)
        self._add_slider("slice", self.slice, 1.0, 0.54)
        for axis, key in enumerate("xyz"):
            self.plotter.add_key_event(key, lambda axis=axis: self.slice_across(axis))
        if self.plotter.iren is not None:
            self.plotter.iren.add_observer("MouseMoveEvent", self._hover)

    def _add_slider(self, title: str, act: Any, value: float, left: float) -> None:
        """A slim slider at the lower edge; what it does is told below it."""
        widget = self.plotter.add_slider_widget(
            act,
            (0.0, 1.0),
            value=value,
            title=title,
            pointa=(left, 0.07),
            pointb=(left + 0.24, 0.07),
            title_height=0.02,
            slider_width=0.02,
            tube_width=0.008,
            color="#555555",
            interaction_event="always",
        )
        widget.GetRepresentation().ShowSliderLabelOff()

    def _hover(self, *_: Any) -> None:
        name = self.name_at(*self.plotter.iren.get_event_position())
        self.plotter.add_text(name or " ", position="upper_left", font_size=10, name="hovered")


def _plane() -> Any:
    from vtkmodules.vtkCommonDataModel import vtkPlane

    return vtkPlane()
