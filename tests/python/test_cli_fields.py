"""The commands that make and compare orientation fields."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import pectinate
from command_line import check_error, run_json
from marks import needs_map
from meshes import single_triangle, with_hole
from pectinate.cli import ExitCode, main


@pytest.fixture
def tracts(tmp_path: Path) -> Path:
    """A tract across the square, and a name for its border."""
    path = tmp_path / "tracts.json"
    tract = pectinate.Tract([[1, 2, 0], [11, 9, 0]], name="slope")
    condition = pectinate.BoundaryCondition("border", "parallel", weight=0.5)
    pectinate.TractSet([tract], [condition], {"border": [0, 0, 0]}).save(path)
    return path


def test_interpolate_writes_and_reports_a_field(square, tracts, tmp_path, capsys):
    files = [tmp_path / "f.vtp", tmp_path / "f.lon"]
    report = run_json(capsys, "interpolate", square, tracts, "--out", files[0], "--out", files[1], "--units", "mm")
    expected = pectinate.interpolate(pectinate.load(square, field=None), tracts)
    assert report["interpolation"] == expected.report()
    assert report["surface"]["source"] == str(square.with_suffix(""))
    assert report["files"] == [str(tmp_path / name) for name in ("f.vtp", "f.pts", "f.elem", "f.lon")]
    for path in (files[0], files[1]):
        written = pectinate.load(path, units="mm" if path.suffix == ".vtp" else "um").data
        assert written.vectors.tolist() == expected.field.directions.tolist()
        assert written.second_vectors is None


@needs_map
def test_interpolate_passes_each_option_on(square, tracts, tmp_path, capsys):
    words = ["--method", "reference_frame", "--outer", "border", "--inner-point", "6,6,0", "--second", "transverse"]
    words += ["--conflict-angle", "20", "--maximum-distance", "0.5", "--per-vertex", "--out", tmp_path / "f.vtu"]
    found = run_json(capsys, "interpolate", square, tracts, *words)["interpolation"]
    options = {"outer_loop": 0, "inner_point": (6, 6, 0), "conflict_angle": math.radians(20), "maximum_distance": 0.5}
    expected = pectinate.interpolate(square, tracts, method="reference_frame", **options)
    assert found == expected.report()
    dataset = pytest.importorskip("pyvista").read(tmp_path / "f.vtu")
    assert set(dataset.cell_data) == {"fiber", "sheet", "elemTag", "confidence", "angle"}
    assert set(dataset.point_data) == {"fiber"}


@needs_map
def test_interpolate_prints_for_people(square, tracts, capsys):
    assert main(["interpolate", str(square), str(tracts), "--outer", "0"]) == ExitCode.DONE
    printed = capsys.readouterr().out
    for said in ("slope: 12.2 mm through", "loop 0: parallel", "outer loop 0", "flipped triangles     0", "energy"):
        assert said in printed


def test_interpolate_draws(square, tracts, tmp_path):
    picture = tmp_path / "f.png"
    words = [
        "interpolate",
        str(square),
        str(tracts),
        "--figure",
        str(picture),
        "--separation",
        "2",
        "--views",
        "superior",
    ]
    assert main([*words, "--quiet"]) == ExitCode.DONE
    assert picture.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")


@needs_map
def test_parameterize_reports_the_disk(square, tracts, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "disk.png"
    words = ["--tracts", tracts, "--outer", "border", "--inner-point=6,6,-0.1", "--figure", picture]
    report = run_json(capsys, "parameterize", square, *words)
    assert report["disk"] == pectinate.parameterize(square, outer_loop=0, inner_point=(6, 6, -0.1)).report()
    assert report["files"] == [str(picture)]
    assert picture.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    assert main(["parameterize", str(square)]) == ExitCode.DONE
    assert "outer loop 0, inner none" in capsys.readouterr().out


def test_smooth_writes_and_reports(square, tmp_path, capsys):
    words = ["--length", "2", "--barriers", "tags", "--outlier-angle", "20", "--fill-missing"]
    report = run_json(capsys, "smooth", square, *words, "--out", tmp_path / "s.vtp")
    options = {"length": 2, "barriers": "tags", "outlier_angle": math.radians(20)}
    expected = pectinate.smooth(square, fill_missing=True, **options)
    assert report["smoothing"] == expected.report()
    assert pectinate.load(tmp_path / "s.vtp").data.vectors.tolist() == expected.field.directions.tolist()
    assert main(["smooth", str(square)]) == ExitCode.DONE
    assert "outliers replaced" in capsys.readouterr().out


def test_compare_reports_angles_per_region(square, tmp_path, capsys):
    other = tmp_path / "other.vtp"
    pectinate.save_surface(pectinate.add_noise(pectinate.load(square), 0.3), other)
    report = run_json(capsys, "compare", square, other, "--out", tmp_path / "c.vtp", "--second", "none")
    assert report["comparison"] == pectinate.compare(square, other).report()
    assert set(report["comparison"]["angles_per_region"]) == {"1"}
    near = run_json(capsys, "compare", square, other, "--how", "nearest", "--maximum-distance", "0.5")
    expected = pectinate.compare(square, other, how="nearest", maximum_distance=0.5)
    assert near["comparison"] == expected.report()
    assert main(["compare", str(square), str(other), "--how", "nearest"]) == ExitCode.DONE
    printed = capsys.readouterr().out
    assert "degrees (median)" in printed
    assert "distance" in printed


@needs_map
def test_compare_by_disks_names_loops(tmp_path, capsys):
    surfaces, drawings = [], []
    for name, size in (("small", 1.0), ("large", 3.0)):
        mesh = with_hole(16, size)
        field = np.tile([1.0, 0.3 * size, 0], (len(mesh[1]), 1))
        surfaces.append(tmp_path / f"{name}.vtp")
        drawings.append(tmp_path / f"{name}.json")
        pectinate.save_surface(pectinate.load((*mesh, field)), surfaces[-1])
        pectinate.TractSet(loops={"hole": [0.6 * size, 0.5 * size, 0], "rim": [0, 0, 0]}).save(drawings[-1])
    words = ["compare", *surfaces, "--how", "disks", "--tracts", drawings[0], "--tracts", drawings[1]]
    report = run_json(capsys, *words)["comparison"]
    models = [
        pectinate.load(path).with_loop_points(pectinate.read_tracts(drawing).loops)
        for path, drawing in zip(surfaces, drawings, strict=True)
    ]
    assert report == pectinate.compare(*models, how="disks").report()
    chosen = ["--outer-first", "rim", "--outer-second", "rim", "--pair", "hole=hole"]
    assert run_json(capsys, *words, *chosen)["comparison"] == report
    # One file names the loops of both: the rim of the small surface is nearest to the hole of the large one.
    once = [*words[:-4], "--tracts", drawings[1], "--pair", "hole=hole"]
    near_rim = pectinate.load(surfaces[0]).with_loop_points(pectinate.read_tracts(drawings[1]).loops)
    assert near_rim.loop_names["hole"] == near_rim.loop_names["rim"]
    assert main([str(word) for word in once]) == ExitCode.USAGE
    assert "outer" in capsys.readouterr().err


def test_info_names_loops(square, tracts, capsys):
    (loop,) = run_json(capsys, "info", square, "--tracts", tracts)["boundary_loops"]
    assert loop["names"] == ["border"]
    assert main(["info", str(square), "--tracts", str(tracts)]) == ExitCode.DONE
    assert "border: length" in capsys.readouterr().out


def single_triangle_field():
    vertices, triangles = single_triangle()
    return vertices, triangles, np.array([[1.0, 0, 0]])


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["interpolate", "SQUARE"], ExitCode.USAGE, "required: TRACTS"),
        (["interpolate", "SQUARE", "TRACTS", "--method", "magic"], ExitCode.USAGE, "--method is 'magic'"),
        (["interpolate", "SQUARE", "TRACTS", "--outer", "valve"], ExitCode.USAGE, "valve"),
        (["interpolate", "SQUARE", "TRACTS", "--outer", "7"], ExitCode.USAGE, "loop 7"),
        (["interpolate", "SQUARE", "TRACTS", "--inner-point", "1,2"], ExitCode.USAGE, "1,2"),
        (
            ["interpolate", "SQUARE", "TRACTS", "--second", "sheet", "--out", "FOLDER/f.vtp"],
            ExitCode.USAGE,
            "--second = 'sh",
        ),
        (["interpolate", "SQUARE", "TRACTS", "--second", "normal"], ExitCode.USAGE, "--second serves --out alone"),
        (["interpolate", "SQUARE", "TRACTS", "--views", "left"], ExitCode.USAGE, "--views serves --figure alone"),
        (["smooth", "SQUARE", "--per-vertex"], ExitCode.USAGE, "--per-vertex serves --out alone"),
        (["smooth", "SQUARE", "--separation", "2"], ExitCode.USAGE, "--separation serves --figure alone"),
        (["compare", "SQUARE", "SQUARE", "--views", "left"], ExitCode.USAGE, "--views serves --figure alone"),
        (["interpolate", "SQUARE", "TRACTS", "--out", "FOLDER/f.ply"], ExitCode.USAGE, ".ply"),
        (["interpolate", "SQUARE", "TRACTS", "--out", "FOLDER/none/f.lon"], ExitCode.FAILED, "no folder"),
        (["interpolate", "SQUARE", "TRACTS", "--maximum-distance", "-1"], ExitCode.USAGE, "--maximum-distance is -1"),
        (["interpolate", "SQUARE", "TRACTS", "--conflict-angle", "91"], ExitCode.USAGE, "at most 90 degrees"),
        (["interpolate", "SQUARE", "TRACTS", "--conflict-angle", "nan"], ExitCode.USAGE, "at most 90 degrees"),
        (
            ["interpolate", "SQUARE", "TRACTS", "--inner", "0", "--inner-point", "1,2,3"],
            ExitCode.USAGE,
            "--inner and --inner-point are both given",
        ),
        (["interpolate", "SQUARE", "TRACTS", "--inner-point", "1,2,nan"], ExitCode.USAGE, "--inner-point is (1.0"),
        (
            ["interpolate", "SQUARE", "TRACTS", "--figure", "FOLDER/f.png", "--separation", "-1"],
            ExitCode.USAGE,
            "--separation is -1",
        ),
        (["interpolate", "SQUARE", "FOLDER/none.json"], ExitCode.REJECTED, "none.json"),
        (["interpolate", "SQUARE", "SQUARE"], ExitCode.REJECTED, "no JSON"),
        (["info", "SQUARE", "--tracts", "FOLDER/none.json"], ExitCode.REJECTED, "none.json"),
        (["parameterize", "SQUARE", "--figure", "FOLDER/f.npz"], ExitCode.USAGE, "f.npz"),
        (["smooth", "SQUARE", "--length", "-1"], ExitCode.USAGE, "--length is -1"),
        (["smooth", "SQUARE", "--length", "1e8"], ExitCode.USAGE, "--length is 1e+08"),
        (["smooth", "SQUARE", "--outlier-angle", "0"], ExitCode.USAGE, "--outlier-angle: 0 is not above 0"),
        (["smooth", "SQUARE", "--outlier-angle", "wide"], ExitCode.USAGE, "--outlier-angle"),
        (["smooth", "SQUARE", "--barriers", "walls"], ExitCode.USAGE, "--barriers is 'walls'"),
        (["compare", "SQUARE"], ExitCode.USAGE, "SECOND"),
        (["compare", "SQUARE", "SQUARE", "--how", "somehow"], ExitCode.USAGE, "--how is 'somehow'"),
        (["compare", "SQUARE", "SQUARE", "--how", "disks"], ExitCode.USAGE, "which correspond: --pair"),
        (["compare", "SQUARE", "SQUARE", "--maximum-distance", "2"], ExitCode.USAGE, "belongs to --how nearest alone"),
        (
            ["compare", "SQUARE", "SQUARE", "--how", "disks", "--maximum-distance", "2"],
            ExitCode.USAGE,
            "--maximum-distance is given, but belongs to --how nearest alone, not to 'disks'; leave it out",
        ),
        (["compare", "SQUARE", "SQUARE", "--how", "nearest", "--pair", "0=0"], ExitCode.USAGE, "--pair is given"),
        (
            ["compare", "SQUARE", "SQUARE", "--outer-second", "0"],
            ExitCode.USAGE,
            "or --outer-second is given",
        ),
        (
            ["compare", "SQUARE", "SQUARE", "--tracts", "TRACTS"],
            ExitCode.USAGE,
            "which --how disks alone compares by",
        ),
        (
            ["compare", "SQUARE", "SQUARE", "--how", "disks", *3 * ["--tracts", "TRACTS"]],
            ExitCode.USAGE,
            "--tracts is given 3 times",
        ),
        (["compare", "SQUARE", "FOLDER/other.vtp"], ExitCode.REJECTED, "compare with --how nearest or --how disks"),
        (["compare", "SQUARE", "SQUARE", "--how", "disks", "--pair", "0"], ExitCode.USAGE, "pair of loops"),
        (["compare", "SQUARE", "FOLDER/none.vtp"], ExitCode.REJECTED, "none.vtp"),
    ],
)
def test_errors_are_in_the_words_of_the_command_line(square, tracts, tmp_path, capsys, words, code, said):
    pectinate.save_surface(pectinate.load(single_triangle_field()), tmp_path / "other.vtp")
    names = {"SQUARE": str(square), "FOLDER": str(tmp_path), "TRACTS": str(tracts)}
    check_error(names, capsys, words, code, said)
