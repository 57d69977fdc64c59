"""Measured surfaces of both atria: everything is kept, everything is reported."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pectinate.io import load, save_surface
from pectinate.io.opencarp import read_opencarp

# vertices, triangles, wrongly wound triangles, edges of more than two triangles, boundary loops
SURFACES = {
    "la_endo": (60100, 119477, 1, 0, 5),
    "la_epi": (70819, 140704, 1, 0, 5),
    "ra_endo": (61643, 122620, 2, 1, 5),
    "ra_epi": (63410, 126190, 0, 0, 4),
}
TAGS = {"la": {11, 13, 21, 23, 25, 27}, "ra": {1, 2, 5, 6, 7}}


@pytest.mark.parametrize("name", SURFACES)
def test_measured_surfaces_load_whole_and_in_millimetres(human_atrium: Path, name: str) -> None:
    vertex_count, triangle_count, reversed_count, cut_count, loop_count = SURFACES[name]
    tags = TAGS[name[:2]]
    model = load(human_atrium / name)
    assert model.data.vertices.shape == (vertex_count, 3)
    assert model.mesh.triangle_count == triangle_count
    assert model.mesh.input_triangle.tolist() == list(range(triangle_count))
    assert (model.data.units.unit, model.data.units.decided_by) == ("um", "auto")
    assert 50 < model.mesh.bounding_box_diagonal < 120
    assert model.tags is not None
    assert set(model.tags.tolist()) == tags
    summary = model.summary()
    assert sum(summary["area_per_tag"].values()) == pytest.approx(model.mesh.area)
    assert summary["field"]["status"]["valid"] == triangle_count
    assert summary["repairs"]["reversed_triangles"]["count"] == reversed_count
    assert summary["repairs"]["non_manifold_edges"]["count"] == cut_count
    assert len(summary["boundary_loops"]) == loop_count
    assert all(set(loop["tags"]) <= tags and loop["tags"] for loop in summary["boundary_loops"])


def test_a_measured_surface_goes_out_and_comes_back(human_atrium: Path, tmp_path: Path) -> None:
    model = load(human_atrium / "la_endo")
    save_surface(model, tmp_path / "copy.pts")
    copy = load(tmp_path / "copy.pts")
    for name in ("vertices", "triangles", "vectors", "tags"):
        np.testing.assert_array_equal(getattr(copy.data, name), getattr(model.data, name))
    micrometres = [read_opencarp(stem, units="mm").vertices for stem in (human_atrium / "la_endo", tmp_path / "copy")]
    np.testing.assert_array_equal(*micrometres)
