"""Values as colours, lines as tubes, and the disk."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from marks import needs_map
from meshes import Mesh, grid
from pectinate import _core, datasets, place_streamlines
from pectinate.errors import InvalidFile, InvalidOption, MissingDependency
from pectinate.figure import Layer, Style, SurfaceValues, draw_disk, draw_sheet, line_tubes, render_view
from pectinate.figure.color_bar import bar_rows
from pectinate.figure.disk import WHOLE_DISK
from pectinate.figure.values import ColorScale

matplotlib = pytest.importorskip("matplotlib")
drawn = pytest.mark.usefixtures("opengl")

SIZE = (240, 180)
SCALE = 0.025  # mm per pixel
GREY = np.rint(255 * np.array(Style().no_value_color))


def wall() -> Mesh:
    """A rectangle of 4 by 3 mm that faces the anterior viewer: 24 triangles, 20 vertices."""
    vertices, triangles = grid(4, 3)
    return vertices[:, [0, 2, 1]] - [2, 0, 1.5], triangles


def pixels_at(picture: NDArray[np.uint8], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colours at points of the wall seen from the front."""
    columns = np.floor(points[:, 0] / SCALE + 0.5 * SIZE[0]).astype(int)
    rows = np.floor(-points[:, 2] / SCALE + 0.5 * SIZE[1]).astype(int)
    return picture[rows, columns].astype(float)


def colors_at_centroids(values: SurfaceValues | NDArray[np.float64], **options: object) -> NDArray[np.float64]:
    vertices, triangles = wall()
    picture = render_view(wall(), surface_values=values, size=SIZE, mm_per_pixel=SCALE, **options)  # type: ignore[arg-type]
    return pixels_at(picture, vertices[triangles].mean(axis=1))


def mapped_colors(fractions: NDArray[np.float64], name: str = "viridis") -> NDArray[np.float64]:
    return 255 * np.asarray(matplotlib.colormaps[name](fractions))[..., :3]


@drawn
@pytest.mark.parametrize("name", ["viridis", "magma"])
def test_triangles_that_face_the_viewer_have_the_colors_of_the_map(name: str) -> None:
    values = np.random.default_rng(1).random(24)
    shown = colors_at_centroids(SurfaceValues(values, name, value_range=(0, 1)))
    assert np.abs(shown - mapped_colors(values, name)).max() <= 1


@drawn
def test_the_range_is_that_of_the_values_unless_it_is_given() -> None:
    values = np.random.default_rng(2).normal(size=24) * 1e3
    fractions = (values - values.min()) / np.ptp(values)
    assert np.abs(colors_at_centroids(values) - mapped_colors(fractions)).max() <= 1
    clipped = np.clip((values + 200) / 500, 0, 1)
    shown = colors_at_centroids(SurfaceValues(values, value_range=(-200, 300)))
    assert np.abs(shown - mapped_colors(clipped)).max() <= 1


@drawn
def test_vertices_blend_their_colors() -> None:
    _, triangles = wall()
    values = np.random.default_rng(3).random(20)
    shown = colors_at_centroids(SurfaceValues(values, value_range=(0, 1)))
    # The centre of the pixel is up to 0.7 pixels from the centroid, in triangles 40 pixels wide.
    assert np.abs(shown - mapped_colors(values)[triangles].mean(axis=1)).max() < 10
    constant = colors_at_centroids(SurfaceValues(np.full(20, 0.3), value_range=(0, 1)))
    assert np.abs(constant - mapped_colors(np.array(0.3))).max() <= 1


