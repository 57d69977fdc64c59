"""Orientation fields that come apart from their surface: arrays, `.npy` and `.lon` files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidField, InvalidFile, InvalidOption
from pectinate.io.opencarp import read_lon
from pectinate.model import Location, SurfaceData

FIELD_SUFFIXES = (".lon", ".npy")

_VECTOR_WIDTH, _TENSOR_WIDTH, _MATRIX_WIDTH = 3, 6, 9


def without_field(data: SurfaceData) -> SurfaceData:
    """Take the vectors and tensors away."""
    return replace(data, vectors=None, tensors=None, second_vectors=None, vector_location="triangle")


def with_field(data: SurfaceData, field: ArrayLike, location: str = "auto") -> SurfaceData:
    """Give a surface the field of an array.

    Parameters
    ----------
    data
        The surface; a field that it has is replaced.
    field
        Vectors (n, 3) or symmetric tensors (n, 6: xx, yy, zz, xy, yz, xz; (n, 9) or (n, 3, 3): whole matrices), with
        n the number of triangles or of vertices of the source.
    location
        "triangle" or "vertex"; "auto" decides by n and is refused where both numbers are the same.

    Raises
    ------
    InvalidField
        The shape does not fit, or "auto" cannot decide.
    InvalidOption
        Another `location`.
    """
    table = _as_table(field)
    place = _location(data, len(table), location)
    return replace(without_field(data), **field_arguments(table, place))


def with_field_file(data: SurfaceData, path: Path, location: str = "auto") -> SurfaceData:
    """Give a surface the field of a `.npy` file (an array as in `with_field`) or of a `.lon` file (a row per element).

    Raises
    ------
    InvalidFile
        The file is missing or malformed.
    InvalidField, InvalidOption
        As in `with_field`.
    """
    if path.suffix.lower() == ".lon":
        count = len(data.triangles) if data.element_count is None else data.element_count
        vectors, second = read_lon(path, count, data.element_rows)
        return replace(without_field(data), vectors=vectors, second_vectors=second)
    try:
        array = np.load(path, allow_pickle=False)
    except FileNotFoundError:
        raise InvalidFile.at(path, "there is no such file", "check the path") from None
    except (OSError, ValueError, EOFError) as error:
        raise InvalidFile.at(path, f"is no array ({error})", "write it with numpy.save") from error
    try:
        return with_field(data, array, location)
    except InvalidField as error:
        raise InvalidField(f"{path}: {error}") from error


def field_arguments(table: NDArray[np.float64], location: Location) -> dict[str, Any]:
    """Make the arguments of `SurfaceData` of vectors (n, 3), tensors (n, 6) or matrices (n, 9)."""
    if table.shape[1] == _VECTOR_WIDTH:
        return {"vectors": table, "vector_location": location}
    return {"tensors": _symmetric_components(table), "vector_location": location}


def _symmetric_components(tensors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Tensors (n, 6) as they are, or the symmetric part of matrices (n, 9) as xx, yy, zz, xy, yz, xz."""
    if tensors.shape[1] == _TENSOR_WIDTH:
        return tensors
    rows, columns = [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]
    matrices = tensors.reshape(-1, 3, 3)
    return (matrices[:, rows, columns] + matrices[:, columns, rows]) / 2


def _as_table(field: ArrayLike) -> NDArray[np.float64]:
    try:
        array: NDArray[Any] = np.asarray(field)
        if array.dtype.kind not in "fiu":
            raise TypeError(f"dtype {array.dtype}")
        table = np.array(array, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidField(f"the field is no array of real numbers ({error}); give floats") from error
    if table.shape[1:] == (3, 3):
        table = table.reshape(-1, _MATRIX_WIDTH)
    if table.shape[1:] not in ((_VECTOR_WIDTH,), (_TENSOR_WIDTH,), (_MATRIX_WIDTH,)):
        raise InvalidField(f"the field has the shape {table.shape}; give n x 3 vectors, or n x 6 or n x 9 tensors")
    return table


def _location(data: SurfaceData, count: int, location: str) -> Location:
    counts: dict[Location, int] = {"triangle": len(data.triangles), "vertex": len(data.vertices)}
    if location not in ("auto", *counts):
        raise InvalidOption(f"field_location = {location!r} is not known; use one of: auto, triangle, vertex")
    fitting = [place for place in counts if location in ("auto", place) and counts[place] == count]
    if not fitting:
        rule = f"the field has {count} rows, the surface {counts['triangle']} triangles and {counts['vertex']} vertices"
        raise InvalidField(f"{rule}; give one row per triangle or per vertex, in the order of the source")
    if len(fitting) > 1:
        rule = f"the field has {count} rows, the surface as many triangles as vertices"
        raise InvalidField(f"{rule}; say field_location='triangle' or 'vertex'")
    return fitting[0]
