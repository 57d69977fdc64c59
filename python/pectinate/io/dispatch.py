"""The two doors: `load` anything that is a surface, `save_surface` to any format."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidField, InvalidFile, InvalidMesh, InvalidOption
from pectinate.io import fields, opencarp, trimesh_io, vtk
from pectinate.io.objects import surface_from_arrays
from pectinate.io.units import from_millimetres
from pectinate.model import Model, SurfaceData

_PATH_KINDS = (str, os.PathLike)
_SUFFIXES = (*opencarp.SUFFIXES, *vtk.SUFFIXES, *trimesh_io.SUFFIXES)
_SECOND = ("given", "none", "transverse", "normal")


def load(source: Any, *, units: str = "auto", field: Any = "auto", field_location: str = "auto") -> Model:
    """Load a surface with its orientation field, in millimetres.

    Parameters
    ----------
    source
        A file: openCARP (`.pts`, `.elem` or `.lon`, or the stem they share), VTK (`.vtp`, `.vtu`, `.vtk`, with the
        extra `vtk`), `.ply`, `.obj`, `.off`, `.stl`, `.glb`. Or arrays: a tuple (vertices (V, 3), triangles (T, 3))
        or (vertices, triangles, field). Or a trimesh or PyVista object. A `Model` is returned as it is.
    units
        Unit of the source: "auto" (a bounding box diagonal above 1000 means micrometres, else millimetres), "mm",
        "um", "cm" or "m". The decision is in `Model.data.units`.
    field
        "auto": what the source holds. None: no field. The name of an array of a VTK source. The path of a `.lon` or
        `.npy` file. An array: vectors (T, 3) or (V, 3), tensors (T, 6) or (V, 6) with xx, yy, zz, xy, yz, xz, per
        triangle or per vertex of the source.
    field_location
        "triangle" or "vertex" for an array or `.npy` file; "auto" decides by the number of rows.

    Raises
    ------
    InvalidFile
        A file is missing, malformed or of an unknown kind.
    InvalidMesh
        Arrays that are no surface.
    InvalidField
        A field that does not fit the surface, or gives no triangle a direction.
    InvalidOption
        An option out of its range.
    MissingDependency
        A VTK source without PyVista.
    """
    if isinstance(source, Model):
        return source
    choice = _choose_field(source, field)
    data = _read(source, units, choice.array)
    if choice.file is not None:
        data = fields.with_field_file(data, choice.file, field_location)
    elif choice.values is not None:
        data = fields.with_field(data, choice.values, field_location)
    return Model.from_data(data)


def save_surface(  # noqa: PLR0913
    model: Model,
    path: str | os.PathLike[str],
    *,
    units: str = "auto",
    second: str = "given",
    per_vertex: bool = False,
    cell_data: Mapping[str, NDArray[np.float64]] | None = None,
) -> list[Path]:
    """Write what a model's source held, in the order of the source, in the format that the suffix names.

    openCARP (`.pts`, `.elem`, `.lon`) and VTK files (`.vtp`, `.vtu`, `.vtk`) hold vectors, second vectors and tags per
    triangle; `.ply`, `.obj`, `.off`, `.stl` and `.glb` the surface alone. Vectors per vertex and tensors are written
    as the unit direction that they give each triangle, zero where they give none.

    Parameters
    ----------
    model
        What to write.
    path
        The file; of openCARP any of the three.
    units
        "mm", "um", "cm" or "m"; "auto" writes openCARP in micrometres, as its solvers want it, all else in millimetres.
        (State the unit when you load a surface of less than 1 mm again: "auto" takes it for millimetres.)
    second
        Second vector of each triangle: "given", that of the source if there is one; "none"; "transverse", in the
        surface across the fibre; "normal", the outward normal. With the last two, fibres are written as unit vectors
        in the surface.
    per_vertex
        VTK files get the field per vertex too, as a point array `fiber`; see `Model.vertex_directions`.
    cell_data
        More arrays for VTK files, (T, ...) float per mesh triangle by name; NaN where the mesh has no such triangle.
        Left out in other formats.

    Returns
    -------
    The files written.

    Raises
    ------
    InvalidFile
        The suffix is unknown or the file cannot be written.
    InvalidOption
        An unknown unit or kind of second vector.
    InvalidField
        Second vectors or vectors per vertex of a surface without a field.
    MissingDependency
        A VTK file without PyVista.
    """
    path = Path(path)
    suffix, data = path.suffix.lower(), model.data
    if suffix not in _SUFFIXES:
        raise _unknown_suffix(path)
    if units == "auto":
        units = "um" if suffix in opencarp.SUFFIXES else "mm"
    vertices = from_millimetres(data.vertices, units)
    if suffix in trimesh_io.SUFFIXES:
        trimesh_io.write_trimesh(path, vertices, data.triangles)
        return [path]
    vectors, second_vectors = _vector_pair(model, second)
    extras = {"vectors": vectors, "second_vectors": second_vectors}
    if suffix in opencarp.SUFFIXES:
        return opencarp.write_opencarp(path, vertices, data.triangles, tags=data.tags, **extras)
    vtk.write_vtk(
        path,
        vertices,
        data.triangles,
        tags=data.tags,
        vertex_vectors=model.vertex_directions() if per_vertex else None,
        cell_data={name: model.per_input_triangle(values) for name, values in (cell_data or {}).items()},
        **extras,
    )
    return [path]


@dataclass(frozen=True)
class _FieldChoice:
    """Where the field comes from: the source ("auto", or an array's name), a file or values."""

    array: str | None = None
    file: Path | None = None
    values: ArrayLike | None = None


def _choose_field(source: Any, field: Any) -> _FieldChoice:
    if isinstance(source, tuple) and isinstance(field, str) and field == "auto":
        return _FieldChoice(array="auto", values=source[2] if source[2:] else None)
    if field is None:
        return _FieldChoice()
    if isinstance(field, _PATH_KINDS):
        path = Path(field)
        if path.suffix.lower() in fields.FIELD_SUFFIXES or not isinstance(field, str):
            return _FieldChoice(file=path)
        return _FieldChoice(array=str(field))
    return _FieldChoice(values=field)


def _read(source: Any, units: str, array: str | None) -> SurfaceData:
    if vtk.is_pyvista(source):
        return vtk.surface_from_pyvista(source, units=units, array=array)
    path = Path(source) if isinstance(source, _PATH_KINDS) else None
    if path is not None and path.suffix.lower() in vtk.SUFFIXES:
        return vtk.read_vtk(path, units=units, array=array)
    if array not in ("auto", None):
        rule = f"field = {array!r} is the name of an array, and only VTK sources have names"
        raise InvalidOption(f"{rule}; give the array itself, or a .npy or .lon file")
    return _read_object(source, units) if path is None else _read_file(path, units, array)


def _read_file(path: Path, units: str, array: str | None) -> SurfaceData:
    if path.suffix.lower() in trimesh_io.SUFFIXES:
        return trimesh_io.read_trimesh(path, units=units)
    if path.suffix in opencarp.SUFFIXES or path.with_name(f"{path.name}.elem").exists():
        return opencarp.read_opencarp(path, units=units, lon=array)
    raise _unknown_suffix(path)


def _read_object(source: Any, units: str) -> SurfaceData:
    if isinstance(source, tuple) and len(source) in (2, 3):
        return surface_from_arrays(source[0], source[1], units=units)
    if type(source).__module__.split(".")[0] == "trimesh":
        return trimesh_io.surface_from_trimesh(source, units=units)
    kinds = "a path, (vertices, triangles[, field]), a trimesh or PyVista object"
    raise InvalidMesh(f"a {type(source).__name__} is no surface; give {kinds}")


def _unknown_suffix(path: Path) -> InvalidFile:
    rule = f"the suffix {path.suffix!r} is unknown" if path.suffix else "there is no suffix"
    if not path.exists() and not path.suffix:
        rule = f"there is no {path.name}.elem"
    return InvalidFile.at(path, rule, f"use one of {', '.join(_SUFFIXES)}")


def _vector_pair(model: Model, second: str) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | None]:
    """Vectors and second vectors per triangle of the source."""
    if second not in _SECOND:
        raise InvalidOption(f"second = {second!r} is not known; use one of: {', '.join(_SECOND)}")
    if second in ("given", "none"):
        return _triangle_vectors(model), model.data.second_vectors if second == "given" else None
    if model.field is None:
        raise InvalidField(
            f"{model.data.source} has no orientation field, so it has no second vectors; use second='none'"
        )
    fibres, normals = model.field.directions, model.mesh.triangle_normals
    known = fibres.any(axis=1, keepdims=True)
    across = np.cross(normals, fibres) if second == "transverse" else np.where(known, normals, 0.0)
    return model.per_input_triangle(fibres, missing=0.0), model.per_input_triangle(across, missing=0.0)


def _triangle_vectors(model: Model) -> NDArray[np.float64] | None:
    """Vectors per triangle of the source, as given or else as the field has them."""
    if model.data.vectors is not None and model.data.vector_location == "triangle":
        return model.data.vectors
    if model.field is None:
        return None
    return model.per_input_triangle(model.field.directions, missing=0.0)
