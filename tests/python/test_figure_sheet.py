"""Sheets of several surfaces: tiles without seams, places in pixels, markers, transparency, patient axes."""

from __future__ import annotations

import itertools
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from meshes import grid
from pectinate import Cell, Marker, Part, PatientAxes, datasets, figure_sheet, place_streamlines
from pectinate.errors import InvalidFile, InvalidMesh, InvalidOption
from pectinate.figure import Lines, Style, SurfaceValues, View, draw_sheet, render_view, standard_view
from pectinate.figure.frame import Frame
from pectinate.figure.markers import place_discs
from pectinate.figure.offscreen import Canvas, Patch, Stage, open_canvas
from pectinate.figure.picture import TILE, draw_frame
from pectinate.figure.shape import Drawing, check_drawing
from pectinate.placement import DRAWN_TUBE_HEIGHT

drawn = pytest.mark.usefixtures("opengl")

SIZE = (200, 160)
SCALE = 0.25  # mm per pixel
RED = (1.0, 0.0, 0.0)


def sphere(radius: float = 10.0, centre: tuple[float, float, float] = (0, 0, 0)) -> tuple[NDArray[np.float64], NDArray]:
    ball = trimesh.creation.icosphere(subdivisions=4, radius=radius)
    return np.asarray(ball.vertices) + centre, np.asarray(ball.faces)


def cube(side: float, **options: object) -> Part:
    solid = trimesh.creation.box((side, side, side))
    return Part("cube", (np.asarray(solid.vertices), np.asarray(solid.faces)), **options)  # type: ignore[arg-type]


def some_rotation(seed: int) -> NDArray[np.float64]:
    random = np.random.default_rng(seed).random(3)
    return np.asarray(trimesh.transformations.random_rotation_matrix(random)[:3, :3])


def bumpy_drawing() -> Drawing:
    """A ball with a deep dent, so that folds are dark, and a tube."""
    vertices, triangles = sphere()
    dent = np.exp(-((np.linalg.norm(vertices - [0, -10, 0], axis=1) / 4) ** 2))
    surface = (vertices * (1 - 0.6 * dent[:, None]), triangles)
    tube = trimesh.creation.capsule(height=14, radius=1)
    return check_drawing(surface, (np.asarray(tube.vertices) + np.array([5, -9, -7]), tube.faces), (), None, Style())


def covered_share(picture: NDArray[np.uint8]) -> float:
    return float((picture != 255).any(axis=2).mean())


