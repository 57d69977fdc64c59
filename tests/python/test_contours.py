"""Contours: where they run, how many there are, and how they are drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import meshes
from pectinate.errors import InvalidOption
from pectinate.figure import Contour, Style, SurfaceValues, View, contour_lines, render_view

matplotlib = pytest.importorskip("matplotlib")

SPECIAL = st.sampled_from([0.0, 1.0, 2.0, np.nan, np.inf])


def edges_of(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)


def value_on_edge(mesh: meshes.Mesh, values: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values, interpolated along edges, of all edges that a point lies on."""
    vertices, triangles = mesh
    first, second = edges_of(triangles).T
    sides = vertices[second] - vertices[first]
    share = ((point - vertices[first]) * sides).sum(axis=1) / (sides**2).sum(axis=1)
    away = np.linalg.norm(vertices[first] + share[:, None] * sides - point, axis=1)
    on = (away < 1e-9) & (share > -1e-9) & (share < 1 + 1e-9)
    return (values[first] + share * (values[second] - values[first]))[on]


def length(contour: Contour) -> float:
    return float(np.linalg.norm(np.diff(contour.points, axis=0), axis=1).sum())


@settings(deadline=None)
@given(seed=st.integers(0, 2**32 - 1), which=st.sampled_from([meshes.grid, meshes.torus, meshes.moebius_strip]))
def test_every_point_lies_on_an_edge_and_has_the_level(seed: int, which: object) -> None:
    mesh = which(6, 5) if which is not meshes.moebius_strip else which()  # type: ignore[operator]
    values = np.random.default_rng(seed).normal(size=len(mesh[0]))
    found = contour_lines(mesh, values, [-0.4, 0.0, 0.7])
    assert {contour.level for contour in found} <= {-0.4, 0.0, 0.7}
    for contour in found[:4]:
        for point in contour.points[:4]:
            at = value_on_edge(mesh, values, point)
            assert len(at) and np.abs(at - contour.level).min() < 1e-9


@given(angle=st.floats(0, 6.28), step=st.floats(0.3, 2.0))
def test_contours_of_a_linear_function_are_straight_and_evenly_spaced(angle: float, step: float) -> None:
    vertices, triangles = meshes.grid(9, 7)
    direction = np.array([np.cos(angle), np.sin(angle), 0.0])
    values = vertices @ direction
    found = contour_lines((vertices, triangles), values, step)
    levels = [contour.level for contour in found]
    multiples = step * np.arange(-200, 200)
    assert np.allclose(np.unique(levels), multiples[(multiples > values.min()) & (multiples < values.max())])
    for contour in found:
        assert np.abs(contour.points @ direction - contour.level).max() < 1e-9
        assert not contour.closed
        for end in contour.points[[0, -1]]:
            assert np.abs(end[:2] - [[0, 0], [9, 7]]).min() < 1e-9
    assert len(found) == len(set(levels))  # one line each, right through the rectangle


@pytest.mark.parametrize(("height", "count"), [(-0.5, 2), (0.0, 2), (0.3, 2), (0.69, 2), (0.71, 0)])
def test_levels_of_a_torus_are_pairs_of_closed_curves(height: float, count: int) -> None:
    mesh = meshes.torus(60, 40)
    found = contour_lines(mesh, mesh[0][:, 2], [height])
    assert len(found) == count
    for contour in found:
        assert contour.closed
        assert np.ptp(contour.points[:, 2]) < 1e-12
    if count:
        radii = sorted(float(np.linalg.norm(contour.points[:, :2], axis=1).mean()) for contour in found)
        across = np.sqrt(0.7**2 - height**2)
        assert radii == pytest.approx([2 - across, 2 + across], abs=0.02)


def test_levels_of_a_sphere_are_circles() -> None:
    vertices, triangles = meshes.sphere(4, radius=10.0)
    found = contour_lines((vertices, triangles), vertices[:, 1], 3.0)
    assert [contour.level for contour in found] == pytest.approx([-9, -6, -3, 0, 3, 6, 9])
    for contour in found:
        assert contour.closed
        assert length(contour) == pytest.approx(2 * np.pi * np.sqrt(100 - contour.level**2), rel=0.01)
        assert np.abs((contour.normals * contour.points).sum(axis=1) / 10 - 1).max() < 0.02


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 2**32 - 1))
def test_contours_are_those_of_matplotlib(seed: int) -> None:
    vertices, triangles = meshes.grid(8, 6)
    values = np.random.default_rng(seed).normal(size=len(vertices))
    figure = pytest.importorskip("matplotlib.figure").Figure()
    levels = [-0.5, 0.25, 1.0]
    peer = figure.subplots().tricontour(vertices[:, 0], vertices[:, 1], triangles, values, levels=levels)
    ours = contour_lines((vertices, triangles), values, levels)
    for level, lines in zip(peer.levels, peer.allsegs, strict=True):
        theirs = sum(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in lines)
        assert sum(length(contour) for contour in ours if contour.level == level) == pytest.approx(theirs)
        closed = sum(bool(np.allclose(line[0], line[-1])) for line in lines)
        assert sum(contour.closed for contour in ours if contour.level == level) == closed


