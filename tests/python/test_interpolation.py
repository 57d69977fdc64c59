"""Fields from tracts."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import pectinate
from drawings import SLANTED, flat, line, lines_agree
from marks import needs_map
from meshes import annulus, grid, moebius_strip, octahedron, sphere, torus, two_components
from pectinate import BoundaryCondition, Model, Tract, TractSet, _core, interpolate
from pectinate.errors import InvalidMesh, InvalidOption

DEMO_TRACTS = Path(__file__).resolve().parents[2] / "benchmarks" / "demo_tracts.json"

METHODS = ("connection", pytest.param("reference_frame", marks=needs_map))


def test_one_straight_tract_makes_a_constant_field():
    result = interpolate(flat(), TractSet([SLANTED]))
    direction = SLANTED.points[1] - SLANTED.points[0]
    direction /= np.linalg.norm(direction)
    np.testing.assert_allclose(lines_agree(result.field.directions, direction), 1, rtol=0, atol=1e-12)
    assert result.topology.singularities == []
    np.testing.assert_allclose(result.confidence, 1, rtol=0, atol=1e-12)


def test_the_connection_does_what_the_core_does():
    model = flat()
    tracts = TractSet([SLANTED, line((2, 6), (9, 6.5), weight=3.0)], [BoundaryCondition(0, "parallel", 0.5)])
    result = interpolate(model, tracts)
    constraints = _core.make_constraints(
        model.mesh,
        [_core.Tract(t.points, weight=t.weight) for t in tracts.tracts],
        [_core.BoundaryCondition(0, _core.BoundaryRule.parallel, weight=0.5)],
    )
    expected = _core.FieldInterpolator(model.mesh).interpolate(constraints)
    assert result.field.directions.tobytes() == expected.field.directions.tobytes()
    assert result.confidence.tobytes() == expected.confidence.tobytes()
    assert result.energy == _core.dirichlet_energy(model.mesh, expected.field)
    assert result.angles is None
    assert result.disk_map is None


@pytest.mark.parametrize("method", METHODS)
def test_parallel_borders_make_a_circular_field(method):
    model = pectinate.load(annulus()).with_loop_points({"rim": np.array([10.0, 0, 0]), "hub": np.array([4.0, 0, 0])})
    boundary = [BoundaryCondition(name, "parallel") for name in ("rim", "hub")]
    loops = {"outer_loop": "rim", "inner_loop": "hub"} if method == "reference_frame" else {}
    result = interpolate(model, TractSet(boundary=boundary), method=method, **loops)
    centres = model.mesh.vertices[model.mesh.triangles].mean(axis=1)
    around = np.cross([0, 0, 1.0], centres / np.linalg.norm(centres, axis=1, keepdims=True))
    assert (lines_agree(result.field.directions, around) > math.cos(math.radians(2))).all()
    assert result.report()["loop_turns"] == [0, 0]
    assert (result.angles is None) == (method == "connection")
    if result.angles is not None:
        assert (np.abs(result.angles) > math.radians(86)).all()  # e_t everywhere


@needs_map
def test_both_methods_agree_where_they_are_sure():
    atrium = pectinate.datasets.demo_atrium(edge_length=2)
    drawing = pectinate.read_tracts(DEMO_TRACTS)
    connection = interpolate(atrium, drawing, maximum_distance=3)
    frame = interpolate(atrium, drawing, method="reference_frame", maximum_distance=3)
    angles = np.degrees(_core.angles_between(connection.field, frame.field))
    sure = (connection.confidence > 0.5) & (frame.confidence > 0.5)
    assert np.count_nonzero(sure) > 0.4 * len(sure)
    assert np.median(angles[sure]) < 3
    assert np.percentile(angles[sure], 95) < 20
    # Each is least by its own measure; the energy is that of the connection.
    assert connection.energy < frame.energy


@needs_map
def test_angles_and_field_are_equations_1_and_2():
    result = interpolate(flat(), TractSet([SLANTED]), outer_loop=0)
    assert result.method == "connection"
    assert result.disk_map is not None
    frame = result.disk_map.frame
    theta = result.angles[:, None]
    again = np.cos(theta) * frame.longitudinal + np.sin(theta) * frame.transverse
    np.testing.assert_allclose(lines_agree(again, result.field.directions), 1, rtol=0, atol=1e-12)


def test_the_model_carries_the_field_in_the_order_of_the_source():
    vertices, triangles = grid(6, 4)
    triangles = np.insert(triangles, 3, [5, 5, 6], axis=0)  # dropped
    old = np.tile([0.0, 1, 0], (len(triangles), 1))
    result = interpolate((vertices, triangles, old), TractSet([line((1, 1.5), (5, 2.5))]))
    data = result.model.data
    assert data.vectors.shape == triangles.shape
    assert data.vectors[3].tolist() == [0, 0, 0]
    assert np.delete(data.vectors, 3, axis=0).tolist() == result.field.directions.tolist()
    assert (data.tensors, data.second_vectors, data.vector_location) == (None, None, "triangle")
    assert data.notes[-1] == "the field is interpolated from 1 tracts and 0 boundary conditions (connection)"
    again = Model.from_data(data)
    np.testing.assert_allclose(again.field.directions, result.field.directions, atol=1e-15)


@pytest.mark.parametrize("mesh", [octahedron(), sphere(3), torus(), moebius_strip(), two_components()])
def test_every_surface_has_a_field_by_the_connection(mesh):
    model = pectinate.load(mesh)
    triangle = mesh[0][mesh[1][0]]
    tract = Tract(np.array([triangle.mean(axis=0), triangle[0] * 0.8 + triangle[1] * 0.2]), name="short")
    result = interpolate(model, TractSet([tract]))
    assert result.field.count(_core.DirectionStatus.valid) == model.mesh.triangle_count
    turns = sum(one["index"] for one in result.report()["singularities"])
    components = model.mesh.components
    if all(c.orientable and c.boundary_loop_count == 0 for c in components):
        assert turns == sum(c.euler_characteristic for c in components)


@pytest.mark.parametrize("mesh", [octahedron(), torus(), moebius_strip(), two_components()])
def test_the_frame_is_for_disks_with_holes(mesh):
    with pytest.raises(InvalidMesh):
        interpolate(mesh, TractSet(), method="reference_frame")


@needs_map
def test_the_report_is_json_and_names_everything():
    crossing = line((6, 1), (6.4, 7), name="crossing")
    loop_points = {"border": np.array([0.0, 0, 0.5])}
    tracts = TractSet([SLANTED, crossing], [BoundaryCondition("border", "perpendicular", 2.0)], loop_points)
    report = interpolate(flat(), tracts, outer_loop=0).report()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    (conflict,) = report["conflicts"]
    assert (conflict["kept"], conflict["dropped"]) == ("slanted", "crossing")
    assert conflict["triangles"]
    angle = math.degrees(math.atan2(6, 0.4) - math.atan2(5.1, 9.1))
    assert conflict["greatest_angle"] == pytest.approx(angle)
    slanted, _ = report["tracts"]
    assert slanted["name"] == "slanted"
    assert slanted["length"] == pytest.approx(np.linalg.norm(SLANTED.points[1] - SLANTED.points[0]))
    assert (slanted["weight"], slanted["greatest_distance"]) == ("exact", 0)
    assert report["boundary"] == [{"loop": 0, "rule": "perpendicular", "weight": 2.0}]
    assert report["named_loops"] == {"border": {"loop": 0, "distance": 0.5}}
    assert report["exact_triangles"] < report["constrained_triangles"] < report["triangles"]
    assert report["disk"]["outer_loop"] == 0


def test_a_tract_that_crosses_itself_is_a_conflict_with_itself():
    loop = line((2, 2), (8, 4), (8, 6), (5.3, 6), (5.4, 1), name="knot")
    (conflict,) = interpolate(flat(), TractSet([loop])).report()["conflicts"]
    assert (conflict["kept"], conflict["dropped"]) == ("knot", "knot")


def test_a_tract_on_the_border_prevails_over_the_condition():
    tracts = TractSet([line((0, 0), (12, 0), name="edge")], [BoundaryCondition(0, "perpendicular")])
    result = interpolate(flat(), tracts)
    assert {(c["kept"], c["dropped"]) for c in result.report()["conflicts"]} == {("edge", "boundary")}
    low = result.model.mesh.vertices[result.model.mesh.triangles][:, :, 1].max(axis=1) == 1
    crossed = np.isin(np.arange(len(low)), result.constraints.tracts[0].triangles)
    assert crossed.any()
    assert (crossed <= low).all()
    np.testing.assert_allclose(lines_agree(result.field.directions[crossed], np.array([1.0, 0, 0])), 1, atol=1e-12)


@pytest.mark.parametrize(
    ("tracts", "options", "said"),
    [
        (TractSet([line((1, 1, 3), (5, 1, 3), name="far")]), {}, '"far": point 0'),
        (TractSet([line((1, 1), (99, 1), name="outside")]), {}, '"outside": point 1'),
        (TractSet([line((1, 1), (1, 1), name="dot")]), {}, '"dot"'),
        (TractSet([SLANTED]), {"maximum_distance": -1.0}, "maximum_distance"),
        (TractSet([SLANTED]), {"conflict_angle": 4.0}, "conflict_angle"),
        (TractSet([SLANTED]), {"method": "magic"}, "connection, reference_frame"),
        (TractSet([SLANTED]), {"outer_loop": "valve"}, "'valve'"),
        pytest.param(TractSet([SLANTED]), {"inner_loop": 0, "method": "reference_frame"}, "loop", marks=needs_map),
        (TractSet([SLANTED]), {"inner_loop": 0, "inner_point": (1, 1, 0)}, "both"),
        (TractSet(boundary=[BoundaryCondition("valve", "parallel")]), {}, "'valve'"),
        (TractSet(boundary=[BoundaryCondition(5, "parallel")]), {}, "loop 5"),
        (TractSet(boundary=[BoundaryCondition(0, "parallel"), BoundaryCondition((0, 0, 0), "free")]), {}, "same"),
    ],
)
def test_bad_input_is_refused_with_its_name(tracts, options, said):
    with pytest.raises(InvalidOption, match=said):
        interpolate(flat(), tracts, **options)


def test_unknown_options_are_type_errors():
    with pytest.raises(TypeError, match="metod"):
        interpolate(flat(), TractSet(), metod="connection")


def test_tracts_of_another_surface_are_used_and_noted(tmp_path):
    drawn_on = pectinate.SurfaceIdentity.of(flat(6, 4))
    TractSet([SLANTED], surface=drawn_on).save(tmp_path / "t.json")
    result = interpolate(flat(), tmp_path / "t.json")
    (note,) = result.report()["notes"]
    assert "another surface, arrays: 35 vertices against 117" in note
    same = TractSet([SLANTED], surface=pectinate.SurfaceIdentity.of(flat()))
    assert interpolate(flat(), same).report()["notes"] == []


def test_a_detour_is_noted():
    vertices, triangles = grid(12, 8)
    centres = vertices[triangles].mean(axis=1)
    slit = (np.abs(centres[:, 0] - 6) < 1) & (centres[:, 1] > 1)
    tract = line((4.5, 7.5), (7.5, 7.5), name="across")
    result = interpolate((vertices, triangles[~slit]), TractSet([tract]))
    (note,) = result.report()["notes"]
    assert note.startswith("across takes a way")


def test_a_measured_atrium_from_its_borders_alone(human_atrium):
    model = pectinate.load(human_atrium / "la_epi", field=None)
    names = {f"loop {i}": np.array(loop.centroid) for i, loop in enumerate(model.mesh.boundary_loops)}
    boundary = [BoundaryCondition(name, "parallel") for name in names]
    result = interpolate(model, TractSet(boundary=boundary, loops=names))
    report = result.report()
    assert result.model.loop_names == {f"loop {i}": i for i in range(5)}
    assert report["conflicts"] == []
    # Where a border is jagged, half a turn may be at a spike of it instead of at a singular point beside it.
    turns = sum(one["index"] for one in report["singularities"]) + sum(report["loop_turns"])
    assert turns == model.mesh.components[0].euler_characteristic == -3
    along = result.constraints
    cosines = lines_agree(result.field.directions[along.triangles], along.directions)
    np.testing.assert_allclose(cosines, 1, rtol=0, atol=1e-12)