@drawn
@pytest.mark.parametrize("nothing", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_is_grey(nothing: float) -> None:
    _, triangles = wall()
    values = np.linspace(0, 1, 24)
    values[[3, 17]] = nothing
    expected = mapped_colors(values)
    expected[[3, 17]] = GREY
    assert np.abs(colors_at_centroids(SurfaceValues(values, value_range=(0, 1))) - expected).max() <= 1
    per_vertex = np.full(20, 0.5)
    per_vertex[7] = nothing
    around = (triangles == 7).any(axis=1)
    shown = colors_at_centroids(SurfaceValues(per_vertex, value_range=(0, 1)))
    assert np.abs(shown[around] - GREY).max() <= 1
    assert np.abs(shown[~around] - mapped_colors(np.array(0.5))).max() <= 1
    other = Style(no_value_color=(1.0, 0.0, 0.0))
    assert np.array_equal(colors_at_centroids(np.full(24, nothing), style=other), np.tile([255.0, 0, 0], (24, 1)))


@drawn
def test_the_same_value_everywhere_has_the_first_color() -> None:
    for value in (0.0, -7.5, 1e300):
        assert np.abs(colors_at_centroids(np.full(24, value)) - mapped_colors(np.array(0.0))).max() <= 1


@drawn
def test_only_the_outside_shows_values() -> None:
    vertices, triangles = wall()
    inside = (vertices, triangles[:, ::-1])
    with_values, without = (render_view(inside, surface_values=v, size=SIZE) for v in (np.arange(24.0), None))
    assert np.array_equal(with_values, without)


def test_values_of_another_count_or_range_are_refused() -> None:
    for values in (np.zeros(23), np.zeros((24, 1)), np.zeros((24, 3)), 1.0, ["a"] * 24, [[1], [2, 3]]):
        with pytest.raises(InvalidOption, match="surface_values"):
            render_view(wall(), surface_values=values)  # type: ignore[arg-type]
    for value_range in ((1, 0), (0, 0), (0, np.nan), (-np.inf, 0)):
        with pytest.raises(InvalidOption, match="value_range"):
            render_view(wall(), surface_values=SurfaceValues(np.zeros(24), value_range=value_range))
    with pytest.raises(InvalidOption, match="viridis"):
        render_view(wall(), surface_values=SurfaceValues(np.zeros(24), "no such map"))
    with pytest.raises(InvalidOption, match="color"):
        render_view(wall(), layers=[Layer(wall(), (0, 0, 256))])


@given(st.floats(-1e3, 1e3), st.floats(1e-6, 1e12))
def test_ticks_are_few_round_and_within_the_scale(low_in_widths: float, width: float) -> None:
    scale = ColorScale("viridis", low_in_widths * width, low_in_widths * width + width)
    ticks = np.array(scale.ticks())
    slack = 1e-9 * width
    assert 2 <= len(ticks) <= 7
    assert (ticks >= scale.low - slack).all() and (ticks <= scale.high + slack).all()
    step = np.diff(ticks)
    assert np.allclose(step, step[0], rtol=1e-6)
    mantissa = step[0] / 10.0 ** np.floor(np.log10(step[0] * (1 + 1e-9)))
    assert np.abs(mantissa - np.array([1, 2, 2.5, 5])).min() < 1e-3


@drawn
def test_a_sheet_of_values_gets_a_bar_with_ticks() -> None:
    options = {"views": "anterior", "size": SIZE}
    plain = draw_sheet(wall(), **options)
    values = np.linspace(0, 1, 24)
    sheet = np.asarray(draw_sheet(wall(), surface_values=SurfaceValues(values, label="angle (degrees)"), **options))
    assert sheet.shape[0] == plain.height
    strip = sheet[:, plain.width :].astype(int)
    top, height = bar_rows(SIZE[1], plain.height)
    column = round(0.035 * SIZE[1]) + 2
    bar = strip[top : top + height, column]
    assert np.abs(bar - mapped_colors((np.arange(height)[::-1] + 0.5) / height)).max() <= 1
    assert (strip[:top, column] == 255).all() and (strip[top + height :, column] == 255).all()
    beside = round(0.035 * SIZE[1]) + round(0.04 * SIZE[1])
    rows = np.nonzero((strip[:, beside] != 255).any(axis=1))[0]
    assert np.abs(rows - (top + (height - 1) * np.linspace(0, 1, 6))).max() <= 1
    below = strip[top + height :].reshape(-1, 3)
    assert not (below == GREY).all(axis=1).any()
    unlabelled = draw_sheet(wall(), surface_values=values, **options)
    assert plain.width < unlabelled.width < sheet.shape[1]


@drawn
def test_the_bar_explains_grey_where_there_is_some() -> None:
    values = np.append(np.nan, np.arange(23.0))
    sheet = draw_sheet(wall(), views="anterior", size=SIZE, surface_values=values)
    plain = draw_sheet(wall(), views="anterior", size=SIZE)
    strip = np.asarray(sheet)[:, plain.width :]
    grey = np.nonzero((strip == GREY).all(axis=2))
    assert len(grey[0]) == round(0.04 * SIZE[1]) ** 2
    assert grey[0].min() > sum(bar_rows(SIZE[1], plain.height))


@drawn
def test_values_need_no_placement_and_go_with_one() -> None:
    model = datasets.demo_atrium(edge_length=4)
    heights = model.mesh.vertices[:, 2]
    alone = model.figure(views="left", size=SIZE, surface_values=heights)
    arrays = (model.mesh.vertices, model.mesh.triangles)
    assert alone.tobytes() == draw_sheet(arrays, views="left", size=SIZE, surface_values=heights).tobytes()
    both = place_streamlines(model, separation_distance=8).figure(views="left", size=SIZE, surface_values=heights)
    assert both.size == alone.size
    assert both.tobytes() != alone.tobytes()
    with pytest.raises(InvalidOption, match=r"\.png"):
        model.figure("picture.docx")
    with pytest.raises(InvalidFile, match="folder"):
        model.figure("/nowhere/picture.png", views="left", size=(40, 30))


def test_without_matplotlib_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(name: str) -> object:
        raise ImportError(f"No module named {name}")

    monkeypatch.setattr(importlib, "import_module", refuse)
    with pytest.raises(MissingDependency, match=r"pip install pectinate\[figures\]"):
        render_view(wall(), surface_values=np.zeros(24))


@drawn
def test_layers_have_colors_of_their_own() -> None:
    tubes = line_tubes([[[-1.5, 0, 1], [1.5, 0, 1]]], 0.2), line_tubes([[[-1.5, 0, -1], [1.5, 0, -1]]], 0.2)
    layers = [Layer(tubes[0], (1, 0, 0)), Layer(tubes[1], (0, 0, 1))]
    picture = render_view(wall(), layers=layers, size=SIZE, mm_per_pixel=SCALE, style=Style(tube_gloss=0))
    red, blue, plain = pixels_at(picture, np.array([[0, 0, 1.0], [0, 0, -1], [0, 0, 0]]))
    assert red[0] > 150 and red[1:].max() == 0
    assert blue[2] > 150 and blue[:2].max() == 0
    assert plain.min() > 150


@pytest.mark.parametrize("side_count", [3, 10])
def test_a_straight_line_is_a_closed_tube_with_round_ends(side_count: int) -> None:
    vertices, triangles = line_tubes([[[1, 2, 3], [1, 2, 3], [4, 2, 3], [11, 2, 3]]], 0.5, side_count=side_count)
    tube = trimesh.Trimesh(vertices, triangles)
    assert tube.is_watertight
    disk = 0.5 * side_count * np.sin(2 * np.pi / side_count) * 0.5**2
    # The round ends are polyhedra: less than half a ball, more than the cone in it.
    assert disk * (10 + 2 * 0.5 / 3) < tube.volume < disk * (10 + 4 * 0.5 / 3)
    along = np.clip(vertices[:, 0], 1, 11)
    assert np.allclose(np.linalg.norm(vertices - np.column_stack([along, 0 * along + 2, 0 * along + 3]), axis=1), 0.5)


def test_a_ring_is_a_torus_in_every_direction() -> None:
    angle = np.linspace(0, 2 * np.pi, 201)
    ring = 5 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    vertices, _ = line_tubes([ring], 0.3)
    from_ring = np.hypot(np.hypot(vertices[:, 0], vertices[:, 1]) - 5, vertices[:, 2])
    assert from_ring.max() == pytest.approx(0.3, rel=1e-3)


def test_corners_and_ways_back_stay_near_the_line() -> None:
    corner = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [2, 2, 2], [2, 2, 0.5]], float)
    vertices, triangles = line_tubes([corner, corner + 10], 0.1)
    assert np.isfinite(vertices).all()
    assert trimesh.Trimesh(vertices, triangles).is_watertight
    starts, ends = corner[:-1], corner[1:]
    first = vertices[: len(vertices) // 2]
    share = np.einsum("psk,sk->ps", first[:, None] - starts, ends - starts) / ((ends - starts) ** 2).sum(axis=1)
    nearest = starts + np.clip(share, 0, 1)[..., None] * (ends - starts)
    assert np.linalg.norm(first[:, None] - nearest, axis=2).min(axis=1).max() <= 0.1 + 1e-12


def test_lines_that_are_none_are_refused() -> None:
    vertices, triangles = line_tubes([], 1)
    assert vertices.shape == triangles.shape == (0, 3)
    for line in ([], [[1, 2, 3]], [[1, 2, 3]] * 4, [[1, 2], [3, 4]], [[0, 0, 0], [np.nan, 0, 0]]):
        with pytest.raises(InvalidOption, match="line 1"):
            line_tubes([[[0, 0, 0], [1, 0, 0]], line], 1)
    for options in ({"radius": 0}, {"radius": np.inf}, {"radius": 1, "side_count": 2}):
        with pytest.raises(InvalidOption, match=list(options)[-1]):
            line_tubes([], **options)


def annulus() -> _core.SurfaceMesh:
    """A flat ring with radii 0.3 and 1."""
    around, across = 120, 30
    angle, radius = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.linspace(0.3, 1, across))
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=-1).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(across - 1), np.arange(around), indexing="ij")
    a, b = (row * around + column).ravel(), (row * around + (column + 1) % around).ravel()
    triangles = np.concatenate([np.column_stack([a, a + around, b + around]), np.column_stack([a, b + around, b])])
    return _core.SurfaceMesh(vertices, triangles)


