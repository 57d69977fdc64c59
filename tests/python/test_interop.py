"""Placements in other programs' hands: trimesh, GLB, PyVista, pandas, and Matplotlib's plots."""

from __future__ import annotations

import importlib
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import meshes
import pectinate
from pectinate import datasets, place_streamlines
from pectinate._core import StopReason
from pectinate.errors import InvalidFile, InvalidOption, MissingDependency
from pectinate.figure import Style, draw_lengths, draw_spacing
from pectinate.figure.plots import length_bins, spacing_slope


@pytest.fixture(scope="module")
def placement() -> pectinate.Placement:
    return place_streamlines(datasets.demo_atrium(edge_length=3), separation_distance=4)


@pytest.fixture(scope="module")
def empty() -> pectinate.Placement:
    vertices, triangles = meshes.grid()
    model = pectinate.load((vertices, triangles, np.tile([1.0, 0, 0], (len(triangles), 1))))
    return place_streamlines(model, minimum_length=1e6)


@pytest.fixture(scope="module")
def height(placement: pectinate.Placement) -> NDArray[np.float64]:
    """A function that is linear in space, per vertex: interpolated values are exact."""
    return placement.mesh.vertices @ [0.3, -0.2, 1.0] + 5


def exact_height(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return points @ [0.3, -0.2, 1.0] + 5


def gltf_json(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    (length,) = struct.unpack("<I", data[12:16])
    return json.loads(data[20 : 20 + length])


def test_the_trimesh_scene_has_surface_and_tubes_in_millimetres(placement: pectinate.Placement) -> None:
    scene = placement.to_trimesh(radius=0.4, side_count=5)
    tubes = placement.tubes(radius=0.4, side_count=5)
    assert set(scene.geometry) == {"surface", "streamlines"}
    np.testing.assert_array_equal(scene.geometry["streamlines"].vertices, tubes.vertices)
    np.testing.assert_array_equal(scene.geometry["streamlines"].faces, tubes.triangles)
    assert scene.geometry["streamlines"].is_watertight
    alone = placement.model.to_trimesh()
    np.testing.assert_array_equal(alone.faces, placement.mesh.triangles)
    np.testing.assert_array_equal(alone.vertices, placement.mesh.vertices)
    assert alone.area == pytest.approx(placement.mesh.area)
    assert not alone.vertices.flags.writeable or not np.shares_memory(alone.vertices, placement.mesh.vertices)


def test_glb_keeps_the_rules_of_gltf(placement: pectinate.Placement, tmp_path: Path) -> None:
    path = tmp_path / "a.glb"
    placement.save(path, radius=0.4, side_count=5)
    scene = trimesh.load(path)
    # The patient's left, the top and the front are +x, +y and +z of glTF, in metres.
    left, back, top = placement.tubes(radius=0.4, side_count=5).vertices.T / 1000
    transform, name = scene.graph["streamlines"]
    placed = trimesh.transform_points(scene.geometry[name].vertices, transform)
    np.testing.assert_allclose(placed, np.column_stack([left, top, -back]), atol=1e-7)
    assert np.linalg.det(transform[:3, :3]) == pytest.approx(1e-9)
    found = gltf_json(path)
    assert {node["name"] for node in found["nodes"]} == {"pectinate", "surface", "streamlines"}
    roots = [found["nodes"][index]["name"] for index in found["scenes"][0]["nodes"]]
    assert roots == ["pectinate"]
    materials = {material["name"]: material for material in found["materials"]}
    assert materials["surface"]["doubleSided"]
    for mesh in found["meshes"]:
        (primitive,) = mesh["primitives"]
        assert {"POSITION", "NORMAL"} <= set(primitive["attributes"])
        assert found["materials"][primitive["material"]]["name"] == mesh["name"]
    color = np.array(materials["surface"]["pbrMetallicRoughness"]["baseColorFactor"][:3])
    shown = np.where(color <= 0.0031308, 12.92 * color, 1.055 * color ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(shown, Style().surface_color, atol=0.005)


def test_normals_in_glb_point_outwards(placement: pectinate.Placement, tmp_path: Path) -> None:
    placement.save(tmp_path / "a.glb")
    tubes = trimesh.load(tmp_path / "a.glb").geometry["streamlines"]
    normals = tubes.vertex_normals[tubes.faces].mean(axis=1)
    assert ((normals * tubes.face_normals).sum(axis=1) > 0).mean() > 0.99
    np.testing.assert_allclose(np.linalg.norm(tubes.vertex_normals, axis=1), 1, atol=1e-5)


def test_vtk_reads_the_glb(placement: pectinate.Placement, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    placement.save(tmp_path / "a.glb")
    bounds = np.reshape(pyvista.read(tmp_path / "a.glb").bounds, (3, 2))
    vertices = np.concatenate([placement.tubes().vertices, placement.mesh.vertices])
    low, high = vertices.min(axis=0) / 1000, vertices.max(axis=0) / 1000
    assert bounds[0] == pytest.approx([low[0], high[0]], abs=1e-3)
    assert bounds[1] == pytest.approx([low[2], high[2]], abs=1e-3)
    assert bounds[2] == pytest.approx([-high[1], -low[1]], abs=1e-3)


def test_pyvista_lines_carry_all_that_is_known(placement: pectinate.Placement, height: NDArray[np.float64]) -> None:
    pytest.importorskip("pyvista")
    of_triangles = np.arange(placement.mesh.triangle_count)
    lines = placement.to_pyvista({"height": height, "of_triangles": of_triangles})
    check_lines(lines, placement)
    np.testing.assert_allclose(lines.point_data["height"], exact_height(placement.points), atol=1e-9)
    np.testing.assert_array_equal(lines.point_data["of_triangles"], placement.point_triangles)
    lengths = lines.compute_cell_sizes(length=True, area=False, volume=False).cell_data["Length"]
    np.testing.assert_allclose(lengths, placement.lengths, rtol=1e-5)


def check_lines(lines: Any, placement: pectinate.Placement) -> None:
    assert lines.n_cells == lines.n_lines == len(placement)
    np.testing.assert_array_equal(lines.points, placement.points)
    first, last = placement.offsets[:-1], placement.offsets[1:] - 1
    for name, expected in {
        "line": np.arange(len(placement)),
        "length": placement.lengths,
        "point_count": np.diff(placement.offsets),
        "stop_reason_first": placement.stop_reasons[:, 0],
        "stop_reason_last": placement.stop_reasons[:, 1],
        "triangle_first": placement.point_triangles[first],
        "triangle_last": placement.point_triangles[last],
        "triangle_seed": placement.point_triangles[placement.seed_points],
    }.items():
        np.testing.assert_array_equal(lines.cell_data[name], expected)
    arcs = lines.point_data["arc_length"]
    assert (arcs[first] == 0).all()
    np.testing.assert_allclose(arcs[last], placement.lengths, rtol=1e-9)
    triangles = lines.point_data["triangle"]
    np.testing.assert_array_equal(triangles, placement.point_triangles)
    np.testing.assert_array_equal(lines.point_data["input_triangle"], placement.mesh.input_triangle[triangles])
    corners = placement.mesh.vertices[placement.mesh.triangles[triangles]]
    places = (lines.point_data["barycentric"][:, :, None] * corners).sum(axis=1)
    np.testing.assert_allclose(places, placement.points, atol=1e-9)
    assert list(lines.field_data["stop_reason_names"]) == [reason.name for reason in sorted(StopReason)]


def test_vtp_holds_the_same_and_vtk_reads_it_without_complaint(
    placement: pectinate.Placement, height: NDArray[np.float64], tmp_path: Path
) -> None:
    pytest.importorskip("pyvista")
    vtk = importlib.import_module("vtkmodules.vtkIOXML")
    placement.save(tmp_path / "a.vtp", values={"height": height})
    check_lines(pectinate.io.vtk_library.read_dataset(tmp_path / "a.vtp"), placement)
    reader = vtk.vtkXMLPolyDataReader()  # ParaView's
    assert reader.CanReadFile(str(tmp_path / "a.vtp"))
    saved = pectinate.io.vtk_library.read_dataset(tmp_path / "a.vtp")
    np.testing.assert_allclose(saved.point_data["height"], exact_height(placement.points), atol=1e-9)


def test_the_pyvista_surface_has_its_arrays(placement: pectinate.Placement, height: NDArray[np.float64]) -> None:
    pytest.importorskip("pyvista")
    model, mesh = placement.model, placement.mesh
    areas = mesh.triangle_areas
    surface = model.to_pyvista({"height": height, "areas": areas})
    np.testing.assert_array_equal(surface.regular_faces, mesh.triangles)
    np.testing.assert_array_equal(surface.points, mesh.vertices)
    np.testing.assert_array_equal(surface.cell_data["fiber"], model.require_field().directions)
    np.testing.assert_array_equal(surface.cell_data["elemTag"], model.tags)
    np.testing.assert_array_equal(surface.cell_data["input_triangle"], mesh.input_triangle)
    np.testing.assert_array_equal(surface.cell_data["areas"], areas)
    np.testing.assert_array_equal(surface.point_data["input_vertex"], mesh.input_vertex)
    np.testing.assert_array_equal(surface.point_data["height"], height)
    back = pectinate.load(surface)
    np.testing.assert_allclose(np.abs((back.field.directions * model.field.directions).sum(axis=1)), 1, atol=1e-9)
    bare = pectinate.load(meshes.grid()).to_pyvista()
    assert set(bare.cell_data.keys()) == {"input_triangle"}


def test_the_table_has_a_row_a_line(placement: pectinate.Placement, height: NDArray[np.float64]) -> None:
    pytest.importorskip("pandas")
    table = placement.to_pandas({"height": height})
    assert table.index.name == "line"
    assert len(table) == len(placement)
    np.testing.assert_array_equal(table["length"], placement.lengths)
    names = [[StopReason(reason).name for reason in pair] for pair in placement.stop_reasons]
    assert table[["stop_reason_first", "stop_reason_last"]].values.tolist() == names
    counts = placement.statistics.stop_counts
    assert (table["stop_reason_first"].value_counts() + table["stop_reason_last"].value_counts()).to_dict() == counts
    for i, line in enumerate(placement):
        middles, steps = 0.5 * (line[1:] + line[:-1]), np.linalg.norm(np.diff(line, axis=0), axis=1)
        mean = (exact_height(middles) * steps).sum() / steps.sum()
        assert table["height"].iloc[i] == pytest.approx(mean, abs=1e-9)


def test_nothing_placed_is_an_empty_everything(empty: pectinate.Placement, tmp_path: Path) -> None:
    assert len(empty) == 0
    values = {"x": np.zeros(empty.mesh.triangle_count)}
    assert set(empty.to_trimesh().geometry) == {"surface"}
    empty.save(tmp_path / "a.glb")
    assert set(trimesh.load(tmp_path / "a.glb").geometry) == {"surface"}
    if importlib.util.find_spec("pyvista"):
        assert empty.to_pyvista(values).n_cells == 0
        empty.save(tmp_path / "a.vtp", values=values)
        assert (tmp_path / "a.vtp").exists()
    if importlib.util.find_spec("pandas"):
        table = empty.to_pandas(values)
        assert len(table) == 0
        assert "x" in table.columns
    if importlib.util.find_spec("matplotlib"):
        assert empty.plot_lengths().size > (100, 100)


def test_wrong_values_and_options_are_refused(placement: pectinate.Placement, tmp_path: Path) -> None:
    with pytest.raises(InvalidOption, match="'x' of shape"):
        placement.to_pyvista({"x": np.zeros(3)})
    with pytest.raises(InvalidOption, match="'x' of shape"):
        placement.model.to_pyvista({"x": np.zeros(3)})
    with pytest.raises(InvalidOption, match="radius"):
        placement.save(tmp_path / "a.vtp", radius=1)
    with pytest.raises(InvalidOption, match="values"):
        placement.save(tmp_path / "a.glb", values={})
    with pytest.raises(InvalidFile, match="nowhere"):
        placement.save(tmp_path / "nowhere" / "a.glb")


@pytest.mark.parametrize("package", ["pandas", "pyvista", "matplotlib.figure"])
def test_a_missing_package_is_named_with_its_remedy(
    placement: pectinate.Placement, monkeypatch: pytest.MonkeyPatch, package: str
) -> None:
    import_module = importlib.import_module

    def import_unless_missing(name: str, package_name: str | None = None) -> Any:
        if name == package:
            raise ImportError(f"no {name}")
        return import_module(name, package_name)

    monkeypatch.setattr(importlib, "import_module", import_unless_missing)
    calls = {
        "pandas": placement.to_pandas,
        "pyvista": placement.to_pyvista,
        "matplotlib.figure": placement.plot_lengths,
    }
    with pytest.raises(MissingDependency, match=r"pip install pectinate\["):
        calls[package]()


def test_lengths_are_counted_in_common_bins() -> None:
    generator = np.random.default_rng(5)
    lengths = [generator.exponential(20, size) for size in (50, 0, 80)]
    edges, counts = length_bins(lengths, 7)
    assert counts.sum(axis=1).tolist() == [50, 0, 80]
    assert edges[0] == 0
    assert edges[-1] == max(lengths[0].max(), lengths[2].max())
    assert np.allclose(np.diff(edges), edges[-1] / 7)
    for i, numbers in enumerate(lengths):
        assert counts[i, 2] == np.count_nonzero((numbers >= edges[2]) & (numbers < edges[3]))


def test_the_spacing_line_is_the_best_through_the_origin() -> None:
    separations = np.array([0.8, 1.6, 3.2])
    assert spacing_slope(separations, 1.376 * separations) == pytest.approx(1.376)
    spacings = 1.4 * separations + [0.1, -0.2, 0.05]
    best = spacing_slope(separations, spacings)
    errors = [((spacings - slope * separations) ** 2).sum() for slope in (best - 1e-4, best, best + 1e-4)]
    assert errors[1] == min(errors)


def test_plots_are_written_and_show_their_numbers(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    few = np.asarray(draw_lengths([[1.0, 2.0, 9.0]], tmp_path / "few.png", bin_count=3))
    many = np.asarray(draw_lengths([[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]], bin_count=3))
    filled = [np.count_nonzero((picture == [0xB8, 0xAC, 0xA0]).all(axis=2)) for picture in (few, many)]
    assert 0 < filled[0] < filled[1]
    assert (tmp_path / "few.png").exists()
    assert draw_lengths([[1.0, 2.0], [1.5]]).size == draw_spacing([1, 2], [1.4, 2.7], tmp_path / "s.png").size


@pytest.mark.parametrize(
    ("lengths", "bin_count"), [([], 5), ([[1.0]], 0), ([[-1.0]], 5), ([[np.nan]], 5), ([[[1.0]]], 5), ([[1.0]], 2.5)]
)
def test_what_cannot_be_counted_is_refused(lengths: Any, bin_count: Any) -> None:
    with pytest.raises(InvalidOption, match=r"lengths|bin_count"):
        draw_lengths(lengths, bin_count=bin_count)


@pytest.mark.parametrize("pair", [([], []), ([1], [1, 2]), ([1, -1], [1, 1]), ([1], [np.nan]), ([[1]], [[1]])])
def test_what_has_no_spacing_is_refused(pair: Any) -> None:
    with pytest.raises(InvalidOption, match="separations"):
        draw_spacing(*pair)