@drawn
@pytest.mark.parametrize("transparent", [False, True])
@pytest.mark.parametrize(("mm_per_pixel", "tile"), [(0.12, 77), (0.03, 500)])
def test_tiles_do_not_show(transparent: bool, mm_per_pixel: float, tile: int) -> None:
    drawing = bumpy_drawing()
    frame = Frame(standard_view("anterior"), np.array([1.0, 2, 3]), (420, 333), mm_per_pixel)
    with open_canvas() as canvas:
        whole, tiled = (
            draw_frame(canvas, drawing, frame, 2, Style(), transparent=transparent, tile=side).picture.astype(int)
            for side in (2048, tile)
        )
    difference = np.abs(whole - tiled).max(axis=2)
    # Rounding decides otherwise for a few samples on the edges of triangles; tiles have nothing to do with where.
    assert np.mean(difference > 1) < 1e-3
    assert difference.max() < 64
    joints = np.arange(tile // 2, 420, tile // 2)
    beside = difference[:, np.concatenate([joints - 1, joints])]
    assert np.mean(beside > 1) < 2e-3


@drawn
def test_depths_are_those_of_the_place_in_the_pixel_that_the_canvas_names() -> None:
    corners, triangles = np.array([[-5.0, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    corners[:, 2] = 0.3 * corners[:, 0] - 0.7 * corners[:, 1]
    with open_canvas() as canvas:
        stage = canvas.load([Patch(corners, triangles, np.ones((4, 3)))])
        _, depth = canvas.draw(stage, (10, 10), 1.0)
        right, down = canvas.depth_place()
    rows, columns = np.indices(depth.shape)
    x, y = columns + right - 5, 5 - rows - down
    np.testing.assert_allclose(stage.nearest - depth, 0.3 * x - 0.7 * y, atol=1e-4)


@drawn
def test_no_more_than_a_tile_is_drawn_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = []
    draw = Canvas.draw

    def counted(canvas: Canvas, stage: Stage, size: tuple[int, int], *rest: Any) -> Any:
        sizes.append(size)
        return draw(canvas, stage, size, *rest)

    monkeypatch.setattr(Canvas, "draw", counted)
    assert render_view(sphere(), size=(700, 500), supersampling=6).shape == (500, 700, 3)
    assert max(max(size) for size in sizes) <= TILE <= 4096
    # The tiles, and the depth map, which is coarse.
    assert sum(width * height for width, height in sizes) <= 4200 * 3000 + 700 * 500
    sizes.clear()
    draw_wide = render_view(sphere(), size=(30_000, 2), mm_per_pixel=0.001, supersampling=1)
    assert draw_wide.shape == (2, 30_000, 3)
    assert covered_share(draw_wide) == pytest.approx(20 / 30, abs=1e-3)
    assert max(max(size) for size in sizes) <= 4096


@drawn
@pytest.mark.parametrize("mm_per_pixel", [0.03, 0.12, 0.25])
def test_folds_are_as_dark_at_any_resolution(mm_per_pixel: float) -> None:
    size = (round(24 / mm_per_pixel), round(24 / mm_per_pixel))
    with open_canvas() as canvas:
        fine, coarse = (
            draw_frame(canvas, bumpy_drawing(), Frame(standard_view("anterior"), np.zeros(3), s, mm), 1, Style())
            for s, mm in ((size, mm_per_pixel), ((80, 80), 0.3))
        )
    small = Image.fromarray(fine.picture).resize((80, 80), Image.Resampling.BOX)
    difference = np.abs(np.asarray(small).astype(int) - coarse.picture)
    assert np.median(difference) <= 2
    assert difference.mean() < 4


@drawn
@settings(max_examples=8, deadline=None)
@given(st.integers(0, 2**31))
def test_a_vertex_is_drawn_where_the_frame_says(seed: int) -> None:
    random = np.random.default_rng(seed)
    view = View("any", tuple(random.normal(size=3).tolist()), tuple(random.normal(size=3).tolist()))
    place = random.uniform(-15, 15, size=3)
    frame = Frame(view, random.uniform(-5, 5, size=3), SIZE, SCALE)
    # A tiny cube: all of it is seen within one or two pixels.
    solid = trimesh.creation.box((0.5, 0.5, 0.5))
    drawing = check_drawing((np.asarray(solid.vertices) + place, solid.faces), None, (), None, Style())
    with open_canvas() as canvas:
        picture = draw_frame(canvas, drawing, frame, 4, Style(), transparent=True).picture
    cover = picture[:, :, 3] / 255.0
    (pixel,) = frame.pixels(place[None])
    inside = (pixel > 3).all() and (pixel < np.array(SIZE) - 3).all()
    if inside:
        rows, columns = np.indices(cover.shape) + 0.5
        middle = np.array([(columns * cover).sum(), (rows * cover).sum()]) / cover.sum()
        assert np.abs(middle - pixel).max() < 0.2
    else:
        # The cube reaches not quite two pixels from its middle.
        assert cover[5:-5, 5:-5].sum() == 0


@drawn
@pytest.mark.parametrize("hidden_depth", [0.0, 2.0])
def test_markers_on_a_sphere_show_on_its_near_half(hidden_depth: float) -> None:
    radius, tolerance = 10.0, hidden_depth
    vertices, triangles = sphere(radius)
    # The corners of the triangles: places that lie on the surface.
    view = View("any", (0.3, 1.0, -0.2), (0, 0, 1))
    drawing = check_drawing((vertices, triangles), None, (), None, Style())
    with open_canvas() as canvas:
        drawn_ball = draw_frame(canvas, drawing, Frame(view, np.zeros(3), SIZE, SCALE), 2, Style())
    seen = drawn_ball.sees(vertices, tolerance)
    height = drawn_ball.frame.seen(vertices)[:, 2]
    # Behind the sphere's near half by twice its depth below the middle, seen at the middle of a cell beside it.
    behind = np.maximum(0, -2 * height)
    steepness = np.sqrt(np.maximum(0, radius**2 - height**2)) / np.maximum(1e-9, np.abs(height))
    doubt = 1.5 * SCALE * steepness + 0.05
    assert seen[(behind < tolerance - doubt) & (steepness < 3)].all()
    assert not seen[(behind > tolerance + doubt) & (steepness < 3)].any()
    assert np.count_nonzero((behind > tolerance + doubt) & (steepness < 3)) > 500


@drawn
def test_a_marker_is_drawn_at_its_place_unless_it_is_hidden() -> None:
    part = Part("ball", sphere())
    size, scale = (600, 480), 0.06
    options = {"size": size, "mm_per_pixel": scale, "scale_bar": False}
    plain = np.asarray(figure_sheet(Cell(part), **options)).astype(int)
    radius = 0.027 * size[1]
    for position, shown in (((3, -9.5, 2), True), ((3, 9.5, 2), False), ((90, -9, 0), False)):
        marked = np.asarray(figure_sheet(Cell(part, markers=[Marker(position, "7")]), **options)).astype(int)
        rows, columns = np.nonzero((marked != plain).any(axis=2))
        assert bool(len(rows)) == shown
        if shown:
            middle = columns.mean() + 0.5, rows.mean() + 0.5
            assert middle == pytest.approx((300 + 3 / scale, 240 - 2 / scale), abs=0.8)
            assert np.ptp(columns) + 1 == pytest.approx(2 * radius, abs=2)
            disc = marked[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
            assert disc.min() < 90 and disc.max() == 255


@drawn
def test_markers_move_with_their_part_and_leave_with_it() -> None:
    ball, far = Part("ball", sphere()), Part("far", sphere(3, (30, 0, 0)))
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    there = far.moved((1, 2, 3), turn)
    assert np.allclose(there.placed(far.surface[0]), np.asarray(far.surface[0]) @ turn.T + [1, 2, 3])
    assert np.allclose(there.moved((0, 0, 1), turn).placed([[1, 0, 0]]), [[-3, 1, 4]])
    marker = Marker((30, -3, 0), "1")  # on the small ball, towards the viewer
    options = {"size": (600, 160), "mm_per_pixel": SCALE, "scale_bar": False}

    def place(parts: list[Part]) -> NDArray[np.float64]:
        bare, marked = (
            np.asarray(figure_sheet(Cell(parts, markers=some, centre=(0, 0, 0)), **options)).astype(int)
            for some in ([], [marker])
        )
        return np.argwhere((bare != marked).any(axis=2)).mean(axis=0) - [79.5, 299.5]

    assert place([ball, far]) == pytest.approx([0, 30 / SCALE], abs=0.8)
    assert place([ball, far.moved((20, 0, 5))]) == pytest.approx([-5 / SCALE, 50 / SCALE], abs=0.8)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**31), st.integers(1, 14), st.sampled_from([0.0, 1.0, 6.0, 60.0]))
def test_discs_keep_apart_near_their_anchors_and_within_the_picture(seed: int, count: int, spread: float) -> None:
    size, radius = (400, 300), 8.0
    anchors = np.array([200, 150]) + np.random.default_rng(seed).normal(size=(count, 2)) * spread
    anchors = np.clip(anchors, 10, np.array(size) - 10)
    places = place_discs(anchors, radius, size)
    apart = [np.linalg.norm(a - b) for a, b in itertools.combinations(places, 2)]
    assert min(apart, default=np.inf) >= 2.2 * radius - 1e-9
    assert np.linalg.norm(places - anchors, axis=1).max() <= 14 * radius
    assert ((places >= radius) & (places <= np.array(size) - radius)).all()
    assert np.array_equal(places, place_discs(anchors, radius, size))
    assert np.array_equal(places[0], anchors[0])
    lonely = np.array(
        [np.delete(np.linalg.norm(anchors - a, axis=1), i).min(initial=99) for i, a in enumerate(anchors)]
    )
    if (lonely > 2.2 * radius).all():
        assert np.array_equal(places, anchors)


@drawn
def test_parts_stand_where_their_offset_and_rotation_put_them() -> None:
    turn = some_rotation(5)
    vertices, triangles = sphere(4, (3, 1, 2))
    moved = (vertices @ turn.T + [4, 0, -3], triangles)
    options = {"size": SIZE, "mm_per_pixel": SCALE, "scale_bar": False}
    by_part = figure_sheet(Cell(Part("", (vertices, triangles), offset=(4, 0, -3), rotation=turn)), **options)
    assert np.array_equal(np.asarray(by_part), render_view(moved, size=SIZE, mm_per_pixel=SCALE))


@drawn
def test_all_cells_share_one_scale_and_hold_their_own_parts() -> None:
    small, large = cube(10), cube(20)
    style = Style(background_color=(1, 1, 1))
    sheet = np.asarray(
        figure_sheet([[Cell(small), Cell(large)], [None, Cell(small)]], size=SIZE, scale_bar=False, style=style)
    )
    assert sheet.shape == (2 * SIZE[1], 2 * SIZE[0], 3)
    widths = {}
    for row, column in itertools.product((0, 1), (0, 1)):
        cell = sheet[row * SIZE[1] : (row + 1) * SIZE[1], column * SIZE[0] : (column + 1) * SIZE[0]]
        widths[row, column] = int((cell != 255).any(axis=(0, 2)).sum())
    assert widths[1, 0] == 0
    assert widths[0, 0] == widths[1, 1]
    assert widths[0, 1] == pytest.approx(0.94 * SIZE[1], abs=2)
    assert widths[0, 1] == pytest.approx(2 * widths[0, 0], abs=2)


@drawn
def test_parts_have_colors_tracts_and_only_the_streamlines_that_are_asked_for() -> None:
    placement = place_streamlines(datasets.demo_atrium(edge_length=4), separation_distance=8)
    options = {"size": SIZE, "scale_bar": False}
    bare, lined = (np.asarray(figure_sheet(Cell(x), **options)) for x in (placement.model, placement))
    tubes = placement.tubes(height=DRAWN_TUBE_HEIGHT)
    mesh = placement.mesh
    old = draw_sheet(
        (mesh.vertices, mesh.triangles), (tubes.vertices, tubes.triangles), views="anterior", labels=False, **options
    )
    assert np.array_equal(lined, np.asarray(old))
    dark = [np.count_nonzero((picture < 45).all(axis=2)) for picture in (bare, lined)]
    assert dark[1] > 5 * dark[0] + 500
    lines = list(placement)[:3]
    tracts = np.asarray(figure_sheet(Cell(placement.model.part(tracts=lines)), **options))
    assert np.count_nonzero((tracts < 45).all(axis=2)) > dark[0] + 50
    assert not np.array_equal(tracts, lined)
    red = np.asarray(figure_sheet(Cell(placement.model.part(surface_color=RED)), **options))
    assert (red[..., 1:][(red != 255).any(axis=2)].max(axis=1) <= red[..., 0][(red != 255).any(axis=2)]).all()
    empty = Part("", (mesh.vertices, mesh.triangles), streamlines=Lines.of([], 0.3), tracts=Lines.of([], 1))
    assert np.array_equal(np.asarray(figure_sheet(Cell(empty), **options)), bare)


@drawn
@pytest.mark.parametrize("paper", [(1.0, 1.0, 1.0), (0.05, 0.05, 0.1)])
def test_a_transparent_sheet_laid_on_paper_is_the_opaque_one(paper: tuple[float, float, float]) -> None:
    part = Part("ball", sphere(), surface_values={"height": sphere()[0][:, 2]})
    cell = Cell(part, title="below", markers=[Marker((3, -9.5, 2), "7"), Marker((3, -9.5, 2), "8")])
    style = Style(background_color=paper)
    options = {"size": SIZE, "title": "title", "row_titles": ["row"], "column_titles": ["column"], "style": style}
    clear, opaque = (
        figure_sheet(cell, transparent=t, shown_values="height", **options)  # type: ignore[arg-type]
        for t in (True, False)
    )
    assert (clear.mode, opaque.mode) == ("RGBA", "RGB")
    assert np.asarray(clear)[0, 0, 3] == 0
    under = Image.new("RGBA", clear.size, (*(round(255 * c) for c in paper), 255))
    under.alpha_composite(clear)
    assert np.abs(np.asarray(under)[..., :3].astype(int) - np.asarray(opaque)).max() <= 2


@drawn
def test_values_of_all_parts_share_one_scale() -> None:
    vertices, triangles = grid(4, 4)
    wall = (vertices[:, [0, 2, 1]], triangles)  # faces the viewer, so that it has the colours of the map
    low, high = (Part(str(x), wall, surface_values={"x": np.full(len(triangles), x)}) for x in (1.0, 5.0))
    bare = Part("bare", wall)
    options = {"size": SIZE, "scale_bar": False, "shown_values": "x"}
    sheet = np.asarray(figure_sheet([Cell(low), Cell(high), Cell(bare)], **options)).astype(int)
    assert sheet.shape[1] > 3 * SIZE[0]
    expected = {0: (68, 1, 84), 1: (253, 231, 37)}  # the ends of viridis
    for column, color in expected.items():
        assert np.abs(sheet[80, column * SIZE[0] + 100] - color).max() <= 2
    assert np.ptp(sheet[80, 2 * SIZE[0] + 100]) < 40
    told = Part("", wall, surface_values={"x": SurfaceValues(np.full(len(triangles), 1.0), value_range=(1, 2))})
    alone = np.asarray(figure_sheet(Cell(told), **options)).astype(int)
    assert np.abs(alone[80, 100] - expected[0]).max() <= 2
    with pytest.raises(InvalidOption, match="shown_values"):
        figure_sheet(Cell(bare), shown_values="x")


@drawn
@pytest.mark.parametrize("dpi", [72.0, 300.0])
def test_files_have_their_dots_per_inch(tmp_path: Path, dpi: float) -> None:
    sheet = figure_sheet(Cell(cube(10)), tmp_path / "sheet.png", size=SIZE, dpi=dpi)
    with Image.open(tmp_path / "sheet.png") as png:
        assert png.info["dpi"] == pytest.approx((dpi, dpi), rel=1e-3)
        assert np.array_equal(np.asarray(png), np.asarray(sheet))
    for transparent in (False, True):
        figure_sheet(Cell(cube(10)), tmp_path / "sheet.pdf", size=SIZE, dpi=dpi, transparent=transparent)
        text = (tmp_path / "sheet.pdf").read_bytes()
        box = text[text.index(b"/MediaBox") :].split(b"[")[1].split(b"]")[0].split()
        assert [float(x) for x in box] == pytest.approx([0, 0, SIZE[0] * 72 / dpi, SIZE[1] * 72 / dpi], abs=0.01)
    figure_sheet(Cell(cube(10)), tmp_path / "sheet.pdf", size=SIZE)
    text = (tmp_path / "sheet.pdf").read_bytes()
    with Image.open(BytesIO(text[text.index(b"\xff\xd8") :])) as page:
        assert np.abs(np.asarray(page).astype(int) - np.asarray(sheet)).mean() < 1


@drawn
def test_a_kind_of_file_that_cannot_be_transparent_is_refused(tmp_path: Path) -> None:
    figure_sheet(Cell(cube(10)), tmp_path / "sheet.jpg", size=SIZE)
    with pytest.raises(InvalidFile, match=r"\.png"):
        figure_sheet(Cell(cube(10)), tmp_path / "sheet.jpg", size=SIZE, transparent=True)


@given(st.integers(0, 2**31), st.sampled_from(["left", "posterior", "superior", None]))
def test_patient_axes_are_those_that_are_given(seed: int, left_out: str | None) -> None:
    rotation = some_rotation(seed)
    lengths = np.random.default_rng(seed).uniform(0.1, 100, 3)
    names = ("left", "posterior", "superior")
    directions = {name: rotation[:, i] * lengths[i] for i, name in enumerate(names) if name != left_out}
    assert np.allclose(PatientAxes(**directions).matrix(), rotation)


def test_slanted_patient_axes_become_perpendicular_alike() -> None:
    matrix = PatientAxes(left=(1, 0.2, 0), posterior=(0.2, 1, 0)).matrix()
    assert np.allclose(matrix, np.eye(3))
    for wrong in (
        {"left": (1, 0, 0)},
        {"left": (1, 0, 0), "superior": (0, 0, 0)},
        {"left": (1, 0, 0), "superior": (-2, 0, 0)},
        {"left": (1, 0, 0), "superior": (np.nan, 0, 1)},
        {"left": (1, 0, 0), "posterior": (0, -1, 0), "superior": (0, 0, 1)},
        {"left": (1, 0, 0), "posterior": (0, 1, 0), "superior": (1, 1, 0)},
    ):
        with pytest.raises(InvalidOption, match="patient axes"):
            PatientAxes(**wrong)  # type: ignore[arg-type]


@drawn
def test_views_follow_the_patient_axes() -> None:
    rotation = some_rotation(11)
    vertices, triangles = sphere(5)
    vertices = np.vstack([vertices, vertices * 0.3 + [7, -2, 3]])
    triangles = np.vstack([triangles, triangles + len(vertices) // 2])
    axes = PatientAxes(left=rotation[:, 0], superior=rotation[:, 2])
    straight = figure_sheet(Cell(Part("", (vertices, triangles))), size=SIZE)
    turned = figure_sheet(Cell(Part("", (vertices, triangles), rotation=rotation)), size=SIZE, axes=axes)
    difference = np.abs(np.asarray(straight).astype(int) - np.asarray(turned))
    assert np.mean(difference > 4) < 0.01


def test_what_makes_no_sheet_is_refused() -> None:
    ball = Part("ball", sphere())
    nowhere = sphere()[0].copy()
    nowhere[0] = np.nan
    with pytest.raises(InvalidMesh, match="nothing"):
        Part("none", (np.zeros((0, 3)), np.zeros((0, 3), int)))
    with pytest.raises(InvalidMesh, match="finite"):
        Part("nan", (nowhere, sphere()[1]))
    mirror = np.diag([1.0, 1, -1])
    for options in (
        {"offset": (0, np.nan, 0)},
        {"offset": (0, 0)},
        {"rotation": mirror},
        {"rotation": 2 * np.eye(3)},
        {"rotation": np.full((3, 3), np.nan)},
        {"surface_color": (1, 2, 0)},
    ):
        with pytest.raises(InvalidOption):
            Part("wrong", sphere(), **options)  # type: ignore[arg-type]
    with pytest.raises(InvalidOption, match="marker"):
        Marker((0, 0, np.inf), "1")
    for cells in ([], [[]], [None], [[None], [None]], Cell([]), Cell(Part("", sphere(), visible=False))):
        with pytest.raises(InvalidOption, match=r"no cells|visible"):
            figure_sheet(cells)  # type: ignore[arg-type]
    for wrong in (
        {"row_titles": ["a", "b"]},
        {"column_titles": ["a", "b"]},
        {"hidden_depth": -1.0},
        {"hidden_depth": np.nan},
        {"mm_per_pixel": 0.0},
        {"size": (30_000, 30_000)},
        {"axes": "XYZ"},
    ):
        with pytest.raises(InvalidOption):
            figure_sheet(Cell(ball), **wrong)  # type: ignore[arg-type]
    with pytest.raises(InvalidOption, match="dpi"):
        figure_sheet(Cell(ball), size=(20, 20), dpi=0.0)
    with pytest.raises(InvalidOption, match="centre"):
        figure_sheet(Cell(ball, centre=(0, np.nan, 0)))
    with pytest.raises(InvalidOption, match=r"\.png"):
        figure_sheet(Cell(ball), "sheet.docx")


@drawn
def test_a_marker_stands_where_its_place_is_seen_from_outside() -> None:
    vertices, triangles = sphere()
    back_half = Part("shell", (vertices, triangles[(vertices[triangles][:, :, 1] >= 0).all(axis=1)]))
    options = {"size": (300, 240), "mm_per_pixel": 0.1, "scale_bar": False}
    front, back, aside = (0.0, -10.0, 0.0), (0.0, 10.0, 0.0), (3.0, -9.5, 2.0)

    def middle(part: Part, marker: Marker) -> NDArray[np.float64] | None:
        bare, marked = (
            np.asarray(figure_sheet(Cell(part, markers=some, centre=(0, 0, 0)), **options)).astype(int)
            for some in ([], [marker])
        )
        changed = np.argwhere((bare != marked).any(axis=2))
        return changed.mean(axis=0) if len(changed) else None

    assert middle(back_half, Marker(back, "1")) is None
    ball = Part("ball", (vertices, triangles))
    expected = middle(ball, Marker(aside, "1"))
    assert middle(ball, Marker(back, "1", [aside, front])) == pytest.approx(expected)