def framed(mesh: _core.SurfaceMesh) -> tuple[_core.Parameterization, _core.ReferenceFrame]:
    parameterization = _core.parameterize(mesh)
    return parameterization, _core.make_reference_frame(
        mesh, parameterization, inner_loop=1 - parameterization.outer_loop
    )


def disk_pixel(picture: NDArray[np.uint8], x: float, y: float, window: tuple[float, float, float]) -> NDArray[np.uint8]:
    """The colour at a point of the disk: its circle is the widest of the picture and starts at 1/60 of its width."""
    diameter = picture.shape[1] / 1.2
    column = 0.02 * diameter + diameter * (0.5 + 0.5 * (x - window[0]) / window[2])
    row = picture.shape[0] - 0.06 * diameter - diameter * (0.5 + 0.5 * (y - window[1]) / window[2])
    return picture[int(row), int(column)].astype(int)


@needs_map
@pytest.mark.parametrize("window", [WHOLE_DISK, (0.4, 0.3, 0.5)])
def test_the_disk_has_the_colors_of_u(window: tuple[float, float, float]) -> None:
    mesh = annulus()
    parameterization, frame = framed(mesh)
    picture = np.asarray(draw_disk(parameterization, frame, mesh, size=400, window=window, isoline_count=0))
    assert picture.shape == (432, 480, 3)
    hole = np.linalg.norm(
        parameterization.points[mesh.boundary_loops[1 - parameterization.outer_loop].vertices], axis=1
    )
    assert np.ptp(hole) < 1e-3
    checked = 0
    for radius in np.linspace(1.15 * hole[0], 0.97, 6):
        for angle in (0.3, 0.8, 2.5, 4.4):
            x, y = radius * np.cos(angle), radius * np.sin(angle)
            if np.hypot(x - window[0], y - window[1]) > 0.98 * window[2]:
                continue
            nearest = np.argmin(np.hypot(*(parameterization.points - [x, y]).T))
            expected = mapped_colors(frame.u[nearest])
            assert np.abs(disk_pixel(picture, x, y, window) - expected).max() < 12, (radius, angle)
            checked += 1
    assert checked >= 5
    assert (picture[0] == 255).all()
    if window == WHOLE_DISK:
        assert (disk_pixel(picture, 0.3 * hole[0], -0.5 * hole[0], window) == 255).all()
        assert frame.u[np.argmax(np.hypot(*parameterization.points.T))] == pytest.approx(1)


