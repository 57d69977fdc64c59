"""What solvers read: second vectors, arrays per triangle and per vertex."""

from __future__ import annotations

import numpy as np
import pytest

import pectinate
from drawings import flat, line, lines_agree
from marks import needs_map
from meshes import grid
from pectinate import Model, TractSet, interpolate
from pectinate.errors import InvalidField, InvalidOption


def field_model() -> Model:
    return interpolate(flat(), TractSet([line((1, 1), (4, 5), (11, 7))])).model


@pytest.mark.parametrize("suffix", [".lon", ".vtp", ".vtu", ".vtk"])
def test_second_vectors_go_out_and_come_back(tmp_path, suffix):
    model = field_model()
    for second, expected in (
        ("none", None),
        ("given", None),
        ("transverse", np.cross(model.mesh.triangle_normals, model.field.directions)),
        ("normal", model.mesh.triangle_normals),
    ):
        path = tmp_path / f"{second}{suffix}"
        pectinate.save_surface(model, path, second=second, units="mm")
        again = pectinate.load(path, units="mm")
        assert again.data.vectors.tolist() == model.field.directions.tolist()
        assert (again.second_vectors is None) == (expected is None)
        if expected is not None:
            assert again.second_vectors.tolist() == expected.tolist()


def test_second_vectors_need_a_field(tmp_path):
    for second in ("transverse", "normal"):
        with pytest.raises(InvalidField, match="second"):
            pectinate.save_surface(flat(), tmp_path / "f.pts", second=second)
    with pytest.raises(InvalidOption, match="given, none, transverse, normal"):
        pectinate.save_surface(field_model(), tmp_path / "f.pts", second="sheet")
    with pytest.raises(InvalidField, match="no orientation field"):
        pectinate.save_surface(flat(), tmp_path / "f.vtp", per_vertex=True)


def test_triangles_without_a_direction_get_no_second_vector(tmp_path):
    vertices, triangles = grid()
    vectors = np.tile([1.0, 0, 0.5], (len(triangles), 1))
    vectors[4] = 0
    for second in ("transverse", "normal"):
        path = tmp_path / f"{second}.pts"
        pectinate.save_surface(pectinate.load((vertices, triangles, vectors)), path, second=second)
        data = pectinate.load(path, units="um").data
        assert data.vectors[4].tolist() == data.second_vectors[4].tolist() == [0, 0, 0]
        np.testing.assert_allclose((data.vectors * data.second_vectors).sum(axis=1), 0, atol=1e-15)
        assert np.delete(data.vectors, 4, axis=0).tolist() == [[1, 0, 0]] * (len(triangles) - 1)


@needs_map
def test_confidence_and_angle_are_cell_arrays(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    vertices, triangles = grid(6, 4)
    triangles = np.insert(triangles, 3, [5, 5, 6], axis=0)  # dropped
    result = interpolate((vertices, triangles), TractSet([line((1, 1.5), (5, 2.5))]), outer_loop=0)
    result.save(tmp_path / "f.vtp")
    cells = pyvista.read(tmp_path / "f.vtp").cell_data
    for name, values in (("confidence", result.confidence), ("angle", result.angles)):
        assert np.isnan(cells[name][3])
        assert np.delete(cells[name], 3).tolist() == values.tolist()
    assert result.save(tmp_path / "f.lon") == [tmp_path / f"f{suffix}" for suffix in (".pts", ".elem", ".lon")]


def test_directions_per_vertex(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    vertices, triangles = grid(6, 4)
    vertices = np.insert(vertices, 2, [9, 9, 9], axis=0)  # of no triangle
    triangles = triangles + (triangles >= 2)
    signs = np.where(np.arange(len(triangles)) % 2, -1.0, 1.0)[:, None]
    model = pectinate.load((vertices, triangles, signs * [3.0, 4, 0]), field_location="triangle")
    directions = model.vertex_directions()
    assert directions[2].tolist() == [0, 0, 0]
    others = np.delete(directions, 2, axis=0)
    np.testing.assert_allclose(lines_agree(others, np.array([0.6, 0.8, 0])), 1, atol=1e-12)
    pectinate.save_surface(model, tmp_path / "f.vtu", per_vertex=True)
    assert pyvista.read(tmp_path / "f.vtu").point_data["fiber"].tolist() == directions.tolist()
