"""What every way to draw does where nothing can be drawn, where there is little to draw, and with odd values."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import meshes
import pectinate
from command_line import check_error
from pectinate import Cell, Model, Placement, compare, figure_sheet, place_streamlines
from pectinate.cli import ExitCode, main
from pectinate.errors import InvalidMesh, InvalidOption, RenderingUnavailable
from pectinate.figure import Part, SurfaceValues, View, context, draw_sheet, render_view

ABOVE = View("above", (0, 0, -1), (0, 1, 0))
SMALL = (60, 50)
Draw = Callable[[Placement, dict], object]

# Each draws a placement with values of its surface.
WAYS: dict[str, Draw] = {
    "Placement.figure": lambda p, values: p.figure(views=ABOVE, size=SMALL, **values),
    "Model.figure": lambda p, values: p.model.figure(views=ABOVE, size=SMALL, **values),
    "draw_sheet": lambda p, values: draw_sheet((p.mesh.vertices, p.mesh.triangles), views=ABOVE, size=SMALL, **values),
    "render_view": lambda p, values: render_view((p.mesh.vertices, p.mesh.triangles), view=ABOVE, size=SMALL, **values),
    "figure_sheet": lambda p, values: figure_sheet(
        Cell(p.part(**values), ABOVE), size=SMALL, shown_values="values" if values else None
    ),
}


def flat(mesh: meshes.Mesh, direction: tuple[float, float, float] = (1, 0, 0)) -> Model:
    return pectinate.load((*mesh, np.tile(np.array(direction, dtype=float), (len(mesh[1]), 1))))


def placed(mesh: meshes.Mesh | None = None, **options: float) -> Placement:
    return place_streamlines(
        flat(meshes.grid(8, 6) if mesh is None else mesh), **{"separation_distance": 2.0, **options}
    )


@pytest.fixture
def no_opengl(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(soname: str, _name: str) -> object:
        raise OSError(f"{soname} is not here")

    monkeypatch.setattr(context, "_load", refuse)


@pytest.mark.usefixtures("no_opengl")
@pytest.mark.parametrize("way", WAYS)
def test_without_opengl_every_way_names_the_packages(way: str) -> None:
    with pytest.raises(RenderingUnavailable, match=r"apt-get install .*libegl1"):
        WAYS[way](placed(), {})
    model = flat(meshes.grid())
    for draw in (compare(model, model).sheet, compare(model, model).figure):
        with pytest.raises(RenderingUnavailable, match="apt-get install"):
            draw(views=ABOVE, size=SMALL)


@pytest.mark.usefixtures("no_opengl")
def test_without_opengl_a_page_is_made_all_the_same(tmp_path: Path) -> None:
    placement = placed()
    placement.save(tmp_path / "page.html", surface_values=placement.mesh.vertices[:, 0])
    assert (tmp_path / "page.html").stat().st_size > 1000


@pytest.mark.usefixtures("no_opengl")
@pytest.mark.parametrize("words", [["place", "SQUARE"], ["smooth", "SQUARE"], ["compare", "SQUARE", "SQUARE"]])
def test_without_opengl_commands_say_so(
    words: list[str], square: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = {"SQUARE": str(square), "FOLDER": str(tmp_path)}
    check_error(names, capsys, [*words, "--figure", "FOLDER/f.png"], ExitCode.FAILED, "apt-get install")
    assert not (tmp_path / "f.png").exists()


def run_in_environment(code: str, **variables: str) -> subprocess.CompletedProcess[str]:
    kept = {name: value for name, value in os.environ.items() if name not in {"PYOPENGL_PLATFORM", "EGL_DEVICE_ID"}}
    command = [sys.executable, "-c", code]
    return subprocess.run(command, check=False, env=kept | variables, capture_output=True, text=True, timeout=120)


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize(
    "broken",
    [
        {"__EGL_VENDOR_LIBRARY_DIRS": "/nowhere"},  # a loader of EGL that finds no EGL
        {"GALLIUM_DRIVER": "nonsense"},
        {"EGL_DEVICE_ID": "99"},
        {"PYOPENGL_PLATFORM": "glx"},
    ],
    ids=lambda broken: next(iter(broken)),
)
def test_a_broken_egl_is_told_by_the_command(square: Path, tmp_path: Path, broken: dict[str, str]) -> None:
    picture = tmp_path / "f.png"
    code = f"from pectinate.cli import main; main(['place', {str(square)!r}, '--figure', {str(picture)!r}, '--quiet'])"
    code = code.replace("; main", "; import sys; sys.exit(main") + ")"
    ended = run_in_environment(code, **{"PYOPENGL_PLATFORM": "egl", **broken})
    assert "Traceback" not in ended.stderr
    # Some drivers ignore such a wish, and draw.
    assert ended.returncode in {ExitCode.FAILED, ExitCode.DONE}, ended.stderr
    assert picture.exists() == (ended.returncode == ExitCode.DONE)
    if ended.returncode == ExitCode.FAILED:
        error = ended.stderr.strip().splitlines()[-1]
        assert error.startswith("pectinate: error: ") and ("apt-get install" in error or "osmesa" in error)


@pytest.mark.usefixtures("opengl")
def test_no_display_is_needed() -> None:
    code = (
        "import pectinate; m = pectinate.datasets.demo_atrium(edge_length=4);"
        "assert m.figure(views='left', size=(50, 50)).size[0] == 50"
    )
    kept = {name: "" for name in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")}
    ended = run_in_environment(code, **kept)
    assert ended.returncode == 0, ended.stderr


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("way", WAYS)
def test_one_triangle_without_streamlines_is_a_picture(way: str) -> None:
    placement = placed(meshes.single_triangle(), minimum_length=50.0)
    assert len(placement) == 0
    picture = np.asarray(WAYS[way](placement, {}))
    assert 0.1 < (picture[:50] != 255).any(axis=2).mean() < 0.7
    per_vertex = {"surface_values": SurfaceValues([0.0, 1.0, 2.0], contours=0.5)}
    assert (np.asarray(WAYS[way](placement, per_vertex))[:50, :60] != picture[:50, :60]).any()


@pytest.mark.usefixtures("opengl")
def test_no_streamlines_have_values_and_a_page(tmp_path: Path) -> None:
    placement = placed(minimum_length=500.0)
    assert len(placement) == 0
    plain = placement.figure(views=ABOVE, size=SMALL)
    for values in (np.zeros(placement.mesh.triangle_count), np.zeros(0)):
        colored = placement.figure(views=ABOVE, size=SMALL, tube_values=values)
        assert np.array_equal(np.asarray(colored), np.asarray(plain))
        part = placement.part(tube_values={"v": values})
        sheet = figure_sheet(Cell(part, ABOVE), size=SMALL, shown_tube_values="v", scale_bar=False)
        assert sheet.size == SMALL
    placement.page(tube_values=np.zeros(0)).save(tmp_path / "page.html")
    one = placed(meshes.single_triangle(), minimum_length=50.0)
    one.page(surface_values=SurfaceValues([0.0, 1, 2], contours=0.5)).save(tmp_path / "one.html")


def odd_values(mesh: meshes.Mesh) -> dict[str, tuple[NDArray[np.float64], int]]:
    """Values and how many of the triangles are grey."""
    vertices, triangles = mesh
    height = vertices[:, 1].copy()
    height[0] = np.nan
    return {
        "one NaN": (height, int((triangles == 0).any(axis=1).sum())),
        "all NaN": (np.full(len(vertices), np.nan), len(triangles)),
        "constant": (np.full(len(vertices), 3.0), 0),
        "infinite": (np.full(len(triangles), np.inf), len(triangles)),
    }


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("kind", ["one NaN", "all NaN", "constant", "infinite"])
def test_odd_values_are_drawn(way: str, kind: str) -> None:
    pytest.importorskip("matplotlib")
    placement = placed()
    values, grey_count = odd_values((placement.mesh.vertices, placement.mesh.triangles))[kind]
    contours = 1.0 if len(values) == len(placement.mesh.vertices) else None
    picture = np.asarray(WAYS[way](placement, {"surface_values": SurfaceValues(values, contours=contours)}))
    seen = picture[:50, :60].astype(int)
    grey = (np.ptp(seen, axis=2) == 0) & (seen[..., 0] > 150) & (seen[..., 0] < 200)
    covered = (seen != 255).any(axis=2)
    if grey_count == 0:
        assert not grey.any()
    elif way in {"Model.figure", "draw_sheet", "render_view"}:
        # Pixels on the rim are part paper.
        assert grey.sum() / covered.sum() == pytest.approx(
            grey_count / placement.mesh.triangle_count, rel=0.1, abs=0.02
        )
    else:
        assert grey.any()


@pytest.mark.parametrize("kind", ["one NaN", "all NaN", "constant", "infinite"])
def test_odd_values_are_on_pages(kind: str) -> None:
    pytest.importorskip("matplotlib")
    placement = placed()
    values, _ = odd_values((placement.mesh.vertices, placement.mesh.triangles))[kind]
    contours = 1.0 if len(values) == len(placement.mesh.vertices) else None
    assert placement.page(surface_values=SurfaceValues(values, contours=contours), tube_values=values).html


@pytest.mark.parametrize("wrong", [np.zeros(5), np.zeros((96, 3)), "red"])
@pytest.mark.parametrize("way", WAYS)
def test_values_of_a_wrong_length_are_refused(way: str, wrong: object) -> None:
    with pytest.raises(InvalidOption, match="surface_values"):
        WAYS[way](placed(), {"surface_values": wrong})
    with pytest.raises(InvalidOption, match="surface_values"):
        placed().page(surface_values=wrong)


def test_nothing_to_show_is_refused() -> None:
    nothing = (np.zeros((3, 3)), np.zeros((0, 3), dtype=int))
    for draw in (render_view, draw_sheet, lambda surface: Part("", surface)):
        with pytest.raises(InvalidMesh, match="no triangles"):
            draw(nothing)  # type: ignore[operator]


def test_the_command_of_a_page_refuses_values_of_a_wrong_length(
    square: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    np.save(tmp_path / "wrong.npy", np.zeros(7))
    page = str(tmp_path / "page.html")
    assert main(["view", str(square), "--values", str(tmp_path / "wrong.npy"), "--out", page]) != ExitCode.DONE
    assert "(7,)" in capsys.readouterr().err
