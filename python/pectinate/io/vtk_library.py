"""VTK itself: it is optional, and says on a log what it cannot do."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidFile, MissingDependency

_READERS = {".vtp": "vtkXMLPolyDataReader", ".vtu": "vtkXMLUnstructuredGridReader", ".vtk": "vtkDataSetReader"}
SUFFIXES = tuple(_READERS)

#: Of a legacy file, without these only the first array of each kind is read.
_LEGACY_KINDS = ("Scalars", "Vectors", "Normals", "Tensors", "ColorScalars", "TCoords", "Fields")


def import_pyvista() -> Any:
    """Import PyVista.

    Raises
    ------
    MissingDependency
        It is not installed.
    """
    try:
        return importlib.import_module("pyvista")
    except ImportError as error:
        remedy = "install it with: pip install pectinate[vtk]"
        raise MissingDependency(f"VTK files need PyVista ({error}); {remedy}") from error


def read_dataset(path: Path) -> Any:
    """Read a file as a PyVista data set.

    VTK's own readers are used, since PyVista's send the complaints to the root logger too.

    Raises
    ------
    MissingDependency
        PyVista is not installed.
    InvalidFile
        The file is missing, or VTK complains of it.
    """
    pyvista = import_pyvista()
    if not path.is_file():
        raise InvalidFile.at(path, "there is no such file", "check the path")
    with _complaints() as complaints:
        reader = _make_reader(path.suffix.lower())
        reader.SetFileName(str(path))
        reader.Update()
        output, reasons = reader.GetOutputDataObject(0), complaints()
    if output is None or reasons:
        raise InvalidFile.at(path, f"is no valid VTK file ({[*reasons, 'nothing in it'][0]})", "write it again")
    return pyvista.wrap(output)


def save_dataset(dataset: Any, path: Path) -> None:
    """Write a PyVista data set.

    Raises
    ------
    InvalidFile
        It cannot be written.
    """
    if not path.parent.is_dir():
        raise InvalidFile.at(path, "its folder does not exist", "make the folder first")
    with _complaints() as complaints:
        dataset.save(str(path))
        if complaints():
            raise InvalidFile.at(path, f"cannot be written ({complaints()[0]})", "check the folder")


def polyline_dataset(
    points: NDArray[np.float64],
    offsets: NDArray[np.int64],
    cell_data: Mapping[str, ArrayLike] | None = None,
    point_data: Mapping[str, ArrayLike] | None = None,
) -> Any:
    """Make a PyVista data set of polylines; parameters as of `write_streamlines_vtp`."""
    offsets = np.asarray(offsets, dtype=np.int64)
    dataset = import_pyvista().PolyData()
    dataset.points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    dataset.lines = np.insert(np.arange(len(points)), offsets[:-1], np.diff(offsets))
    for store, arrays in ((dataset.cell_data, cell_data), (dataset.point_data, point_data)):
        for name, values in (arrays or {}).items():
            if np.size(values):  # PyVista refuses empty arrays of vectors
                store[name] = np.asarray(values)
    return dataset


def surface_dataset(
    vertices: NDArray[np.float64],
    triangles: NDArray[np.integer[Any]],
    cell_data: Mapping[str, ArrayLike | None],
    point_data: Mapping[str, ArrayLike],
) -> Any:
    """Make a PyVista data set of triangles with arrays per triangle, of which those that are None are left out."""
    dataset = import_pyvista().PolyData(np.array(vertices), faces_of(triangles))
    for store, arrays in ((dataset.cell_data, cell_data), (dataset.point_data, point_data)):
        for name, values in arrays.items():
            if values is not None:
                store[name] = np.array(values)
    return dataset


def faces_of(triangles: NDArray[np.integer[Any]]) -> NDArray[np.integer[Any]]:
    """Triangles as PyVista wants polygons: each with its number of corners before them."""
    return np.insert(triangles, 0, 3, axis=1).ravel()


def _make_reader(suffix: str) -> Any:
    module = importlib.import_module("vtkmodules.vtkIOLegacy" if suffix == ".vtk" else "vtkmodules.vtkIOXML")
    reader = getattr(module, _READERS[suffix])()
    for kind in _LEGACY_KINDS if suffix == ".vtk" else ():
        getattr(reader, f"ReadAll{kind}On")()
    return reader


@contextmanager
def _complaints() -> Iterator[Callable[[], list[str]]]:
    """Collect what VTK writes to its log: it has no exceptions, and returns half a data set for a broken file."""
    core = importlib.import_module("vtkmodules.vtkCommonCore")
    window, previous = core.vtkStringOutputWindow(), core.vtkOutputWindow.GetInstance()
    verbosity = core.vtkLogger.GetCurrentVerbosityCutoff()
    core.vtkLogger.SetStderrVerbosity(core.vtkLogger.VERBOSITY_OFF)
    core.vtkOutputWindow.SetInstance(window)
    try:
        yield lambda: _serious(window.GetOutput())
    finally:
        core.vtkOutputWindow.SetInstance(previous)
        core.vtkLogger.SetStderrVerbosity(verbosity)


def _serious(log: str | bytes) -> list[str]:
    """Pick the messages that mean lost data."""
    log = log.decode(errors="replace") if isinstance(log, bytes) else log  # it quotes the file
    messages = re.findall(r"(ERROR|Warning): In [^\n]*\n([^\n]*)", log)
    texts = [(kind, re.sub(r"^vtk\w+ \(0x[0-9a-f]+\): ", "", text).strip()) for kind, text in messages]
    return [
        text
        for kind, text in texts
        # A NaN in an array spoils only a cached range of its norms.
        if (kind == "ERROR" or text.startswith(("Error", "No "))) and "InformationKey" not in text
    ]
