"""Checked triangles, ready to be drawn from any direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidMesh
from pectinate.figure.offscreen import Patch
from pectinate.figure.shading import Style, gloss, light, shaded, triangle_normals, vertex_normals
from pectinate.figure.views import View

Triangles = tuple[ArrayLike, ArrayLike]
"""Vertices (V, 3) float in mm and triangles (T, 3) int, counter-clockwise seen from outside."""


@dataclass(frozen=True)
class Shape:
    """Triangles with what all views of them share; made by `check_shape`."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    normals: NDArray[np.float64]


@dataclass(frozen=True)
class Drawing:
    """What pictures show: a surface, and tubes on it or None."""

    surface: Shape
    tubes: Shape | None

    @property
    def points(self) -> NDArray[np.float64]:
        """Every vertex that is drawn, (n, 3) float64 in mm."""
        return np.concatenate([shape.vertices for shape in (self.surface, self.tubes) if shape is not None])


def check_drawing(surface: Triangles, tubes: Triangles | None) -> Drawing:
    """Check what shall be drawn; tubes without triangles count as no tubes.

    Raises
    ------
    InvalidMesh
        If the surface has no triangles, or anything breaks the rules of `check_shape`.
    """
    shape = check_shape("surface", surface)
    if shape is None:
        raise InvalidMesh("the surface has no triangles: there is nothing to draw")
    return Drawing(shape, None if tubes is None else check_shape("tubes", tubes))


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


def surface_patches(shape: Shape, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """The surface seen along a view: outside and inside as patches of their own colours."""
    rotation = view.rotation()
    vertices, normals = (shape.vertices - centre) @ rotation.T, shape.normals @ rotation.T
    faces_viewer = triangle_normals(vertices, shape.triangles)[:, 2] >= 0
    outside = shaded(style.surface_color, light(normals, style.edge_darkness))
    inside = shaded(style.inside_color, light(-normals, style.edge_darkness))
    sides = ((shape.triangles[faces_viewer], outside), (shape.triangles[~faces_viewer], inside))
    return [Patch(vertices, triangles, colors) for triangles, colors in sides if len(triangles)]


def tube_patches(shape: Shape, view: View, centre: NDArray[np.float64], style: Style) -> list[Patch]:
    """The halves of the tubes that face the viewer; the others are hidden, because tubes are closed."""
    rotation = view.rotation()
    vertices, normals = (shape.vertices - centre) @ rotation.T, shape.normals @ rotation.T
    facing = shape.triangles[triangle_normals(vertices, shape.triangles)[:, 2] > 0]
    colors = shaded(style.tube_color, light(normals, 0.0), style.tube_gloss * gloss(normals))
    return [Patch(vertices, facing, colors)] if len(facing) else []


def _used(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    used = np.zeros(len(vertices), dtype=bool)
    used[triangles] = True
    if used.all():
        return vertices, triangles
    return vertices[used], (np.cumsum(used) - 1)[triangles]
