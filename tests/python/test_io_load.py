"""The two doors: `load` takes every kind of source and field, `save_surface` writes what it took."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from meshes import grid, octahedron, single_triangle
from pectinate.errors import InvalidField, InvalidFile, InvalidMesh, InvalidOption
from pectinate.io import load, save_surface
from pectinate.model import Model

VERTICES, TRIANGLES = grid(4, 3)
ALONG_X = np.tile([2.0, 0, 0], (len(TRIANGLES), 1))


def directions(model: Model) -> Any:
    assert model.field is not None
    return model.field.directions


def check_along_x(model: Model) -> None:
    np.testing.assert_allclose(np.abs(directions(model)), ALONG_X / 2, atol=1e-12)


@pytest.mark.parametrize("rows", [len(TRIANGLES), len(VERTICES)])
@pytest.mark.parametrize("width", [3, 6, 9])
def test_arrays_per_triangle_and_per_vertex(rows: int, width: int) -> None:
    values = np.zeros((rows, width))
    values[:, 0] = 1
    check_along_x(load((VERTICES, TRIANGLES, values)))
    check_along_x(load((VERTICES, TRIANGLES), field=values))
    model = load((VERTICES.tolist(), TRIANGLES.tolist()), field=values.tolist())
    assert model.data.vector_location == ("triangle" if rows == len(TRIANGLES) else "vertex")
    assert (model.data.vectors is None) == (width != 3)


def test_matrices_are_tensors() -> None:
    matrices = np.zeros((len(TRIANGLES), 3, 3))
    matrices[:, 0, 0] = 1
    check_along_x(load((VERTICES, TRIANGLES, matrices)))


def test_the_location_must_be_said_where_the_counts_agree() -> None:
    vertices, triangles = octahedron()
    vertices = np.concatenate([vertices, [[5.0, 5, 5], [6, 6, 6]]])
    assert len(vertices) == len(triangles)
    values = np.random.default_rng(0).random((8, 3))
    with pytest.raises(InvalidField, match="say field_location='triangle' or 'vertex'"):
        load((vertices, triangles, values))
    for location in ("triangle", "vertex"):
        assert load((vertices, triangles, values), field_location=location).data.vector_location == location


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.ones((5, 3)), "the field has 5 rows, the surface 24 triangles and 20 vertices"),
        (np.ones((24, 4)), r"the field has the shape \(24, 4\)"),
        (np.ones(24), r"the field has the shape \(24,\)"),
        (np.full((24, 3), "x"), "no array of real numbers"),
        (np.ones((24, 3), dtype=complex), "no array of real numbers"),
        ([[1, 2, 3], [1, 2]], "no array of real numbers"),
        (np.zeros((24, 3)), "arrays: "),
    ],
)
def test_fields_that_do_not_fit_are_refused(values: Any, message: str) -> None:
    with pytest.raises(InvalidField, match=message):
        load((VERTICES, TRIANGLES), field=values)


def test_a_wrong_location_is_refused() -> None:
    with pytest.raises(InvalidField, match="the field has 24 rows"):
        load((VERTICES, TRIANGLES, ALONG_X), field_location="vertex")
    with pytest.raises(InvalidOption, match="field_location = 'edge'"):
        load((VERTICES, TRIANGLES, ALONG_X), field_location="edge")


@pytest.mark.parametrize(
    ("vertices", "triangles", "message"),
    [
        (VERTICES[:, :2], TRIANGLES, r"vertices have the shape \(20, 2\)"),
        (VERTICES, TRIANGLES[0], r"triangles have the shape \(3,\)"),
        (VERTICES, TRIANGLES + 0.5, r"triangle 0 has the corners .*; use integers"),
        (VERTICES, np.where(TRIANGLES == 19, np.nan, TRIANGLES), "nan.*; use integers"),
        (VERTICES, np.where(TRIANGLES == 19, 2.0**32 + 1, TRIANGLES), "use integers"),
        (VERTICES, np.where(TRIANGLES == 19, 20, TRIANGLES), "arrays: "),
        (VERTICES, np.where(TRIANGLES == 19, 2**32 + 1, TRIANGLES), "arrays: "),
        (VERTICES, np.where(TRIANGLES == 19, -1, TRIANGLES), "arrays: "),
        (VERTICES.astype(str), TRIANGLES, "vertices have the shape"),
        ([[0, 0, 0], [1, 0]], TRIANGLES, "vertices are no array"),
    ],
)
def test_arrays_that_are_no_surface_are_refused(vertices: Any, triangles: Any, message: str) -> None:
    with pytest.raises(InvalidMesh, match=message):
        load((vertices, triangles))


@pytest.mark.parametrize("source", [None, 7, [VERTICES, TRIANGLES], (VERTICES,), {"vertices": VERTICES}])
def test_other_objects_are_refused(source: Any) -> None:
    with pytest.raises(InvalidMesh, match="is no surface; give a path"):
        load(source)


def test_a_model_is_returned_as_it_is() -> None:
    model = load((VERTICES, TRIANGLES))
    assert load(model) is model


def test_input_arrays_are_neither_changed_nor_shared() -> None:
    vertices, triangles, values = VERTICES.copy(), TRIANGLES.copy(), ALONG_X.copy()
    model = load((vertices, triangles, values))
    vertices[:], triangles[:], values[:] = 9, 0, 7
    assert model.data.vertices.tolist() == VERTICES.tolist()
    assert model.data.triangles.tolist() == TRIANGLES.tolist()
    assert model.data.vectors is not None
    assert model.data.vectors.tolist() == ALONG_X.tolist()


def test_trimesh_objects() -> None:
    check_along_x(load(trimesh.Trimesh(VERTICES, TRIANGLES, process=False), field=ALONG_X))


def test_pyvista_objects() -> None:
    pyvista = pytest.importorskip("pyvista")
    source = pyvista.PolyData.from_regular_faces(VERTICES, TRIANGLES)
    source.cell_data["fiber"] = ALONG_X
    source.cell_data["mine"] = ALONG_X[:, [1, 0, 2]]
    check_along_x(load(source))
    check_along_x(load(source.cast_to_unstructured_grid()))
    np.testing.assert_allclose(np.abs(directions(load(source, field="mine"))), ALONG_X[:, [1, 0, 2]] / 2, atol=1e-12)
    assert load(source, field=None).field is None
    check_along_x(load(source, field=ALONG_X))


@pytest.mark.parametrize("suffix", [".pts", ".vtp", ".vtu", ".vtk"])
@pytest.mark.parametrize("units", ["auto", "um", "mm", "cm", "m"])
def test_surfaces_with_fields_go_out_and_come_back(tmp_path: Path, suffix: str, units: str) -> None:
    if suffix != ".pts":
        pytest.importorskip("pyvista")
    model = load((VERTICES / 7 * 1000, TRIANGLES, np.random.default_rng(0).random((24, 3))), units="um")
    files = save_surface(model, tmp_path / f"a{suffix}", units=units)
    assert all(file.exists() for file in files)
    written = {"auto": "um" if suffix == ".pts" else "mm"}.get(units, units)
    back = load(tmp_path / f"a{suffix}", units=written)
    np.testing.assert_allclose(back.data.vertices, VERTICES / 7, rtol=1e-15)
    np.testing.assert_array_equal(back.data.triangles, TRIANGLES)
    assert directions(back).tobytes() == directions(model).tobytes()


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".off", ".stl", ".glb"])
def test_surfaces_alone_go_out_and_come_back_with_a_field_apart(tmp_path: Path, suffix: str) -> None:
    save_surface(load((VERTICES, TRIANGLES)), tmp_path / f"a{suffix}")
    np.save(tmp_path / "f.npy", ALONG_X)
    (tmp_path / "f.lon").write_text("1\n" + "1 0 0\n" * len(TRIANGLES))
    assert load(tmp_path / f"a{suffix}").field is None
    check_along_x(load(tmp_path / f"a{suffix}", field=tmp_path / "f.npy"))
    check_along_x(load(str(tmp_path / f"a{suffix}"), field=str(tmp_path / "f.lon")))


def test_vertex_vectors_are_saved_as_what_they_give_each_triangle(tmp_path: Path) -> None:
    vectors = np.random.default_rng(3).normal(size=VERTICES.shape) * [1, 1, 0]
    model = load((VERTICES, TRIANGLES, vectors))
    save_surface(model, tmp_path / "a.pts")
    np.testing.assert_allclose(np.abs(directions(load(tmp_path / "a.pts"))), np.abs(directions(model)), atol=1e-14)


def test_dropped_triangles_are_saved_without_a_direction(tmp_path: Path) -> None:
    triangles = np.insert(TRIANGLES, 1, [3, 3, 4], axis=0)
    tensors = np.tile([1.0, 0, 0, 0, 0, 0], (25, 1))
    model = load((VERTICES, triangles, tensors))
    assert model.mesh.triangle_count == 24
    save_surface(model, tmp_path / "a.pts")
    back = load(tmp_path / "a.pts")
    assert back.data.vectors is not None
    assert np.flatnonzero(~back.data.vectors.any(axis=1)).tolist() == [1]


def test_a_fibre_file_apart_is_paired_with_all_elements(tmp_path: Path) -> None:
    (tmp_path / "a.pts").write_text("4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n")
    (tmp_path / "a.elem").write_text("3\nTr 0 1 2\nLn 0 1\nTr 0 2 3\n")
    (tmp_path / "a.lon").write_text("broken\n")
    (tmp_path / "b.lon").write_text("1 0 0\n0 0 1\n0 1 0\n")
    model = load(tmp_path / "a", field=tmp_path / "b.lon")
    assert model.data.vectors is not None
    assert model.data.vectors.tolist() == [[1, 0, 0], [0, 1, 0]]
    assert load(tmp_path / "a", field=None).field is None
    with pytest.raises(InvalidFile, match=r"a\.lon"):
        load(tmp_path / "a")


@pytest.mark.parametrize("name", ["a.stlx", "a", "a.txt"])
def test_unknown_suffixes_are_refused_with_the_known_ones(tmp_path: Path, name: str) -> None:
    (tmp_path / "a.txt").write_text("x")
    with pytest.raises(InvalidFile, match=r"; use one of \.pts, .*\.vtk, \.ply, .*\.glb"):
        load(tmp_path / name)
    with pytest.raises(InvalidFile, match=r"; use one of \.pts"):
        save_surface(load(single_triangle()), tmp_path / name)


def test_array_names_are_for_vtk_only(tmp_path: Path) -> None:
    for source in ((VERTICES, TRIANGLES), tmp_path / "a.ply", tmp_path / "a.pts"):
        with pytest.raises(InvalidOption, match="only VTK sources have names"):
            load(source, field="fiber")


@pytest.mark.parametrize("content", [b"", b"hello", b"\x93NUMPY\x01\x00"])
def test_broken_array_files_are_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "f.npy"
    with pytest.raises(InvalidFile, match="there is no such file"):
        load((VERTICES, TRIANGLES), field=path)
    path.write_bytes(content)
    with pytest.raises(InvalidFile, match=r"f\.npy: is no array"):
        load((VERTICES, TRIANGLES), field=path)


def test_pickled_arrays_are_not_opened(tmp_path: Path) -> None:
    np.save(tmp_path / "f.npy", np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(InvalidFile, match="is no array"):
        load((VERTICES, TRIANGLES), field=tmp_path / "f.npy")


def test_units_of_arrays_are_decided_like_those_of_files() -> None:
    model = load((VERTICES * 1000, TRIANGLES))
    assert model.data.units.unit == "um"
    np.testing.assert_array_equal(model.mesh.vertices, VERTICES)
    assert load((VERTICES * 1000, TRIANGLES), units="mm").mesh.area == pytest.approx(12e6)
