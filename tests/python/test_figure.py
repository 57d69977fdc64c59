"""Pictures: their scale, their orientation, what hides what, and clear errors where nothing can be drawn."""

from __future__ import annotations

import os
import subprocess
import sys
from ctypes.util import find_library

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from pectinate import datasets, place_streamlines
from pectinate.errors import InvalidFile, InvalidMesh, InvalidOption, RenderingUnavailable
from pectinate.figure import STANDARD_VIEWS, Style, View, context, draw_sheet, principal_views, render_view, scale_bar
from pectinate.figure.context import offscreen_context

Arrays = tuple[NDArray[np.float64], NDArray[np.int64]]

pytestmark = pytest.mark.usefixtures("opengl")

SCALE = 0.25  # mm per pixel
SIZE = (200, 160)


def sphere(radius: float = 10.0, centre: tuple[float, float, float] = (0, 0, 0)) -> Arrays:
    ball = trimesh.creation.icosphere(subdivisions=4, radius=radius)
    return np.asarray(ball.vertices) + centre, np.asarray(ball.faces)


def box(extents: tuple[float, float, float], centre: tuple[float, float, float] = (0, 0, 0)) -> Arrays:
    solid = trimesh.creation.box(extents)
    return np.asarray(solid.vertices) + centre, np.asarray(solid.faces)


def joined(*parts: Arrays) -> Arrays:
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    triangles = [faces + start for (_, faces), start in zip(parts, starts, strict=False)]
    return np.vstack([vertices for vertices, _ in parts]), np.vstack(triangles)


def covered(picture: NDArray[np.uint8]) -> NDArray[np.bool_]:
    return np.any(picture[:, :, :3] != 255, axis=2)


def test_the_silhouette_of_a_sphere_has_its_area_and_its_place() -> None:
    picture = render_view(sphere(), size=SIZE, mm_per_pixel=SCALE, transparent=True)
    area = picture[:, :, 3].sum() / 255 * SCALE**2
    assert area == pytest.approx(np.pi * 10**2, rel=0.01)
    rows, columns = np.nonzero(picture[:, :, 3] > 127)
    assert columns.mean() == pytest.approx((SIZE[0] - 1) / 2, abs=0.5)
    assert rows.mean() == pytest.approx((SIZE[1] - 1) / 2, abs=0.5)


def test_the_scale_is_exact() -> None:
    inside = covered(render_view(box((20, 10, 8)), size=SIZE, mm_per_pixel=SCALE))
    rows, columns = np.nonzero(inside)
    assert (np.ptp(columns) + 1, np.ptp(rows) + 1) == (20 / SCALE, 8 / SCALE)


@pytest.mark.parametrize(
    ("view", "towards", "side"),
    [
        ("anterior", (1, 0, 0), "right"),  # the patient's left is on the viewer's right
        ("posterior", (1, 0, 0), "left"),
        ("anterior", (0, 0, 1), "top"),
        ("left", (0, 0, 1), "top"),
        ("superior", (1, 0, 0), "right"),
        ("left", (0, -1, 0), "left"),
        ("right", (0, -1, 0), "right"),
    ],
)
def test_views_are_anatomical(view: str, towards: tuple[float, float, float], side: str) -> None:
    blob = tuple(12.0 * x for x in towards)
    inside = covered(render_view(joined(sphere(8), sphere(3, blob)), view=view, size=(200, 200), mm_per_pixel=SCALE))
    rows, columns = np.nonzero(inside)
    big_row, big_column = (np.median(rows), np.median(columns))
    lean = {"right": columns.max() - big_column, "left": big_column - columns.min()}
    lean |= {"top": big_row - rows.min(), "bottom": rows.max() - big_row}
    assert max(lean, key=lambda name: lean[name]) == side


def test_other_axes_turn_the_view_with_them() -> None:
    surface = joined(sphere(8), sphere(3, (12, 0, 0)))
    turned = np.column_stack([-surface[0][:, 0], -surface[0][:, 1], surface[0][:, 2]])
    lps = render_view(surface, size=SIZE, mm_per_pixel=SCALE)
    ras = render_view((turned, surface[1]), axes="RAS", size=SIZE, mm_per_pixel=SCALE)
    assert np.mean(np.abs(lps.astype(int) - ras.astype(int)) > 8) < 0.01


