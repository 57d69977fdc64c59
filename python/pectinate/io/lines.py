"""Streamlines with all that is known of them: arrays per line and per point, poly-lines for VTK, a table for pandas."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate._core import StopReason
from pectinate.errors import InvalidOption, MissingDependency
from pectinate.io.vtk_library import polyline_dataset

if TYPE_CHECKING:
    from pectinate.placement import Placement


def line_arrays(placement: Placement) -> dict[str, NDArray[Any]]:
    """Arrays per streamline, by name: its number, length (mm), points, ends and triangles of `mesh`."""
    first, last = placement.offsets[:-1], placement.offsets[1:] - 1
    return {
        "line": np.arange(len(placement)),
        "length": placement.lengths,
        "point_count": np.diff(placement.offsets),
        "stop_reason_first": placement.stop_reasons[:, 0],
        "stop_reason_last": placement.stop_reasons[:, 1],
        "triangle_first": placement.point_triangles[first],
        "triangle_last": placement.point_triangles[last],
        "triangle_seed": placement.point_triangles[placement.seed_points],
    }


def point_arrays(placement: Placement, values: Mapping[str, ArrayLike] | None = None) -> dict[str, NDArray[Any]]:
    """Arrays per point of the streamlines, by name, and values of the surface there.

    Parameters
    ----------
    placement
        The streamlines.
    values
        Numbers per triangle (T,) or vertex (V,) of `mesh`; between vertices they are interpolated.

    Raises
    ------
    InvalidOption
        There is not one number per triangle or vertex.
    """
    triangles = placement.point_triangles
    arrays: dict[str, NDArray[Any]] = {
        "line": np.repeat(np.arange(len(placement)), np.diff(placement.offsets)),
        "arc_length": _arc_lengths(placement),
        "triangle": triangles,
        "input_triangle": placement.mesh.input_triangle[triangles],
        "barycentric": placement.barycentric,
    }
    return arrays | {name: _at_points(placement, name, given) for name, given in (values or {}).items()}


def to_polylines(placement: Placement, values: Mapping[str, ArrayLike] | None = None) -> Any:
    """Make a PyVista data set of poly-lines with `line_arrays` per cell and `point_arrays` per point.

    Raises
    ------
    MissingDependency
        PyVista is not installed.
    InvalidOption
        As `point_arrays`.
    """
    per_point = point_arrays(placement, values)
    dataset = polyline_dataset(placement.points, placement.offsets, line_arrays(placement), per_point)
    dataset.field_data["stop_reason_names"] = [reason.name for reason in sorted(StopReason)]
    return dataset


def to_table(placement: Placement, values: Mapping[str, ArrayLike] | None = None) -> Any:
    """Make a pandas table with a row per streamline: `line_arrays`, stop reasons by name, and means of values.

    Raises
    ------
    MissingDependency
        pandas is not installed.
    InvalidOption
        As `point_arrays`.
    """
    pandas = _import_pandas()
    columns = line_arrays(placement)
    names = [reason.name for reason in sorted(StopReason)]
    for column in ("stop_reason_first", "stop_reason_last"):
        columns[column] = pandas.Categorical.from_codes(columns[column].astype(np.int8), names)
    table = pandas.DataFrame(columns).set_index("line")
    per_point = point_arrays(placement, values)
    for name in values or {}:
        table[name] = _means(placement, per_point["arc_length"], per_point[name])
    return table


def _import_pandas() -> Any:
    try:
        return importlib.import_module("pandas")
    except ImportError as error:
        remedy = "install it with: pip install pectinate[tables]"
        raise MissingDependency(f"tables need pandas ({error}); {remedy}") from error


def _arc_lengths(placement: Placement) -> NDArray[np.float64]:
    """Length from the first point of its line to each point, (N,), mm."""
    steps = np.linalg.norm(np.diff(placement.points, axis=0, prepend=placement.points[:1]), axis=1)
    steps[placement.offsets[:-1]] = 0.0
    sums = np.cumsum(steps)
    return np.asarray(sums - np.repeat(sums[placement.offsets[:-1]], np.diff(placement.offsets)))


def _at_points(placement: Placement, name: str, values: ArrayLike) -> NDArray[np.float64]:
    array, mesh = np.asarray(values, dtype=np.float64), placement.mesh
    if array.shape == (mesh.triangle_count,):
        return np.asarray(array[placement.point_triangles])
    if array.shape == (len(mesh.vertices),):
        corners = array[mesh.triangles[placement.point_triangles]]
        # A corner without weight takes no part, even if it is NaN.
        return np.asarray(np.where(placement.barycentric != 0, placement.barycentric * corners, 0.0).sum(axis=1))
    raise InvalidOption(
        f"values {name!r} of shape {array.shape}: give one number per triangle ({mesh.triangle_count},) or vertex "
        f"({len(mesh.vertices)},) of the mesh"
    )


def _means(placement: Placement, arcs: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean of values (N,) along each line, by length."""
    within = np.ones(max(len(values) - 1, 0), dtype=bool)
    within[placement.offsets[1:-1] - 1] = False
    pieces = (0.5 * (values[1:] + values[:-1]) * np.diff(arcs))[within]
    starts = placement.offsets[:-1] - np.arange(len(placement))
    return np.add.reduceat(pieces, starts) / placement.lengths if len(placement) else np.zeros(0)
