"""VTK files: every version and kind, the choice of arrays, broken files."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from meshes import grid, octahedron
from pectinate.errors import InvalidField, InvalidFile, InvalidMesh, MissingDependency
from pectinate.io.vtk import read_vtk, surface_from_pyvista, write_streamlines_vtp, write_vtk

try:
    import pyvista
except ImportError:
    pyvista = None

needs_pyvista = pytest.mark.skipif(pyvista is None, reason="PyVista is not installed")

VECTORS = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, np.nan], [0, 0, 0]])

POLY_3_0 = """# vtk DataFile Version 3.0
a surface
ASCII
DATASET POLYDATA
POINTS 4 float
0 0 0 1 0 0
1 1 0 0 1 0
LINES 1 3
2 0 1
POLYGONS 3 13
3 0 1 2
4 0 1 2 3
3 0 2 3
CELL_DATA 4
SCALARS elemTag int 1
LOOKUP_TABLE default
9 5 7 6
VECTORS fiber float
9 9 9
1 0 0
8 8 8
0 1 0
"""

GRID_3_0 = """# vtk DataFile Version 3.0
a surface
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 double
0 0 0 1 0 0
1 1 0 0 1 0
CELLS 3 13
3 0 1 2
4 0 1 2 3
3 0 2 3
CELL_TYPES 3
5
10
5
CELL_DATA 3
FIELD FieldData 2
material 1 3 double
4.0 3.0 2.0
Fibers 3 3 double
1 0 0 9 9 9 0 1 0
"""


def dataset(values: dict[str, Any] | None = None, point_values: dict[str, Any] | None = None) -> Any:
    """Two triangles on four points with arrays."""
    vertices, triangles = grid(1, 1)
    result = pyvista.PolyData.from_regular_faces(vertices, triangles)
    for store, arrays in ((result.cell_data, values), (result.point_data, point_values)):
        for name, array in (arrays or {}).items():
            store[name] = np.asarray(array)
    return result


@needs_pyvista
def test_legacy_poly_data_keeps_triangles_with_their_values(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_text(POLY_3_0)
    data = read_vtk(tmp_path / "a.vtk")
    assert data.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert data.element_rows is not None
    assert data.element_rows.tolist() == [1, 3]
    assert data.element_count == 4
    assert data.vectors is not None
    assert data.vectors.tolist() == [[1, 0, 0], [0, 1, 0]]
    assert data.tags is not None
    assert data.tags.tolist() == [5, 6]
    assert "cells that are no triangles were left out: 1 lines, 1 polygons" in data.notes


@needs_pyvista
def test_legacy_unstructured_grid_keeps_triangles_with_their_values(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_text(GRID_3_0)
    data = read_vtk(tmp_path / "a.vtk")
    assert data.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert data.vectors is not None
    assert data.vectors.tolist() == [[1, 0, 0], [0, 1, 0]]
    assert data.tags is not None
    assert data.tags.tolist() == [4, 2]
    assert "cells that are no triangles were left out: 1 cells of type 10" in data.notes


@needs_pyvista
@pytest.mark.parametrize("version", [42, 51])
@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("kind", ["PolyData", "UnstructuredGrid"])
def test_later_legacy_versions(tmp_path: Path, version: int, binary: bool, kind: str) -> None:
    writers = pytest.importorskip("vtkmodules.vtkIOLegacy")
    source = dataset({"fiber": VECTORS[:2], "elemTag": [5, 6]})
    writer = getattr(writers, f"vtk{kind}Writer")()
    writer.SetInputData(source if kind == "PolyData" else source.cast_to_unstructured_grid())
    writer.SetFileName(str(tmp_path / "a.vtk"))
    writer.SetFileVersion(version)
    writer.SetFileType(2 if binary else 1)
    assert writer.Write() == 1
    assert f"Version {version // 10}.{version % 10}".encode() in (tmp_path / "a.vtk").read_bytes()[:40]
    data = read_vtk(tmp_path / "a.vtk")
    np.testing.assert_array_equal(data.triangles, grid(1, 1)[1])
    np.testing.assert_array_equal(data.vertices, grid(1, 1)[0])
    assert data.vectors is not None
    np.testing.assert_array_equal(data.vectors, VECTORS[:2])
    assert data.tags is not None
    assert data.tags.tolist() == [5, 6]


@needs_pyvista
@pytest.mark.parametrize("suffix", [".vtp", ".vtu", ".vtk"])
def test_writing_and_reading_gives_the_very_same_numbers(tmp_path: Path, suffix: str) -> None:
    vertices, triangles = grid(2, 1)
    vertices = vertices + 0.1234567890123456
    path = tmp_path / f"a{suffix}"
    tags = np.array([1, -2, 3, 2**40])
    write_vtk(path, vertices, triangles, vectors=VECTORS, second_vectors=VECTORS[::-1], tags=tags)
    data = read_vtk(path)
    np.testing.assert_array_equal(data.vertices, vertices)
    np.testing.assert_array_equal(data.triangles, triangles)
    assert data.vectors is not None
    np.testing.assert_array_equal(data.vectors, VECTORS)
    assert data.second_vectors is not None
    np.testing.assert_array_equal(data.second_vectors, VECTORS[::-1])
    assert data.tags is not None
    assert data.tags.tolist() == tags.tolist()
    assert data.element_rows is None
    assert data.vector_location == "triangle"


@needs_pyvista
@pytest.mark.parametrize(
    "name", ["fiber", "Fibers", "FIBRE", "fibres", "f0", "Orientation", "directions", "fiber_direction"]
)
def test_names_of_orientation_arrays(name: str) -> None:
    data = surface_from_pyvista(dataset({"Normals": np.ones((2, 3)), name: VECTORS[:2]}))
    assert data.vectors is not None
    assert data.vectors.tolist() == VECTORS[:2].tolist()
    assert f"the field is array {name!r} (per triangle)" in data.notes


@needs_pyvista
def test_cell_arrays_go_before_point_arrays_and_the_choice_is_reported() -> None:
    cells, points = {"direction": VECTORS[:2], "Fibers": -VECTORS[:2]}, {"fiber": np.ones((4, 3))}
    data = surface_from_pyvista(dataset(cells, points))
    assert data.vectors is not None
    assert data.vectors.tolist() == (-VECTORS[:2]).tolist()
    assert data.vector_location == "triangle"
    (note,) = data.notes
    assert note.startswith(
        "the field is array 'Fibers' (per triangle); 'direction' (per triangle), 'fiber' (per vertex)"
    )


@needs_pyvista
def test_point_arrays_are_handed_on_per_vertex() -> None:
    data = surface_from_pyvista(dataset({"fiber": [1.0, 2.0]}, {"fibre": VECTORS}))
    assert data.vectors is not None
    np.testing.assert_array_equal(data.vectors, VECTORS)
    assert data.vector_location == "vertex"
    assert "array 'fiber' has 1 components and was not taken for the field" in data.notes


@needs_pyvista
def test_a_named_array_wins() -> None:
    source = dataset({"fiber": VECTORS[:2], "mine": -VECTORS[:2]}, {"mine": VECTORS})
    data = surface_from_pyvista(source, array="mine")
    assert data.vectors is not None
    assert data.vectors.tolist() == (-VECTORS[:2]).tolist()
    assert data.notes == ("'mine' is both a cell and a point array: the cell array was taken",)
    assert surface_from_pyvista(source, array=None).vectors is None


@needs_pyvista
def test_a_named_array_must_fit() -> None:
    source = dataset({"fiber": VECTORS[:2], "one": [1.0, 2.0]})
    with pytest.raises(InvalidField, match=r"there is no array 'two'; name one of: fiber \(per triangle\), one"):
        surface_from_pyvista(source, array="two")
    with pytest.raises(InvalidField, match="array 'one' has 1 components"):
        surface_from_pyvista(source, array="one")


@needs_pyvista
def test_unknown_names_are_reported_not_guessed() -> None:
    data = surface_from_pyvista(dataset({"velocity": VECTORS[:2]}))
    assert data.vectors is None
    assert data.notes == (
        "no array is called like an orientation field: no field; arrays that could be one if you name them: velocity",
    )


@needs_pyvista
def test_tensors_with_six_and_with_nine_components_say_the_same() -> None:
    nine = np.arange(18.0).reshape(2, 9)
    symmetric = (nine.reshape(2, 3, 3) + nine.reshape(2, 3, 3).transpose(0, 2, 1)) / 2
    six = symmetric[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    for values in (nine, six):
        data = surface_from_pyvista(dataset({"fiber": values}))
        assert data.vectors is None
        assert data.tensors is not None
        assert data.tensors.tolist() == six.tolist()


@needs_pyvista
def test_tags_must_be_one_integer_per_cell() -> None:
    data = surface_from_pyvista(dataset({"region": [0.5, 1], "tag": np.zeros((2, 2))}))
    assert data.tags is None
    for name in ("region", "tag"):
        assert f"array {name!r} does not hold one integer per cell and was not taken for region tags" in data.notes


@needs_pyvista
def test_strips_polygons_and_vertices_among_triangles() -> None:
    points = np.random.default_rng(0).random((6, 3))
    source = pyvista.PolyData(
        points, verts=[1, 5, 1, 4], faces=[4, 0, 1, 2, 3, 3, 1, 2, 3], strips=[4, 0, 1, 2, 3, 3, 3, 4, 5]
    )
    source.cell_data["fiber"] = np.arange(6)[:, None] * [1.0, 0, 0]
    data = surface_from_pyvista(source)
    assert data.triangles.tolist() == [[1, 2, 3], [3, 4, 5]]
    assert data.vectors is not None
    assert data.vectors[:, 0].tolist() == [3, 5]
    assert "cells that are no triangles were left out: 1 polygons, 1 strips, 2 vertices" in data.notes


@needs_pyvista
def test_units_apply_to_points() -> None:
    source = dataset()
    source.points *= 4000.0
    assert surface_from_pyvista(source).vertices.max() == 4
    assert surface_from_pyvista(source, units="mm").vertices.max() == 4000


@needs_pyvista
@pytest.mark.parametrize(
    "break_file",
    [
        pytest.param(lambda text: text[: len(text) // 2], id="cut off in the points"),
        pytest.param(lambda text: text[:-8], id="cut off in the vectors"),
        pytest.param(lambda text: text.replace("1 1 0 0 1 0", "1 q 0 0 1 0"), id="a word"),
        pytest.param(lambda text: text.replace("3 0 2 3", "3 0 2 7"), id="an index out of range"),
        pytest.param(lambda text: text.replace("3 0 2 3", "3 0 2 -3"), id="a negative index"),
        pytest.param(lambda text: text.replace("POLYDATA", "HOUSE"), id="another data set"),
        pytest.param(lambda _: "hello\n", id="another file"),
        pytest.param(lambda _: "", id="nothing"),
    ],
)
def test_broken_legacy_files_are_refused(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture, break_file: Any
) -> None:
    path = tmp_path / "a.vtk"
    path.write_text(break_file(POLY_3_0))
    with pytest.raises(InvalidFile, match=r"a\.vtk: .*; "):
        read_vtk(path)
    assert (*capfd.readouterr(), caplog.text) == ("", "", "")


@needs_pyvista
@pytest.mark.parametrize("suffix", [".vtp", ".vtu", ".vtk"])
@pytest.mark.parametrize("kept", [0, 1, 2])
def test_cut_binary_files_are_refused(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture, suffix: str, kept: int
) -> None:
    path = tmp_path / f"a{suffix}"
    write_vtk(path, *octahedron(), vectors=np.ones((8, 3)))
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * kept // 3])
    with pytest.raises(InvalidFile, match="is no valid VTK file"):
        read_vtk(path)
    assert (*capfd.readouterr(), caplog.text) == ("", "", "")


@needs_pyvista
def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidFile, match="there is no such file"):
        read_vtk(tmp_path / "none.vtp")


@needs_pyvista
def test_data_sets_without_triangles_are_refused() -> None:
    with pytest.raises(InvalidMesh, match="a ImageData is no surface"):
        surface_from_pyvista(pyvista.ImageData(dimensions=(2, 2, 2)))
    with pytest.raises(InvalidMesh, match=r"no cell is a triangle .*4 vertices"):
        surface_from_pyvista(pyvista.PolyData(grid(1, 1)[0]))
    with pytest.raises(InvalidMesh, match="no cell is a triangle"):
        surface_from_pyvista(pyvista.PolyData())


@needs_pyvista
def test_a_folder_that_is_not_there_cannot_be_written_to(tmp_path: Path) -> None:
    with pytest.raises(InvalidFile, match="its folder does not exist"):
        write_vtk(tmp_path / "no" / "a.vtp", *grid(1, 1))


@needs_pyvista
def test_streamlines_are_polylines_with_their_data(tmp_path: Path) -> None:
    points = np.random.default_rng(1).random((9, 3))
    offsets = np.array([0, 4, 6, 9])
    lengths, values = np.array([3.5, 1.5, 2.5]), np.arange(9)
    write_streamlines_vtp(tmp_path / "s.vtp", points, offsets, {"length": lengths}, {"value": values})
    lines = pyvista.read(tmp_path / "s.vtp")
    np.testing.assert_array_equal(lines.points, points)
    assert lines.lines.tolist() == [4, 0, 1, 2, 3, 2, 4, 5, 3, 6, 7, 8]
    assert lines.cell_data["length"].tolist() == lengths.tolist()
    assert lines.point_data["value"].tolist() == values.tolist()


@needs_pyvista
def test_no_streamlines_are_written_as_none(tmp_path: Path) -> None:
    write_streamlines_vtp(tmp_path / "s.vtp", np.empty((0, 3)), np.array([0]))
    assert pyvista.read(tmp_path / "s.vtp").n_cells == 0


def test_without_pyvista_the_remedy_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    for attempt in (
        lambda: read_vtk(tmp_path / "a.vtk"),
        lambda: write_vtk(tmp_path / "a.vtk", *grid(1, 1)),
        lambda: write_streamlines_vtp(tmp_path / "a.vtp", np.empty((0, 3)), np.array([0])),
    ):
        with pytest.raises(MissingDependency, match=r"pip install pectinate\[vtk\]"):
            attempt()
    assert issubclass(MissingDependency, ImportError)
