"""`place_streamlines` and `Placement`: the engine as Python sees it."""

from __future__ import annotations

import gc
import json
import os
import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import pectinate
from meshes import Mesh, grid, moebius_strip, single_triangle, sphere, three_triangles_on_an_edge, torus, two_components
from pectinate import Model, Placement, load, place_streamlines
from pectinate._core import StopReason
from pectinate.errors import InvalidField, InvalidFile, InvalidMesh, InvalidOption
from pectinate.placement import DEFAULTS

Floats = NDArray[np.float64]


def smooth(mesh: Mesh) -> Floats:
    """A slowly turning vector per triangle, with a part along the normal."""
    x, y, z = mesh[0][mesh[1]].mean(axis=1).T
    return np.column_stack([np.sin(0.7 * y + 0.3), np.cos(0.5 * x), 0.3 * np.sin(z + 0.2)])


def model_of(mesh: Mesh) -> Model:
    return load(mesh, field=smooth(mesh), field_location="triangle")


def unit(rows: Floats) -> Floats:
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def segments(placement: Placement) -> tuple[Floats, Floats]:
    """Start and end of every segment."""
    ends = np.zeros(len(placement.points), bool)
    ends[placement.offsets[1:] - 1] = True
    starts = np.roll(ends, 1)
    return placement.points[~ends], placement.points[~starts]


def check_geometry(placement: Placement, vertices: Floats, triangles: NDArray[Any], vectors: Floats) -> None:
    """Points lie on their triangles, segments run along the field: by the input alone, without the engine's numbers."""
    of_input = placement.mesh.input_triangle[placement.segment_triangles]
    a, b, c = (vertices[triangles[of_input, k]] for k in range(3))
    normal = unit(np.cross(b - a, c - a))
    diagonal = np.linalg.norm(np.nanmax(vertices, axis=0) - np.nanmin(vertices, axis=0))
    start, end = segments(placement)
    for point in (start, end):
        assert np.abs(((point - a) * normal).sum(axis=1)).max() < 1e-9 * diagonal
        for corner, following in ((a, b), (b, c), (c, a)):
            inward = np.cross(normal, following - corner)
            assert ((point - corner) * inward).sum(axis=1).min() > -1e-9 * diagonal**2
    step = end - start
    direction = vectors[of_input]
    direction = unit(direction - (direction * normal).sum(axis=1, keepdims=True) * normal)
    length = np.linalg.norm(step, axis=1)
    long = length > 1e-4 * np.median(length)  # rounding turns tiny ones
    sine = np.linalg.norm(np.cross(step, direction), axis=1)[long] / length[long]
    assert np.degrees(np.arcsin(sine)).max() < 1e-4


def check_arrays(placement: Placement) -> None:
    count, offsets = len(placement), placement.offsets
    assert offsets[0] == 0
    assert offsets[-1] == len(placement.points)
    assert np.diff(offsets).min() >= 2
    assert len(placement.segment_triangles) == len(placement.points) - count
    corners = placement.mesh.vertices[placement.mesh.triangles[placement.point_triangles]]
    np.testing.assert_allclose((placement.barycentric[:, :, None] * corners).sum(axis=1), placement.points, atol=1e-12)
    np.testing.assert_allclose(placement.barycentric.sum(axis=1), 1, rtol=1e-15)
    start, end = segments(placement)
    lengths = np.add.reduceat(np.linalg.norm(end - start, axis=1), offsets[:-1] - np.arange(count))
    np.testing.assert_allclose(placement.lengths, lengths, rtol=1e-6)
    assert ((placement.seed_points >= offsets[:-1]) & (placement.seed_points < offsets[1:])).all()
    assert [len(line) for line in placement] == np.diff(offsets).tolist()
    np.testing.assert_array_equal(np.concatenate(list(placement)), placement.points)


def check_statistics(placement: Placement) -> None:
    statistics, lengths = placement.statistics, placement.lengths
    assert statistics.streamline_count == len(placement)
    assert statistics.total_length == pytest.approx(lengths.sum())
    assert statistics.mean_length == pytest.approx(lengths.mean())
    assert statistics.length_weighted_mean == pytest.approx((lengths**2).sum() / lengths.sum())
    assert statistics.mean_spacing * lengths.sum() == pytest.approx(statistics.surface_area)
    separation = placement.options["separation_distance"]
    assert statistics.mean_spacing_ratio == pytest.approx(statistics.mean_spacing / separation)
    assert statistics.short_fraction == pytest.approx((lengths < separation).mean())
    assert 0 < statistics.coverage <= 1
    assert (
        list(statistics.stop_counts.values())
        == np.bincount(placement.stop_reasons.ravel(), minlength=len(StopReason)).tolist()
    )


