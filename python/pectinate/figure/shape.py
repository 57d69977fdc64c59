"""Checked triangles, ready to be drawn from any direction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidMesh
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
    vertex_normals,
)
from pectinate.figure.values import CornerColors, SurfaceValues, corner_colors
from pectinate.figure.views import View

Triangles = tuple[ArrayLike, ArrayLike]
"""Vertices (V, 3) float in mm and triangles (T, 3) int, counter-clockwise seen from outside."""


@dataclass(frozen=True)
class Shape:
    """Triangles with what all views of them share; made by `check_shape`."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    normals: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Layer:
    """Closed tubes in a colour of their own; `line_tubes` makes them of lines.

    Parameters
    ----------
    triangles : (vertices, triangles)
        (V, 3) float in mm and (T, 3) int, counter-clockwise seen from outside.
    color : tuple of 3 float
        Display RGB in full light, 0 to 1.
    """

    triangles: Triangles
    color: Color


@dataclass(frozen=True)
class Surface:
    """A surface with its colour in full light, or the colours of its values."""

    shape: Shape
    color: Color
    colors: CornerColors | None = None


@dataclass(frozen=True)
class Drawing:
    """What pictures show: surfaces, and tubes with the colour of each."""

    surfaces: tuple[Surface, ...]
    tubes: tuple[tuple[Shape, Color], ...]

    @property
    def points(self) -> NDArray[np.float64]:
        """Every vertex that is drawn, (n, 3) float64 in mm."""
        shapes = [surface.shape for surface in self.surfaces] + [shape for shape, _ in self.tubes]
        return np.concatenate([shape.vertices for shape in shapes])

    @property
    def shows_values(self) -> bool:
        """Whether a surface shows values."""
        return any(surface.colors is not None for surface in self.surfaces)

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
    return Drawing((whole,), check_layers([*given, *layers]))


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
    colors = None
    if surface_values is not None:
        vertex_count = len(np.asarray(triangles[0]))
        colors = corner_colors(surface_values, np.asarray(triangles[1]), vertex_count, style.no_value_color)
    return Surface(shape, color, colors)


def check_layers(layers: Sequence[Layer]) -> tuple[tuple[Shape, Color], ...]:
    """Check tubes and their colours; those without triangles are left out."""
    checked = ((check_shape("tubes", layer.triangles), check_color(layer.color)) for layer in layers)
    return tuple((tube, color) for tube, color in checked if tube is not None)


def check_shape(name: str, arrays: Triangles) -> Shape | None:
    """Check triangles and drop the vertices that none of them uses; None without triangles.

    Raises
    ------
    InvalidMesh
        If an array has the wrong shape or type, an index is out of range, or a used vertex is not finite.
    """
    vertices, triangles = np.asarray(arrays[0], dtype=np.float64), np.asarray(arrays[1])
    for what, array in (("vertices", vertices), ("triangles", triangles)):
        if array.ndim != 2 or array.shape[1] != 3:  # noqa: PLR2004
            raise InvalidMesh(f"{name}: {what} of shape {array.shape}; give an array of shape (n, 3)")
    if not len(triangles):
        return None
    if not np.issubdtype(triangles.dtype, np.integer):
        raise InvalidMesh(f"{name}: triangles of type {triangles.dtype}; give whole numbers")
    low, high = triangles.min(), triangles.max()
    if low < 0 or high >= len(vertices):
        raise InvalidMesh(f"{name}: triangles refer to vertices {low} to {high}; there are {len(vertices)} vertices")
    vertices, triangles = _used(vertices, triangles.astype(np.int64))
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        raise InvalidMesh(f"{name}: {np.count_nonzero(~finite)} vertices in use are not finite; remove their triangles")
    return Shape(vertices, triangles, vertex_normals(vertices, triangles))


def patches(drawing: Drawing, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """All that is seen along a view, relative to the middle of the picture."""
    result = []
    for surface in drawing.surfaces:
        result += _surface_patches(surface, view, centre, style)
    for shape, color in drawing.tubes:
        result += _tube_patches(shape, color, view, centre, style)
    return result


def _surface_patches(surface: Surface, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """A surface: outside and inside as patches of their own colours."""
    shape, rotation = surface.shape, view.rotation()
    vertices, normals = (shape.vertices - centre) @ rotation.T, shape.normals @ rotation.T
    faces_viewer = turned_to_viewer(vertices, shape.triangles) >= 0
    facing = shape.triangles[faces_viewer]
    if surface.colors is None:
        outside = Patch(vertices, facing, shaded(surface.color, light(normals, style.edge_darkness)))
    else:
        corners, colors = facing.ravel(), surface.colors.colors[faces_viewer].reshape(-1, 3)
        lit = shaded(colors, value_light(normals[corners], style.edge_darkness))
        # Each triangle has corners of its own, whose colours it does not share with its neighbours.
        outside = Patch(vertices[corners], np.arange(len(corners)).reshape(-1, 3), lit)
    inside = shaded(style.inside_color, light(-normals, style.edge_darkness))
    sides = (outside, Patch(vertices, shape.triangles[~faces_viewer], inside))
    return [patch for patch in sides if len(patch.triangles)]


def _tube_patches(shape: Shape, color: Color, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """The halves of the tubes that face the viewer; the others are hidden, because tubes are closed."""
    rotation = view.rotation()
    vertices, normals = (shape.vertices - centre) @ rotation.T, shape.normals @ rotation.T
    facing = shape.triangles[turned_to_viewer(vertices, shape.triangles) > 0]
    colors = shaded(color, light(normals, 0.0), style.tube_gloss * gloss(normals))
    return [Patch(vertices, facing, colors)] if len(facing) else []


def _used(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    used = np.zeros(len(vertices), dtype=bool)
    used[triangles] = True
    if used.all():
        return vertices, triangles
    return vertices[used], (np.cumsum(used) - 1)[triangles]
