"""The command line: what it writes, prints and returns."""

from __future__ import annotations

import io
import json
import math
import os
import pty
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

import pectinate
from pectinate.cli import ExitCode, commands, main
from pectinate.cli.progress import ProgressBar

SIDE = 12  # mm, of a flat square with edges of 1 mm


@pytest.fixture
def square(tmp_path: Path) -> Path:
    """A flat square with fibres along x, as openCARP files."""
    x, y = np.meshgrid(np.arange(SIDE + 1), np.arange(SIDE + 1))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(SIDE)[:, None] * (SIDE + 1) + np.arange(SIDE)).ravel()
    lower = np.column_stack([corner, corner + 1, corner + SIDE + 2])
    upper = np.column_stack([corner, corner + SIDE + 2, corner + SIDE + 1])
    triangles = np.concatenate([lower, upper])
    base = tmp_path / "square"
    write_lines(base.with_suffix(".pts"), [str(len(points)), *(f"{a} {b} {c}" for a, b, c in points)])
    write_lines(base.with_suffix(".elem"), [str(len(triangles)), *(f"Tr {a} {b} {c} 1" for a, b, c in triangles)])
    write_lines(base.with_suffix(".lon"), ["1", *("1 0 0" for _ in triangles)])
    return base.with_suffix(".elem")


def write_lines(path: Path, lines: list[str]) -> None:
    path.write_text("\n".join(lines) + "\n")


def run_json(capsys: pytest.CaptureFixture[str], *words: object) -> dict:
    assert main([str(word) for word in words] + ["--json"]) == ExitCode.DONE
    return json.loads(capsys.readouterr().out)


def test_place_writes_every_format_and_reports_it(square, tmp_path, capsys):
    files = [tmp_path / f"r{suffix}" for suffix in (".npz", ".vtp", ".ply", ".obj", ".glb", ".html")]
    report = run_json(capsys, "place", square, *(word for path in files for word in ("--out", path)))
    assert report["files"] == [str(path) for path in files]
    assert all(path.stat().st_size > 0 for path in files)
    with np.load(files[0]) as saved:
        assert len(saved["offsets"]) == report["statistics"]["streamline_count"] + 1
    assert report["end"] == "complete"
    assert report["surface"]["mesh"]["triangles"] == 2 * SIDE**2
    assert report["statistics"]["surface_area"] == pytest.approx(SIDE**2)


def test_place_leaves_the_defaults_to_the_library(square, tmp_path):
    assert main(["place", str(square), "--quiet", "--out", str(tmp_path / "r.npz")]) == ExitCode.DONE
    expected = pectinate.place_streamlines(pectinate.load(square))
    with np.load(tmp_path / "r.npz") as saved:
        assert np.array_equal(saved["points"], expected.points)
        assert np.array_equal(saved["offsets"], expected.offsets)


@pytest.mark.parametrize(
    ("flag", "word", "option", "value"),
    [
        ("--separation", "2.5", "separation_distance", 2.5),
        ("--method", "random", "method", "random"),
        ("--method", "neighborhood", "method", "neighborhood"),
        ("--seeds", "3", "seed_count", 3),
        ("--seed-distance-factor", "1.5", "seed_distance_factor", 1.5),
        ("--max-steps", "7", "max_steps", 7),
        ("--random-seed", "12345", "random_seed", 12345),
        ("--threads", "2", "thread_count", 2),
        ("--abrupt-turn-angle", "60", "abrupt_turn_angle", math.radians(60)),
    ],
)
def test_place_passes_each_option_on(square, capsys, flag, word, option, value):
    changed = run_json(capsys, "place", square, flag, word)["options"]
    default = run_json(capsys, "place", square)["options"]
    assert changed.pop(option) == value != default.pop(option)
    assert changed == default


def test_tube_options_reach_the_tubes(square, tmp_path):
    for sides in (3, 5):
        words = ["place", str(square), "--quiet", "--tubes", str(tmp_path / f"{sides}.obj"), "--tube-sides", str(sides)]
        assert main(words) == ExitCode.DONE
    faces = {sides: (tmp_path / f"{sides}.obj").read_text().count("\nf ") for sides in (3, 5)}
    assert faces[3] < faces[5]


def test_units_and_field_reach_the_loader(square, capsys):
    assert run_json(capsys, "info", square, "--units", "cm")["mesh"]["area"] == pytest.approx(100 * SIDE**2)
    other = square.with_name("other.lon")
    write_lines(other, ["1", *("0 0 1" if row == 0 else "0 1 0" for row in range(2 * SIDE**2))])
    assert run_json(capsys, "info", square, "--field", other)["field"]["status"]["normal"] == 1


def test_info_is_the_summary_of_the_model(square, capsys):
    assert run_json(capsys, "info", square) == json.loads(json.dumps(pectinate.load(square).summary()))
    assert main(["info", str(square)]) == ExitCode.DONE
    text = capsys.readouterr().out
    assert f"{2 * SIDE**2} of {2 * SIDE**2}" in text
    assert f"length {4 * SIDE:.2f} mm" in text