def same_bytes(one: Placement, other: Placement) -> bool:
    names = ("points", "offsets", "segment_triangles", "barycentric", "lengths", "stop_reasons", "seed_points")
    return all(getattr(one, name).tobytes() == getattr(other, name).tobytes() for name in names)


SURFACES = {
    "grid": grid(12, 9),
    "sphere": sphere(3, radius=2),
    "torus": torus(),
    "moebius": moebius_strip(),
    "triangle": single_triangle(),
    "edge of three": three_triangles_on_an_edge(),
    "two components": two_components(),
}


METHODS = ("random", "neighborhood", "distance", "longest")
#: Every method with every occupancy model that it takes.
WAYS = [{"method": method, "occupancy": "exact"} for method in METHODS] + [
    {"method": method, "occupancy": "edge_mask"} for method in METHODS if method != "longest"
]


def name_of(way: object) -> str:
    return "-".join(way.values()) if isinstance(way, dict) else str(way)


@pytest.mark.parametrize("way", WAYS, ids=name_of)
@pytest.mark.parametrize("name", SURFACES)
def test_every_surface_is_filled(name: str, way: dict[str, Any]) -> None:
    vertices, triangles = SURFACES[name]
    for separation in (0.1, 0.4, 100):
        placement = place_streamlines(
            model_of((vertices, triangles)), separation_distance=separation, seed_count=4, **way
        )
        check_arrays(placement)
        check_statistics(placement)
        check_geometry(placement, vertices, triangles, smooth((vertices, triangles)))
        assert placement.end == "complete"


def test_both_components_get_streamlines() -> None:
    placement = place_streamlines(model_of(two_components()), separation_distance=0.5)
    assert set(placement.mesh.triangle_components[placement.segment_triangles]) == {0, 1}


@pytest.mark.parametrize("bad", [[0, 0, 0], [np.nan, 1, 0], [0, np.inf, 0], [0, 0, 5]])
def test_triangles_without_a_direction_stay_empty(bad: list[float]) -> None:
    mesh = grid(12, 8)
    vectors = smooth(mesh)
    vectors[:, 2] = 0
    empty = np.arange(60, 90)
    vectors[empty] = bad
    for way in WAYS:
        placement = place_streamlines((*mesh, vectors), separation_distance=0.4, **way)
        assert not np.isin(placement.segment_triangles, empty).any()
        assert placement.statistics.surface_area == pytest.approx(len(mesh[1]) / 2 - len(empty) / 2)
        assert placement.statistics.stop_counts["no_field"] > 0


def test_reversed_vectors_change_no_byte() -> None:
    mesh = sphere(3)
    vectors = smooth(mesh)
    signs = np.random.default_rng(1).choice([-1, 1], size=(len(vectors), 1))
    for way in WAYS:
        one, other = (place_streamlines((*mesh, v), separation_distance=0.2, **way) for v in (vectors, signs * vectors))
        assert same_bytes(one, other)


@pytest.mark.parametrize("way", WAYS, ids=name_of)
def test_threads_change_no_byte_and_the_random_seed_does_but_for_longest(way: dict[str, Any]) -> None:
    model = model_of(sphere(3))
    first = place_streamlines(model, separation_distance=0.2, **way)
    assert same_bytes(first, place_streamlines(model, separation_distance=0.2, thread_count=3, **way))
    other = place_streamlines(model, separation_distance=0.2, random_seed=1, **way)
    assert same_bytes(first, other) == (way["method"] == "longest")


def test_contiguity_and_precision_of_arrays_do_not_matter() -> None:
    vertices, triangles = grid(12, 9)  # whole numbers: exact in any precision
    vectors = smooth((vertices, triangles)).astype(np.float32)
    expected = place_streamlines((vertices, triangles, vectors.astype(np.float64)), separation_distance=0.5)
    padded = np.zeros((len(vertices), 6))
    padded[:, ::2] = vertices
    for points in (vertices.astype(np.float32), np.asfortranarray(vertices), padded[:, ::2], vertices.tolist()):
        for corners in (triangles.astype(np.uint8), np.asfortranarray(triangles, np.int32), triangles.astype(float)):
            placement = place_streamlines((points, corners, vectors), separation_distance=0.5)
            assert same_bytes(placement, expected)


