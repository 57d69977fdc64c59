"""Tracts, boundary conditions and nearest points, as Python sees them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from meshes import grid, octahedron, sphere, two_components
from pectinate import _core
from pectinate._core import BoundaryCondition, BoundaryRule, SurfaceMesh, Tract, TractProjector
from pectinate.errors import InvalidMesh, InvalidOption


def flat(columns: int = 6, rows: int = 4) -> SurfaceMesh:
    return SurfaceMesh(*grid(columns, rows))


def tract(points: list[list[float]], *, name: str = "", weight: float = math.inf) -> Tract:
    return Tract(np.array(points), name=name, weight=weight)


def test_a_tract_constrains_the_triangles_that_it_crosses() -> None:
    roof = tract([[0.3, 0.6, 0.01], [5.5, 3.2, 0]], name="roof", weight=2.0)
    assert (roof.name, roof.weight, roof.points.shape) == ("roof", 2.0, (2, 3))
    constraints = _core.make_constraints(flat(), [roof])
    assert constraints.triangles.dtype == np.int32
    assert (np.diff(constraints.triangles) > 0).all()
    direction = np.array([5.2, 2.6, 0]) / math.hypot(5.2, 2.6)
    np.testing.assert_allclose(np.abs(constraints.directions @ direction), 1, rtol=0, atol=1e-12)
    assert (constraints.weights == 2).all()
    assert (constraints.tract_indices == 0).all()
    (curve,) = constraints.tracts
    assert set(curve.triangles) == set(constraints.triangles)
    assert len(curve.points) == len(curve.triangles) + 1
    assert curve.greatest_distance == pytest.approx(0.01)
    assert curve.greatest_detour == pytest.approx(1)


def test_conflicts_are_listed_and_the_default_weight_is_hard() -> None:
    tracts = [tract([[1.2, 1.1, 0], [4.2, 1.1, 0]]), tract([[2.6, 0.1, 0], [2.6, 3.9, 0]])]
    constraints = _core.make_constraints(flat(), tracts)
    assert np.isinf(constraints.weights).all()
    assert len(constraints.conflict_triangles) >= 1
    assert (constraints.conflict_tracts == [0, 1]).all()
    np.testing.assert_allclose(constraints.conflict_angles, math.pi / 2, atol=1e-12)
    assert len(_core.make_constraints(flat(), tracts, conflict_angle=math.pi / 2).conflict_triangles) == 0


def test_boundary_conditions() -> None:
    mesh = flat()
    condition = BoundaryCondition(0, BoundaryRule.parallel, weight=3.0)
    assert (condition.loop, condition.rule, condition.weight) == (0, BoundaryRule.parallel, 3.0)
    constraints = _core.make_constraints(mesh, [], [condition])
    assert (constraints.tract_indices == -1).all()
    assert (constraints.weights == 3).all()
    centres = mesh.vertices[mesh.triangles[constraints.triangles]].mean(axis=1)
    lower = (centres[:, 1] < 0.5) & (np.abs(centres[:, 0] - 3) < 1)
    np.testing.assert_allclose(np.abs(constraints.directions[lower]), [[1, 0, 0]] * lower.sum(), atol=1e-12)
    assert len(_core.make_constraints(mesh, [], [BoundaryCondition(0, BoundaryRule.free)]).triangles) == 0


def test_nearest_points_agree_with_a_dense_sample() -> None:
    vertices, triangles = sphere(2)
    mesh = SurfaceMesh(vertices, triangles)
    rng = np.random.default_rng(1)
    points = rng.normal(size=(50, 3))
    found, nearest, distances = _core.nearest_surface_points(mesh, points)
    np.testing.assert_allclose(np.linalg.norm(points - nearest, axis=1), distances, rtol=1e-14, atol=1e-15)
    weights = rng.dirichlet([1, 1, 1], size=400)
    samples = (weights @ vertices[triangles]).reshape(-1, 3)
    least = np.linalg.norm(points[:, None] - samples, axis=2).min(axis=1)
    assert (distances <= least + 1e-12).all()
    assert (distances > least - 0.1).all()
    np.testing.assert_allclose(
        ((nearest - vertices[triangles[found, 0]]) * mesh.triangle_normals[found]).sum(1), 0, atol=1e-14
    )


def test_the_projector_does_as_the_functions_and_keeps_its_mesh() -> None:
    tracts = [tract([[0.3, 0.6, 0], [5.5, 3.2, 0]])]
    projector = TractProjector(flat())
    constraints, expected = projector.make_constraints(tracts), _core.make_constraints(flat(), tracts)
    assert constraints.triangles.tolist() == expected.triangles.tolist()
    assert constraints.directions.tolist() == expected.directions.tolist()
    found, nearest, distances = projector.nearest_surface_points(np.array([[0.5, 0.25, 3.0]]))
    assert (found.tolist(), nearest.tolist(), distances.tolist()) == ([0], [[0.5, 0.25, 0]], [3])


def test_the_nearest_boundary_loop() -> None:
    mesh = SurfaceMesh(*two_components())
    loops = mesh.boundary_loops
    for height in (1.0, 9.0):
        loop = loops[_core.nearest_boundary_loop(mesh, [1, 1, height])]
        assert abs(loop.centroid[2] - height) == pytest.approx(1)
    with pytest.raises(InvalidMesh, match="closed"):
        _core.nearest_boundary_loop(SurfaceMesh(*octahedron()), [0, 0, 0])


def test_results_are_read_only() -> None:
    constraints = _core.make_constraints(flat(), [tract([[0.3, 0.6, 0], [5.5, 3.2, 0]])])
    for array in (constraints.directions, constraints.tracts[0].points, constraints.conflict_angles):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def test_errors() -> None:
    mesh, line = flat(), [[0.3, 0.6, 0], [5.5, 3.2, 0]]
    with pytest.raises(InvalidOption, match='tract 1 "Bachmann": point 1 is'):
        _core.make_constraints(mesh, [tract(line), tract([[1, 1, 0], [1, 2, 9]], name="Bachmann")])
    with pytest.raises(InvalidOption, match="loop 7"):
        _core.make_constraints(mesh, [], [BoundaryCondition(7, BoundaryRule.parallel)])
    with pytest.raises(InvalidOption, match="maximum_distance"):
        _core.make_constraints(mesh, [tract(line)], maximum_distance=0.0)
    with pytest.raises(InvalidOption, match="conflict_angle"):
        _core.make_constraints(mesh, [tract(line)], conflict_angle=math.nan)
    with pytest.raises(InvalidOption, match="point 0"):
        _core.nearest_surface_points(mesh, np.full((1, 3), np.nan))
    with pytest.raises(ValueError, match=r"\(n, 3\)"):
        Tract(np.ones((2, 2)))
    with pytest.raises(TypeError):
        Tract(np.array([["a", "b", "c"]]))
    with pytest.raises(TypeError):
        Tract(np.ones((2, 3)), wieght=1.0)  # type: ignore[call-arg]
