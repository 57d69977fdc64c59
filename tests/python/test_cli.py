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
from PIL import Image

import pectinate
from command_line import SIDE, check_error, run_json, write_lines
from pectinate import _core
from pectinate.cli import ExitCode, commands, main
from pectinate.cli.progress import ProgressBar
from pectinate.figure import SurfaceValues


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
        ("--singularity-radius", "0.5", "singularity_radius", 0.5),
        ("--polishing-rounds", "2", "polishing_rounds", 2),
        ("--polishing-time", "0.01", "polishing_time", 0.01),
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


def test_place_closes_loops_if_asked(square, capsys):
    default = run_json(capsys, "place", square)["options"]
    assert run_json(capsys, "place", square, "--close-loops")["options"] == default | {"close_loops": True}


def test_tube_options_reach_the_tubes(square, tmp_path):
    for sides in (3, 5):
        words = ["place", str(square), "--quiet", "--tubes", str(tmp_path / f"{sides}.obj"), "--tube-sides", str(sides)]
        assert main(words) == ExitCode.DONE
    faces = {sides: (tmp_path / f"{sides}.obj").read_text().count("\nf ") for sides in (3, 5)}
    assert faces[3] < faces[5]
    flat = tmp_path / "flat.ply"
    assert main(["place", str(square), "--quiet", "--tubes", str(flat), "--tube-height", "0.25"]) == ExitCode.DONE
    # The square lies in a plane; its tubes are round unless told otherwise.
    assert main(["place", str(square), "--quiet", "--tubes", str(tmp_path / "round.ply")]) == ExitCode.DONE
    low, high = (np.ptp(pectinate.load(file).mesh.vertices[:, 2]) for file in (flat, tmp_path / "round.ply"))
    assert low == pytest.approx(0.25 * high, rel=1e-5)


@pytest.mark.usefixtures("opengl")
def test_values_colour_the_picture_and_the_page(square, tmp_path):
    pytest.importorskip("matplotlib")
    model = pectinate.load(square)
    heights, tags = model.mesh.vertices[:, 1], np.arange(len(model.mesh.triangles))
    for name, array in (("height", heights), ("tag", tags)):
        np.save(tmp_path / f"{name}.npy", array)
    words = [
        "place",
        square,
        "--quiet",
        "--figure",
        tmp_path / "f.png",
        "--out",
        tmp_path / "p.html",
        "--views",
        "left",
    ]
    words += ["--values", tmp_path / "height.npy", "--contours", "2", "--tube-values", tmp_path / "tag.npy"]
    assert main([str(word) for word in words]) == ExitCode.DONE
    expected = pectinate.place_streamlines(model).figure(
        views=["left"],
        surface_values=SurfaceValues(heights, label="height", contours=2),
        tube_values=SurfaceValues(tags, label="tag"),
    )
    assert np.array_equal(np.asarray(Image.open(tmp_path / "f.png")), np.asarray(expected))
    html = (tmp_path / "p.html").read_text(encoding="utf-8")
    assert '"label":"height"' in html
    assert '"label":"tag"' in html
    assert '"contours":{' in html


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