def test_defaults_are_the_engine_s_and_come_back_as_used() -> None:
    model = model_of(grid())
    assert place_streamlines(model).options == DEFAULTS
    assert (DEFAULTS["method"], DEFAULTS["occupancy"]) == ("longest", "exact")
    given: dict[str, Any] = {"method": "random", "occupancy": "edge_mask", "seed_count": 2, "random_seed": 2**64 - 1}
    assert place_streamlines(model, **given).options == DEFAULTS | given
    given = {"seed_clearance": 1.16, "test_distance": 0.9, "minimum_length": 0.25}
    given |= {"close_loops": True, "singularity_radius": 0.1, "polishing_rounds": 3, "polishing_time": 7.5}
    assert place_streamlines(model, **given).options == DEFAULTS | given


def distances(placement: Placement) -> tuple[Floats, Floats]:
    """For all pairs of points of different streamlines: the distance, and the later one's streamline's index."""
    line = np.repeat(np.arange(len(placement)), np.diff(placement.offsets))
    later, earlier = np.nonzero(line[:, None] > line[None, :])
    return np.linalg.norm(placement.points[later] - placement.points[earlier], axis=1), earlier


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("option", "value", "least"), [("seed_clearance", 1.3, 1), ("test_distance", 0.8, 0.8)])
def test_clearances_keep_what_they_promise(method: str, option: str, value: float, least: float) -> None:
    model = model_of(grid(16, 12))
    strict = place_streamlines(model, separation_distance=0.7, method=method)
    placement = place_streamlines(model, separation_distance=0.7, method=method, **{option: value})
    check_arrays(placement)
    check_statistics(placement)
    assert distances(strict)[0].min() >= 0.7
    assert distances(placement)[0].min() >= least * 0.7
    if method == "longest":
        assert placement.statistics.mean_length > strict.statistics.mean_length


@pytest.mark.parametrize("way", WAYS, ids=name_of)
def test_no_streamline_is_shorter_than_asked(way: dict[str, Any]) -> None:
    model = model_of(grid(16, 12))
    assert place_streamlines(model, separation_distance=0.7, **way).lengths.min() < 2
    placement = place_streamlines(model, separation_distance=0.7, minimum_length=2, **way)
    assert placement.end == "complete"
    assert placement.lengths.min() >= 2 * (1 - 1e-6)  # lengths of candidates are summed in single precision
    nothing = place_streamlines(model, separation_distance=0.7, minimum_length=1000, **way)
    assert (len(nothing), nothing.end) == (0, "complete")


@pytest.mark.parametrize("way", WAYS, ids=name_of)
@pytest.mark.parametrize("location", ["triangle", "vertex"])
def test_one_separation_distance_everywhere_is_like_a_number(way: dict[str, Any], location: str) -> None:
    mesh = torus()
    model = model_of(mesh)
    count = len(mesh[1]) if location == "triangle" else len(mesh[0])
    expected = place_streamlines(model, separation_distance=0.5, **way)
    assert same_bytes(place_streamlines(model, separation_distance=np.full(count, 0.5), **way), expected)
    assert same_bytes(place_streamlines(model, separation_distance=[0.5] * count, **way), expected)


def test_separation_distances_follow_the_rows_of_the_input() -> None:
    vertices, triangles = grid(16, 12)
    centres = vertices[triangles].mean(axis=1)[:, 0]
    # A row that the mesh drops, a degenerate triangle at the front: its distance does not matter.
    with_dropped = np.concatenate([[[3, 3, 4]], triangles])
    vectors = smooth((vertices, with_dropped))
    separation = np.concatenate([[np.nan], np.where(centres < 8, 0.5, 2.0)])
    placement = place_streamlines((vertices, with_dropped, vectors), separation_distance=separation)
    of_mesh = separation[placement.mesh.input_triangle]
    np.testing.assert_array_equal(of_mesh, np.where(centres < 8, 0.5, 2.0))
    distance, earlier = distances(placement)
    assert (distance >= of_mesh[placement.point_triangles[earlier]] * (1 - 1e-12)).all()
    start, end = segments(placement)
    length, left = np.linalg.norm(end - start, axis=1), start[:, 0] < 8
    assert length[left].sum() > 2 * length[~left].sum()


