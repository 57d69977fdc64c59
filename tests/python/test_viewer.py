"""Interactive pages: what they are made of, and what cannot be shown. How they look is tested in a browser."""

from __future__ import annotations

import json
import re
import sys
import tempfile
import types
import webbrowser
import zipfile
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import meshes
import pectinate
from pectinate import datasets, place_streamlines
from pectinate.cli import ExitCode, main
from pectinate.errors import InvalidFile, InvalidMesh, InvalidOption, MissingDependency
from pectinate.figure import SurfaceValues
from pectinate.figure.polylines import normals_at, resampled
from pectinate.viewer import Lines, Marker, Page, Part
from pectinate.viewer.encoding import (
    NO_VALUE,
    coherent_order,
    first_use_codes,
    quantized_directions,
    quantized_points,
    quantized_values,
)
from pectinate.viewer.scene import describe_scene
from pectinate.viewer.three import three_js


@pytest.fixture(scope="module")
def placement() -> pectinate.Placement:
    return place_streamlines(datasets.demo_atrium(edge_length=3), separation_distance=4)


def description(page: Page) -> dict:
    found = re.search(r'<script type="application/json" id="description">(.*?)</script>', page.html)
    assert found is not None
    return json.loads(found.group(1))


def test_the_same_placement_gives_the_same_page(placement: pectinate.Placement) -> None:
    assert placement.page().html == placement.page().html


def test_a_page_keeps_the_notice_of_three_js(placement: pectinate.Placement) -> None:
    html = placement.page().html
    assert re.search(r"Copyright [-\d]+ Three\.js Authors\n \* SPDX-License-Identifier: MIT", html)
    assert html.count("<script") == html.count("</script>") == 4


def test_text_from_outside_cannot_leave_its_place() -> None:
    page = Page(Part("</script><b>", meshes.grid()), title='</title><b>"', notes=["</script>"])
    assert page.html.count("</script>") == 4
    assert page.html.count("</title>") == 1
    shown = description(page)
    assert (shown["title"], shown["notes"], shown["parts"][0]["name"]) == (
        '</title><b>"',
        ["</script>"],
        "</script><b>",
    )


@pytest.mark.slow
def test_a_measured_atrium_makes_a_small_page(human_atrium: Path) -> None:
    placement = place_streamlines(pectinate.load(human_atrium / "la_epi.pts"), separation_distance=0.7)
    assert len(placement) >= 1500
    assert placement.mesh.triangle_count > 140_000
    assert len(placement.page().html) < 12e6


@given(
    lengths=st.lists(st.floats(0.01, 50), min_size=1, max_size=5),
    radius=st.floats(0.05, 2),
    taper=st.sampled_from([0.0, 0.5, 2.0]),
    seed=st.integers(0, 99),
)
def test_resampled_lines_keep_their_ends_and_lie_on_the_lines(
    lengths: list[float], radius: float, taper: float, seed: int
) -> None:
    generator = np.random.default_rng(seed)
    lines = [length * np.cumsum(generator.normal(size=(generator.integers(2, 9), 3)), axis=0) for length in lengths]
    points, _, counts = resampled(Lines(np.concatenate(lines), np.cumsum([0, *map(len, lines)]), radius, taper))
    assert len(counts) == len(lines)
    for line, samples in zip(lines, np.split(points, np.cumsum(counts)[:-1]), strict=True):
        np.testing.assert_array_equal(samples[[0, -1]], line[[0, -1]])
        steps = np.linalg.norm(np.diff(samples, axis=0), axis=1)
        assert steps.max() <= 1.5 * radius * (1 + 1e-9)
        assert taper == 0 or steps.max() <= 0.5 * taper * (1 + 1e-9)
        starts, sides = line[:-1], np.diff(line, axis=0)
        share = ((samples[:, None] - starts) * sides).sum(axis=2) / (sides**2).sum(axis=1)
        nearest = starts + np.clip(share, 0, 1)[:, :, None] * sides
        distances = np.linalg.norm(samples[:, None] - nearest, axis=2).min(axis=1)
        assert distances.max() <= 1e-9 * np.abs(line).max()


