"""The triangles among the cells of a VTK data set."""

from __future__ import annotations

import importlib
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidMesh

_VERTEX, _LINE, TRIANGLE, _STRIP, _POLYGON = 1, 3, 5, 6, 7  # of VTK's cell types
_NAMES = {_VERTEX: "vertices", _LINE: "lines", _STRIP: "strips", _POLYGON: "polygons", 9: "quadrilaterals"}
_CORNERS = 3


@dataclass(frozen=True, eq=False)
class TriangleCells:
    """What a surface is made of.

    Attributes
    ----------
    triangles
        (T, 3) int64, indices of points.
    rows
        (T,) int64, numbers of the triangles among all cells.
    cell_count
        Number of all cells.
    others_note
        A sentence that counts the cells that are no triangles; None where there are none.
    """

    triangles: NDArray[np.int64]
    rows: NDArray[np.int64]
    cell_count: int
    others_note: str | None


def find_triangles(dataset: Any, source: str) -> TriangleCells:
    """Select the triangles of a `pyvista.PolyData` or `UnstructuredGrid`; polygons and strips of three corners count.

    Nothing that a file says about indices is trusted: VTK would follow it out of its memory.

    Raises
    ------
    InvalidMesh
        It is another kind of data set, has no triangle, or an index is out of range.
    """
    kinds, starts, sizes, connectivity = _all_cells(dataset, source)
    chosen = np.isin(kinds, (TRIANGLE, _STRIP, _POLYGON)) & (sizes == _CORNERS)
    others = Counter(_NAMES.get(kind, f"cells of type {kind}") for kind in kinds[~chosen].tolist())
    listed = ", ".join(f"{count} {name}" for name, count in sorted(others.items()))
    if not chosen.any():
        rule = f"no cell is a triangle ({listed or 'it has no cells'})"
        raise InvalidMesh(f"{source}: {rule}; extract and triangulate the surface first")
    rows = np.flatnonzero(chosen).astype(np.int64)
    triangles = connectivity[starts[rows][:, None] + np.arange(_CORNERS)]
    bad = ((triangles < 0) | (triangles >= dataset.n_points)).any(axis=1)
    if bad.any():
        row = int(np.argmax(bad))
        rule = f"cell {rows[row]} has the corners {triangles[row].tolist()} among {dataset.n_points} points"
        raise InvalidMesh(f"{source}: {rule}; correct the indices")
    note = f"cells that are no triangles were left out: {listed}" if others else None
    return TriangleCells(triangles, rows, len(kinds), note)


def _all_cells(dataset: Any, source: str) -> tuple[NDArray[np.int64], ...]:
    """Type, start and size of each cell, and the connectivity that the starts refer to."""
    if hasattr(dataset, "GetPolys"):
        arrays = [dataset.GetVerts(), dataset.GetLines(), dataset.GetPolys(), dataset.GetStrips()]
    elif hasattr(dataset, "celltypes"):
        arrays = [dataset.GetCells()]
    else:
        raise InvalidMesh(f"{source}: a {type(dataset).__name__} is no surface; give PolyData or an UnstructuredGrid")
    offsets, connectivities = zip(*(_offsets_and_connectivity(array, source) for array in arrays), strict=True)
    bases = np.cumsum([0, *map(len, connectivities)])
    starts = np.concatenate([part[:-1] + base for part, base in zip(offsets, bases, strict=False)])
    sizes = np.concatenate([np.diff(part) for part in offsets])
    if len(arrays) == 1:
        kinds = np.asarray(dataset.celltypes, dtype=np.int64)
    else:  # poly data numbers its cells in this order
        kinds = np.repeat(np.array([_VERTEX, _LINE, _POLYGON, _STRIP]), [len(part) - 1 for part in offsets])
    if len(kinds) != len(sizes):
        raise InvalidMesh(f"{source}: {len(kinds)} types for {len(sizes)} cells; write it again")
    return kinds, starts, sizes, np.concatenate(connectivities)


def _offsets_and_connectivity(cells: Any, source: str) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Where each cell begins and, last, where the last one ends; the indices of points of all cells."""
    if cells is None or cells.GetNumberOfCells() == 0:
        return np.zeros(1, dtype=np.int64), np.empty(0, dtype=np.int64)
    to_numpy = importlib.import_module("vtkmodules.util.numpy_support").vtk_to_numpy
    offsets = to_numpy(cells.GetOffsetsArray()).astype(np.int64)
    connectivity = to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    if offsets[0] != 0 or (np.diff(offsets) < 0).any() or offsets[-1] > len(connectivity):
        raise InvalidMesh(f"{source}: the offsets of its cells do not ascend from 0 to their end; write it again")
    return offsets, connectivity