def test_statistics_are_printed_for_people(square, capsys):
    statistics = run_json(capsys, "place", square)["statistics"]
    assert main(["place", str(square)]) == ExitCode.DONE
    printed = capsys.readouterr().out
    assert f"{statistics['mean_length']:.2f} mm" in printed
    assert f"{statistics['mean_spacing_ratio']:.3f} separation distances" in printed


def test_quiet_prints_nothing(square, capsys):
    assert main(["place", str(square), "--quiet"]) == ExitCode.DONE
    assert capsys.readouterr() == ("", "")


def test_demo_writes_streamlines_and_picture(tmp_path, capsys):
    folder = tmp_path / "a" / "b"
    report = run_json(capsys, "demo", "--out", folder, "--edge-length", "3", "--separation", "5", "--seeds", "2")
    assert report["files"] == [str(folder / "demo_atrium.npz"), str(folder / "demo_atrium.png")]
    assert (folder / "demo_atrium.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    assert len(report["surface"]["boundary_loops"]) == 5


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        ([], ExitCode.USAGE, "COMMAND"),
        (["paint"], ExitCode.USAGE, "paint"),
        (["place"], ExitCode.USAGE, "MESH"),
        (["place", "SQUARE", "--seeds", "many"], ExitCode.USAGE, "many"),
        (["place", "SQUARE", "--seeds", "0"], ExitCode.USAGE, "seed_count"),
        (["place", "SQUARE", "--threads", "99999999999999999999"], ExitCode.USAGE, "thread"),
        (["place", "SQUARE", "--random-seed", "-1"], ExitCode.USAGE, "random"),
        (["place", "SQUARE", "--separation", "nan"], ExitCode.USAGE, "separation_distance"),
        (["place", "SQUARE", "--method", "nearest"], ExitCode.USAGE, "nearest"),
        (["place", "SQUARE", "--units", "inch"], ExitCode.USAGE, "inch"),
        (["place", "SQUARE", "--out", "FOLDER/r.txt"], ExitCode.USAGE, ".txt"),
        (["place", "SQUARE", "--figure", "FOLDER/f.npz"], ExitCode.USAGE, "f.npz"),
        (["place", "SQUARE", "--tubes", "FOLDER/r.npz"], ExitCode.USAGE, "r.npz"),
        (["place", "SQUARE", "--figure", "FOLDER/f.png", "--views", "sideways"], ExitCode.USAGE, "sideways"),
        (["place", "SQUARE", "--tubes", "FOLDER/t.ply", "--tube-sides", "2"], ExitCode.USAGE, "side_count"),
        (["place", "FOLDER/none.elem"], ExitCode.REJECTED, "none"),
        (["place", "SQUARE", "--field", "FOLDER/none.lon"], ExitCode.REJECTED, "none"),
        (["place", "FOLDER"], ExitCode.REJECTED, "FOLDER"),
        (["info", "FOLDER/mesh.xyz"], ExitCode.REJECTED, "xyz"),
        (["place", "SQUARE", "--out", "FOLDER/none/r.npz"], ExitCode.FAILED, "none"),
        (["demo", "--out", "SQUARE/x", "--edge-length", "4"], ExitCode.FAILED, "square"),
        (["demo", "--edge-length", "1000"], ExitCode.USAGE, "edge_length"),
    ],
)
def test_errors_are_one_line_and_a_code(square, tmp_path, capsys, words, code, said):
    check_error({"SQUARE": str(square), "FOLDER": str(tmp_path)}, capsys, words, code, said)


def check_error(names, capsys, words, code, said):
    for name, path in names.items():
        words = [word.replace(name, path) for word in words]
    assert main(words) == code
    error = capsys.readouterr().err
    assert error.startswith("pectinate: error: ")
    assert error.count("\n") == 1
    assert names.get(said, said) in error
    assert "fault of pectinate" not in error


def test_broken_input_is_rejected(square, capsys):
    text = square.read_text().replace("Tr 0 1", "Tr 0 9999", 1)
    square.write_text(text)
    assert main(["info", str(square)]) == ExitCode.REJECTED
    assert "9999" in capsys.readouterr().err


def test_a_surface_without_fibres_can_be_described_but_not_filled(square, capsys):
    square.with_suffix(".lon").unlink()
    assert run_json(capsys, "info", square)["field"] is None
    assert main(["place", str(square)]) == ExitCode.REJECTED
    assert "--field" in capsys.readouterr().err


def test_a_fault_is_one_line_unless_debugged(square, capsys, monkeypatch):
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("two\nlines")

    monkeypatch.setattr(commands.pectinate, "load", fail)
    assert main(["info", str(square)]) == ExitCode.FAILED
    assert "RuntimeError: two lines" in capsys.readouterr().err
    with pytest.raises(RuntimeError, match="two"):
        main(["info", str(square), "--debug"])


