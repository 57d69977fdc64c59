"""Interactive pages in a real browser: they load without the network, look like the pictures and follow the mouse."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import meshes
import pectinate
from browser import Browser, start_browser
from pectinate import datasets, place_streamlines
from pectinate._core import StopReason
from pectinate.figure import Layer, SurfaceValues, View, render_view, standard_view
from pectinate.figure.polylines import Lines, values_at
from pectinate.placement import DRAWN_TUBE_HEIGHT
from pectinate.viewer import Marker, Page, Part

SIZE = (360, 300)
# Darker pixels are those of tubes on a surface in light.
DARK = 70
Picture = NDArray[np.float64]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    started = start_browser()
    yield started
    started.driver.quit()


@pytest.fixture(scope="module")
def placement() -> pectinate.Placement:
    return place_streamlines(datasets.demo_atrium(edge_length=3), separation_distance=4)


@pytest.fixture(scope="module")
def values(placement: pectinate.Placement) -> NDArray[np.float64]:
    """A number per vertex, missing on the patient's left."""
    x, _, z = placement.mesh.vertices.T
    return np.where(x > np.quantile(x, 0.8), np.nan, z)


@pytest.fixture(scope="module")
def page(placement: pectinate.Placement, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "demo.html"
    placement.save(path, title="demo")
    return path


def figure(
    placement: pectinate.Placement, *, height: float = DRAWN_TUBE_HEIGHT, radius: float | None = None, **options: Any
) -> Picture:
    tubes, mesh = placement.tubes(height=height, radius=radius), placement.mesh
    surface = (mesh.vertices, mesh.triangles)
    return render_view(surface, (tubes.vertices, tubes.triangles), size=SIZE, **options).astype(np.float64)


def covered(picture: Picture) -> NDArray[np.bool_]:
    return picture.min(axis=2) < 250


def overlap(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    return float((first & second).sum() / (first | second).sum())


def dark_area(picture: Picture) -> int:
    return int((picture.max(axis=2) < DARK).sum())


def open_folded(browser: Browser, path: Path) -> None:
    """Open a page with the controls folded, so that the surface is in the middle of the window."""
    assert browser.open(path, SIZE) == "ready"
    assert browser.run("return document.getElementById('panel').classList.contains('folded')")


def drag(browser: Browser, dx: int, dy: int) -> None:
    actions = pytest.importorskip("selenium.webdriver").ActionChains(browser.driver, duration=20)
    canvas = browser.driver.find_element("id", "scene")
    actions.move_to_element(canvas).click_and_hold().move_by_offset(dx, dy).release().perform()


def test_a_page_loads_without_errors_and_without_the_network(browser: Browser, page: Path) -> None:
    assert browser.open(page) == "ready"
    browser.picture()
    assert browser.messages() == []
    assert browser.requests() == [page.as_uri()]
    assert browser.run("return document.title") == "demo"
    assert browser.run("return document.getElementById('message').hidden")


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("view", ["anterior", "posterior", "inferior"])
def test_a_page_shows_what_the_picture_shows(
    browser: Browser, page: Path, placement: pectinate.Placement, view: str
) -> None:
    open_folded(browser, page)
    browser.run(
        "document.querySelectorAll('.views button').forEach((b) => b.textContent === arguments[0] && b.click())", view
    )
    shown, drawn = browser.picture(ratio=2), figure(placement, view=view)
    assert shown.shape == drawn.shape
    assert overlap(covered(shown), covered(drawn)) > 0.99
    dark = [(picture.max(axis=2) < DARK).ravel() for picture in (shown, drawn)]
    assert np.corrcoef(*dark)[0, 1] > 0.9
    assert np.corrcoef(shown.ravel(), drawn.ravel())[0, 1] > 0.98
    assert np.abs(shown - drawn).mean() < 5


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("per_triangle", [False, True])
def test_values_have_the_colours_of_the_picture(
    browser: Browser, placement: pectinate.Placement, values: NDArray[np.float64], tmp_path: Path, per_triangle: bool
) -> None:
    pytest.importorskip("matplotlib")
    triangles = placement.mesh.triangles
    shown_values = SurfaceValues(values[triangles].mean(axis=1) if per_triangle else values, "magma")
    Page(placement.model.part(surface_values=shown_values)).save(tmp_path / "values.html")
    open_folded(browser, tmp_path / "values.html")
    browser.run("viewer.insets = () => [0, 0]; viewer.look(0)")
    mesh = placement.mesh
    drawn = render_view((mesh.vertices, triangles), surface_values=shown_values, size=SIZE).astype(np.float64)
    shown = browser.picture()
    assert overlap(covered(shown), covered(drawn)) > 0.99
    assert np.abs(shown - drawn).mean() < 2
    assert browser.run("return viewer.parts[0].someMissing")
    assert np.abs(browser.picture(written=True) - shown).sum() > 0  # the colour bar
    browser.run("document.querySelector('select').selectedIndex = 0")
    browser.run("document.querySelector('select').dispatchEvent(new Event('change'))")
    plain = render_view((mesh.vertices, triangles), size=SIZE).astype(np.float64)
    assert np.abs(browser.picture() - plain).mean() < 2


def test_the_surface_arrives_as_it_was(browser: Browser, page: Path, placement: pectinate.Placement) -> None:
    browser.open(page)
    surface = "viewer.parts[0].surface"
    positions = np.reshape(browser.run(f"return Array.from({surface}.positions)"), (-1, 3))
    corners = np.reshape(browser.run(f"return Array.from({surface}.corners)"), (-1, 3))
    mesh = placement.mesh
    step = np.ptp(mesh.vertices, axis=0).max() / 65535
    # The order is the page's own: triangles are compared by their middles, whichever corner comes first.
    sent, kept = (
        np.sort(np.round(v[t].mean(axis=1) / (4 * step)), axis=0)
        for v, t in ((positions, corners), (mesh.vertices, mesh.triangles))
    )
    assert sent.shape == kept.shape
    assert np.abs(sent - kept).max() <= 1
    normals = [
        np.cross(v[t[:, 1]] - v[t[:, 0]], v[t[:, 2]] - v[t[:, 0]])
        for v, t in ((positions, corners), (mesh.vertices, mesh.triangles))
    ]
    volumes = [
        (n * v[t[:, 0]]).sum()
        for n, (v, t) in zip(normals, ((positions, corners), (mesh.vertices, mesh.triangles)), strict=True)
    ]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-4)


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("taper", [None, 0.0])
def test_values_on_tubes_and_contours_are_those_of_the_picture(
    browser: Browser, placement: pectinate.Placement, values: NDArray[np.float64], tmp_path: Path, taper: float | None
) -> None:
    pytest.importorskip("matplotlib")
    x = placement.mesh.vertices[:, 0]
    on_surface, on_tubes = SurfaceValues(x, "magma", contours=8.0), SurfaceValues(values)
    look = {"surface_values": on_surface, "tube_values": on_tubes, "taper_length": taper}
    placement.save(tmp_path / "page.html", **look)
    open_folded(browser, tmp_path / "page.html")
    shown, mesh = browser.picture(ratio=2), placement.mesh
    tubes = placement.tubes(taper_length=taper, height=DRAWN_TUBE_HEIGHT)
    at_points = (placement.barycentric * np.nan_to_num(values)[mesh.triangles[placement.point_triangles]]).sum(axis=1)
    missing = (np.isnan(values)[mesh.triangles[placement.point_triangles]] & (placement.barycentric > 0)).any(axis=1)
    numbers = values_at(SurfaceValues(np.where(missing, np.nan, at_points)), tubes.vertex_points)
    layer = Layer((tubes.vertices, tubes.triangles), (0, 0, 0), numbers)
    surface = (mesh.vertices, mesh.triangles)
    drawn = render_view(surface, layers=[layer], surface_values=on_surface, size=SIZE).astype(np.float64)
    assert overlap(covered(shown), covered(drawn)) > 0.98
    assert np.abs(shown - drawn).mean() < 5
    assert np.corrcoef(shown.ravel(), drawn.ravel())[0, 1] > 0.98
    keys = browser.run("return viewer.keys().map(({ scale, someMissing }) => [scale.name, someMissing])")
    assert keys == [["values", False], ["values", True]]
    click = "document.querySelector('input[name=contours]').click()"
    browser.run(click)
    plain = render_view(surface, layers=[layer], surface_values=SurfaceValues(x, "magma"), size=SIZE).astype(np.float64)
    without = browser.picture(ratio=2)
    changed = np.abs(without - shown).max(axis=2) > 40
    assert changed.sum() > 500
    assert np.corrcoef(changed.ravel(), (np.abs(plain - drawn).max(axis=2) > 40).ravel())[0, 1] > 0.8
    browser.run("viewer.showTubeValues(-1)")
    assert dark_area(browser.picture(ratio=2)) > dark_area(without) + 2000
    assert browser.messages() == []


@pytest.mark.usefixtures("opengl")
def test_categories_have_their_colours_and_no_scale(browser: Browser, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    vertices, triangles = meshes.sphere(4, radius=10.0)
    tags = SurfaceValues((vertices[triangles][:, :, 0].mean(axis=1) // 4).astype(int), categories={0: "middle"})
    Page(Part("", (vertices, triangles), surface_values={"tag": tags})).save(tmp_path / "tags.html")
    open_folded(browser, tmp_path / "tags.html")
    browser.run("viewer.insets = () => [0, 0]; viewer.look(0)")
    drawn = render_view((vertices, triangles), surface_values=tags, size=SIZE).astype(np.float64)
    assert np.abs(browser.picture(ratio=2) - drawn).mean() < 3
    assert browser.run("return viewer.keys()[0].scale.categories") == ["-3", "-2", "-1", "middle", "1", "2"]
    plain, written = (browser.picture(written=w) for w in (False, True))
    assert np.abs(plain - written)[:, :90].max() > 100


def test_tubes_have_the_taper_of_the_paper(browser: Browser, page: Path, placement: pectinate.Placement) -> None:
    browser.open(page)
    share = np.array(browser.run("return Array.from(viewer.parts[0].streamlines.geometry.attributes.thickness.array)"))
    longest = placement.lengths.max()
    assert share.min() == 0
    assert share.max() == pytest.approx((1 - np.exp(-0.5 * longest / 2.0)) ** 2, abs=0.02)
    # An end for each line, with as many vertices as a ring has.
    assert np.count_nonzero(share == 0) == 2 * 8 * len(placement)


def closed_lines() -> dict[str, Lines]:
    """Streamlines round a ring, and a knot, whose parallel normals do not close."""
    vertices, triangles = meshes.annulus(inner=4.0, outer=10.0)
    x, y, _ = vertices[triangles].mean(axis=1).T
    model = pectinate.load((vertices, triangles), field=np.column_stack([-y, x, 0 * x]), field_location="triangle")
    placement = place_streamlines(model, separation_distance=2.0, close_loops=True)
    assert (placement.stop_reasons == StopReason.closed).all()
    t = np.linspace(0, 2 * np.pi, 200)
    ring = 5 + 2 * np.cos(3 * t)
    knot = np.column_stack([ring * np.cos(2 * t), ring * np.sin(2 * t), 2 * np.sin(3 * t)])
    knot[-1] = knot[0]
    return {"ring": Lines(placement.points, placement.offsets, 0.3, 2.0), "knot": Lines.of([knot], 0.3)}


@pytest.mark.parametrize("name", ["ring", "knot"])
def test_tubes_of_closed_lines_are_rings(browser: Browser, tmp_path: Path, name: str) -> None:
    part = Part(name, meshes.annulus(inner=4.0, outer=10.0), streamlines=closed_lines()[name])
    Page([part], views=["superior"]).save(tmp_path / "rings.html")
    open_folded(browser, tmp_path / "rings.html")
    assert browser.messages() == []

    def array(of_geometry: str) -> NDArray[np.float64]:
        values = browser.run(f"return Array.from(viewer.parts[0].streamlines.geometry.{of_geometry}.array)")
        return np.array(values, dtype=np.float64)

    thickness, corners = array("attributes.thickness"), array("index").astype(int).reshape(-1, 3)
    assert (thickness == 1).all()
    starts, ends = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    sides = set(zip(starts.tolist(), ends.tolist(), strict=True))
    # Each side has its counterpart: watertight; and with so many vertices the Euler characteristic is 0.
    assert len(sides) == len(starts)
    assert all((second, first) in sides for first, second in sides)
    assert len(thickness) - len(sides) // 2 + len(corners) == 0
    centres, offsets = array("attributes.position").reshape(-1, 3), array("attributes.offset").reshape(-1, 4) / 127
    # From ring to ring neighbours are close, at the joint as well: nothing is twisted.
    assert np.linalg.norm(centres[starts] - centres[ends], axis=1).max() < 1
    assert np.linalg.norm(offsets[starts] - offsets[ends], axis=1).max() < 1.1


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("height", [0.3, 1.0])
def test_tubes_have_the_height_of_the_picture(
    browser: Browser, placement: pectinate.Placement, tmp_path: Path, height: float
) -> None:
    # Thick ones, on a part that is turned.
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    part = placement.part(tube_radius=1.2, tube_height=height, rotation=turn)
    Page(part, views=["anterior"]).save(tmp_path / "page.html")
    open_folded(browser, tmp_path / "page.html")
    shown, seen = browser.picture(ratio=2), standard_view("anterior")
    unturned = View("turned", tuple(seen.direction @ turn), tuple(seen.up @ turn))
    same, other = (
        np.corrcoef(shown.ravel(), figure(placement, radius=1.2, height=h, view=unturned).ravel())[0, 1]
        for h in (height, 1.3 - height)
    )
    assert same > 0.98
    assert 1 - same < 0.5 * (1 - other)


def test_a_drag_turns_the_scene_like_a_ball(browser: Browser, page: Path) -> None:
    open_folded(browser, page)
    before = browser.picture()
    first = np.array(browser.run("return viewer.view.rotation"))
    drag(browser, 66, 0)
    turned = np.array(browser.run("return viewer.view.rotation")) @ first.T
    angle = 66 / (0.33 * SIZE[1])
    c, s = np.cos(angle), np.sin(angle)
    np.testing.assert_allclose(turned, [[c, 0, s], [0, 1, 0], [-s, 0, c]], atol=1e-6)
    assert np.abs(browser.picture() - before).mean() > 5
    drag(browser, -66, 0)
    assert np.abs(browser.picture() - before).mean() < 0.5
    drag(browser, 0, 40)
    tipped = np.array(browser.run("return viewer.view.rotation")) @ first.T
    assert tipped[1, 2] == pytest.approx(-np.sin(40 / (0.33 * SIZE[1])), abs=1e-6)


def test_a_scroll_zooms_about_the_pointer(browser: Browser, page: Path) -> None:
    open_folded(browser, page)
    webdriver = pytest.importorskip("selenium.webdriver")
    canvas = browser.driver.find_element("id", "scene")
    under = (
        "return [viewer.view.mmPerPixel, viewer.view.toScene([100 * viewer.view.mmPerPixel, 0, 0])"
        ".map((x, k) => x + viewer.view.centre[k])]"
    )
    scale, place = browser.run(under)
    origin = webdriver.common.actions.wheel_input.ScrollOrigin.from_element(canvas, 100, 0)
    webdriver.ActionChains(browser.driver).scroll_from_origin(origin, 0, -200).perform()
    browser.wait_for(f"return viewer.view.mmPerPixel < {scale}")
    closer, same_place = browser.run(under)
    assert closer == pytest.approx(scale * np.exp(-0.3), rel=1e-6)
    np.testing.assert_allclose(same_place, place, atol=1e-6)


def test_layers_are_switched(browser: Browser, page: Path) -> None:
    open_folded(browser, page)
    browser.driver.find_element("css selector", ".fold").click()
    whole = browser.picture()
    click = "document.querySelector('input[name=' + arguments[0] + ']').click()"
    browser.run(click, "streamlines")
    without_tubes = browser.picture()
    assert dark_area(without_tubes) < 0.2 * dark_area(whole)
    assert overlap(covered(without_tubes), covered(whole)) > 0.95
    browser.run(click, "surface")
    assert not covered(browser.picture()).any()
    browser.run(click, "streamlines")
    tubes = browser.picture()
    assert 0.3 * covered(whole).sum() < covered(tubes).sum() < 0.98 * covered(whole).sum()
    browser.run(click, "surface")
    assert np.array_equal(browser.picture(), whole)


def test_the_slider_makes_tubes_thicker(browser: Browser, page: Path, placement: pectinate.Placement) -> None:
    open_folded(browser, page)
    slider = "const slider = document.querySelector('input[name=radius]');"
    assert float(browser.run(slider + "return slider.value")) == pytest.approx(
        placement.default_tube_radius(), rel=0.02
    )
    areas = []
    for share in (0.25, 1, 2):
        script = "slider.value = arguments[0]; slider.dispatchEvent(new Event('input'))"
        browser.run(slider + script, share * placement.default_tube_radius())
        areas.append(dark_area(browser.picture()))
    assert areas[0] < 0.5 * areas[1] < 0.5 * areas[2]


def test_the_button_saves_the_picture(browser: Browser, page: Path, tmp_path: Path) -> None:
    open_folded(browser, page)
    behaviour = {"behavior": "allow", "downloadPath": str(tmp_path)}
    browser.driver.execute_cdp_cmd("Browser.setDownloadBehavior", behaviour)
    browser.run("document.querySelector('.save').click()")
    saved = tmp_path / "demo.png"
    for _ in range(100):
        browser.wait_for("return true")
        if saved.exists():
            break
        browser.driver.execute_async_script("setTimeout(arguments[0], 50)")
    with Image.open(saved) as image:
        assert image.size == (2 * SIZE[0], 2 * SIZE[1])


def test_parts_and_markers_are_switched_together(
    browser: Browser, placement: pectinate.Placement, tmp_path: Path
) -> None:
    mesh = placement.mesh
    left, right = (
        placement.part("left <b>", tracts=[mesh.vertices[mesh.boundary_loops[0].vertices]]),
        placement.part("right"),
    )
    shift = 1.2 * np.ptp(mesh.vertices[:, 0])
    moved = type(right)("right", (mesh.vertices - [shift, 0, 0], mesh.triangles))
    y = mesh.vertices[:, 1]
    front, back = mesh.vertices[y.argmin()], mesh.vertices[y.argmax()]
    marks = [Marker(tuple(front), "1"), Marker(tuple(back), "2"), Marker(tuple(front - [shift, 0, 0]), "3")]
    Page([left, moved], markers=marks, title="</script><i>two").save(tmp_path / "two.html")
    open_folded(browser, tmp_path / "two.html")
    shown = "viewer.draw(1); return viewer.visibleMarkers().map(({ text }) => text)"
    assert browser.run(shown) == ["1", "3"]
    browser.run("viewer.look(1)")
    assert browser.run(shown) == ["2"]
    both = browser.picture()
    browser.run("document.querySelector('input[name=\"part 1\"]').click()")
    assert browser.run(shown) == ["2"]
    one = browser.picture()
    assert 0.3 < covered(one).sum() / covered(both).sum() < 0.8
    browser.run("document.querySelector('input[name=\"part 0\"]').click()")
    assert browser.run(shown) == []
    assert not covered(browser.picture()).any()
    labels = browser.run("return [...document.querySelectorAll('#panel label, #panel h1')].map((e) => e.textContent)")
    assert {"</script><i>two", "left <b>", "right", "Tracts", "Markers"} <= set(labels)
    assert browser.messages() == []


def test_markers_are_seen_from_outside_only_and_stand_where_they_are_seen(browser: Browser, tmp_path: Path) -> None:
    vertices, triangles = meshes.sphere(3, radius=5)
    back_half = vertices, triangles[(vertices[triangles][:, :, 1] >= 0).all(axis=1)]
    front, back = (0.0, -5.0, 0.0), (0.0, 5.0, 0.0)
    marks = [Marker(back, "back"), Marker(front, "front"), Marker(back, "either", [front])]
    shown = "viewer.draw(1); return viewer.visibleMarkers().map(({ text }) => text)"
    for surface, before, behind in (
        ((vertices, triangles), ["front", "either"], ["back", "either"]),
        (back_half, [], ["back", "either"]),
    ):
        here = marks if before else [marks[0], marks[2]]
        Page(Part("shell", surface), markers=here, views=["anterior", "posterior"]).save(tmp_path / "shell.html")
        open_folded(browser, tmp_path / "shell.html")
        assert browser.run(shown) == before
        browser.run("viewer.look(1)")
        assert browser.run(shown) == behind


def test_dark_mode_and_a_narrow_window_change_nothing_of_the_picture(browser: Browser, page: Path) -> None:
    browser.open(page, (320, 480))
    light = browser.window()
    assert browser.open(page, (320, 480), dark=True) == "ready"
    assert np.abs(browser.window() - light).mean() < 1
    assert (browser.window()[-5, -5] == 255).all()
    assert browser.run("return document.documentElement.scrollWidth <= 320")


def test_a_notebook_shows_the_page_in_a_frame(browser: Browser, placement: pectinate.Placement, tmp_path: Path) -> None:
    notebook = tmp_path / "notebook.html"
    notebook.write_text(f"<!DOCTYPE html><title>n</title>{placement.page()._repr_html_()}", encoding="utf-8")
    browser.driver.get(notebook.as_uri())
    browser.driver.switch_to.frame(0)
    assert browser.wait_for("return document.documentElement.dataset.state") == "ready"
    assert browser.run("return viewer.parts.length") == 1
    browser.driver.switch_to.default_content()


@pytest.mark.parametrize("name", ["triangle", "sphere", "no lines"])
def test_small_closed_and_empty_scenes_are_shown(browser: Browser, tmp_path: Path, name: str) -> None:
    mesh = {"triangle": meshes.single_triangle, "sphere": meshes.sphere, "no lines": meshes.grid}[name]()
    along = np.tile([1.0, 0.3, 0.2], (len(mesh[1]), 1))
    options = {"minimum_length": 1e6} if name == "no lines" else {}
    placement = place_streamlines(pectinate.load((*mesh, along)), separation_distance=0.3, **options)
    assert (len(placement) == 0) == (name == "no lines")
    placement.save(tmp_path / "small.html", views=["superior"], surface_values=np.full(len(mesh[1]), np.nan))
    open_folded(browser, tmp_path / "small.html")
    picture = browser.picture()
    assert covered(picture).sum() > 0.05 * covered(picture).size
    assert browser.messages() == []


def test_without_webgl_the_page_says_so(page: Path) -> None:
    browser = start_browser("--disable-3d-apis")
    try:
        assert browser.open(page) == "unsupported"
        message = browser.driver.find_element("id", "message")
        assert message.is_displayed()
        assert "WebGL" in message.text
        assert browser.messages() == []
    finally:
        browser.driver.quit()


def test_the_views_are_those_of_the_pictures(browser: Browser, page: Path) -> None:
    browser.open(page)
    for shown in browser.run("return viewer.scene.views"):
        np.testing.assert_allclose(shown["rotation"], standard_view(shown["name"]).rotation())