def test_points_are_kept_to_half_a_step() -> None:
    points = np.random.default_rng(1).normal(size=(500, 3)) * [30, 40, 5]
    steps, place = quantized_points(points)
    assert place["step"] == pytest.approx(np.ptp(points, axis=0).max() / 65535)
    assert np.abs(place["origin"] + place["step"] * steps - points).max() <= 0.5 * place["step"] * (1 + 1e-9)


def test_values_are_kept_to_half_a_step_and_missing_ones_are_told() -> None:
    values = np.array([0.0, 2.5, 10.0, -3.0, 12.0, np.nan, np.inf, -np.inf])
    steps = quantized_values(values, 0.0, 10.0)
    assert steps.tolist() == [0, round(0.25 * (NO_VALUE - 1)), NO_VALUE - 1, 0, NO_VALUE - 1, *[NO_VALUE] * 3]
    extremes = np.array([-1.7e308, 0.0, 1.7e308])
    assert quantized_values(extremes, *extremes[[0, 2]]).tolist() == [0, (NO_VALUE - 1) // 2, NO_VALUE - 1]


def test_triangles_survive_their_codes() -> None:
    vertices, triangles = meshes.torus()
    vertices = np.concatenate([vertices, [[9.0, 9, 9]]])  # used by none
    triangle_order, vertex_order = coherent_order(vertices, triangles)
    assert sorted(triangle_order) == list(range(len(triangles)))
    assert sorted(vertex_order) == list(range(len(vertices) - 1))
    rank = np.argsort(np.append(vertex_order, len(vertices) - 1))
    corners, seen = [], 0
    for code in first_use_codes(rank[triangles[triangle_order]]).tolist():
        corners.append(seen - code)
        seen += code == 0
    np.testing.assert_array_equal(vertex_order[corners].reshape(-1, 3), triangles[triangle_order])


def test_parts_share_the_scale_of_a_name() -> None:
    vertices, triangles = meshes.grid()
    low, high = np.full(len(triangles), 1.0), np.linspace(2, 5, len(vertices))
    parts = [Part("a", (vertices, triangles), surface_values={"t": low, "u": low})]
    parts.append(Part("b", (vertices, triangles), surface_values={"t": SurfaceValues(high, "magma", label="t (ms)")}))
    pytest.importorskip("matplotlib")
    first, second = description(Page(parts, shown_values="u"))["scales"]
    assert (first["name"], first["label"], first["low"], first["high"]) == ("t", "t (ms)", 1.0, 5.0)
    assert (second["name"], second["low"], second["high"]) == ("u", 1.0, 2.0)
    assert description(Page(parts, shown_values="u"))["shown_values"] == 1


def test_markers_belong_to_the_nearest_part() -> None:
    vertices, triangles = meshes.grid()
    parts = [Part(str(x), (vertices + np.array([x, 0, 0]), triangles)) for x in (0, 100)]
    page = Page(parts, markers=[Marker((101, 1, 0), "1"), Marker((1, 1, 0), "2")])
    assert [(marker["text"], marker["part"]) for marker in description(page)["markers"]] == [("1", 1), ("2", 0)]


def test_tracts_follow_the_surface(placement: pectinate.Placement) -> None:
    model, mesh = placement.model, placement.mesh
    ends = mesh.vertices[[0, int(np.argmin(np.abs(np.linalg.norm(mesh.vertices - mesh.vertices[0], axis=1) - 8)))]]
    (curve,) = pectinate.TractSet([pectinate.Tract(ends, "one")]).curves_on(model)
    np.testing.assert_allclose(curve[[0, -1]], ends, atol=1e-6)
    lines = placement.part(tracts=[curve, ends], tract_radius=0.3).tracts
    assert lines is not None
    assert lines.offsets.tolist() == [0, len(curve), len(curve) + 2]
    assert (lines.radius, lines.taper_length) == (0.3, 0.0)


def test_source_values_go_to_the_mesh() -> None:
    vertices, triangles = meshes.grid()
    degenerate = np.insert(triangles, 3, [0, 0, 1], axis=0)
    model = pectinate.load((vertices[:, [0, 1, 2]], degenerate))
    numbers = np.arange(len(degenerate))
    assert model.to_mesh(numbers).tolist() == [n for n in numbers if n != 3]
    assert model.to_mesh(vertices[:, 0]).tolist() == model.mesh.vertices[:, 0].tolist()
    for wrong in (numbers[1:], np.zeros((len(numbers), 2)), np.array(["a"] * len(numbers))):
        with pytest.raises(InvalidOption, match="per triangle"):
            model.to_mesh(wrong)


def test_show_opens_a_file(placement: pectinate.Placement, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda address: opened.append(address) or True)
    pages = [placement.show(title="t"), placement.model.show(title="u")]
    for page, address in zip(pages, opened, strict=True):
        path = Path(url2pathname(urlparse(address).path))
        assert path.read_text(encoding="utf-8") == page.html
        path.unlink()


def test_without_a_browser_show_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(webbrowser, "open", lambda _: False)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with pytest.raises(MissingDependency, match="save the page"):
        Page(Part("", meshes.grid())).show()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("points", "offsets"),
    [
        (np.zeros((3, 2)), [0, 3]),
        (np.full((3, 3), np.nan), [0, 3]),
        (np.zeros((3, 3)), []),
        (np.zeros((3, 3)), [0, 2]),
        (np.zeros((3, 3)), [1, 3]),
        (np.zeros((3, 3)), [0, 1, 3]),
        (np.zeros((3, 3)), [0, 4, 3]),
        (np.zeros((3, 3)), [[0, 3]]),
    ],
)
def test_lines_must_fit_together(points: NDArray[np.float64], offsets: list[int]) -> None:
    with pytest.raises(InvalidOption, match="lines"):
        Lines(points, np.array(offsets, dtype=np.int64), 1.0)


