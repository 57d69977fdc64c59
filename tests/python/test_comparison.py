"""Angles, noise, directions per vertex and transfers, as Python sees them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from marks import needs_map
from meshes import grid, single_triangle, sphere, torus
from pectinate import _core
from pectinate._core import OrientationField, SurfaceMesh
from pectinate.errors import InvalidField, InvalidOption


def flat(columns: int = 6, rows: int = 4) -> SurfaceMesh:
    return SurfaceMesh(*grid(columns, rows))


def constant_field(mesh: SurfaceMesh, angle: float) -> OrientationField:
    row = [math.cos(angle), math.sin(angle), 0]
    return OrientationField.from_triangle_vectors(mesh, np.tile(row, (mesh.triangle_count, 1)))


def random_field(mesh: SurfaceMesh, seed: int = 1) -> OrientationField:
    vectors = np.random.default_rng(seed).normal(size=(mesh.triangle_count, 3))
    return OrientationField.from_triangle_vectors(mesh, vectors)


def cylinder(around: int = 24, rows: int = 12, *, shift: int = 0) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Around the z axis, with a square hole; its vertices numbered from another place with `shift`."""
    vertices, triangles = grid(around, rows)
    angle = 2 * np.pi * vertices[:, 0] / around
    bent = np.column_stack([2 * np.cos(angle), 2 * np.sin(angle), vertices[:, 1] / 3])
    centres = vertices[triangles].mean(axis=1)
    hole = (np.abs(centres[:, :2] - [6, 5]) < 2).all(axis=1)
    column, row = triangles % (around + 1) % around, triangles // (around + 1)
    order = (column + shift) % around + around * row
    renumbered = np.empty((around * (rows + 1), 3))
    every = np.arange(len(vertices))
    renumbered[(every % (around + 1) % around + shift) % around + around * (every // (around + 1))] = bent
    return renumbered, order[~hole]


def test_angles_agree_with_numpy() -> None:
    mesh = SurfaceMesh(*torus())
    first, second = random_field(mesh, 1), random_field(mesh, 2)
    angles = _core.angles_between(first, second)
    assert (angles.dtype, angles.shape) == (np.float64, (mesh.triangle_count,))
    cosines = np.abs((first.directions * second.directions).sum(axis=1))
    np.testing.assert_allclose(np.cos(angles), cosines, rtol=0, atol=1e-14)
    assert angles.tolist() == _core.angles_between(second, first).tolist()
    missing = first.directions.copy()
    missing[3] = 0
    angles = _core.angles_between(OrientationField.from_triangle_vectors(mesh, missing), second)
    assert np.flatnonzero(np.isnan(angles)).tolist() == [3]


def test_noise() -> None:
    mesh = flat(100, 100)
    field = constant_field(mesh, 0.3)
    noisy = _core.add_angular_noise(mesh, field, standard_deviation=math.radians(10), random_seed=5)
    angles = _core.angles_between(field, noisy)
    assert np.sqrt(np.mean(angles**2)) == pytest.approx(math.radians(10), rel=4 / math.sqrt(2 * len(angles)))
    again = _core.add_angular_noise(mesh, field, standard_deviation=math.radians(10), random_seed=5)
    assert (again.directions == noisy.directions).all()
    default = _core.add_angular_noise(mesh, field, standard_deviation=0.1)
    assert (
        default.directions == _core.add_angular_noise(mesh, field, standard_deviation=0.1, random_seed=1).directions
    ).all()
    assert (_core.add_angular_noise(mesh, field, standard_deviation=0).directions == field.directions).all()


def test_vertex_directions_agree_with_numpy() -> None:
    vertices, triangles = sphere(2)
    mesh = SurfaceMesh(vertices, triangles)
    field = random_field(mesh)
    directions = _core.vertex_directions(mesh, field)
    assert (directions.dtype, directions.shape) == (np.float64, vertices.shape)
    outer = mesh.triangle_areas[:, None, None] * np.einsum("ti,tj->tij", field.directions, field.directions)
    sums = np.zeros((len(vertices), 3, 3))
    for corner in mesh.triangles.T:
        np.add.at(sums, corner, outer)
    expected = np.linalg.eigh(sums)[1][:, :, 2]
    np.testing.assert_allclose(np.abs((directions * expected).sum(axis=1)), 1, rtol=0, atol=1e-10)


def test_transfer_by_nearest_point_to_another_mesh_of_a_plane() -> None:
    source, target = flat(6, 4), SurfaceMesh(grid(9, 6, spacing=2 / 3)[0] + [0, 0, 0.25], grid(9, 6)[1])
    result = _core.transfer_by_nearest_point(source, constant_field(source, 0.7), target, maximum_distance=math.inf)
    assert np.nanmax(_core.angles_between(result.field, constant_field(target, 0.7))) < 1e-12
    np.testing.assert_allclose(result.distances, 0.25, rtol=1e-14)
    found, _, _ = _core.nearest_surface_points(source, target.vertices[target.triangles].mean(axis=1))
    assert result.source_triangles.tolist() == found.tolist()
    with pytest.raises(InvalidField, match="maximum_distance"):
        _core.transfer_by_nearest_point(source, constant_field(source, 0.7), target, maximum_distance=0.2)


@needs_map
@pytest.mark.parametrize("as_array", [False, True])
def test_transfer_through_disks_to_a_moved_copy(as_array: bool) -> None:
    rotation = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])
    source = SurfaceMesh(*cylinder())
    vertices, triangles = cylinder(shift=7)
    target = SurfaceMesh(5 * vertices @ rotation.T + [1, 2, 3], triangles)
    field = random_field(source)
    pairs = [
        (loop, _core.nearest_boundary_loop(target, 5 * rotation @ item.centroid + [1, 2, 3]))
        for loop, item in enumerate(source.boundary_loops)
    ]
    maps = [
        _core.parameterize(mesh, outer_loop=outer) for mesh, outer in ((source, pairs[0][0]), (target, pairs[0][1]))
    ]
    result = _core.transfer_through_disks(
        source, maps[0], field, target, maps[1], loop_pairs=np.array(pairs) if as_array else pairs
    )
    expected = OrientationField.from_triangle_vectors(target, field.directions @ rotation.T)
    assert _core.angles_between(result.field, expected).max() < 1e-6
    assert (result.source_triangles == np.arange(source.triangle_count)).all()


