"""Tracts, boundary loops by name, and the file that holds both."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pectinate
from meshes import grid, octahedron, two_components
from pectinate import BoundaryCondition, Model, SurfaceIdentity, Tract, TractSet, find_loop, read_tracts
from pectinate.errors import InvalidFile, InvalidOption

HEAD = {"format": "pectinate tracts", "version": 1}
numbers = st.floats(allow_nan=False, allow_infinity=False)
points = st.tuples(numbers, numbers, numbers)
weights = st.just(math.inf) | st.floats(*pectinate.tracts.WEIGHT_RANGE)
tracts = st.builds(
    Tract, st.lists(points, min_size=2, max_size=5).map(np.array), name=st.text(), weight=weights, description=st.text()
)
conditions = st.builds(
    BoundaryCondition, st.integers(0, 99) | st.text() | points, st.sampled_from(pectinate.tracts.RULES), weight=weights
)


def two_grids() -> Model:
    """Loop 0 lies at z = 0, loop 1 at z = 10."""
    return pectinate.load(two_components()).with_loop_points({"floor": np.zeros(3), "roof": np.array([2.0, 3, 11])})


def same(first: TractSet, second: TractSet) -> bool:
    def plain(tract_set: TractSet) -> object:
        return (
            [(t.points.tobytes(), t.name, t.weight, t.description) for t in tract_set.tracts],
            [
                (c.loop if isinstance(c.loop, (int, str)) else tuple(c.loop), c.rule, c.weight)
                for c in tract_set.boundary
            ],
            {name: point.tobytes() for name, point in tract_set.loops.items()},
            tract_set.surface,
        )

    return plain(first) == plain(second)


@settings(max_examples=60, deadline=None)
@given(st.lists(tracts, max_size=3), st.lists(conditions, max_size=3), st.dictionaries(st.text(), points, max_size=2))
def test_a_file_gives_back_the_very_same_numbers(tmp_path_factory, tracts, boundary, loops):
    path = tmp_path_factory.mktemp("tracts") / "t.json"
    drawn = TractSet(tracts, boundary, loops, SurfaceIdentity.of(two_grids()))
    drawn.save(path)
    assert same(read_tracts(path), drawn)
    assert json.loads(path.read_text())["format"] == "pectinate tracts"


def test_the_file_has_one_point_a_line(tmp_path):
    TractSet([Tract(np.array([[0, 0.1, 2], [1, 0, 0]]), name="roof")], loops={"valve": [1, 2, 3]}).save(
        tmp_path / "t.json"
    )
    lines = (tmp_path / "t.json").read_text().splitlines()
    assert "        [0.0, 0.1, 2.0]," in lines
    assert '    "valve": [1.0, 2.0, 3.0]' in lines
    assert not any("weight" in line or "description" in line for line in lines)


def document(**parts: object) -> dict:
    return HEAD | parts


LINE = [[0, 0, 0], [1, 0, 0]]


@pytest.mark.parametrize(
    ("content", "where", "rule"),
    [
        ({"version": 1}, "", "'format' is missing"),
        (HEAD | {"format": "tracts"}, "format", "'tracts' is not 'pectinate tracts'"),
        (HEAD | {"version": 2}, "version", "2 is not 1"),
        (HEAD | {"version": True}, "version", "True is not 1"),
        (document(units="um"), "units", "'um' is not 'mm'"),
        (document(tract=[]), "", "'tract' is unknown"),
        (document(tracts={}), "tracts", "not a list"),
        (document(tracts=[{"points": LINE}, 7]), "tracts[1]", "7 is not an object"),
        (document(tracts=[{"name": "a"}]), "tracts[0]", "'points' is missing"),
        (document(tracts=[{"points": LINE, "wieght": 1}]), "tracts[0]", "'wieght' is unknown"),
        (document(tracts=[{"points": LINE[:1]}]), "tracts[0].points", "1 points"),
        (document(tracts=[{"points": [*LINE, [1, 2]]}]), "tracts[0].points[2]", "2 numbers"),
        (document(tracts=[{"points": [*LINE, [1, "2", 3]]}]), "tracts[0].points[2][1]", "'2' is not a number"),
        (document(tracts=[{"points": [*LINE, [1, True, 3]]}]), "tracts[0].points[2][1]", "True is not a number"),
        (document(tracts=[{"points": [*LINE, [1, 10**400, 3]]}]), "tracts[0].points[2][1]", "not a finite number"),
        (document(tracts=[{"points": LINE, "weight": 0}]), "tracts[0].weight", "0 is not a positive number"),
        (document(tracts=[{"points": LINE, "weight": 1e-7}]), "tracts[0].weight", "the weight is 1e-07"),
        (document(tracts=[{"points": LINE, "weight": 2e12}]), "tracts[0].weight", "the weight is 2e+12"),
        (document(boundary=[{"loop": 0, "rule": "free", "weight": 1e-7}]), "boundary[0].weight", "1e-07"),
        (document(tracts=[{"points": LINE, "name": 3}]), "tracts[0].name", "3 is not text"),
        (document(boundary=[{"loop": 0}]), "boundary[0]", "'rule' is missing"),
        (document(boundary=[{"loop": 0, "rule": "along"}]), "boundary[0].rule", "'along' is not 'free' or"),
        (document(boundary=[{"loop": -1, "rule": "free"}]), "boundary[0].loop", "-1 is not an index, a name"),
        (document(boundary=[{"loop": 0.5, "rule": "free"}]), "boundary[0].loop", "0.5 is not an index, a name"),
        (document(boundary=[{"loop": [1, 2], "rule": "free"}]), "boundary[0].loop", "2 numbers"),
        (document(loops={"mitral valve": [1, 2, None]}), "loops['mitral valve'][2]", "None is not a number"),
        (document(loops={"valve": 7}), "loops.valve", "7 is not a list"),
        (document(surface={}), "surface", "'source' is missing"),
        ([], "", "[] is not an object"),
    ],
)
def test_errors_name_the_place(tmp_path, content, where, rule):
    path = tmp_path / "t.json"
    path.write_text(json.dumps(content))
    with pytest.raises(InvalidFile) as error:
        read_tracts(path)
    message = str(error.value)
    assert message.startswith(f"{path}, {where}: " if where else f"{path}: ")
    assert rule in message
    assert "; " in message


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("{\n\n  'a': 1}", "line 3: is no JSON"),
        ('{"format": "pectinate tracts",\n "format": "x"}', "'format' is there twice"),
        ('{"version": NaN}', "NaN is no number"),
        ("[" * 100_000, "is no JSON that can be read"),
        ("7" * 5000, "is no JSON that can be read"),
    ],
)
def test_what_is_no_json_is_refused(tmp_path, text, said):
    path = tmp_path / "t.json"
    path.write_text(text)
    with pytest.raises(InvalidFile, match=said):
        read_tracts(path)


keys = st.sampled_from(["points", "name", "weight", "loop", "rule", "source", "description"]) | st.text(max_size=2)
json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(st.sampled_from(["tracts", "boundary", "loops", "surface", "units"]), json_values))
def test_whatever_a_file_holds_is_read_or_refused(tmp_path_factory, parts):
    path = tmp_path_factory.mktemp("tracts") / "t.json"
    path.write_text(json.dumps(HEAD | parts))
    try:
        drawn = read_tracts(path)
    except InvalidFile as error:
        assert str(error).startswith(str(path))
    else:
        drawn.save(path)
        assert same(read_tracts(path), drawn)


def test_names_that_are_no_text_survive(tmp_path):
    path = tmp_path / "t.json"
    path.write_text('{"format": "pectinate tracts", "version": 1, "loops": {"\\ud800": [1, 2, 3]}}')
    drawn = read_tracts(path)
    drawn.save(path)
    assert list(read_tracts(path).loops) == list(drawn.loops) == ["\ud800"]


def test_missing_and_unwritable_files(tmp_path):
    with pytest.raises(InvalidFile, match="no such file"):
        read_tracts(tmp_path / "none.json")
    with pytest.raises(InvalidFile, match="cannot be written"):
        TractSet().save(tmp_path / "none" / "t.json")


def test_bad_tracts_and_conditions():
    for bad in ([[0, 0, 0]], [[0, 0], [1, 1]], [[0, 0, 0], [1, math.nan, 0]], "ab", [[1, 2, 3], [4]]):
        with pytest.raises(InvalidOption, match="'roof'"):
            Tract(bad, name="roof")  # type: ignore[arg-type]
    for weight in (0, -1, math.nan, 0.999e-6, 1.001e12, -math.inf, "1", None, True):
        with pytest.raises((InvalidOption, TypeError), match="weight"):
            Tract(np.eye(3), weight=weight)  # type: ignore[arg-type]
        with pytest.raises((InvalidOption, TypeError), match="loop 'valve'"):
            BoundaryCondition("valve", "parallel", weight)  # type: ignore[arg-type]
    with pytest.raises(InvalidOption, match="free, parallel, perpendicular"):
        BoundaryCondition(0, "along")  # type: ignore[arg-type]
    for point in (np.array([1.0, 2]), "xyz", [[1], [2, 3]], [0, math.inf, 0]):
        with pytest.raises(InvalidOption, match="'valve'"):
            TractSet(loops={"valve": point})  # type: ignore[dict-item]


def test_tracts_do_not_change_with_the_array_that_they_came_from():
    points = np.eye(3)
    tract = Tract(points)
    points[:] = 7
    assert (tract.points == np.eye(3)).all()
    with pytest.raises(ValueError, match="read-only"):
        tract.points[0] = 1


def test_loops_are_found_by_index_name_and_point():
    model = two_grids()
    heights = [loop.centroid[2] for loop in model.mesh.boundary_loops]
    floor, roof = heights.index(0), heights.index(10)
    assert model.loop_names == {"floor": floor, "roof": roof}
    for which in (roof, np.int64(roof), "roof", (1, 1, 8), np.array([1.0, 1, 8])):
        assert find_loop(model, which) == roof
    assert find_loop(model, [1, 1, 4]) == floor
    named = model.with_loop_points({"floor": np.array([0.0, 0, 9])})
    assert named.loop_names == {"floor": roof, "roof": roof}
    assert [loop["names"] for loop in named.summary()["boundary_loops"]][roof] == ["floor", "roof"]


@pytest.mark.parametrize(
    ("which", "said"),
    [
        ("attic", "'attic'; the named loops are 'floor', 'roof'"),
        (2, "loop 2 does not exist; .* from 0 to 1"),
        (-1, "loop -1"),
        (True, "True is no boundary loop"),
        (None, "None is no boundary loop"),
        ((1, 2), "no boundary loop"),
        ((1, 2, math.nan), "no boundary loop"),
        ((1, 2, "x"), "no boundary loop"),
        (0.5, "no boundary loop"),
    ],
)
def test_loops_that_do_not_exist(which, said):
    with pytest.raises(InvalidOption, match=said):
        find_loop(two_grids(), which)


def test_a_closed_surface_has_no_loops():
    model = pectinate.load(octahedron()).with_loop_points({"valve": np.zeros(3)})
    assert model.loop_names == {}
    for which in (0, "valve", (0, 0, 0)):
        with pytest.raises(InvalidOption, match="closed"):
            find_loop(model, which)


def test_the_demo_atrium_has_named_loops():
    model = pectinate.datasets.demo_atrium(edge_length=4)
    assert sorted(model.loop_names.values()) == [0, 1, 2, 3, 4]
    longest = max(range(5), key=lambda loop: model.mesh.boundary_loops[loop].length)
    assert model.loop_names["mitral valve"] == longest
    for name, loop in model.loop_names.items():
        assert pectinate.loops.distance_to_loop(model, loop, model.data.loop_points[name]) == 0


def test_the_identity_tells_surfaces_apart():
    model = pectinate.load(grid())
    identity = SurfaceIdentity.of(model)
    assert identity.differences(SurfaceIdentity.of(pectinate.load(grid()))) == []
    vertices, triangles = grid()
    rounded = vertices + 1e-5
    assert identity.checksum == SurfaceIdentity.of(pectinate.load((rounded, triangles))).checksum
    moved, renumbered, bigger = vertices.copy(), triangles[::-1], grid(5, 3)
    moved[7, 2] += 0.01
    for other in ((moved, triangles), (vertices, renumbered), bigger):
        assert identity.differences(SurfaceIdentity.of(pectinate.load(other)))
    (counts, area) = (SurfaceIdentity.of(pectinate.load(bigger)).differences(identity)[i] for i in (0, 2))
    assert (counts, area) == ("24 vertices against 20", "15.0 mm2 against 12.0")
    assert identity.differences(replace(identity, source="elsewhere")) == []


def test_the_identity_survives_a_file_in_micrometres(tmp_path: Path):
    vertices, triangles = grid(30, 20)
    model = pectinate.load((vertices * 1.1, triangles))
    pectinate.save_surface(model, tmp_path / "g.pts")
    again = pectinate.load(tmp_path / "g.pts")
    assert SurfaceIdentity.of(again).checksum == SurfaceIdentity.of(model).checksum
