"""Comparison of fields on one surface and on two, and noise, as models."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import pectinate
from marks import needs_map
from meshes import Mesh, grid, octahedron, two_components, with_hole
from pectinate import Model, add_noise, compare
from pectinate.angle_statistics import angle_statistics, angle_statistics_per_region
from pectinate.errors import InvalidField, InvalidMesh, InvalidOption


def with_angle(mesh: Mesh, degrees: float) -> Model:
    angle = math.radians(degrees)
    return pectinate.load((*mesh, np.tile([math.cos(angle), math.sin(angle), 0], (len(mesh[1]), 1))))


def test_the_angle_between_two_constant_fields():
    first, second = with_angle(grid(), 170), with_angle(grid(), 35)
    result = compare(first, second)
    np.testing.assert_allclose(np.degrees(result.angles), 45, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(result.angles, compare(second, first).angles)
    assert (compare(first, first).angles == 0).all()
    assert result.distances is None
    assert result.model.data.notes[-1] == "the field is that of arrays (same)"


def test_statistics_per_region():
    mesh = grid(20, 20)
    model = with_angle(mesh, 0)
    tags = np.arange(800) % 3
    turned = Model.from_data(replace(add_noise(model, 0.4).data, tags=tags))
    result = compare(model, turned)
    report = result.report()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert sorted(report["angles_per_region"]) == ["0", "1", "2"]
    degrees = np.degrees(result.angles)
    for tag in range(3):
        found = report["angles_per_region"][str(tag)]
        ours = degrees[tags == tag]
        assert found["count"] == len(ours)
        assert found["median"] == pytest.approx(np.median(ours))
        assert found["p95"] == pytest.approx(np.percentile(ours, 95))
        assert found["below_30"] == pytest.approx(np.mean(ours < 30))
    halves = compare(model, turned, regions=np.arange(800) // 400).report()["angles_per_region"]
    assert {tag: found["count"] for tag, found in halves.items()} == {"0": 400, "1": 400}


def test_triangles_without_a_direction_are_counted():
    mesh = grid()
    vectors = np.tile([1.0, 0, 0], (24, 1))
    vectors[:5] = 0
    report = compare(with_angle(mesh, 10), (*mesh, vectors)).report()
    assert (report["angles"]["count"], report["angles"]["missing"]) == (19, 5)
    assert report["angles_per_region"] is None


def test_by_the_nearest_point():
    coarse, fine = with_angle(grid(6, 6, spacing=2.0), 20), with_angle(grid(12, 12), 50)
    result = compare(coarse, fine, how="nearest")
    np.testing.assert_allclose(np.degrees(result.angles), 30, atol=1e-9)
    np.testing.assert_allclose(result.distances, 0, atol=1e-12)
    vertices, triangles = grid(12, 12)
    above = with_angle((vertices + np.array([0, 0, 1.5]), triangles), 50)
    report = compare(coarse, above, how="nearest").report()
    assert report["distances"] == {"median": pytest.approx(1.5), "greatest": pytest.approx(1.5)}
    with pytest.raises(InvalidOption, match="maximum_distance"):
        compare(coarse, above, how="nearest", maximum_distance=-1)


@needs_map
def test_through_the_disks():
    names = {"hole": np.array([0.6, 0.5, 0])}
    small = with_angle(with_hole(16, 1.0), 20).with_loop_points(names)
    large = with_angle(with_hole(24, 3.0), 50).with_loop_points({"hole": 3 * names["hole"]})
    for pairs in (None, [("hole", "hole")], [((0.6, 0.5, 0), "hole")]):
        angles = np.degrees(compare(small, large, how="disks", loop_pairs=pairs).angles)
        assert np.mean(np.isnan(angles)) < 0.01  # the holes are not the same to a triangle
        assert np.nanpercentile(np.abs(angles - 30), 90) < 3
    with pytest.raises(InvalidOption, match="same name"):
        compare(small, with_angle(with_hole(24, 3.0), 50), how="disks")
    for pairs in (3, [0], [(0, 0, 0)]):
        with pytest.raises(InvalidOption, match="pairs of loops"):
            compare(small, large, how="disks", loop_pairs=pairs)  # type: ignore[arg-type]
    with pytest.raises(InvalidOption, match="'window'"):
        compare(small, large, how="disks", loop_pairs=[("window", "hole")])
    with pytest.raises(InvalidOption, match="'door'"):
        compare(small, large, how="disks", outer_loops=("door", None))


@needs_map
def test_the_chosen_outer_loops_become_the_circles():
    model = with_angle(with_hole(16, 1.0), 0).with_loop_points({"hole": np.array([0.6, 0.5, 0]), "rim": np.zeros(3)})
    pairs = [("hole", "hole"), ("rim", "rim")]
    angles = compare(model, model, how="disks", outer_loops=("hole", "hole"), loop_pairs=pairs).angles
    assert np.nanmax(angles) < 1e-6
    for outer_loops in (("hole", None), (None, "hole")):
        with pytest.raises(InvalidOption, match="is of an outer loop and an inner one"):
            compare(model, model, how="disks", outer_loops=outer_loops, loop_pairs=pairs)


@pytest.mark.parametrize(
    ("how", "options"),
    [
        ("same", {"maximum_distance": 2.0}),
        ("disks", {"maximum_distance": 2.0}),
        ("same", {"outer_loops": (0, None)}),
        ("nearest", {"outer_loops": (None, 0)}),
        ("same", {"loop_pairs": []}),
        ("nearest", {"loop_pairs": [(0, 0)]}),
    ],
)
def test_options_of_another_way_are_refused(how, options):
    (name,) = options
    with pytest.raises(InvalidOption, match=f"{name} is given, but belongs to how='"):
        compare(with_angle(grid(), 0), with_angle(grid(), 0), how=how, **options)


def test_surfaces_must_be_the_same_or_have_a_disk():
    with pytest.raises(InvalidField, match="not the same triangles"):
        compare(with_angle(grid(), 0), with_angle(grid(5, 3), 0))
    vertices, triangles = grid()
    moved = vertices + np.array([0, 0, 0.01])
    with pytest.raises(InvalidField, match="nearest"):
        compare(with_angle(grid(), 0), with_angle((moved, triangles), 0))
    for mesh in (octahedron(), two_components()):
        closed = pectinate.load((*mesh, np.tile([1.0, 2, 3], (len(mesh[1]), 1))), field_location="triangle")
        with pytest.raises((InvalidMesh, InvalidOption)):
            compare(closed, closed, how="disks", loop_pairs=[(0, 0)])


def test_bad_options():
    model = with_angle(grid(), 0)
    with pytest.raises(InvalidOption, match="same, nearest, disks"):
        compare(model, model, how="somehow")  # type: ignore[arg-type]
    for regions in (np.zeros(23, int), np.zeros(24)):
        with pytest.raises(InvalidOption, match=r"\(24,\)"):
            compare(model, model, regions=regions)
    for pair in ((model, grid()), (grid(), model)):
        with pytest.raises(InvalidField, match="no orientation field"):
            compare(*pair)


def test_noise_has_its_standard_deviation_and_its_seed():
    model = with_angle(grid(60, 60), 30)
    noisy = add_noise(model, math.radians(10))
    angles = compare(model, noisy).angles
    assert np.degrees(np.sqrt(np.mean(angles**2))) == pytest.approx(10, rel=0.05)
    assert noisy.data.notes[-1] == "angular noise of standard deviation 10 degrees was added"
    assert add_noise(model, 0.1).data.vectors.tobytes() == add_noise(model, 0.1).data.vectors.tobytes()
    assert add_noise(model, 0.1).data.vectors.tobytes() != add_noise(model, 0.1, random_seed=2).data.vectors.tobytes()
    np.testing.assert_allclose(compare(model, add_noise(model, 0.0)).angles, 0, atol=1e-7)
    with pytest.raises(InvalidOption, match="standard_deviation"):
        add_noise(model, -0.1)
    with pytest.raises(InvalidField, match="no orientation field"):
        add_noise(grid(), 0.1)


def test_the_angle_is_a_cell_array(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    result = compare(with_angle(grid(), 170), with_angle(grid(), 35))
    result.save(tmp_path / "c.vtp")
    assert pyvista.read(tmp_path / "c.vtp").cell_data["angle"].tolist() == result.angles.tolist()


@given(arrays.arrays(float, st.integers(0, 40), elements=st.floats(0, math.pi / 2) | st.just(math.nan)))
def test_statistics_of_any_angles(angles):
    found = angle_statistics(angles)
    assert found["count"] + found["missing"] == len(angles)
    known = angles[~np.isnan(angles)]
    if len(known) == 0:
        assert found["median"] is found["mean"] is found["below_15"] is None
        return
    assert np.degrees(known.min()) - 1e-9 <= found["median"] <= found["p95"] + 1e-9
    assert found["p95"] <= np.degrees(known.max()) + 1e-9
    assert 0 <= found["below_15"] <= found["below_30"] <= 1
    regions = np.arange(len(angles)) % 2
    parts = angle_statistics_per_region(angles, regions)
    assert sum(part["count"] for part in parts.values()) == found["count"]