def test_separation_distances_of_vertices_are_averaged_over_triangles() -> None:
    mesh = sphere(3)
    model = model_of(mesh)
    of_vertices = 0.2 + 0.1 * mesh[0][:, 2]
    of_triangles = of_vertices[mesh[1]].mean(axis=1)
    one, other = (place_streamlines(model, separation_distance=values) for values in (of_vertices, of_triangles))
    assert same_bytes(one, other)


@pytest.mark.parametrize("shape", [(0,), (1,), (23,), (25,), (24, 1), (2, 12)])
def test_separation_distances_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidOption, match=r"separation_distance .*\(24,\).*\(20,\)"):
        place_streamlines(model_of(grid()), separation_distance=np.ones(shape))


@pytest.mark.parametrize("bad", [0, -1, np.nan, np.inf, 1e-12])
def test_a_separation_distance_out_of_range_is_refused_and_its_triangle_named(bad: float) -> None:
    values = np.ones(24)
    values[7] = bad
    with pytest.raises(InvalidOption, match="separation_distance of triangle 7"):
        place_streamlines(model_of(grid()), separation_distance=values)


@pytest.mark.parametrize("options", [{}, {"seed_clearance": 1.1}, {"test_distance": 0.9}, {"singularity_radius": 0.1}])
def test_what_needs_exact_occupancy_is_refused_with_the_mask(options: dict[str, Any]) -> None:
    method = "random" if options else "longest"
    with pytest.raises(InvalidOption, match="exact occupancy"):
        place_streamlines(model_of(grid()), occupancy="edge_mask", method=method, **options)


BAD_OPTIONS = {
    "separation_distance": [0, -1, np.nan, np.inf, 1e-12],
    "method": ["nearest", "", None, 3],
    "occupancy": ["mask", "", None, 1],
    "seed_count": [0, -1, 10**6 + 1],
    "seed_distance_factor": [0.9, np.nan, np.inf],
    "seed_clearance": [0.99, 2.01, np.nan],
    "test_distance": [0, 1.01, -1, np.nan],
    "minimum_length": [-1, np.nan, np.inf],
    "singularity_radius": [-1, np.nan, np.inf],
    "polishing_rounds": [-1, -(2**63)],
    "polishing_time": [-1, np.nan, np.inf],
    "abrupt_turn_angle": [0, -1, 4, np.nan],
    "max_steps": [0, -7],
    "thread_count": [0, -1, 10**6],
}


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in BAD_OPTIONS.items() for value in values])
def test_an_option_out_of_range_is_named(name: str, value: object) -> None:
    with pytest.raises(InvalidOption, match=name) as raised:
        place_streamlines(model_of(grid()), **{name: value})
    assert isinstance(raised.value, ValueError)


@pytest.mark.parametrize(
    "options",
    [
        {"separation": 1},
        {"seeds": 3},
        {"seed_count": 1.5},
        {"seed_count": "many"},
        {"separation_distance": "wide"},
        {"random_seed": -1},
        {"random_seed": 2**64},
        {"progress": 3},
    ],
)
def test_an_option_that_is_unknown_or_of_another_type_is_a_type_error(options: dict[str, Any]) -> None:
    with pytest.raises(TypeError):
        place_streamlines(model_of(grid()), **options)


def test_without_a_field_there_is_nothing_to_place() -> None:
    with pytest.raises(InvalidField, match="field"):
        place_streamlines(grid())


@pytest.mark.parametrize("vectors", [np.zeros((1, 3)), np.full((1, 3), np.nan), np.array([[0, 0, 1.0]])])
def test_a_field_without_any_direction_is_refused(vectors: Floats) -> None:
    with pytest.raises(InvalidField):
        load((*single_triangle(), vectors))


BAD_TRIANGLES = {
    "fraction": np.array([[0, 1, 0.7]]),
    "beyond 32 bits": np.array([[0, 1, 2**32 + 2]]),
    "beyond 64 bits": np.array([[0, 1, 2**64 - 1]], np.uint64),
    "negative": np.array([[0, 1, -1]]),
    "too great": np.array([[0, 1, 3]]),
    "nan": np.array([[0, 1, np.nan]]),
    "infinite": np.array([[0, 1, np.inf]]),
    "repeated": np.array([[0, 1, 1]]),
    "none": np.zeros((0, 3), int),
}


