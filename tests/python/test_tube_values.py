"""Values on tubes and categories: their colours, their keys, and what is refused."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import meshes
import pectinate
from pectinate import Cell, Placement, figure_sheet, place_streamlines
from pectinate.errors import InvalidOption
from pectinate.figure import Layer, Lines, Part, Style, SurfaceValues, View, draw_sheet, line_tubes, render_view
from pectinate.figure.frame import Frame, extent, fitting_scale, middle
from pectinate.figure.lines import located_tubes
from pectinate.figure.polylines import values_at
from pectinate.figure.values import CategoryScale, make_scale
from pectinate.viewer import Page

matplotlib = pytest.importorskip("matplotlib")
drawn = pytest.mark.usefixtures("opengl")

ABOVE = View("above", (0, 0, -1), (0, 1, 0))
SIZE = (400, 240)
# Without shadows, so that what faces the viewer has just its colour.
STYLE = Style(fold_darkness=0)
LOOK = {"views": ABOVE, "size": SIZE, "labels": False, "scale_bar": False, "style": STYLE}


@pytest.fixture(scope="module")
def placement() -> Placement:
    """Straight streamlines along x on a rectangle of 20 by 12 mm."""
    vertices, triangles = meshes.grid(20, 12)
    model = pectinate.load((vertices, triangles, np.tile([1.0, 0, 0], (len(triangles), 1))))
    return place_streamlines(model, separation_distance=3.0)


def viridis(share: NDArray[np.float64]) -> NDArray[np.float64]:
    return 255 * np.asarray(matplotlib.colormaps["viridis"](share))[..., :3]


def ridge(placement: Placement, picture: Image.Image) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Colours in the middle of the tubes away from their ends, and where they are in mm."""
    drawn_points = np.concatenate([placement.mesh.vertices, placement.tubes().vertices])
    frame = Frame(ABOVE, middle(drawn_points, ABOVE), SIZE, fitting_scale(extent(drawn_points, ABOVE), SIZE))
    places = np.concatenate([line[(line[:, 0] > 4) & (line[:, 0] < 16)] for line in placement])
    columns, rows = np.floor(frame.pixels(places)).astype(int).T
    return np.asarray(picture)[rows, columns].astype(float), places[:, 0]


@drawn
def test_tubes_have_the_color_of_the_value_where_they_are(placement: Placement) -> None:
    x = placement.mesh.vertices[:, 0]
    for values in (x, placement.points[:, 0]):
        given = SurfaceValues(values, value_range=(0, 20))
        colors, places = ridge(placement, placement.figure(tube_values=given, **LOOK))
        assert len(colors) > 50
        assert np.abs(colors - viridis(places / 20)).max() < 4
    per_triangle = np.full(placement.mesh.triangle_count, 0.7)
    colors, _ = ridge(placement, placement.figure(tube_values=SurfaceValues(per_triangle, value_range=(0, 1)), **LOOK))
    assert np.abs(colors - viridis(np.array(0.7))).max() <= 4


@drawn
def test_a_sheet_of_cells_shows_the_same_tubes(placement: Placement) -> None:
    values = SurfaceValues(placement.mesh.vertices[:, 1], label="y (mm)")
    one = placement.figure(tube_values=values, **LOOK)
    part = placement.part(tube_values={"y": values})
    sheet = figure_sheet(Cell(part, ABOVE), shown_tube_values="y", size=SIZE, scale_bar=False, style=STYLE)
    assert np.array_equal(np.asarray(one), np.asarray(sheet))
    assert one.width > SIZE[0]
    plain = figure_sheet(Cell(part, ABOVE), size=SIZE, scale_bar=False, style=STYLE)
    assert np.array_equal(np.asarray(plain), np.asarray(placement.figure(**LOOK)))
    with pytest.raises(InvalidOption, match="shown_tube_values"):
        figure_sheet(Cell(part, ABOVE), shown_tube_values="x")