def test_results_are_read_only() -> None:
    mesh = flat()
    result = _core.transfer_by_nearest_point(mesh, constant_field(mesh, 0), mesh, maximum_distance=1)
    for array in (result.source_triangles, result.distances, result.field.directions):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def test_errors() -> None:
    mesh, other = flat(), SurfaceMesh(*single_triangle())
    field, foreign = constant_field(mesh, 0), constant_field(other, 0)
    for bad in (-1.0, math.nan, math.inf, 10.0):
        with pytest.raises(InvalidOption, match="radians"):
            _core.add_angular_noise(mesh, field, standard_deviation=bad)
    for bad in (0.0, -1.0, math.nan):
        with pytest.raises(InvalidOption, match="maximum_distance"):
            _core.transfer_by_nearest_point(mesh, field, other, maximum_distance=bad)
    for call in (
        lambda: _core.angles_between(field, foreign),
        lambda: _core.add_angular_noise(mesh, foreign, standard_deviation=0.1),
        lambda: _core.vertex_directions(mesh, foreign),
        lambda: _core.transfer_by_nearest_point(mesh, foreign, other, maximum_distance=1),
    ):
        with pytest.raises(InvalidField, match="triangles"):
            call()
    with pytest.raises(TypeError):
        _core.add_angular_noise(mesh, field, 0.1)  # type: ignore[misc]


@needs_map
def test_loop_pairs_that_do_not_fit() -> None:
    mesh = SurfaceMesh(*cylinder())
    disk, field = _core.parameterize(mesh), random_field(SurfaceMesh(*cylinder()))
    for pairs in ([], [(0, 0)], [(3, 1)], [(1, 1), (1, 2)], [(0, 1)]):
        with pytest.raises(InvalidOption, match="loop"):
            _core.transfer_through_disks(mesh, disk, field, mesh, disk, loop_pairs=pairs)
    with pytest.raises(TypeError):
        _core.transfer_through_disks(mesh, disk, field, mesh, disk, loop_pairs=[(1, 1, 1)])
    with pytest.raises(InvalidOption, match="source's parameterization"):
        _core.transfer_through_disks(mesh, _core.parameterize(flat()), field, mesh, disk, loop_pairs=[(1, 1)])
