"""VTK files (legacy `.vtk`, `.vtp`, `.vtu`) through PyVista, the optional extra `vtk`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidFile, InvalidMesh
from pectinate.io.fields import field_arguments
from pectinate.io.units import decide_unit, to_millimetres
from pectinate.io.vtk_arrays import DatasetArrays
from pectinate.io.vtk_cells import TRIANGLE, find_triangles
from pectinate.io.vtk_library import (
    SUFFIXES,
    faces_of,
    import_pyvista,
    polyline_dataset,
    read_dataset,
    save_dataset,
)
from pectinate.model import SurfaceData

__all__ = ["SUFFIXES", "is_pyvista", "read_vtk", "surface_from_pyvista", "write_streamlines_vtp", "write_vtk"]


def read_vtk(path: Path, *, units: str = "auto", array: str | None = "auto") -> SurfaceData:
    """Read the triangles of a VTK file with their orientation field and region tags.

    Parameters
    ----------
    path
        A legacy `.vtk` (poly data or unstructured grid), `.vtp` or `.vtu` file.
    units
        "auto", "mm", "um", "cm" or "m".
    array
        Name of the array with vectors (3 components) or tensors (6 or 9), among the cell arrays or else the point
        arrays; "auto" looks for `vtk_arrays.FIELD_NAMES`; None for no field.

    Raises
    ------
    MissingDependency
        PyVista is not installed.
    InvalidFile
        The file is missing or malformed, or has no triangle.
    InvalidField
        The named array is not there or has another number of components.
    """
    try:
        return surface_from_pyvista(read_dataset(path), units=units, array=array, source=str(path))
    except InvalidMesh as error:
        raise InvalidFile(str(error)) from error


def surface_from_pyvista(
    dataset: Any, *, units: str = "auto", array: str | None = "auto", source: str = "PyVista object"
) -> SurfaceData:
    """Take the triangles of a `pyvista.PolyData` or `UnstructuredGrid`; parameters as in `read_vtk`.

    Raises
    ------
    InvalidMesh
        It is another kind of data set, has no triangle, or an index is out of range.
    InvalidField
        The named array is not there or has another number of components.
    """
    cells = find_triangles(dataset, source)
    points = np.array(dataset.points, dtype=np.float64)
    decision = decide_unit(points, units)
    arrays = DatasetArrays(dataset, cells, source)
    chosen = None if array is None else arrays.field() if array == "auto" else arrays.named(array)
    only_triangles = cells.others_note is None
    return SurfaceData(
        vertices=to_millimetres(points, decision),
        triangles=cells.triangles,
        units=decision,
        source=source,
        second_vectors=None if chosen is None else arrays.second_vectors(),
        tags=arrays.tags(),
        element_rows=None if only_triangles else cells.rows,
        element_count=None if only_triangles else cells.cell_count,
        notes=(*([] if cells.others_note is None else [cells.others_note]), *arrays.notes),
        **({} if chosen is None else field_arguments(arrays.values(*chosen), chosen[0])),
    )


def write_vtk(  # noqa: PLR0913
    path: Path,
    vertices: NDArray[np.float64],
    triangles: NDArray[np.integer[Any]],
    *,
    vectors: NDArray[np.float64] | None = None,
    second_vectors: NDArray[np.float64] | None = None,
    tags: NDArray[np.int64] | None = None,
    vertex_vectors: NDArray[np.float64] | None = None,
    cell_data: Mapping[str, NDArray[np.float64]] | None = None,
) -> None:
    """Write a surface as `.vtp`, `.vtk` (poly data) or `.vtu`, binary, with cell arrays `fiber`, `sheet`, `elemTag`.

    Parameters are as in `write_opencarp`, with `vertex_vectors` (V, 3) for a point array `fiber`, and more cell arrays.

    Raises
    ------
    MissingDependency
        PyVista is not installed.
    InvalidFile
        It cannot be written.
    """
    pyvista = import_pyvista()
    faces = faces_of(triangles)
    if path.suffix.lower() == ".vtu":
        dataset = pyvista.UnstructuredGrid(faces, np.full(len(triangles), TRIANGLE, np.uint8), vertices)
    else:
        dataset = pyvista.PolyData(vertices, faces)
    arrays = {"fiber": vectors, "sheet": second_vectors, "elemTag": tags, **(cell_data or {})}
    for name, values in arrays.items():
        if values is not None:
            dataset.cell_data[name] = values
    if vertex_vectors is not None:
        dataset.point_data["fiber"] = vertex_vectors
    save_dataset(dataset, path)


def write_streamlines_vtp(
    path: str | os.PathLike[str],
    points: NDArray[np.float64],
    offsets: NDArray[np.int64],
    cell_data: Mapping[str, ArrayLike] | None = None,
    point_data: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write streamlines as polylines.

    Parameters
    ----------
    path
        A `.vtp` or legacy `.vtk` file.
    points
        (N, 3), mm, one streamline after the other.
    offsets
        (n + 1,): streamline i owns points[offsets[i]:offsets[i + 1]].
    cell_data, point_data
        Arrays per streamline, n rows, and per point, N rows, by name.

    Raises
    ------
    MissingDependency
        PyVista is not installed.
    InvalidFile
        It cannot be written.
    """
    save_dataset(polyline_dataset(points, offsets, cell_data, point_data), Path(path))


def is_pyvista(source: object) -> bool:
    """Whether an object is a PyVista data set; does not import PyVista."""
    return type(source).__module__.split(".")[0] == "pyvista"