@drawn
def test_tubes_of_all_parts_share_one_scale(placement: Placement) -> None:
    low, high = (placement.part(tube_values={"v": np.full(placement.mesh.triangle_count, v)}) for v in (1.0, 3.0))
    sheet = figure_sheet(
        [Cell(low, ABOVE), Cell(high, ABOVE)], shown_tube_values="v", size=SIZE, scale_bar=False, style=STYLE
    )
    for column, share in ((0, 0.0), (1, 1.0)):
        colors, _ = ridge(placement, sheet.crop((column * SIZE[0], 0, (column + 1) * SIZE[0], SIZE[1])))
        assert np.abs(colors - viridis(np.array(share))).max() <= 4


@drawn
def test_two_scales_have_two_bars_and_one_has_one(placement: Placement) -> None:
    x, y = placement.mesh.vertices[:, :2].T
    plain = placement.figure(**LOOK).width
    widths = [
        placement.figure(surface_values=surface, tube_values=tubes, **LOOK).width - plain
        for surface, tubes in (
            (SurfaceValues(x, value_range=(0, 1)), None),
            (None, SurfaceValues(y, value_range=(0, 9))),
        )
    ]
    both = placement.figure(
        surface_values=SurfaceValues(x, value_range=(0, 1)), tube_values=SurfaceValues(y, value_range=(0, 9)), **LOOK
    )
    assert both.width - plain == sum(widths)
    same = SurfaceValues(x, value_range=(0, 1))
    assert placement.figure(surface_values=same, tube_values=same, **LOOK).width - plain == widths[0]


@drawn
def test_missing_constant_and_no_values_on_tubes(placement: Placement) -> None:
    grey = np.rint(255 * np.array(Style().no_value_color))
    for values in (np.full(placement.mesh.triangle_count, np.nan), np.full(len(placement.mesh.vertices), np.inf)):
        colors, _ = ridge(placement, placement.figure(tube_values=values, **LOOK))
        assert np.abs(colors - grey).max() <= 4
    half = np.where(placement.points[:, 0] < 10, np.nan, 1.0)
    colors, places = ridge(placement, placement.figure(tube_values=SurfaceValues(half, value_range=(1, 2)), **LOOK))
    assert np.abs(colors[places < 8.5] - grey).max() <= 4
    assert np.abs(colors[places > 11.5] - viridis(np.array(0.0))).max() <= 4
    colors, _ = ridge(placement, placement.figure(tube_values=np.full(placement.mesh.triangle_count, -3.0), **LOOK))
    assert np.abs(colors - viridis(np.array(0.0))).max() <= 4


def test_places_on_tubes_are_those_of_the_streamlines(placement: Placement) -> None:
    curved = place_streamlines(pectinate.datasets.demo_atrium(edge_length=4), separation_distance=8)
    for some in (placement, curved):
        tubes = some.tubes(radius=0.2, side_count=5)
        places = tubes.vertex_points
        assert places.shape == (len(tubes.vertices),)
        for index, (first, last) in enumerate(zip(some.offsets[:-1], some.offsets[1:] - 1, strict=True)):
            mine = slice(*tubes.vertex_offsets[index : index + 2])
            assert (places[mine].min(), places[mine].max()) == (first, last)
            assert (np.diff(places[mine]) >= 0).all()
        centres = np.column_stack(
            [values_at(SurfaceValues(axis), places).values for axis in some.points.T]  # type: ignore[arg-type]
        )
        # On a ring or at an end: at most the radius away, but for points left out because they are too close.
        assert np.linalg.norm(tubes.vertices - centres, axis=1).max() <= 0.2 * 1.1


