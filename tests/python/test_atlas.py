"""Tracts of the built-in atria on other surfaces."""

from dataclasses import replace

import numpy as np
import pytest

import pectinate
from command_line import check_error, run_json
from pectinate import _core, datasets
from pectinate.cli import ExitCode
from pectinate.errors import InvalidFile, InvalidOption
from pectinate.io.loop_file import read_loops
from test_correspondence import SHEAR, atrium, mapped, rotation, without

LOOPS = {
    "mitral valve": [59.1, 31.4, 13.3],
    "left superior pulmonary vein": [20.9, 61.5, 49.0],
    "left inferior pulmonary vein": [22.2, 45.5, 45.5],
    "right superior pulmonary vein": [63.1, 64.8, 56.5],
    "right inferior pulmonary vein": [55.0, 51.1, 56.0],
}


def loops_of(model):
    return dict(model.data.loop_points)


def angles_to_carried(model, matrix, made):
    """Degrees between a field on the image of a surface, and the image of the field that the surface has itself."""
    field = pectinate.interpolate(model, datasets.atrial_tracts("left_atrium"), maximum_distance=3).field
    image = _core.OrientationField.from_triangle_vectors(made.model.mesh, field.directions @ matrix.T)
    return np.degrees(_core.angles_between(made.field, image))


@pytest.mark.parametrize("matrix", [np.eye(3), 1.3 * rotation()])
def test_a_turned_copy_gets_the_field_turned(matrix):
    copy = mapped(atrium(), matrix)
    angles = angles_to_carried(atrium(), matrix, pectinate.atlas(copy, loops_of(copy)))
    assert np.median(angles) < 2
    assert np.percentile(angles, 95) < 20


def test_a_sheared_copy_gets_nearly_the_field_sheared():
    matrix = SHEAR @ rotation()
    copy = mapped(atrium(), matrix)
    angles = angles_to_carried(atrium(), matrix, pectinate.atlas(copy, loops_of(copy)))
    assert np.median(angles) < 6


def test_tracts_carried_to_where_they_are_stay_there():
    tracts = datasets.atrial_tracts("left_atrium")
    carried = pectinate.carry_tracts(tracts, atrium(), atrium())
    assert carried.left_out == ()
    assert [(t.name, t.label, t.weight) for t in carried.tracts.tracts] == [
        (t.name, t.label, t.weight) for t in tracts.tracts
    ]
    projector = _core.TractProjector(atrium().mesh)

    def curve(tract):
        made = projector.make_constraints([_core.Tract(tract.points)], maximum_distance=3.0)
        return made.tracts[0].points

    for before, after in zip(tracts.tracts, carried.tracts.tracts, strict=True):
        drawn, points = curve(before), after.points
        np.testing.assert_allclose(points[[0, -1]], drawn[[0, -1]], atol=1e-5)
        starts, sides = drawn[:-1], np.diff(drawn, axis=0)
        along = np.einsum("psi,si->ps", points[:, None] - starts, sides) / np.maximum((sides**2).sum(axis=1), 1e-30)
        nearest = starts + np.clip(along, 0, 1)[..., None] * sides
        assert np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1).max() < 1e-4
        assert np.linalg.norm(np.diff(points, axis=0), axis=1).max() < 3.0001


def test_conditions_go_with_the_names_of_loops():
    tracts = datasets.atrial_tracts("left_atrium")
    target = mapped(atrium(), rotation())
    carried = pectinate.carry_tracts(tracts, atrium(), target).tracts
    assert [(c.loop, c.rule) for c in carried.boundary] == [(c.loop, c.rule) for c in tracts.boundary]
    assert {name: point.tolist() for name, point in carried.loops.items()} == {
        name: point.tolist() for name, point in target.data.loop_points.items()
    }
    assert carried.surface == pectinate.SurfaceIdentity.of(target)


def test_a_loop_that_is_not_there_is_reported():
    target = without(atrium(), "left inferior pulmonary vein", "fossa ovalis")
    carried = pectinate.carry_tracts(datasets.atrial_tracts("left_atrium"), atrium(), target)
    assert "left inferior pulmonary vein" not in [condition.loop for condition in carried.tracts.boundary]
    assert carried.left_out == (
        "the surface has no loop named 'left inferior pulmonary vein': its condition was left out",
    )
    made = pectinate.atlas(without(atrium(), *atrium().loop_names), loops_of(target))
    assert carried.left_out[0] in made.notes