def test_back_faces_show_the_inside_colour_and_front_faces_do_not() -> None:
    vertices, triangles = sphere()
    style = Style(fold_darkness=0)
    front = render_view((vertices, triangles), size=SIZE, mm_per_pixel=SCALE, style=style)
    inside = render_view((vertices, triangles[:, ::-1]), size=SIZE, mm_per_pixel=SCALE, style=style)
    centre = (SIZE[1] // 2, SIZE[0] // 2)
    assert front[centre].astype(int).sum() > inside[centre].astype(int).sum() + 60


@pytest.mark.parametrize("shadow_color", [(0.9, 0.3, 0.6), (0.0, 0.0, 0.0), (1.0, 0.5, 1.0)])
def test_shadows_leave_their_share_of_each_colour(shadow_color: tuple[float, float, float]) -> None:
    style = Style(surface_color=(0.8, 0.9, 1.0), shadow_color=shadow_color, fold_darkness=0, edge_darkness=1)
    picture = render_view(sphere(), size=SIZE, mm_per_pixel=SCALE, transparent=True, style=style)
    lost = 1 - picture[picture[:, :, 3] == 255][:, :3] / (255 * np.array(style.surface_color))
    most = 1 - np.array(shadow_color)
    assert (lost <= most + 0.01).all()
    assert (lost.max(axis=0) >= 0.8 * most).all()
    # All channels are in the same light.
    for a, b in ((0, 1), (1, 2)):
        np.testing.assert_allclose(lost[:, a] * most[b], lost[:, b] * most[a], atol=0.01)


@pytest.mark.parametrize("shadow_color", [(0.9, 0.3, 0.6), (0.0, 0.0, 0.0)])
def test_folds_are_in_the_same_shadow(shadow_color: tuple[float, float, float]) -> None:
    # A wall far behind a ball is the deepest of folds around it.
    surface = joined(sphere(3), box((40, 0.1, 32), (0, 20, 0)))
    bright, dark = (
        render_view(
            surface,
            size=SIZE,
            mm_per_pixel=SCALE,
            style=Style(surface_color=(1, 1, 1), shadow_color=shadow_color, fold_darkness=darkness, edge_darkness=0),
        )
        for darkness in (0.0, 0.5)
    )
    left = dark.reshape(-1, 3) / np.maximum(bright.reshape(-1, 3), 1)
    most = 0.5 * (1 - np.array(shadow_color))
    np.testing.assert_allclose(1 - left.min(axis=0), most, atol=0.02)


def test_tubes_are_dark_and_hide_what_is_behind_them() -> None:
    bar = box((10, 1, 1), (0, -11, 0))
    plain = render_view(sphere(), size=SIZE, mm_per_pixel=SCALE)
    anterior = render_view(sphere(), bar, size=SIZE, mm_per_pixel=SCALE)
    posterior = render_view(sphere(), bar, view="posterior", size=SIZE, mm_per_pixel=SCALE)
    row, column = SIZE[1] // 2, SIZE[0] // 2
    assert anterior[row, column].max() < 90 < plain[row, column].min()
    assert posterior[row, column].min() > 90


def test_the_same_picture_is_the_same_bytes() -> None:
    first = render_view(sphere(), size=SIZE)
    assert first.tobytes() == render_view(sphere(), size=SIZE).tobytes()
    assert first.shape == (SIZE[1], SIZE[0], 3)


def test_a_transparent_picture_has_no_background() -> None:
    picture = render_view(sphere(), size=SIZE, mm_per_pixel=SCALE, transparent=True)
    assert picture.shape == (SIZE[1], SIZE[0], 4)
    assert picture[0, 0, 3] == 0
    assert picture[SIZE[1] // 2, SIZE[0] // 2, 3] == 255


def test_a_sheet_holds_its_views_labels_and_bar() -> None:
    plain = draw_sheet(sphere(), size=SIZE, labels=False, scale_bar=False)
    assert plain.size == (3 * SIZE[0], 2 * SIZE[1])
    labelled = draw_sheet(sphere(), size=SIZE, labels=True, scale_bar=False)
    assert labelled.size == (3 * SIZE[0], 2 * (SIZE[1] + round(0.09 * SIZE[1])))
    assert draw_sheet(sphere(), views="left", size=SIZE, labels=False).size == SIZE
    four = draw_sheet(sphere(), views=STANDARD_VIEWS[:4], size=SIZE, labels=False)
    assert four.size == (2 * SIZE[0], 2 * SIZE[1])
    single = draw_sheet(sphere(), views="anterior", size=SIZE, labels=False, scale_bar=False)
    assert np.array_equal(np.asarray(plain)[: SIZE[1], : SIZE[0]], np.asarray(single))


@pytest.mark.parametrize("width", [7.0, 34.0, 50.0, 75.0])
def test_the_scale_bar_has_its_length_and_keeps_off_the_label(width: float) -> None:
    size, kwargs = (400, 350), {"views": "posterior", "supersampling": 1}
    surface = box((width, 1, 0.5 * width))
    plain, barred = (np.asarray(draw_sheet(surface, scale_bar=bar, size=size, **kwargs)) for bar in (False, True))
    changed = np.any(plain != barred, axis=2)
    bar = changed[np.nonzero(changed.any(axis=1))[0].max()]
    pixels_per_mm = 0.94 * size[0] / width
    lengths = [round(mm * pixels_per_mm) for mm in (1, 2, 5, 10, 20, 50)]
    assert np.ptp(np.nonzero(bar)[0]) + 1 == bar.sum()
    assert bar.sum() == max(length for length in lengths if length <= 0.28 * size[0])
    assert not (covered(plain[size[1] :]) & changed.any(axis=0)).any()


@pytest.mark.parametrize("power", range(-6, 7))
def test_bars_are_round_and_as_long_as_can_be(power: int) -> None:
    for longest in (10.0**power, np.nextafter(10.0**power, 0), np.nextafter(10.0**power, np.inf), 4.9 * 10.0**power):
        length = scale_bar.round_length(float(longest))
        assert longest / 2.5 < length * (1 + 1e-12) <= longest * (1 + 1e-11)


def test_the_views_of_a_sheet_share_one_scale() -> None:
    sizes = {"anterior": (30, 20), "left": (10, 20), "superior": (30, 10)}
    picture = np.asarray(draw_sheet(box((30, 10, 20)), views=list(sizes), size=SIZE, labels=False, scale_bar=False))
    pixels_per_mm = min(0.94 * SIZE[0] / 30, 0.94 * SIZE[1] / 20)
    for view, extents in zip(np.split(picture, 3, axis=1), sizes.values(), strict=True):
        rows, columns = np.nonzero(covered(view))
        assert np.ptp(columns) + 1 == pytest.approx(extents[0] * pixels_per_mm, abs=2)
        assert np.ptp(rows) + 1 == pytest.approx(extents[1] * pixels_per_mm, abs=2)


@pytest.mark.parametrize("paper", [(1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (0.2, 0.2, 0.3)])
def test_writing_stands_out_from_the_paper(paper: tuple[float, float, float]) -> None:
    style = Style(background_color=paper)
    written = draw_sheet(sphere(), views="left", size=SIZE, title="title", style=style)
    plain = draw_sheet(sphere(), views="left", size=SIZE, labels=False, scale_bar=False, style=style)
    top, band = round(1.5 * 0.09 * SIZE[1]), round(0.09 * SIZE[1])
    assert written.size == (SIZE[0], top + SIZE[1] + band)
    pixels = np.asarray(written).astype(int)
    assert np.array_equal(pixels[top : top + SIZE[1] // 2], np.asarray(plain)[: SIZE[1] // 2])
    for strip in (pixels[:top], pixels[-band:]):
        assert np.abs(strip - np.round(255 * np.asarray(paper))).min(axis=2).max() > 90


def test_principal_views_turn_with_the_shape() -> None:
    generator = np.random.default_rng(3)
    points = generator.normal(size=(500, 3)) ** 3 * [5, 3, 1]
    rotation = trimesh.transformations.random_rotation_matrix(generator.random(3))[:3, :3]
    for view, turned in zip(principal_views(points), principal_views(points @ rotation.T), strict=True):
        assert np.allclose(rotation @ view.direction, turned.direction)
        assert np.allclose(rotation @ view.up, turned.up)


def test_one_triangle_and_no_tubes_make_a_picture() -> None:
    triangle = (np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1.0]]), np.array([[0, 1, 2]]))
    nothing = (np.zeros((0, 3)), np.zeros((0, 3), int))
    assert covered(render_view(triangle, nothing, size=SIZE)).any()


def test_what_cannot_be_drawn_is_refused() -> None:
    vertices, triangles = sphere()
    broken = vertices.copy()
    broken[triangles[0, 0]] = np.nan
    with pytest.raises(InvalidMesh):
        render_view((vertices, triangles[:0]))
    with pytest.raises(InvalidMesh, match="finite"):
        render_view((broken, triangles))
    with pytest.raises(InvalidMesh):
        render_view((vertices, triangles + len(vertices)))
    with pytest.raises(InvalidOption, match="anterior"):
        render_view(sphere(), view="front")
    with pytest.raises(InvalidOption, match="LPS"):
        render_view(sphere(), axes="XYZ")
    with pytest.raises(InvalidOption):
        render_view(sphere(), size=(0, 10))
    with pytest.raises(InvalidOption, match="supersampling"):
        render_view(sphere(), supersampling=2.0)  # type: ignore[arg-type]
    for option in ({"mm_per_pixel": 0.0}, {"mm_per_pixel": np.nan}, {"supersampling": 0}, {"supersampling": 9}):
        with pytest.raises(InvalidOption, match=next(iter(option))):
            render_view(sphere(), **option)
    with pytest.raises(InvalidMesh, match="whole numbers"):
        render_view((vertices, triangles.astype(float)))
    with pytest.raises(InvalidMesh, match="tubes"):
        render_view(sphere(), (vertices[:1], triangles))
    with pytest.raises(InvalidOption, match="more than"):
        render_view(sphere(), size=(200_000, 1), supersampling=1)
    with pytest.raises(InvalidOption):
        draw_sheet(sphere(), views=[])
    with pytest.raises(InvalidOption):
        draw_sheet(sphere(), columns=0)
    with pytest.raises(InvalidOption):
        View("none", (0, 0, 0), (0, 0, 1))


@pytest.mark.parametrize("missing", [("libGL.so.1",), ("libEGL.so.1", "libOSMesa.so.8")])
def test_without_opengl_the_error_names_the_packages(monkeypatch: pytest.MonkeyPatch, missing: tuple[str, ...]) -> None:
    load = context._load

    def load_unless_missing(soname: str, name: str) -> object:
        if soname in missing:
            raise OSError(f"{soname} ({name}) is not here")
        return load(soname, name)

    monkeypatch.setattr(context, "_load", load_unless_missing)
    monkeypatch.setattr(context, "_candidates", lambda: ("egl", "osmesa"))
    message = rf"{missing[-1]} .*apt-get install .*libegl1"
    with pytest.raises(RenderingUnavailable, match=message), offscreen_context():
        pass


def test_a_vertex_that_no_triangle_uses_may_be_anything() -> None:
    vertices, triangles = sphere()
    padded = np.vstack([vertices, [[np.nan] * 3, [1e6] * 3]])
    assert np.array_equal(render_view((padded, triangles), size=SIZE), render_view((vertices, triangles), size=SIZE))


@pytest.mark.parametrize("platform", ["glx", "egl,osmesa"])
def test_a_platform_with_windows_is_refused_with_its_remedy(monkeypatch: pytest.MonkeyPatch, platform: str) -> None:
    monkeypatch.delitem(sys.modules, "OpenGL.platform", raising=False)
    monkeypatch.setenv("PYOPENGL_PLATFORM", platform)
    with pytest.raises(RenderingUnavailable, match="egl or osmesa"), offscreen_context():
        pass


@pytest.mark.skipif(find_library("OSMesa") is None, reason="libOSMesa is not installed")
@pytest.mark.parametrize(
    "wish", [{"PYOPENGL_PLATFORM": "osmesa"}, {"EGL_DEVICE_ID": "none"}], ids=["named", "fallback"]
)
def test_osmesa_draws_as_well(wish: dict[str, str]) -> None:
    code = (
        "import os; import numpy as np; from pectinate.figure import render_view;"
        "p = render_view((np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1.0]]), np.array([[0, 1, 2]])), size=(50, 50));"
        "assert (p != 255).any() and os.environ['PYOPENGL_PLATFORM'] == 'osmesa'"
    )
    # Without the platform that this process has settled on.
    environment = {name: value for name, value in os.environ.items() if name != "PYOPENGL_PLATFORM"} | wish
    subprocess.run([sys.executable, "-c", code], check=True, env=environment, timeout=60)


def test_a_placement_refuses_a_suffix_that_is_no_picture() -> None:
    placement = place_streamlines(datasets.demo_atrium(edge_length=4), separation_distance=8)
    with pytest.raises(InvalidOption, match=r"\.png"):
        placement.figure("picture.docx")
    with pytest.raises(InvalidFile, match="folder"):
        placement.figure("/nowhere/picture.png", views="left", size=(40, 30))
