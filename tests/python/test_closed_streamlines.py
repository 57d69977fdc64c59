"""Closed streamlines and the stop radius about singularities, as Python and files see them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from meshes import Mesh, grid
from pectinate import Model, Placement, load, place_streamlines
from pectinate._core import StopReason, field_topology
from pectinate.errors import InvalidOption


def tube(around: int = 24, rows: int = 10) -> Mesh:
    """An open prism of radius 2 and height 5."""
    angle, height = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(rows + 1) * 5 / rows)
    vertices = np.stack([2 * np.cos(angle), 2 * np.sin(angle), height], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(around), np.arange(rows)))
    a, b = i + around * j, (i + 1) % around + around * j
    c, d = b + around, a + around
    return vertices, np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def round_about(mesh: Mesh) -> Model:
    x, y, _ = mesh[0][mesh[1]].mean(axis=1).T
    return load(mesh, field=np.column_stack([-y, x, np.zeros(len(x))]), field_location="triangle")


@pytest.fixture(scope="module")
def closed() -> Placement:
    return place_streamlines(round_about(tube()), separation_distance=0.7, close_loops=True)


def test_every_line_round_a_tube_closes(closed: Placement) -> None:
    assert len(closed) >= 6
    assert (closed.stop_reasons == StopReason.closed).all()
    assert closed.statistics.stop_counts["closed"] == 2 * len(closed)
    np.testing.assert_allclose(closed.lengths, 24 * 4 * np.sin(np.pi / 24), rtol=1e-9)
    for line in closed:
        np.testing.assert_array_equal(line[0], line[-1])
    plain = place_streamlines(closed.model, separation_distance=0.7)
    assert not (plain.stop_reasons == StopReason.closed).any()
    assert (plain.stop_reasons == StopReason.near_itself).any()


@pytest.mark.parametrize("options", [{}, {"taper_length": 0}, {"side_count": 3}])
def test_tubes_of_closed_lines_are_rings(closed: Placement, options: dict[str, float]) -> None:
    tubes = closed.tubes(radius=0.05, **options)
    for first, last in zip(tubes.triangle_offsets[:-1], tubes.triangle_offsets[1:], strict=True):
        ring = trimesh.Trimesh(tubes.vertices, tubes.triangles[first:last])
        ring.remove_unreferenced_vertices()
        assert ring.is_watertight
        assert ring.euler_number == 0
        sides = options.get("side_count", 8)
        area = sides / 2 * 0.05**2 * np.sin(2 * np.pi / sides)
        assert ring.volume == pytest.approx(area * closed.lengths[0], rel=0.05)


def test_files_hold_closed_lines(closed: Placement, tmp_path: Path) -> None:
    closed.save(tmp_path / "lines.npz")
    with np.load(tmp_path / "lines.npz") as arrays:
        assert set(arrays["stop_reason_names"][arrays["stop_reasons"].ravel()]) == {"closed"}
        first, last = arrays["offsets"][:-1], arrays["offsets"][1:] - 1
        np.testing.assert_array_equal(arrays["points"][first], arrays["points"][last])
    closed.save(tmp_path / "tubes.glb", radius=0.05)
    for name, geometry in trimesh.load(tmp_path / "tubes.glb").geometry.items():
        if "streamlines" in name:
            assert geometry.euler_number == 0
    assert "closed" in closed.page().html


@pytest.mark.parametrize("method", ["random", "neighborhood", "distance", "longest"])
@pytest.mark.parametrize("radius", [0.8, 1.6])
def test_streamlines_stop_about_a_star(method: str, radius: float) -> None:
    mesh = grid(12, 10)
    model = load(mesh, field=mesh[0][mesh[1]].mean(axis=1) - [6.0, 5.0, 0.0], field_location="triangle")
    placement = place_streamlines(model, separation_distance=0.5, method=method, singularity_radius=radius)
    singularities = field_topology(model.mesh, model.require_field()).singularities
    assert len(singularities) > 0
    assert placement.statistics.stop_counts["singularity"] > 0
    for singularity in singularities:
        assert np.linalg.norm(placement.points - singularity.position, axis=1).min() >= radius
    assert placement.statistics.coverage > 1 - 1e-6
    assert placement.options["singularity_radius"] == radius


def test_options_that_do_not_go_together_are_refused() -> None:
    model = round_about(tube())
    with pytest.raises(InvalidOption, match="close_loops"):
        place_streamlines(model, method="distance", close_loops=True)
    with pytest.raises(InvalidOption, match="singularity_radius needs exact"):
        place_streamlines(model, method="distance", occupancy="edge_mask", singularity_radius=1.0)
    for bad in (-1.0, np.nan, np.inf):
        with pytest.raises(InvalidOption, match="singularity_radius"):
            place_streamlines(model, singularity_radius=bad)