def test_tracts_too_far_away_are_left_out_and_reported():
    tracts = datasets.atrial_tracts("left_atrium")
    target = mapped(atrium(), SHEAR)
    carried = pectinate.carry_tracts(tracts, atrium(), target, maximum_distance=1e-9)
    assert carried.tracts.tracts == ()
    assert len(carried.left_out) == len(tracts.tracts)
    assert all("mm from the surface" in sentence for sentence in carried.left_out)
    assert len(carried.tracts.boundary) == len(tracts.boundary)
    for wrong in (0, -1, np.nan):
        with pytest.raises(InvalidOption, match="maximum_distance"):
            pectinate.carry_tracts(tracts, atrium(), target, maximum_distance=wrong)


def test_a_tract_that_collapses_is_left_out_and_reported():
    tiny = pectinate.Tract(atrium().mesh.vertices[[0, 0]] + [[0, 0, 0], [1e-3, 0, 0]], name="tiny")
    target = mapped(atrium(), 1e-9 * np.eye(3))
    carried = pectinate.carry_tracts(pectinate.TractSet([tiny]), atrium(), target)
    assert len(carried.tracts.tracts) + len(carried.left_out) == 1
    assert all("tiny" in sentence for sentence in carried.left_out)


def test_a_tract_that_meets_a_slit_is_left_out_and_reported():
    tract = next(t for t in datasets.atrial_tracts("left_atrium").tracts if t.name == "septopulmonary bundle")
    start, end = tract.points[1:3]
    mesh, middle, along = atrium().mesh, (start + end) / 2, (end - start) / np.linalg.norm(end - start)
    offsets = mesh.vertices[mesh.triangles].mean(axis=1) - middle
    slit = (np.abs(offsets @ along) < 1.5) & (np.linalg.norm(offsets, axis=1) < 12)
    data = replace(atrium().data, triangles=atrium().data.triangles[~slit[np.argsort(mesh.input_triangle)]], tags=None)
    carried = pectinate.carry_tracts(pectinate.TractSet([tract]), atrium(), pectinate.Model.from_data(data))
    assert carried.tracts.tracts == ()
    assert "'septopulmonary bundle' was left out: between two of its points" in carried.left_out[0]


def test_the_order_of_names_means_nothing():
    names = list(atrium().loop_names)
    first, second = ({name: atrium().data.loop_points[name] for name in order} for order in (names, names[::-1]))
    fields = [pectinate.atlas(atrium(), loops, layer="endocardium").field for loops in (first, second)]
    assert fields[0].directions.tobytes() == fields[1].directions.tobytes()


def test_the_chamber_follows_from_the_names():
    right = atrium("right_atrium")
    loops = {name.replace(" ", "_"): point for name, point in loops_of(right).items()}
    named = pectinate.atlas(right, loops, chamber="right_atrium")
    assert pectinate.atlas(right, loops).field.directions.tobytes() == named.field.directions.tobytes()
    both = {"fossa ovalis": [0, 0, 0]}
    with pytest.raises(InvalidOption, match="do not tell the chamber"):
        pectinate.atlas(right, both)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"chamber": "left_atrium", "loops": {"tricuspid valve": [0, 0, 0]}},
            "the left atrium has no 'tricuspid valve'",
        ),
        ({"loops": {"mitral valv": [0, 0, 0]}}, "'mitral valve' instead of 'mitral valv'"),
        ({"chamber": "left_atrium", "loops": {"mitral vale": [0, 0, 0]}}, "'mitral valve' instead of 'mitral vale'"),
        ({"chamber": "ventricle"}, "chamber"),
        ({"layer": "mesocardium"}, "layer"),
        ({"loops": {}}, "do not tell the chamber"),
        ({"loops": {"mitral valve": [0, 0]}}, "the point of loop 'mitral valve'"),
        ({"loops": {"mitral valve": [0, 0, np.nan]}}, "the point of loop 'mitral valve'"),
        ({"chamber": "bachmann_bundle"}, "chamber"),
    ],
)
def test_what_is_refused(options, message):
    with pytest.raises(InvalidOption, match=message):
        pectinate.atlas(atrium(), **{"loops": loops_of(atrium()), **options})