def test_places_on_tubes_of_lines_are_their_points() -> None:
    lines = [np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0], [1, 2, 0]]), np.array([[9.0, 0, 0], [9, 9, 9]])]
    tubes = located_tubes(lines, 0.1)
    points = np.concatenate(lines)[np.rint(tubes.vertex_points).astype(int)]
    assert np.linalg.norm(tubes.vertices - points, axis=1).max() <= 0.1 + 1e-12
    assert set(tubes.vertex_points) == {0, 2, 3, 4, 5}
    assert len(located_tubes([], 1.0).vertex_points) == 0
    np.testing.assert_array_equal(line_tubes(lines, 0.1)[0], tubes.vertices)


def test_values_of_lines_must_fit(placement: Placement) -> None:
    points, offsets = placement.points, placement.offsets
    for wrong in (
        np.zeros(3),
        np.zeros((len(points), 2)),
        ["a"] * len(points),
        SurfaceValues(points[:, 0], contours=1.0),
    ):
        with pytest.raises(InvalidOption, match="values"):
            Lines(points, offsets, 0.2, values={"v": wrong})  # type: ignore[dict-item]
    for given in (np.zeros(5), 1.0, "red", SurfaceValues(points[:, 0], contours=1.0), [[1], [2, 3]]):
        for draw in (placement.figure, placement.part, placement.page):
            with pytest.raises(InvalidOption, match="tube_values"):
                draw(tube_values=given)  # type: ignore[operator]
    per_vertex = SurfaceValues(np.zeros(len(placement.mesh.vertices)), categories={})
    with pytest.raises(InvalidOption, match="categories"):
        placement.figure(tube_values=per_vertex)
    with pytest.raises(InvalidOption, match="per vertex"):
        render_view(meshes.grid(), layers=[Layer(meshes.grid(), (0, 0, 0), np.zeros(3))])


@drawn
def test_categories_have_separate_colors_and_names(placement: Placement) -> None:
    mesh = placement.mesh
    right = (mesh.vertices[mesh.triangles][:, :, 0].mean(axis=1) > 10).astype(int)
    tags = SurfaceValues(np.where(right == 1, 7, 2), categories={7: "right", 2: "left", 5: "none here"})
    scale = make_scale([tags], np.asarray(tags.values, float))
    assert isinstance(scale, CategoryScale)
    assert (scale.numbers, scale.names) == ((2, 5, 7), ("left", "none here", "right"))
    palette = np.rint(255 * np.array(scale.palette))
    assert len({tuple(color) for color in palette.tolist()}) == 3
    colors, places = ridge(placement, placement.figure(tube_values=tags, **LOOK))
    assert np.abs(colors[places < 8.5] - palette[0]).max() <= 4
    assert np.abs(colors[places > 11.5] - palette[2]).max() <= 4
    bare = draw_sheet((mesh.vertices, mesh.triangles), surface_values=tags, **LOOK)
    picture = np.asarray(bare)
    assert np.abs(picture[120, [60, 340]].astype(int) - palette[[0, 2]]).max() <= 4
    # The legend: a square of each colour, one below the other, in the order of the numbers.
    strip = picture[:, SIZE[0] :]
    tops = [np.nonzero((strip == color).all(axis=2))[0] for color in palette]
    assert [len(top) for top in tops] == [round(0.04 * SIZE[1]) ** 2] * 3
    assert tops[0].max() < tops[1].min() and tops[1].max() < tops[2].min()
    assert not (strip == np.rint(255 * np.array(Style().no_value_color))).all(axis=2).any()


def test_categories_of_parts_together_have_one_color_each() -> None:
    first, second = (SurfaceValues(np.array(tags), categories=names) for tags, names in (([1, 3], {3: "c"}), ([2], {})))
    scale = make_scale([first, second], np.array([1.0, 3, 2]))
    assert isinstance(scale, CategoryScale)
    assert scale.names == ("1", "2", "c")
    assert scale.indices(np.array([3, 1, np.nan, 8, 2.0])).tolist() == [2, 0, -1, -1, 1]