def test_in_a_notebook_the_page_is_displayed_not_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(webbrowser, "open", lambda _: pytest.fail("opened a browser"))
    shell = types.SimpleNamespace(kernel=None)
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    page = Page(Part("", meshes.grid())).show()
    frame = page._repr_html_()
    assert frame.startswith('<iframe srcdoc="')
    assert frame.count('"') == 2 * 3  # none of the page's own


def test_what_cannot_be_shown_is_refused(placement: pectinate.Placement, tmp_path: Path) -> None:
    vertices, triangles = meshes.grid()
    part = Part("a", (vertices, triangles))
    broken = vertices.copy()
    broken[0] = np.nan
    with pytest.raises(InvalidMesh, match="nothing to show"):
        Part("a", (vertices, triangles[:0]))
    with pytest.raises(InvalidMesh, match="finite"):
        Part("a", (broken, triangles))
    with pytest.raises(InvalidOption, match="at least one part"):
        Page([])
    with pytest.raises(InvalidOption, match="views"):
        Page(part, views=[])
    with pytest.raises(InvalidOption, match="front"):
        Page(part, views=["front"])
    with pytest.raises(InvalidOption, match="shown_values"):
        Page(part, shown_values="x")
    with pytest.raises(InvalidOption, match="one number per triangle"):
        Page(Part("a", (vertices, triangles), surface_values={"x": np.zeros(5)}))
    with pytest.raises(InvalidOption, match="position"):
        Marker((0, 0, np.nan), "1")
    for wrong in ([[0, 0, 0]], [[0, 0, 0], [np.nan, 0, 0]], [[0, 0], [1, 1]]):
        with pytest.raises(InvalidOption, match="line"):
            placement.part(tracts=[wrong])
    for option in ({"tube_radius": 0}, {"tube_radius": np.nan}, {"taper_length": -1}, {"tract_radius": 0}):
        with pytest.raises(InvalidOption, match=r"radius|taper_length"):
            placement.page(tracts=[[[0, 0, 0], [1, 0, 0]]], **option)
    with pytest.raises(InvalidOption, match=r"\.html"):
        Page(part).save(tmp_path / "a.png")
    with pytest.raises(InvalidFile, match="nowhere"):
        Page(part).save(tmp_path / "nowhere" / "a.html")


def test_without_three_js_the_error_names_the_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(*_: object) -> None:
        raise zipfile.BadZipFile("broken")

    three_js.cache_clear()
    monkeypatch.setattr(zipfile, "ZipFile", nothing)
    try:
        with pytest.raises(MissingDependency, match="trimesh"):
            three_js()
    finally:
        three_js.cache_clear()


def test_the_scene_of_no_streamlines_has_none() -> None:
    lines = Lines(np.zeros((0, 3)), np.zeros(1, dtype=np.int64), 1.0)
    scene, _ = describe_scene(
        [Part("a", meshes.grid(), streamlines=lines)], [], ["anterior"], "LPS", pectinate.figure.Style()
    )
    assert scene["parts"][0]["streamlines"] is None