@pytest.mark.parametrize("name", BAD_TRIANGLES)
def test_bad_triangles_are_invalid_meshes(name: str) -> None:
    vertices = single_triangle()[0]
    for make in (pectinate.SurfaceMesh, lambda *mesh: load(mesh)):
        with pytest.raises(InvalidMesh) as raised:
            make(vertices, BAD_TRIANGLES[name])
        assert isinstance(raised.value, ValueError)


@pytest.mark.parametrize("triangles", [np.ones((1, 3), bool), np.array([["0", "1", "2"]]), np.array([[0, 1, 2j]])])
def test_what_are_no_numbers_is_refused(triangles: NDArray[Any]) -> None:
    with pytest.raises(TypeError, match="triangles"):
        pectinate.SurfaceMesh(single_triangle()[0], triangles)
    with pytest.raises(InvalidMesh, match="triangles"):
        load((single_triangle()[0], triangles))


@pytest.mark.parametrize("shape", [(3,), (1, 4), (1, 3, 1), (0,)])
def test_a_wrong_shape_is_refused(shape: tuple[int, ...]) -> None:
    vertices, triangles = single_triangle()
    for mesh in ((vertices, np.zeros(shape, int)), (np.zeros(shape), triangles)):
        with pytest.raises(ValueError, match="shape"):
            pectinate.SurfaceMesh(*mesh)
        with pytest.raises(InvalidMesh, match="shape"):
            load(mesh)


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_soup_is_filled_or_refused(data: st.DataObject) -> None:
    random = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    vertices = random.normal(size=(data.draw(st.integers(3, 9)), 3))
    vertices[random.random(len(vertices)) < 0.05] = np.nan
    triangles = random.integers(0, len(vertices), size=(data.draw(st.integers(1, 25)), 3))
    vectors = random.normal(size=(len(triangles), 3))
    vectors[random.random(len(vectors)) < 0.1] = data.draw(st.sampled_from([0, np.nan, np.inf]))
    try:
        model = load((vertices, triangles), field=vectors, field_location="triangle")
    except (InvalidMesh, InvalidField):
        return
    separation = data.draw(st.floats(0.02, 3))
    placement = place_streamlines(model, separation_distance=separation, seed_count=2, max_steps=500)
    check_arrays(placement)
    check_geometry(placement, vertices, triangles, vectors)
    tubes = placement.tubes(radius=0.01)
    assert trimesh.Trimesh(tubes.vertices, tubes.triangles, process=False).is_watertight


def points_on_edges(placement: Placement, count: int) -> NDArray[np.float64]:
    """Return the points of the first `count` streamlines without the ends in the midst of triangles."""
    last = placement.offsets[count]
    return placement.points[:last][(placement.barycentric[:last] == 0).any(axis=1)]


@pytest.mark.parametrize("way", WAYS, ids=name_of)
def test_progress_is_told_and_can_stop(way: dict[str, Any]) -> None:
    model = model_of(sphere(5, radius=10))  # work for more than the calls below, which are 50 ms apart
    told: list[float] = []

    def stop_at(last: int) -> Callable[[float], bool]:
        def stop(coverage: float) -> bool:
            told.append(coverage)
            return len(told) < last

        return stop

    longer = place_streamlines(model, separation_distance=0.015, seed_count=200, progress=stop_at(4), **way)
    told.clear()
    part = place_streamlines(model, separation_distance=0.015, seed_count=200, progress=stop_at(3), **way)
    assert part.end == "cancelled"
    assert len(told) == 3
    assert told == sorted(told)
    assert told[0] == 0
    assert len(part) > 0
    count = min(len(part), len(longer))
    np.testing.assert_array_equal(points_on_edges(part, count), points_on_edges(longer, count))
    check_arrays(part)
    check_statistics(part)


def test_progress_that_returns_nothing_goes_on() -> None:
    model = model_of(grid())
    told: list[float] = []
    assert same_bytes(place_streamlines(model, progress=told.append), place_streamlines(model))
    assert told


