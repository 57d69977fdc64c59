"""`Model`: what the source holds, seen from the mesh, and its summary."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from meshes import Mesh, grid, moebius_strip, octahedron, single_triangle, sphere, three_triangles_on_an_edge, torus
from meshes import two_components as two_grids
from pectinate.errors import InvalidField, InvalidMesh
from pectinate.io import load
from pectinate.model import Model


def with_extras(model: Model, **extras: object) -> Model:
    return Model.from_data(replace(model.data, **extras))  # type: ignore[arg-type]


def test_tags_and_second_vectors_follow_the_kept_triangles() -> None:
    vertices, triangles = grid(2, 1)
    triangles = np.insert(triangles, [0, 2], [[1, 1, 2], [0, 0, 0]], axis=0)  # rows 0 and 3 are degenerate
    second = np.arange(18.0).reshape(6, 3)
    model = with_extras(load((vertices, triangles)), tags=np.arange(10, 16), second_vectors=second)
    assert model.mesh.input_triangle.tolist() == [1, 2, 4, 5]
    assert model.tags is not None
    assert model.tags.tolist() == [11, 12, 14, 15]
    assert model.second_vectors is not None
    assert model.second_vectors.tolist() == second[[1, 2, 4, 5]].tolist()


def test_without_extras_there_are_none() -> None:
    model = load(grid())
    assert (model.tags, model.second_vectors, model.field) == (None, None, None)
    summary = model.summary()
    assert (summary["field"], summary["area_per_tag"]) == (None, None)
    assert [loop["tags"] for loop in summary["boundary_loops"]] == [None]


@pytest.mark.parametrize(
    ("mesh", "genus", "orientable", "loops", "euler"),
    [
        (single_triangle(), [0], [True], [1], [1]),
        (octahedron(), [0], [True], [0], [2]),
        (sphere(2), [0], [True], [0], [2]),
        (torus(), [1], [True], [0], [0]),
        (moebius_strip(), [1], [False], [1], [0]),
        (two_grids(), [0, 0], [True, True], [1, 1], [1, 1]),
    ],
    ids=["triangle", "octahedron", "sphere", "torus", "moebius", "two components"],
)
def test_summary_of_topology(
    mesh: Mesh, genus: list[int], orientable: list[bool], loops: list[int], euler: list[int]
) -> None:
    summary = load(mesh).summary()
    components = summary["components"]
    assert [component["genus"] for component in components] == genus
    assert [component["orientable"] for component in components] == orientable
    assert [component["boundary_loops"] for component in components] == loops
    assert [component["euler_characteristic"] for component in components] == euler
    assert len(summary["boundary_loops"]) == sum(loops)
    assert sum(component["triangles"] for component in components) == summary["mesh"]["triangles"] == len(mesh[1])
    assert sum(component["area"] for component in components) == pytest.approx(summary["mesh"]["area"])


def test_summary_of_a_rectangle() -> None:
    vertices, triangles = grid(4, 3)
    tags = np.where(np.arange(24) % 8 < 4, 1, 2)  # the left and the right half
    tags[[10, 11]] = 3  # the square in the middle row, second column: no border
    vectors = np.tile([1.0, 0, np.tan(np.radians(30))], (24, 1))
    vectors[0], vectors[1], vectors[2] = 0, np.nan, [0, 0, 1]
    summary = with_extras(load((vertices, triangles, vectors)), tags=tags).summary()
    assert summary["input"] == {"vertices": 20, "triangles": 24}
    assert summary["mesh"]["area"] == pytest.approx(12)
    assert summary["mesh"]["bounding_box"] == [[0, 0, 0], [4, 3, 0]]
    assert summary["mesh"]["bounding_box_diagonal"] == pytest.approx(5)
    assert summary["area_per_tag"] == pytest.approx({"1": 5, "2": 6, "3": 1})
    (loop,) = summary["boundary_loops"]
    assert loop["length"] == pytest.approx(14)
    assert loop["diameter"] == pytest.approx(5)
    assert loop["centroid"] == pytest.approx([2, 1.5, 0])
    assert (loop["vertices"], loop["component"], loop["tags"]) == (14, 0, [1, 2])
    assert summary["field"]["status"] == {"valid": 21, "zero": 1, "non_finite": 1, "normal": 1, "isotropic": 0}
    assert summary["field"]["out_of_plane_median"] == pytest.approx(30)
    assert summary["field"]["out_of_plane_p95"] == pytest.approx(30)
    assert (summary["field"]["given_as"], summary["field"]["given_per"]) == ("vectors", "triangle")


def test_every_repair_is_counted_with_its_first_indices() -> None:
    vertices, triangles = grid(4, 3)
    vertices = np.concatenate([vertices, np.full((7, 3), 50.0)])  # 7 unreferenced
    vertices[19] = np.nan  # a corner of the rectangle: of two triangles
    triangles = np.concatenate([triangles, triangles[:1], [[2, 2, 3]]])
    triangles[4] = triangles[4, ::-1]
    repairs = load((vertices, triangles)).summary()["repairs"]
    assert repairs["non_finite_vertices"] == {"count": 1, "first": [19]}
    assert repairs["non_finite_triangles"] == {"count": 2, "first": [22, 23]}
    assert repairs["duplicate_triangles"] == {"count": 1, "first": [24]}
    assert repairs["degenerate_triangles"] == {"count": 1, "first": [25]}
    assert repairs["reversed_triangles"] == {"count": 1, "first": [4]}
    assert repairs["unreferenced_vertices"] == {"count": 7, "first": [20, 21, 22, 23, 24]}
    assert repairs["non_manifold_edges"] == {"count": 0, "first": []}


def test_a_cut_edge_is_reported() -> None:
    summary = load(three_triangles_on_an_edge()).summary()
    assert summary["repairs"]["non_manifold_edges"] == {"count": 1, "first": [[0, 1]]}
    assert summary["mesh"]["triangles"] == 3


@pytest.mark.parametrize("mesh", [grid(), three_triangles_on_an_edge(), moebius_strip(), sphere(1)])
def test_the_summary_is_json(mesh: Mesh) -> None:
    model = load((*mesh, np.ones((len(mesh[1]), 3)) * [1, 2, 3]), field_location="triangle")
    summary = with_extras(model, tags=np.arange(len(mesh[1]))).summary()
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary


def test_errors_name_the_source() -> None:
    data = load(grid()).data
    with pytest.raises(InvalidMesh, match=r"^heart\.vtk: "):
        Model.from_data(replace(data, source="heart.vtk", triangles=data.triangles * 0))
    with pytest.raises(InvalidField, match=r"^heart\.vtk: "):
        Model.from_data(replace(data, source="heart.vtk", vectors=np.zeros((24, 3))))


def test_models_and_their_data_are_frozen() -> None:
    model = load(grid())
    with pytest.raises(AttributeError):
        model.field = None  # type: ignore[misc]
    with pytest.raises(AttributeError):
        model.data.tags = None  # type: ignore[misc]