@pytest.mark.parametrize("count", [0, 1, 9, 10, 18, 19, 64])
def test_colors_of_categories_differ(count: int) -> None:
    for colormap in (None, "viridis", "Set2"):
        scale = make_scale([SurfaceValues((), colormap, categories={})], np.arange(count, dtype=float))
        assert isinstance(scale, CategoryScale)
        assert len(set(scale.palette)) >= min(count, 8) and len(scale.palette) == count
        assert colormap == "Set2" or len(set(scale.palette)) == count
        # Grey is for what has no value.
        assert colormap is not None or all(max(color) - min(color) > 0.05 for color in scale.palette)


@pytest.mark.parametrize(
    ("values", "said"),
    [(np.full(24, 0.5), "whole number"), (np.zeros(20), "per triangle"), (np.arange(24.0) * 1e3, None)],
)
def test_what_is_no_category_is_refused(values: NDArray[np.float64], said: str | None) -> None:
    given = SurfaceValues(values, categories={})
    if said is None:
        assert Page(Part("", meshes.grid(), surface_values={"tag": given})).html
        many = SurfaceValues(np.arange(24), categories={n: "x" for n in range(100, 150)})
        with pytest.raises(InvalidOption, match="more than 64"):
            Page(Part("", meshes.grid(), surface_values={"tag": many}))
        return
    with pytest.raises(InvalidOption, match=said):
        render_view(meshes.grid(), surface_values=given)
    with pytest.raises(InvalidOption, match=said):
        Page(Part("", meshes.grid(), surface_values={"tag": given}))


def description(page: Page) -> dict:
    found = re.search(r'<script type="application/json" id="description">(.*?)</script>', page.html)
    assert found is not None
    return json.loads(found.group(1))


def test_a_page_has_values_on_tubes_categories_and_contours(placement: Placement) -> None:
    mesh = placement.mesh
    x = SurfaceValues(mesh.vertices[:, 0], contours=5.0, label="x (mm)")
    tags = SurfaceValues(np.arange(mesh.triangle_count) % 3, categories={1: "one"})
    page = placement.page(
        surface_values={"x": x, "tag": tags},
        tube_values={"y": mesh.vertices[:, 1], "tag": tags},
        shown_values="tag",
        shown_tube_values="tag",
    )
    scene = description(page)
    assert [scale["name"] for scale in scene["scales"]] == ["x", "tag"]
    assert [scale["name"] for scale in scene["tube_scales"]] == ["y", "tag"]
    assert (scene["shown_values"], scene["shown_tube_values"]) == (1, 1)
    assert scene["tube_scales"][1]["categories"] == ["0", "one", "2"]
    (part,) = scene["parts"]
    contours = part["values"][0]["contours"]
    assert contours["counts"]["rows"] == 3  # at 5, 10 and 15 mm
    assert part["values"][1]["contours"] is None
    lines = part["streamlines"]
    assert [values["name"] for values in lines["values"]] == ["y", "tag"]
    assert {values["steps"]["rows"] for values in lines["values"]} == {lines["positions"]["rows"]}
    with pytest.raises(InvalidOption, match="shown_tube_values"):
        placement.page(tube_values=replace(tags, label="tag"), shown_tube_values="none")


@drawn
def test_vertices_that_no_tube_uses_may_be_anything() -> None:
    vertices, triangles = line_tubes([[[0, 0, 1], [4, 3, 1]]], 0.4)
    values = vertices[:, 0]
    padded = np.concatenate([[[np.nan] * 3], vertices[:9], [[1e9] * 3], vertices[9:]])
    moved = np.where(triangles < 9, triangles + 1, triangles + 2)
    numbers = np.concatenate([[np.nan], values[:9], [0.0], values[9:]])
    options = {"view": ABOVE, "size": SIZE}
    plain, same = (
        render_view(meshes.grid(), layers=[Layer(tubes, (0, 0, 0), SurfaceValues(v, value_range=(0, 4)))], **options)
        for tubes, v in (((vertices, triangles), values), ((padded, moved), numbers))
    )
    assert np.array_equal(plain, same)
