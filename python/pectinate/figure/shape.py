"""Checked triangles, ready to be drawn from any direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidMesh
from pectinate.figure.contours import contour_tubes
from pectinate.figure.frame import rotated
from pectinate.figure.offscreen import Patch
from pectinate.figure.shading import (
    Color,
    Style,
    check_color,
    gloss,
    light,
    shaded,
    turned_to_viewer,
    value_light,
)
from pectinate.figure.triangles import Shape, Triangles, check_shape
from pectinate.figure.values import Key, SurfaceValues, ValueColors, corner_colors, vertex_colors
from pectinate.figure.views import View


@dataclass(frozen=True, eq=False)
class Layer:
    """Closed tubes in a colour of their own; `line_tubes` makes them of lines.

    Parameters
    ----------
    triangles : (vertices, triangles)
        (V, 3) float in mm and (T, 3) int, counter-clockwise seen from outside.
    color : tuple of 3 float
        Display RGB in full light, 0 to 1.
    values : SurfaceValues or (V,) float, optional
        Numbers per vertex of the tubes that colour them instead.
    """

    triangles: Triangles
    color: Color
    values: SurfaceValues | ArrayLike | None = None


@dataclass(frozen=True)
class Tubes:
    """Tubes with their colour in full light, or the colours of their values; `calm` ones are lit like values."""

    shape: Shape
    color: Color
    colors: ValueColors | None = None
    calm: bool = False


@dataclass(frozen=True)
class Surface:
    """A surface with its colour in full light, or the colours of its values and their contours."""

    shape: Shape
    color: Color
    colors: ValueColors | None = None
    contours: tuple[Tubes, ...] = ()


@dataclass(frozen=True)
class Drawing:
    """What pictures show: surfaces and tubes."""

    surfaces: tuple[Surface, ...]
    tubes: tuple[Tubes, ...]

    @property
    def points(self) -> NDArray[np.float64]:
        """Every vertex that is drawn but those of contours, (n, 3) float64 in mm."""
        return np.concatenate([drawn.shape.vertices for drawn in self._all])

    @property
    def shows_values(self) -> bool:
        """Whether a surface or a tube shows values."""
        return bool(self.keys)

    @property
    def keys(self) -> list[Key]:
        """What the colours mean, those of surfaces first."""
        return [drawn.colors.key for drawn in self._all if drawn.colors is not None]

    @property
    def _all(self) -> list[Surface | Tubes]:
        return [*self.surfaces, *self.tubes]

    @property
    def diagonal(self) -> float:
        """Of the box of the largest surface, mm."""
        return max(float(np.linalg.norm(np.ptp(surface.shape.vertices, axis=0))) for surface in self.surfaces)


def check_drawing(
    surface: Triangles,
    tubes: Triangles | None,
    layers: Sequence[Layer],
    surface_values: SurfaceValues | ArrayLike | None,
    style: Style,
) -> Drawing:
    """Check what shall be drawn; tubes without triangles count as no tubes.

    Raises
    ------
    InvalidMesh
        If the surface has no triangles, or anything breaks the rules of `check_shape`.
    InvalidOption
        If a colour is none, or the values break the rules of `corner_colors`.
    """
    given = [] if tubes is None else [Layer(tubes, style.tube_color)]
    whole = check_surface("surface", surface, style.surface_color, surface_values, style)
    return Drawing((whole,), check_layers([*given, *layers], style))


def check_surface(
    name: str,
    triangles: Triangles,
    color: Color,
    surface_values: SurfaceValues | ArrayLike | None,
    style: Style,
) -> Surface:
    """Check a surface, which must have triangles, and give its values their colours."""
    shape = check_shape(name, triangles)
    if shape is None:
        raise InvalidMesh(f"the {name} has no triangles: there is nothing to draw")
    if surface_values is None:
        return Surface(shape, color)
    values, vertex_count = SurfaceValues.of(surface_values), len(np.asarray(triangles[0]))
    colors = corner_colors(values, np.asarray(triangles[1]), vertex_count, style.no_value_color)
    lines = contour_tubes(triangles, values)
    tubes = [] if lines is None else [lines.tubes()]
    contours = check_layers([Layer((some.vertices, some.triangles), style.contour_color) for some in tubes], style)
    return Surface(shape, color, colors, tuple(replace(some, calm=True) for some in contours))


def check_layers(layers: Sequence[Layer], style: Style) -> tuple[Tubes, ...]:
    """Check tubes and their colours; those without triangles are left out."""
    checked = (_check_tubes(layer, style) for layer in layers)
    return tuple(tubes for tubes in checked if tubes is not None)


def _check_tubes(layer: Layer, style: Style) -> Tubes | None:
    shape, color = check_shape("tubes", layer.triangles), check_color(layer.color)
    if shape is None:
        return None
    if layer.values is None:
        return Tubes(shape, color)
    colors = vertex_colors(layer.values, len(np.asarray(layer.triangles[0])), style.no_value_color)
    return Tubes(shape, color, ValueColors(colors.colors[shape.rows], colors.key))


def patches(drawing: Drawing, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """All that is seen along a view, relative to the middle of the picture."""
    result = []
    for surface in drawing.surfaces:
        result += _surface_patches(surface, view, centre, style)
    for tubes in (*drawing.tubes, *(lines for surface in drawing.surfaces for lines in surface.contours)):
        result += _tube_patches(tubes, view, centre, style)
    return result


def _surface_patches(surface: Surface, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """A surface: outside and inside as patches of their own colours."""
    triangles, (vertices, normals) = surface.shape.triangles, _seen(surface.shape, view, centre)
    faces_viewer = turned_to_viewer(vertices, triangles) >= 0
    facing = triangles[faces_viewer]
    if surface.colors is None:
        brightness = light(normals, style.edge_darkness)
        outside = Patch(vertices, facing, shaded(surface.color, brightness, style.shadow_color))
    else:
        corners, colors = facing.ravel(), surface.colors.colors[faces_viewer].reshape(-1, 3)
        lit = shaded(colors, value_light(normals[corners], style.edge_darkness))
        # Each triangle has corners of its own, whose colours it does not share with its neighbours.
        outside = Patch(vertices[corners], np.arange(len(corners)).reshape(-1, 3), lit)
    inside = shaded(style.inside_color, light(-normals, style.edge_darkness), style.shadow_color)
    sides = (outside, Patch(vertices, triangles[~faces_viewer], inside))
    return [patch for patch in sides if len(patch.triangles)]


def _tube_patches(tubes: Tubes, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """The halves of the tubes that face the viewer; the others are hidden, because tubes are closed."""
    vertices, normals = _seen(tubes.shape, view, centre)
    facing = tubes.shape.triangles[turned_to_viewer(vertices, tubes.shape.triangles) > 0]
    if tubes.colors is not None or tubes.calm:
        # No gloss, which would be another colour.
        colors = shaded(tubes.color if tubes.colors is None else tubes.colors.colors, value_light(normals, 0.0))
    else:
        highlight = style.tube_gloss * gloss(normals)
        colors = np.minimum(shaded(tubes.color, light(normals, 0.0)) + highlight[:, None], 1.0)
    return [Patch(vertices, facing, colors)] if len(facing) else []


def _seen(shape: Shape, view: View, centre: NDArray[np.float64]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Vertices and normals in picture coordinates, in the single precision in which they are drawn."""
    rotation = view.rotation()
    vertices = rotated((shape.vertices - centre).astype(np.float32), rotation)
    return vertices, rotated(shape.normals, rotation)