def test_directions_come_back_from_their_steps() -> None:
    directions = np.random.default_rng(3).normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    steps = quantized_directions(directions).view(np.int16) / 127
    np.testing.assert_allclose(steps, directions, atol=0.5 / 127 + 1e-12)


def test_flat_lines_have_unit_normals_and_round_ones_none() -> None:
    points, offsets = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([0, 3])
    normals = np.array([[0.0, 0, 2], [0, 3, 0], [0, 3, 0]])
    flat = Lines(points, offsets, 0.1, height=0.5, normals=normals)
    np.testing.assert_allclose(normals_at(flat, np.array([0.0, 1, 1.5])), [[0, 0, 1], [0, 1, 0], [0, 1, 0]])
    between = normals_at(flat, np.array([0.5]))
    np.testing.assert_allclose(between, np.array([[0, 3, 2]]) / np.sqrt(13))
    assert normals_at(Lines(points, offsets, 0.1, normals=normals), np.array([0.0])) is None
    for height, some in (
        (0.0, normals),
        (1.1, normals),
        (np.nan, normals),
        (0.5, None),
        (1.0, normals[:2]),
        (0.5, np.nan * normals),
    ):
        with pytest.raises(InvalidOption, match=r"height|normal"):
            Lines(points, offsets, 0.1, height=height, normals=some)


def test_a_page_has_the_height_of_the_tubes() -> None:
    vertices, triangles = meshes.sphere(2, radius=5)
    model = pectinate.load((vertices, triangles, np.cross(vertices[triangles].mean(axis=1), [0, 0, 1])))
    placement = pectinate.place_streamlines(model, separation_distance=2.0)
    for height in (0.3, 1.0):
        part = placement.part(tube_height=height)
        scene, _ = describe_scene([part], [], ["anterior"], "LPS", pectinate.figure.Style())
        lines = scene["parts"][0]["streamlines"]
        assert lines["height"] == height
        assert (lines["normals"] is None) == (height == 1)
        # On a ball normals point away from its middle.
        normals, points = part.streamlines.normals, part.streamlines.points  # type: ignore[union-attr]
        cosines = (normals * points).sum(axis=1) / np.linalg.norm(points, axis=1)  # type: ignore[operator]
        assert cosines.min() > 0.9