@pytest.mark.parametrize("kind", [KeyboardInterrupt, RuntimeError, ZeroDivisionError])
@pytest.mark.parametrize("thread_count", [1, 3])
def test_what_progress_raises_comes_through(kind: type[BaseException], thread_count: int) -> None:
    def fail(_: float) -> bool:
        raise kind("stop here")

    with pytest.raises(kind, match="stop here"):
        place_streamlines(model_of(grid()), progress=fail, thread_count=thread_count)


@pytest.mark.skipif(os.name != "posix", reason="needs POSIX signals")
@pytest.mark.parametrize("way", [WAYS[0], WAYS[-1], {"method": "longest"}], ids=name_of)
@pytest.mark.parametrize("progress", [None, lambda _: True])
def test_ctrl_c_is_heard_within_a_second(progress: Callable[[float], bool] | None, way: dict[str, Any]) -> None:
    model = model_of(sphere(6, radius=20))
    sent: list[float] = []
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)  # processes in the background ignore it

    def interrupt() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.3, interrupt)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):  # would take long
            place_streamlines(model, separation_distance=0.05, seed_count=5000, progress=progress, **way)
    finally:
        timer.cancel()
        signal.signal(signal.SIGINT, previous)
    assert time.monotonic() - sent[0] < 1


def test_other_threads_run_meanwhile() -> None:
    model = model_of(sphere(5, radius=10))
    placing = threading.Thread(target=lambda: place_streamlines(model, separation_distance=0.15))
    placing.start()
    ticks = 0
    while placing.is_alive():
        ticks += 1
        time.sleep(0.001)
    assert ticks > 10


def test_arrays_are_read_only_and_outlive_what_they_come_from() -> None:
    placement = place_streamlines(model_of(three_triangles_on_an_edge()), separation_distance=0.1)
    tubes = placement.tubes()
    names = (
        "points",
        "offsets",
        "segment_triangles",
        "point_triangles",
        "barycentric",
        "lengths",
        "stop_reasons",
        "seed_points",
    )
    arrays = [getattr(placement, name) for name in names]
    arrays += [placement.mesh.vertices, placement.mesh.edges, placement.field.directions, placement.field.status]
    arrays += [placement.mesh.boundary_loops[0].vertices, placement.mesh.repairs.split_vertices]
    arrays += [tubes.vertices, tubes.triangles]
    copies = [array.copy() for array in arrays]
    del placement, tubes
    gc.collect()
    filler = [np.full(1000, 7.0) for _ in range(1000)]  # would take the place of what was freed
    for array, copy in zip(arrays, copies, strict=True):
        np.testing.assert_array_equal(array, copy)
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.setflags(write=True)
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    assert len(filler) == 1000


@pytest.fixture
def placement() -> Placement:
    return place_streamlines(model_of(grid(12, 9)), separation_distance=0.5)


def test_npz_holds_all_that_a_checker_needs(placement: Placement, tmp_path: Path) -> None:
    placement.save(tmp_path / "lines.npz")
    with np.load(tmp_path / "lines.npz", allow_pickle=False) as file:
        arrays = dict(file)
    kinds = {
        "vertices": "float64", "triangles": "int32", "field": "float64", "points": "float64", "offsets": "int64",
        "segment_triangles": "int32", "point_triangles": "int32", "barycentric": "float64", "lengths": "float64",
        "stop_reasons": "uint8", "seed_points": "int64", "input_vertex": "int32", "input_triangle": "int32",
    }  # fmt: skip
    assert {name: str(array.dtype) for name, array in arrays.items() if name in kinds} == kinds
    assert set(arrays) - set(kinds) == {"stop_reason_names", "options", "statistics"}
    for name in ("points", "offsets", "segment_triangles", "point_triangles", "barycentric", "lengths", "stop_reasons"):
        np.testing.assert_array_equal(arrays[name], getattr(placement, name))
    assert json.loads(str(arrays["options"])) == placement.options
    assert json.loads(str(arrays["statistics"])) == placement.statistics.to_dict()
    assert list(arrays["stop_reason_names"]) == list(placement.statistics.stop_counts)
    corners = arrays["vertices"][arrays["triangles"][arrays["point_triangles"]]]
    np.testing.assert_allclose((arrays["barycentric"][:, :, None] * corners).sum(axis=1), arrays["points"], atol=1e-12)