def test_version(capsys):
    assert main(["--version"]) == ExitCode.DONE
    assert capsys.readouterr().out == f"pectinate {version('pectinate')}\n"


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_progress_bar_draws_on_terminals_only():
    terminal, file = Terminal(), io.StringIO()
    for stream in (terminal, file):
        with ProgressBar("placing", stream=stream) as bar:
            bar(0.5)
    assert file.getvalue() == ""
    assert terminal.getvalue() == f"\rplacing [{'#' * 20}{'.' * 20}]  50%\r\033[K"
    with ProgressBar("placing", enabled=False, stream=(hidden := Terminal())) as bar:
        bar(0.5)
    assert hidden.getvalue() == ""


def test_progress_bar_draws_seldom():
    with ProgressBar("placing", stream=(terminal := Terminal())) as bar:
        for step in range(1000):
            bar(step / 1000)
    assert terminal.getvalue().count("%") < 20


def test_interrupt_ends_at_once_with_its_code(tmp_path):
    controller, terminal = pty.openpty()
    # Processes in the background ignore the signal unless told otherwise.
    heed = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    program = f"{heed}; import sys; from pectinate.cli import main; sys.exit(main())"
    words = ["demo", "--out", str(tmp_path), "--edge-length", "0.5", "--separation", "0.1", "--json"]
    process = subprocess.Popen([sys.executable, "-c", program, *words], stdout=subprocess.PIPE, stderr=terminal)
    os.close(terminal)
    seen = b""
    while b"%" not in seen:
        seen += os.read(controller, 1024)
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=10)
    while b"interrupted" not in seen:
        seen += os.read(controller, 1024)
    os.close(controller)
    assert process.returncode == ExitCode.INTERRUPTED
    assert output == b""


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


def test_info_names_loops(square, tracts, capsys):
    (loop,) = run_json(capsys, "info", square, "--tracts", tracts)["boundary_loops"]
    assert loop["names"] == ["border"]
    assert main(["info", str(square), "--tracts", str(tracts)]) == ExitCode.DONE
    assert "border: length" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["interpolate", "SQUARE"], ExitCode.USAGE, "required: TRACTS"),
        (["interpolate", "SQUARE", "TRACTS", "--method", "magic"], ExitCode.USAGE, "magic"),
        (["interpolate", "SQUARE", "TRACTS", "--outer", "valve"], ExitCode.USAGE, "valve"),
        (["interpolate", "SQUARE", "TRACTS", "--outer", "7"], ExitCode.USAGE, "loop 7"),
        (["interpolate", "SQUARE", "TRACTS", "--inner-point", "1,2"], ExitCode.USAGE, "1,2"),
        (["interpolate", "SQUARE", "TRACTS", "--second", "sheet", "--out", "FOLDER/f.vtp"], ExitCode.USAGE, "sheet"),
        (["interpolate", "SQUARE", "TRACTS", "--out", "FOLDER/f.ply"], ExitCode.USAGE, ".ply"),
        (["interpolate", "SQUARE", "TRACTS", "--out", "FOLDER/none/f.lon"], ExitCode.FAILED, "no folder"),
        (["interpolate", "SQUARE", "TRACTS", "--maximum-distance", "-1"], ExitCode.USAGE, "maximum_distance"),
        (["interpolate", "SQUARE", "FOLDER/none.json"], ExitCode.REJECTED, "none.json"),
        (["interpolate", "SQUARE", "SQUARE"], ExitCode.REJECTED, "no JSON"),
        (["info", "SQUARE", "--tracts", "FOLDER/none.json"], ExitCode.REJECTED, "none.json"),
        (["parameterize", "SQUARE", "--figure", "FOLDER/f.npz"], ExitCode.USAGE, "f.npz"),
        (["smooth", "SQUARE", "--length", "-1"], ExitCode.USAGE, "length"),
        (["smooth", "SQUARE", "--barriers", "walls"], ExitCode.USAGE, "walls"),
        (["compare", "SQUARE"], ExitCode.USAGE, "SECOND"),
        (["compare", "SQUARE", "SQUARE", "--how", "somehow"], ExitCode.USAGE, "somehow"),
        (["compare", "SQUARE", "SQUARE", "--how", "disks"], ExitCode.USAGE, "loop"),
        (["compare", "SQUARE", "SQUARE", "--how", "disks", "--pair", "0"], ExitCode.USAGE, "pair of loops"),
        (["compare", "SQUARE", "FOLDER/none.vtp"], ExitCode.REJECTED, "none.vtp"),
    ],
)
def test_errors_of_the_commands_on_fields(square, tracts, tmp_path, capsys, words, code, said):
    names = {"SQUARE": str(square), "FOLDER": str(tmp_path), "TRACTS": str(tracts)}
    check_error(names, capsys, words, code, said)