@given(seed=st.integers(0, 2**32 - 1), special=st.lists(SPECIAL, min_size=20, max_size=20))
def test_no_values_break_it(seed: int, special: list[float]) -> None:
    mesh = meshes.grid()
    values = np.array(special)
    for contour in contour_lines(mesh, values, 0.5):
        assert np.isfinite(contour.points).all() and length(contour) > 0
    known = np.isfinite(values)[mesh[1]].all(axis=1)
    part = contour_lines((mesh[0], mesh[1][known]), np.nan_to_num(values, posinf=0), [0.5, 1.0])
    whole = contour_lines(mesh, values, [0.5, 1.0])
    assert [c.points.tolist() for c in part] == [c.points.tolist() for c in whole]


def test_lines_end_at_missing_values_and_none_is_where_nothing_changes() -> None:
    vertices, triangles = meshes.grid(6, 4)
    values = vertices[:, 0].copy()
    values[np.flatnonzero((vertices[:, 1] == 2) & (vertices[:, 0] == 3))] = np.nan
    found = contour_lines((vertices, triangles), values, [2.5])
    assert len(found) == 2
    assert all(np.abs(contour.points[:, 0] - 2.5).max() == 0 for contour in found)
    for constant in (0.0, 5.0, np.nan):
        for contours in (1.0, [0.0, 5.0], []):
            assert contour_lines((vertices, triangles), np.full(len(vertices), constant), contours) == []
    assert contour_lines((vertices, triangles[:0]), values, 1.0) == []


def test_a_line_runs_round_a_plateau() -> None:
    vertices, triangles = meshes.grid(6, 6)
    inside = ((vertices[:, :2] >= 2) & (vertices[:, :2] <= 4)).all(axis=1)
    (contour,) = contour_lines((vertices, triangles), np.where(inside, 1.0, 0.0), [1.0])
    assert contour.closed
    assert length(contour) == pytest.approx(8)


def test_where_three_triangles_meet_lines_end() -> None:
    mesh = meshes.three_triangles_on_an_edge()
    found = contour_lines(mesh, mesh[0][:, 2], [0.25])
    assert len(found) == 3
    middle = [0, 0, 0.25]
    assert all(any(np.allclose(end, middle) for end in contour.points[[0, -1]]) for contour in found)


def test_one_triangle_and_unused_vertices() -> None:
    vertices, triangles = meshes.single_triangle()
    padded = np.concatenate([[[np.nan] * 3], vertices])
    (contour,) = contour_lines((padded, triangles + 1), [7.0, 0, 1, 0], [0.25])
    assert sorted(contour.points.tolist()) == [[0.25, 0, 0], [0.25, 0.75, 0]]


def test_huge_values_do_not_overflow() -> None:
    mesh = meshes.grid()
    values = np.where(mesh[0][:, 0] < 1.5, -1.7e308, 1.7e308)
    (contour,) = contour_lines(mesh, values, [0.0])
    assert np.abs(contour.points[:, 0] - 1.5).max() < 1e-12


@pytest.mark.parametrize("contours", [0.0, -1.0, np.nan, [np.inf], [[1.0]], "ten", 1e-9, np.arange(501)])
def test_levels_that_are_none_are_refused(contours: object) -> None:
    mesh = meshes.grid()
    with pytest.raises(InvalidOption, match="contours"):
        contour_lines(mesh, mesh[0][:, 0], contours)  # type: ignore[arg-type]


def test_values_per_triangle_have_no_contours() -> None:
    mesh = meshes.grid()
    for values in (np.zeros(24), np.zeros(7), ["a"] * 20):
        with pytest.raises(InvalidOption, match="per vertex"):
            contour_lines(mesh, values, 1.0)
    with pytest.raises(InvalidOption, match="per vertex"):
        render_view(mesh, surface_values=SurfaceValues(np.arange(24.0), contours=1.0))


FROM_ABOVE = View("above", (0, 0, -1), (0, 1, 0))


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("color", [(1.0, 1.0, 1.0), (0.8, 0.1, 0.2)])
def test_a_contour_is_drawn_where_it_is(color: tuple[float, float, float]) -> None:
    vertices, triangles = meshes.grid(8, 4)
    style, scale = Style(contour_color=color, fold_darkness=0), 0.0045
    options = {"view": FROM_ABOVE, "size": (2000, 40), "mm_per_pixel": scale, "supersampling": 2, "style": style}
    colored = SurfaceValues(vertices[:, 0], value_range=(0, 8))
    lined = replace(colored, contours=[2.5, 6.0])
    plain, picture = (render_view((vertices, triangles), surface_values=v, **options) for v in (colored, lined))
    columns = np.flatnonzero((picture[20] != plain[20]).any(axis=1))
    expected = 1000 + (np.array([2.5, 6.0]) - 4) / scale
    for place in expected:
        near = columns[np.abs(columns - place) < 20]
        assert near.mean() + 0.5 == pytest.approx(place, abs=0.6)
        assert np.abs(picture[20, int(place)] - np.rint(255 * np.array(color))).max() <= 4
    radius = np.hypot(8, 4) / 700 / scale
    assert (np.abs(columns[:, None] + 0.5 - expected).min(axis=1) < radius + 1).all()
    assert len(columns) == pytest.approx(4 * radius, abs=4)
    # They lie outside: from inside nothing of them is seen.
    options["view"] = View("below", (0, 0, 1), (0, 1, 0))
    inside = [render_view((vertices, triangles), surface_values=v, **options) for v in (colored, lined)]
    assert np.array_equal(*inside)