def test_npz_joins_again_what_was_cut(tmp_path: Path) -> None:
    vertices, triangles = three_triangles_on_an_edge()
    placement = place_streamlines(model_of((vertices, triangles)), separation_distance=0.2)
    placement.save(tmp_path / "lines.npz")
    with np.load(tmp_path / "lines.npz") as file:
        joined = file["input_vertex"][file["triangles"]]
        assert len(np.unique(file["triangles"])) == len(vertices)
        np.testing.assert_array_equal(np.sort(joined, axis=1), np.sort(triangles[file["input_triangle"]], axis=1))


def test_vtp_holds_the_lines(placement: Placement, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    placement.save(tmp_path / "lines.vtp")
    lines = pyvista.read(tmp_path / "lines.vtp")
    assert lines.n_lines == len(placement)
    np.testing.assert_allclose(lines.points, placement.points, rtol=1e-6)
    np.testing.assert_array_equal(lines.cell_data["length"], placement.lengths)
    np.testing.assert_array_equal(lines.point_data["triangle"], placement.point_triangles)


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".PLY"])
def test_tubes_are_saved_watertight(placement: Placement, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"tubes{suffix}"
    placement.save(path, radius=0.05, side_count=5)
    saved = trimesh.load(path, force="mesh", process=False)
    tubes = placement.tubes(radius=0.05, side_count=5)
    assert saved.is_watertight
    assert saved.volume > 0
    np.testing.assert_array_equal(saved.faces, tubes.triangles)
    np.testing.assert_allclose(saved.vertices, tubes.vertices, atol=1e-5)


def test_what_cannot_be_saved_is_refused(placement: Placement, tmp_path: Path) -> None:
    with pytest.raises(InvalidOption, match=r"\.xyz"):
        placement.save(tmp_path / "lines.xyz")
    with pytest.raises(InvalidOption, match="radius"):
        placement.save(tmp_path / "lines.npz", radius=1)
    with pytest.raises(InvalidFile, match="nowhere"):
        placement.save(tmp_path / "nowhere" / "lines.npz")


@pytest.mark.parametrize(
    "options",
    [
        {"radius": 0},
        {"radius": np.nan},
        {"taper_length": -1},
        {"side_count": 2},
        {"side_count": 13},
        {"height": 0},
        {"height": 1.01},
        {"height": np.nan},
    ],
)
def test_tube_options_out_of_range_are_refused(placement: Placement, options: dict[str, Any]) -> None:
    with pytest.raises(InvalidOption, match=next(iter(options))):
        placement.tubes(**options)


def test_tubes_belong_to_their_lines(placement: Placement) -> None:
    tubes = placement.tubes()
    assert len(tubes.vertex_offsets) == len(tubes.triangle_offsets) == len(placement) + 1
    for i in (0, len(placement) // 2, len(placement) - 1):
        first, last = tubes.vertex_offsets[i], tubes.vertex_offsets[i + 1] - 1
        line = placement.points[placement.offsets[i] : placement.offsets[i + 1]]
        np.testing.assert_array_equal(tubes.vertices[[first, last]], line[[0, -1]])


@pytest.mark.parametrize("name", ["la_endo", "ra_endo"])
def test_on_a_measured_surface_lines_follow_the_fibres(human_atrium: Path, name: str, tmp_path: Path) -> None:
    model = load(human_atrium / name)
    placement = place_streamlines(model, separation_distance=1.6)
    assert model.data.vectors is not None
    check_arrays(placement)
    check_statistics(placement)
    check_geometry(placement, model.data.vertices, model.data.triangles, model.data.vectors)
    assert placement.statistics.coverage > 0.999
    assert 1 < placement.statistics.mean_spacing_ratio < 2


def test_points_of_a_measured_surface_keep_the_separation(human_atrium: Path) -> None:
    spatial = pytest.importorskip("scipy.spatial")
    placement = place_streamlines(load(human_atrium / "la_epi"), separation_distance=1.6)
    line = np.repeat(np.arange(len(placement)), np.diff(placement.offsets))
    pairs = spatial.cKDTree(placement.points).query_pairs(1.6 * (1 - 1e-12), output_type="ndarray")
    pairs = pairs[line[pairs[:, 0]] != line[pairs[:, 1]]]
    # The wall is folded: what is near in space only may come closer, and is far along the surface.
    assert len(np.unique(pairs)) < 0.02 * len(placement.points)
