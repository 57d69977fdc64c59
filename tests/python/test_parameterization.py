"""The map onto the disk and the reference frame, against scipy and on measured surfaces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import coo_array, diags_array, eye_array
from scipy.sparse.linalg import spsolve

from marks import needs_map
from meshes import grid, moebius_strip, sphere, torus, two_components
from pectinate import OrientationField, SurfaceMesh, errors, load
from pectinate._core import (
    Parameterization,
    ReferenceFrame,
    field_angles,
    field_from_angles,
    make_reference_frame,
    parameterize,
)

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


def bumpy_sheet(seed: int = 1) -> SurfaceMesh:
    """A sheet with bumps and one hole, its inner vertices moved at random."""
    vertices, triangles = grid(20, 16)
    random = np.random.default_rng(seed)
    inner = (vertices[:, 0] % 20 != 0) & (vertices[:, 1] % 16 != 0)
    vertices[inner, :2] += random.uniform(-0.25, 0.25, (inner.sum(), 2))
    x, y = vertices[:, 0], vertices[:, 1]
    vertices[:, 2] = 2 * np.sin(0.5 * x) * np.cos(0.4 * y) + 4 * np.exp(-((x - 14) ** 2 + (y - 9) ** 2) / 3)
    return SurfaceMesh(vertices, triangles[~(triangles == 8 * 21 + 6).any(axis=1)])


def filled(mesh: SurfaceMesh, per_vertex: Floats, per_loop: Floats) -> tuple[Floats, Ints]:
    """Rows for the vertices and the centres of all loops, and the triangles with the fans of all but the first loop."""
    fans = []
    for hole, loop in enumerate(mesh.boundary_loops):
        centre = np.full(len(loop.vertices), len(per_vertex) + hole)
        fans.append(np.column_stack([centre, np.roll(loop.vertices, -1), loop.vertices]))
    return np.vstack([per_vertex, per_loop]), np.concatenate([mesh.triangles, *fans[1:]]).astype(np.int32)


def averages(points: Floats, triangles: Ints) -> coo_array:
    """The matrix of mean value coordinates, rows that sum to 1."""
    rows, columns, weights = [], [], []
    for k in range(3):
        i, j, other = (triangles[:, (k + n) % 3] for n in range(3))
        u, v = points[j] - points[i], points[other] - points[i]
        lengths = np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)
        angles = np.arccos(np.clip((u * v).sum(axis=1) / (lengths[0] * lengths[1]), -1, 1))
        for neighbour, length in zip((j, other), lengths, strict=True):
            rows.append(i)
            columns.append(neighbour)
            weights.append(np.tan(angles / 2) / length)
    size = len(points)
    matrix = coo_array((np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))), (size, size))
    sums = matrix.sum(axis=1)
    return diags_array(1 / np.where(sums > 0, sums, 1)) @ matrix.tocsr()


def solve(matrix: coo_array, fixed: Ints, values: Floats) -> Floats:
    """Every row the average of its neighbours, the fixed ones as given."""
    free = np.ones(matrix.shape[0])
    free[fixed] = 0
    right_side = np.zeros((matrix.shape[0], *values.shape[1:]))
    right_side[fixed] = values
    return spsolve((eye_array(matrix.shape[0]) - diags_array(free) @ matrix).tocsc(), right_side)


@needs_map
def test_the_map_is_that_of_scipy() -> None:
    mesh = bumpy_sheet()
    map_ = parameterize(mesh)
    centroids = np.array([loop.centroid for loop in mesh.boundary_loops])
    points, triangles = filled(mesh, mesh.vertices, centroids)
    border = mesh.boundary_loops[0].vertices
    steps = np.linalg.norm(np.diff(mesh.vertices[np.append(border, border[0])], axis=0), axis=1)
    angles = 2 * np.pi * np.concatenate([[0], np.cumsum(steps)[:-1]]) / steps.sum()
    expected = solve(averages(points, triangles), border, np.column_stack([np.cos(angles), np.sin(angles)]))
    np.testing.assert_allclose(map_.points, expected[: len(mesh.vertices)], atol=1e-12)
    np.testing.assert_allclose(map_.loop_centres[1:], expected[len(mesh.vertices) + 1 :], atol=1e-12)
    assert map_.loop_centres[0].tolist() == [0, 0]


@needs_map
def test_distortion_is_that_of_the_singular_values() -> None:
    mesh = bumpy_sheet()
    map_ = parameterize(mesh)
    corners, disk = mesh.vertices[mesh.triangles], map_.points[mesh.triangles]
    sides, images = (np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=2) for p in (corners, disk))
    along = sides[:, :, 0] / np.linalg.norm(sides[:, :, 0], axis=1, keepdims=True)
    basis = np.stack([along, np.cross(mesh.triangle_normals, along)], axis=1)
    singular = np.linalg.svd(images @ np.linalg.inv(basis @ sides), compute_uv=False)
    np.testing.assert_allclose(map_.anisotropy, singular[:, 0] / singular[:, 1], rtol=1e-9)
    areas = singular.prod(axis=1) * mesh.triangle_areas
    shares = areas / areas.sum() / (mesh.triangle_areas / mesh.area)
    np.testing.assert_allclose(map_.area_ratio, shares, rtol=1e-9)


@needs_map
def test_u_is_that_of_scipy_and_e_l_its_gradient() -> None:
    mesh = bumpy_sheet()
    map_ = parameterize(mesh)
    frame = make_reference_frame(mesh, map_, inner_loop=1)
    flat, triangles = filled(mesh, map_.points, map_.loop_centres)
    outer, inner = (loop.vertices for loop in mesh.boundary_loops)
    zero = np.append(inner, len(mesh.vertices) + 1)
    fixed, values = np.concatenate([outer, zero]), np.repeat([1.0, 0.0], [len(outer), len(zero)])
    expected = solve(averages(np.column_stack([flat, np.zeros(len(flat))]), triangles), fixed, values)
    np.testing.assert_allclose(frame.u, expected[: len(mesh.vertices)], atol=1e-12)

    a, b, c = (mesh.vertices[corner] for corner in mesh.triangles.T)
    u_a, u_b, u_c = (frame.u[corner][:, None] for corner in mesh.triangles.T)
    gradient = np.cross(mesh.triangle_normals, u_a * (c - b) + u_b * (a - c) + u_c * (b - a))
    length = np.linalg.norm(gradient, axis=1)
    rises = length > 1e-12
    assert not np.isin(frame.borrowed_triangles, np.flatnonzero(rises)).any()
    np.testing.assert_allclose(frame.longitudinal[rises], gradient[rises] / length[rises, None], atol=1e-9)
    np.testing.assert_allclose(frame.transverse, np.cross(mesh.triangle_normals, frame.longitudinal), atol=1e-14)


@needs_map
def test_angles_and_field_undo_each_other() -> None:
    mesh = bumpy_sheet()
    frame = make_reference_frame(mesh, parameterize(mesh))
    angles = np.random.default_rng(4).uniform(-1.5, 1.5, mesh.triangle_count)
    angles[3] = np.nan
    field = field_from_angles(mesh, frame, angles)
    np.testing.assert_allclose(field_angles(frame, field), angles, atol=1e-13)
    both = [OrientationField.from_triangle_vectors(mesh, sign * field.directions) for sign in (1, -1)]
    np.testing.assert_array_equal(*(field_angles(frame, field) for field in both))
    whole = field_from_angles(mesh, frame, np.zeros(mesh.triangle_count, dtype=np.int64))
    assert np.abs(field_angles(frame, whole)).max() < 1e-14


@needs_map
def test_arrays_are_typed_views_that_cannot_be_written() -> None:
    mesh = bumpy_sheet()
    count, loops = mesh.triangle_count, len(mesh.boundary_loops)
    map_ = parameterize(mesh)
    frame = make_reference_frame(mesh, map_, inner_point=mesh.vertices[100])
    expected = [
        (map_, "points", (len(mesh.vertices), 2), np.float64),
        (map_, "loop_centres", (loops, 2), np.float64),
        (map_, "flipped_triangles", (0,), np.int32),
        (map_, "area_ratio", (count,), np.float64),
        (map_, "anisotropy", (count,), np.float64),
        (frame, "u", (len(mesh.vertices),), np.float64),
        (frame, "longitudinal", (count, 3), np.float64),
        (frame, "transverse", (count, 3), np.float64),
        (frame, "borrowed_triangles", (2,), np.int32),  # in two corners of the sheet
        (frame, "critical_points", (0, 2), np.int32),
    ]
    for owner, name, shape, dtype in expected:
        array = getattr(owner, name)
        assert (array.shape, array.dtype) == (shape, dtype), name
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.setflags(write=True)
    assert frame.u[100] == 0
    area_ratio = parameterize(mesh).area_ratio  # outlives what it views
    np.testing.assert_array_equal(area_ratio, map_.area_ratio)


@pytest.mark.parametrize("make", [sphere, torus, moebius_strip, two_components])
def test_surfaces_without_a_map_are_refused(make) -> None:
    with pytest.raises(errors.InvalidMesh):
        parameterize(SurfaceMesh(*make()))


def test_a_torus_with_a_hole_is_refused() -> None:
    vertices, triangles = torus()
    with pytest.raises(errors.InvalidMesh, match="handle"):
        parameterize(SurfaceMesh(vertices, triangles[1:]))


@needs_map
def test_bad_options_are_refused() -> None:
    mesh = bumpy_sheet()
    for loop in (-1, 2):
        with pytest.raises(errors.InvalidOption, match="outer_loop"):
            parameterize(mesh, outer_loop=loop)
    for wrong in (0.5, "valve", 2**40):
        with pytest.raises(TypeError):
            parameterize(mesh, outer_loop=wrong)  # type: ignore[arg-type]
    map_ = parameterize(mesh)
    for options in (
        {"inner_loop": 0},
        {"inner_loop": 2},
        {"inner_loop": 1, "inner_point": (5, 5, 0)},
        {"inner_point": (np.nan, 0, 0)},
        {"inner_point": (-9, -9, 0)},
    ):
        with pytest.raises(errors.InvalidOption, match="inner_"):
            make_reference_frame(mesh, map_, **options)
    with pytest.raises(TypeError):
        make_reference_frame(mesh, map_, inner_point=(1, 2))
    with pytest.raises(errors.InvalidOption, match="of this mesh"):
        make_reference_frame(SurfaceMesh(*grid()), map_)


@needs_map
def test_bad_angles_are_refused() -> None:
    mesh = bumpy_sheet()
    frame = make_reference_frame(mesh, parameterize(mesh))
    for wrong in (np.zeros(3), np.full(mesh.triangle_count, np.nan)):
        with pytest.raises(errors.InvalidField):
            field_from_angles(mesh, frame, wrong)
    with pytest.raises(TypeError, match="real"):
        field_from_angles(mesh, frame, np.zeros(mesh.triangle_count, dtype=complex))
    with pytest.raises(ValueError, match="dimension"):
        field_from_angles(mesh, frame, np.zeros((mesh.triangle_count, 1)))


def triangles_with_corners_in(mesh: SurfaceMesh, vertices: Ints) -> int:
    return int(np.isin(mesh.triangles, vertices).all(axis=1).sum())


def check_frame(mesh: SurfaceMesh, map_: Parameterization, frame: ReferenceFrame, borrowed_count: int) -> None:
    assert len(frame.critical_points) == 0
    assert len(frame.borrowed_triangles) == borrowed_count
    mapped = ~np.isnan(map_.points[:, 0])
    np.testing.assert_array_equal(np.isnan(frame.u), ~mapped)
    for basis in (frame.longitudinal, frame.transverse):
        assert np.abs(np.linalg.norm(basis, axis=1) - 1).max() < 1e-12
        assert np.abs((basis * mesh.triangle_normals).sum(axis=1)).max() < 1e-12


@needs_map
@pytest.mark.parametrize("name", ["la_epi", "la_endo", "ra_epi", "ra_endo"])
def test_measured_atria_have_a_map_without_flips_and_a_frame_without_critical_points(
    human_atrium: Path, name: str
) -> None:
    mesh = load(human_atrium / name).mesh
    map_ = parameterize(mesh)
    loops = mesh.boundary_loops
    assert len(map_.flipped_triangles) == 0
    assert map_.outer_loop == 0
    in_fragments = int((mesh.triangle_components != loops[0].component).sum())
    assert in_fragments == (1 if name == "ra_endo" else 0)
    check_frame(mesh, map_, make_reference_frame(mesh, map_), in_fragments)
    inner = 1
    on_loops = in_fragments + sum(triangles_with_corners_in(mesh, loops[k].vertices) for k in (0, inner))
    check_frame(mesh, map_, make_reference_frame(mesh, map_, inner_loop=inner), on_loops)
    on_outer = in_fragments + triangles_with_corners_in(mesh, loops[0].vertices)
    point = mesh.vertices[len(mesh.vertices) // 2]
    check_frame(mesh, map_, make_reference_frame(mesh, map_, inner_point=point), on_outer)