@needs_map
def test_isolines_names_and_lenses_are_drawn_on_the_disk(tmp_path: Path) -> None:
    mesh = annulus()
    arguments = (*framed(mesh), mesh)
    none = {0: "", 1: ""}
    plain = np.asarray(draw_disk(*arguments, size=300, loop_names=none, isoline_count=0)).astype(int)
    for options in (
        {"loop_names": {0: "inner", 1: "outer"}, "isoline_count": 0},
        {"loop_names": none, "isoline_count": 3},
        {"loop_names": none, "isoline_count": 0, "lens": (0.1, 0.1, 0.5)},
        {"loop_names": none, "isoline_count": 0, "origin_name": "origin"},
    ):
        changed = np.any(np.asarray(draw_disk(*arguments, size=300, **options)).astype(int) != plain, axis=2)
        assert 50 < np.count_nonzero(changed) < 0.1 * changed.size
    isolines = np.asarray(draw_disk(*arguments, size=300, loop_names=none, isoline_count=3)).astype(int)
    # Along a radius each isoline is a place that is lighter than before.
    row = disk_row(isolines) - disk_row(plain)
    lighter = (row.sum(axis=1) > 30).astype(int)
    assert np.count_nonzero(np.diff(lighter) == 1) == 2 * 3
    path = tmp_path / "disk.png"
    assert draw_disk(*arguments, path, size=300).size == (360, 324)
    assert path.is_file()


def disk_row(picture: NDArray[np.int64]) -> NDArray[np.int64]:
    """The pixels of a horizontal diameter, without the colour bar."""
    return picture[round(0.02 * 300 + 150), : round(1.02 * 300)]


@needs_map
def test_disks_of_another_surface_or_with_bad_options_are_refused() -> None:
    mesh = annulus()
    parameterization, frame = framed(mesh)
    other = _core.SurfaceMesh(*grid())
    with pytest.raises(InvalidOption, match="one surface"):
        draw_disk(parameterization, frame, other)
    for options in (
        {"loop_names": {2: "none"}},
        {"window": (0, 0, 0)},
        {"lens": (0, np.nan, 1)},
        {"isoline_count": -1},
        {"size": 10},
        {"colormap": "no such map"},
    ):
        with pytest.raises(InvalidOption, match=next(iter(options))):
            draw_disk(parameterization, frame, mesh, **options)
    with pytest.raises(InvalidOption, match=r"\.png"):
        draw_disk(parameterization, frame, mesh, "disk.docx")