def test_view_writes_a_page_of_several_surfaces(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    vertices, triangles = meshes.grid(12, 12)
    along = np.tile([1.0, 0, 0], (len(triangles), 1))
    pectinate.save_surface(pectinate.load((vertices, triangles, along)), tmp_path / "fibres.pts")
    pectinate.save_surface(pectinate.load((vertices, triangles)), tmp_path / "bare.ply")
    page = tmp_path / "page.html"
    words = ["view", tmp_path / "fibres.pts", tmp_path / "bare.ply", "--out", page, "--units", "mm", "--json"]
    pectinate.save_surface(pectinate.load((vertices, triangles, along)), tmp_path / "fibres.pts", units="mm")
    words += ["--separation", "2", "--tube-radius", "0.3", "--tube-height", "0.6"]
    assert main([str(word) for word in words]) == ExitCode.DONE
    report = json.loads(capsys.readouterr().out)
    assert report["files"] == [str(page)]
    assert [surface["name"] for surface in report["surfaces"]] == ["fibres", "bare"]
    assert report["surfaces"][0]["streamlines"] > 3
    assert report["surfaces"][1]["streamlines"] == 0
    html = page.read_text(encoding="utf-8")
    assert len(html.encode()) == report["bytes"]
    assert '"radius":0.3' in html
    assert '"height":0.6' in html


def test_view_shows_values_and_tracts(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    vertices, triangles = meshes.grid(6, 6)
    surface, values, tracts = tmp_path / "a.ply", tmp_path / "activation.npy", tmp_path / "t.json"
    pectinate.save_surface(pectinate.load((vertices, triangles)), surface)
    np.save(values, vertices[:, 0])
    pectinate.TractSet([pectinate.Tract(np.array([[1.0, 1, 0], [5, 5, 0]]), "one")]).save(tracts)
    page = tmp_path / "page.html"
    words = ["view", surface, "--values", values, "--tracts", tracts, "--contours", 1.5, "--out", page, "--quiet"]
    assert main([str(word) for word in words]) == ExitCode.DONE
    html = page.read_text(encoding="utf-8")
    assert '"label":"activation"' in html
    assert '"tracts":{' in html
    assert '"contours":{' in html


def test_view_shows_values_on_tubes(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    vertices, triangles = meshes.grid(6, 6)
    model = pectinate.load((vertices, triangles, np.tile([1.0, 0, 0], (len(triangles), 1))))
    surface, values, page = tmp_path / "a.pts", tmp_path / "row.npy", tmp_path / "page.html"
    pectinate.save_surface(model, surface)
    np.save(values, np.arange(len(triangles)))
    assert main([str(word) for word in ("view", surface, "--tube-values", values, "--out", page, "--quiet")]) == 0
    placement = pectinate.place_streamlines(pectinate.load(surface))
    expected = placement.page(name="a", title="a", tube_values={"row": np.arange(len(triangles))}, notes=[])
    scales = re.findall(r'"tube_scales":\[.*?\]', page.read_text(encoding="utf-8"))
    assert scales == re.findall(r'"tube_scales":\[.*?\]', expected.html)
    assert '"row"' in scales[0]


def test_view_refuses_before_it_works(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    values = tmp_path / "v.npy"
    values.write_text("no array")
    vertices, triangles = meshes.grid()
    tags, heights = tmp_path / "tags.npy", tmp_path / "heights.npy"
    np.save(tags, np.arange(len(triangles)))
    np.save(heights, vertices[:, 1])
    pectinate.save_surface(pectinate.load((vertices, triangles)), tmp_path / "a.ply")
    for words, code, text in (
        (["a.ply", "--out", "page.png"], ExitCode.USAGE, "page.png"),
        (["a.ply", "b.ply", "--values", str(values)], ExitCode.USAGE, "one MESH"),
        (["a.ply", "--values", "v.txt"], ExitCode.USAGE, "v.txt"),
        (["a.ply", "--tube-values", "v.txt"], ExitCode.USAGE, "v.txt"),
        ([str(tmp_path / "a.ply"), "--tube-values", str(heights)], ExitCode.USAGE, "has no fibres"),
        (["a.ply", "--contours", "1"], ExitCode.USAGE, "--contours serves --values alone"),
        ([str(tmp_path / "a.ply"), "--values", str(tags), "--contours", "1"], ExitCode.USAGE, "one value per vertex"),
        ([str(tmp_path / "a.ply"), "--values", str(heights), "--contours", "-1"], ExitCode.USAGE, "-1"),
        (["a.ply", "--views", "front"], ExitCode.USAGE, "front"),
        ([str(tmp_path / "a.ply"), "--values", str(values)], ExitCode.REJECTED, "is no array"),
        ([str(tmp_path / "none.ply")], ExitCode.REJECTED, "none.ply"),
        (["a.ply", "--out", str(tmp_path / "nowhere" / "p.html")], ExitCode.FAILED, "nowhere"),
    ):
        assert main(["view", *words]) == code
        assert text in capsys.readouterr().err


def test_parts_of_a_page_stand_where_they_are_placed_and_have_their_colors() -> None:
    vertices, triangles = meshes.grid()
    turn = ((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    lines = Lines.of([vertices[:3]], 0.1)
    placed = Part(
        "moved", (vertices, triangles), tracts=lines, surface_color=(1, 0, 0), offset=(5, 6, 7), rotation=turn
    )
    by_hand = vertices @ np.array(turn).T + [5, 6, 7]
    other = Part("by hand", (by_hand, triangles), tracts=Lines.of([by_hand[:3]], 0.1))
    x, y, z = vertices[4].tolist()
    shown = description(Page(placed, markers=[Marker((x, y, z), "1")]))
    expected = description(Page(other))
    (part,), (same,) = shown["parts"], expected["parts"]
    assert part["surface"] == same["surface"]
    assert part["tracts"] == same["tracts"]
    assert part["surface_color"] == [1, 0, 0]
    assert same["surface_color"] == list(pectinate.figure.Style().surface_color)
    assert shown["markers"][0]["places"][0]["position"] == pytest.approx(by_hand[4].tolist())
    assert shown["views"] == expected["views"]
