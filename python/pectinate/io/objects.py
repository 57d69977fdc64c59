"""Surfaces that are in memory already: arrays and trimesh objects."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidMesh
from pectinate.io.units import decide_unit, to_millimetres
from pectinate.model import SurfaceData

_LARGEST_INDEX = 2**31 - 1


def surface_from_arrays(
    vertices: ArrayLike, triangles: ArrayLike, *, units: str = "auto", source: str = "arrays"
) -> SurfaceData:
    """Make a surface of vertices (V, 3), in `units`, and triangles (T, 3), integers.

    Raises
    ------
    InvalidMesh
        The shape or the kind of numbers is wrong. Whether indices are below V is checked where the mesh is made.
    """
    points = _numbers(vertices, "vertices").astype(np.float64)
    corners = _numbers(triangles, "triangles")
    integral = _integers(corners) if corners.dtype.kind == "f" else corners.astype(np.int64)
    decision = decide_unit(points, units)
    return SurfaceData(to_millimetres(points, decision), integral, decision, source)


def _numbers(values: ArrayLike, name: str) -> NDArray[Any]:
    try:
        array: NDArray[Any] = np.asarray(values)
    except ValueError as error:
        raise InvalidMesh(f"{name} are no array ({error}); give n x 3 numbers") from error
    if array.shape[1:] != (3,) or array.dtype.kind not in "fiu":
        raise InvalidMesh(f"{name} have the shape {array.shape} of {array.dtype}; give n x 3 numbers")
    return array


def _integers(corners: NDArray[Any]) -> NDArray[np.int64]:
    good = (corners == np.floor(corners)) & (np.abs(corners) <= _LARGEST_INDEX)
    if not good.all():
        row = int(np.argmin(good.all(axis=1)))
        raise InvalidMesh(f"triangle {row} has the corners {corners[row].tolist()}; use integers")
    return corners.astype(np.int64)