def test_files_of_loops(tmp_path):
    bare, tracts = tmp_path / "bare.json", tmp_path / "tracts.json"
    bare.write_text('{"mitral valve": [1, 2.5, -3]}')
    pectinate.TractSet(loops={"mitral valve": np.array([1, 2.5, -3])}).save(tracts)
    for path in (bare, tracts):
        assert {name: point.tolist() for name, point in read_loops(path).items()} == {"mitral valve": [1, 2.5, -3]}
    for text, message in (('{"a": [1, 2]}', "2 numbers"), ("[]", "object"), ('{"a": "b"}', "list"), ("{", "JSON")):
        bare.write_text(text)
        with pytest.raises(InvalidFile, match=message):
            read_loops(bare)
    with pytest.raises(InvalidFile):
        read_loops(tmp_path / "none.json")


@pytest.fixture
def bare(tmp_path):
    """A surface in a file, and a file of its names."""
    surface, loops = tmp_path / "bare.ply", tmp_path / "loops.json"
    model = mapped(atrium(), rotation())
    rows = [f"{x} {y} {z}" for x, y, z in model.data.vertices.tolist()]
    faces = [f"3 {a} {b} {c}" for a, b, c in model.data.triangles.tolist()]
    head = ["ply", "format ascii 1.0", f"element vertex {len(rows)}", *(f"property double {axis}" for axis in "xyz")]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    surface.write_text("\n".join([*head, *rows, *faces, ""]))
    pectinate.TractSet(loops=model.data.loop_points).save(loops)
    return surface, loops


def test_the_command_saves_field_and_tracts(bare, tmp_path, capsys):
    surface, loops = bare
    out, tracts = tmp_path / "f.vtp", tmp_path / "carried.json"
    words = ["atlas", surface, "--loops", loops, "--units", "mm", "--layer", "endocardium", "--out", out]
    found = run_json(capsys, *words, "--tracts-out", tracts)
    expected = pectinate.atlas(pectinate.load(surface, units="mm"), loops, layer="endocardium")
    assert found["interpolation"] == expected.report()
    assert found["files"] == [str(out), str(tracts)]
    assert pectinate.load(out, units="mm").data.vectors.tolist() == expected.field.directions.tolist()
    again = pectinate.interpolate(pectinate.load(surface, units="mm"), tracts)
    assert again.field.directions.tobytes() == expected.field.directions.tobytes()


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["atlas", "SURFACE"], ExitCode.USAGE, "--loops"),
        (["atlas", "SURFACE", "--loops", "none.json"], ExitCode.REJECTED, "none.json"),
        (["atlas", "SURFACE", "--loops", "LOOPS", "--chamber", "right_atrium"], ExitCode.USAGE, "tricuspid valve"),
        (["atlas", "SURFACE", "--loops", "LOOPS", "--tracts-out", "t.txt"], ExitCode.USAGE, "--tracts-out"),
        (["atlas", "SURFACE", "--loops", "LOOPS", "--tracts-out", "no/t.json"], ExitCode.FAILED, "no folder"),
    ],
)
def test_the_command_refuses(words, code, said, bare, capsys):
    check_error({"SURFACE": str(bare[0]), "LOOPS": str(bare[1])}, capsys, [*words, "--units", "mm"], code, said)


def test_a_measured_left_atrium(human_atrium):
    model = pectinate.load(human_atrium / "la_epi.pts")
    made = pectinate.atlas(model, LOOPS)
    left_out = [note for note in made.notes if "was left out" in note]
    assert len(made.tracts.tracts) + len(left_out) == len(datasets.atrial_tracts("left_atrium").tracts)
    assert len(left_out) <= 2
    assert "5 loops" in made.notes[0]
    found = pectinate.correspond(atrium(), made.model)
    assert np.median(found.distances) < 1.5
    assert found.landmark_distances.max() < 3