def test_demo_makes_both_atria_inside_and_outside(tmp_path, capsys):
    folder = tmp_path / "a" / "b"
    report = run_json(capsys, "demo", "--out", folder, "--edge-length", "2", "--separation", "5")
    surfaces = [(row["layer"], row["chamber"]) for row in report["surfaces"]]
    assert surfaces == [
        ("epicardium", "left_atrium"),
        ("epicardium", "right_atrium"),
        ("epicardium", "bachmann_bundle"),
        ("endocardium", "left_atrium"),
        ("endocardium", "right_atrium"),
    ]
    assert all(row["statistics"]["coverage"] > 0.99 and row["seconds"] > 0 for row in report["surfaces"])
    written = {path for path in folder.rglob("*") if path.is_file()}
    assert {Path(path) for path in report["files"]} == written
    assert (folder / "fibres.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    loaded = pectinate.load(folder / "epicardium" / "left_atrium.pts")
    tracts = folder / "epicardium" / "left_atrium_tracts.json"
    again = pectinate.interpolate(loaded, tracts, maximum_distance=5)
    assert np.degrees(_core.angles_between(again.field, loaded.field)).max() < 0.01  # digits of the files


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        ([], ExitCode.USAGE, "COMMAND"),
        (["paint"], ExitCode.USAGE, "paint"),
        (["place"], ExitCode.USAGE, "MESH"),
        (["place", "SQUARE", "--seeds", "many"], ExitCode.USAGE, "many"),
        (["place", "SQUARE", "--seeds", "0"], ExitCode.USAGE, "--seeds is 0"),
        (["place", "SQUARE", "--threads", "99999999999999999999"], ExitCode.USAGE, "thread"),
        (["place", "SQUARE", "--random-seed", "-1"], ExitCode.USAGE, "random"),
        (["place", "SQUARE", "--separation", "nan"], ExitCode.USAGE, "--separation is nan"),
        (["place", "SQUARE", "--method", "nearest"], ExitCode.USAGE, "--method is 'nearest'"),
        (["place", "SQUARE", "--abrupt-turn-angle", "181"], ExitCode.USAGE, "at most 180 degrees"),
        (["place", "SQUARE", "--minimum-length", "-1"], ExitCode.USAGE, "--minimum-length is -1"),
        (["place", "SQUARE", "--singularity-radius", "-1"], ExitCode.USAGE, "--singularity-radius is -1"),
        (
            ["place", "SQUARE", "--close-loops", "--method", "random"],
            ExitCode.USAGE,
            "--close-loops needs method longest",
        ),
        (["place", "SQUARE", "--tubes", "FOLDER/t.ply", "--tube-radius", "-1"], ExitCode.USAGE, "--tube-radius is -1"),
        (["place", "SQUARE", "--units", "inch"], ExitCode.USAGE, "inch"),
        (["place", "SQUARE", "--out", "FOLDER/r.txt"], ExitCode.USAGE, ".txt"),
        (["place", "SQUARE", "--figure", "FOLDER/f.npz"], ExitCode.USAGE, "f.npz"),
        (["place", "SQUARE", "--tubes", "FOLDER/r.npz"], ExitCode.USAGE, "r.npz"),
        (["place", "SQUARE", "--figure", "FOLDER/f.png", "--views", "sideways"], ExitCode.USAGE, "sideways"),
        (["place", "SQUARE", "--tubes", "FOLDER/t.ply", "--tube-sides", "2"], ExitCode.USAGE, "--tube-sides"),
        (["place", "SQUARE", "--figure", "FOLDER/f.png", "--tube-height", "2"], ExitCode.USAGE, "--tube-height is 2"),
        (["place", "SQUARE", "--values", "v.npy"], ExitCode.USAGE, "--values: only pictures and pages have colours"),
        (["place", "SQUARE", "--tube-values", "v.txt", "--figure", "FOLDER/f.png"], ExitCode.USAGE, "v.txt"),
        (["place", "SQUARE", "--figure", "FOLDER/f.png", "--contours", "2"], ExitCode.USAGE, "--contours serves"),
        (
            ["place", "SQUARE", "--figure", "FOLDER/f.png", "--values", "a.npy", "--values", "b.npy"],
            ExitCode.USAGE,
            "a picture shows one of --values",
        ),
        (["place", "SQUARE", "--figure", "FOLDER/f.png", "--tube-values", "FOLDER/a.npy"], ExitCode.REJECTED, "a.npy"),
        (["place", "FOLDER/none.elem"], ExitCode.REJECTED, "none"),
        (["place", "SQUARE", "--field", "FOLDER/none.lon"], ExitCode.REJECTED, "none"),
        (["place", "FOLDER"], ExitCode.REJECTED, "FOLDER"),
        (["info", "FOLDER/mesh.xyz"], ExitCode.REJECTED, "xyz"),
        (["place", "SQUARE", "--out", "FOLDER/none/r.npz"], ExitCode.FAILED, "none"),
        (["demo", "--out", "SQUARE/x", "--edge-length", "4"], ExitCode.FAILED, "square"),
        (["demo", "--edge-length", "1000"], ExitCode.USAGE, "--edge-length is 1000"),
    ],
)
def test_errors_are_one_line_and_a_code(square, tmp_path, capsys, words, code, said):
    check_error({"SQUARE": str(square), "FOLDER": str(tmp_path)}, capsys, words, code, said)


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
    words = ["demo", "--out", str(tmp_path), "--edge-length", "1", "--separation", "0.04", "--json"]
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
