"""Triangles that are known to be good, with their normals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidMesh
from pectinate.figure.shading import vertex_normals

Triangles = tuple[ArrayLike, ArrayLike]
"""Vertices (V, 3) float in mm and triangles (T, 3) int, counter-clockwise seen from outside."""


@dataclass(frozen=True)
class Shape:
    """Triangles with what all views of them share; made by `check_shape`.

    `rows` (V,) int64 are those of the given vertices that triangles use.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    normals: NDArray[np.float32]
    rows: NDArray[np.int64]


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
    triangles = triangles.astype(np.int64)
    used = np.zeros(len(vertices), dtype=bool)
    used[triangles] = True
    vertices, triangles, rows = vertices[used], (np.cumsum(used) - 1)[triangles], np.flatnonzero(used)
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        raise InvalidMesh(f"{name}: {np.count_nonzero(~finite)} vertices in use are not finite; remove their triangles")
    return Shape(vertices, triangles, vertex_normals(vertices, triangles).astype(np.float32), rows)
