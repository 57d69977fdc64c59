"""PLY, OBJ, OFF, STL and GLB: the order of the file is kept, broken files are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from meshes import grid, sphere
from pectinate.errors import InvalidFile, InvalidMesh
from pectinate.io.trimesh_io import read_trimesh, surface_from_trimesh, write_trimesh

SUFFIXES = [".ply", ".obj", ".off", ".stl", ".glb"]
EXACT = [".obj", ".off"]

OBJ = """# two materials, seams, a quadrilateral, negative indices
mtllib none.mtl
v 0 0 0 1 0 0
v 1 0 0 0 1 0
v 1 1 0 0 0 1
vt 0 0
vt 1 1
vn 0 0 1
usemtl b
f 3/1/1 2/2/1 1/1/1
v 0 1 0
usemtl a
f 1//1 3//1 4//1 # a comment
usemtl b
f -4/2 -3/1 -2/2 -1/1
v 5 5 5
"""


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_writing_and_reading_keeps_order_and_numbers(tmp_path: Path, suffix: str) -> None:
    rng = np.random.default_rng(0)
    vertices, triangles = sphere(2, radius=30)
    vertices, triangles = vertices[:, [1, 2, 0]] + 1 / 3, rng.permutation(triangles)
    write_trimesh(tmp_path / f"a{suffix}", vertices, triangles)
    data = read_trimesh(tmp_path / f"a{suffix}")
    expected = vertices if suffix in EXACT else vertices.astype(np.float32).astype(np.float64)
    np.testing.assert_array_equal(data.vertices[data.triangles], expected[triangles])
    assert data.vertices.shape == vertices.shape
    if suffix != ".stl":
        np.testing.assert_array_equal(data.triangles, triangles)
    assert (data.vectors, data.tags, data.units.unit) == (None, None, "mm")


def test_stl_corners_at_the_same_place_are_merged(tmp_path: Path) -> None:
    vertices, triangles = grid(2, 2)
    write_trimesh(tmp_path / "a.stl", vertices, triangles)
    data = read_trimesh(tmp_path / "a.stl")
    assert data.notes == ("24 corners at 9 places were merged: STL has no shared vertices",)
    ranks = [int(corner) for corner in dict.fromkeys(data.triangles.ravel().tolist())]
    assert ranks == list(range(9))  # numbered as they appear


def test_obj_is_read_in_the_order_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(OBJ)
    data = read_trimesh(tmp_path / "a.obj")
    assert data.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]]
    assert data.triangles.tolist() == [[2, 1, 0], [0, 2, 3], [0, 1, 2], [0, 2, 3]]
    assert data.notes == ("1 polygons were split into triangles",)


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("f 1 2 9", r"line 17: a face of \[1, 2, 9\] among 5 vertices; a face has at least 3 corners"),
        ("f 1 2", "line 17: a face of"),
        ("f 0 1 2", "line 17: a face of"),
        ("f 1 2 -9", "line 17: a face of"),
        ("f 1 x 2", "line 17: '1 x 2' are no corners"),
        ("v 1 2", "line 17: 2 columns where line 3 has 3"),
        ("v 1 2 z", "line 17: 'z' is not a number"),
    ],
)
def test_malformed_obj_lines_are_named(tmp_path: Path, line: str, place: str) -> None:
    (tmp_path / "a.obj").write_text(f"{OBJ}{line}\n")
    with pytest.raises(InvalidFile, match=place):
        read_trimesh(tmp_path / "a.obj")


def test_split_polygons_are_reported(tmp_path: Path) -> None:
    path = tmp_path / "a.off"
    path.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n")
    data = read_trimesh(path)
    assert len(data.triangles) == 3
    assert data.notes[0].startswith("2 faces gave 3 triangles: polygons were split")


def test_split_polygons_of_ply_are_reported(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    properties = "".join(f"property double {axis}\n" for axis in "xyz")
    header = f"ply\nformat ascii 1.0\nelement vertex 4\n{properties}element face 1\n"
    rows = "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
    path.write_text(header + rows)
    data = read_trimesh(path)
    assert len(data.triangles) == 2
    assert data.notes[0].startswith("1 faces gave 2 triangles")


def test_texture_seams_do_not_split_ply_vertices(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    properties = "".join(f"property float {axis}\n" for axis in "xyz")
    lists = "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
    header = f"ply\nformat ascii 1.0\nelement vertex 4\n{properties}element face 2\n{lists}end_header\n"
    path.write_text(header + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 .5 .5 .2 .2 .3 .3\n")
    data = read_trimesh(path)
    assert len(data.vertices) == 4
    assert data.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_the_parts_of_a_scene_are_joined_at_their_places(tmp_path: Path) -> None:
    vertices, triangles = grid(1, 1)
    turn = trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0])
    turn[:3, 3] = [0, 0, 10]
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.Trimesh(vertices, triangles, process=False), node_name="a")
    scene.add_geometry(trimesh.Trimesh(vertices, triangles, process=False), node_name="b", transform=turn)
    scene.export(tmp_path / "a.glb")
    for data in (read_trimesh(tmp_path / "a.glb"), surface_from_trimesh(scene)):
        np.testing.assert_array_equal(data.triangles, np.concatenate([triangles, triangles + 4]))
        moved = vertices @ turn[:3, :3].T + turn[:3, 3]
        np.testing.assert_allclose(data.vertices, np.concatenate([vertices, moved]), atol=1e-6)
    assert "2 meshes of the scene were joined" in read_trimesh(tmp_path / "a.glb").notes


def test_trimesh_objects_keep_their_order() -> None:
    vertices, triangles = grid(3, 2)
    vertices = np.concatenate([vertices, vertices])  # duplicates and unreferenced vertices stay
    data = surface_from_trimesh(trimesh.Trimesh(vertices, triangles[::-1], process=False))
    np.testing.assert_array_equal(data.vertices, vertices)
    np.testing.assert_array_equal(data.triangles, triangles[::-1])
    for empty in (trimesh.Scene(), trimesh.PointCloud(vertices)):
        with pytest.raises(InvalidMesh, match="holds no triangle"):
            surface_from_trimesh(empty)


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("content", ["nothing", "another file", "cut off", "bytes"])
def test_broken_files_are_refused(tmp_path: Path, suffix: str, content: str) -> None:
    path = tmp_path / f"a{suffix}"
    write_trimesh(path, *grid(3, 3))
    whole = path.read_bytes()
    cut = whole[
        : -4 if suffix == ".obj" else len(whole) * 2 // 3
    ]  # an OBJ file announces nothing: only a cut line shows
    broken = {"nothing": b"", "another file": b"hello 1 2 3\n", "cut off": cut, "bytes": bytes(range(256))}
    path.write_bytes(broken[content])
    with pytest.raises(InvalidFile, match=f"a{suffix}.*; "):
        read_trimesh(path)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_missing_files_are_named(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(InvalidFile, match="there is no such file"):
        read_trimesh(tmp_path / f"none{suffix}")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_is_not_there_cannot_be_written_to(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(InvalidFile, match="cannot be written"):
        write_trimesh(tmp_path / "no" / f"a{suffix}", *grid(1, 1))


def test_an_index_out_of_range_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    properties = "".join(f"property float {axis}\n" for axis in "xyz")
    lists = "property list uchar int vertex_indices\nend_header\n"
    path.write_text(
        f"ply\nformat ascii 1.0\nelement vertex 3\n{properties}element face 1\n{lists}0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"
    )
    with pytest.raises(InvalidFile, match=r"a\.ply.*; "):
        read_trimesh(path)
