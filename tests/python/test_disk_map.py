"""The map onto the disk and its reference frame, as models."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import pectinate
from drawings import flat
from marks import needs_map
from meshes import annulus, grid
from pectinate import _core, parameterize
from pectinate.errors import Error, InvalidOption


@needs_map
def test_the_disk_of_an_annulus():
    model = pectinate.load(annulus()).with_loop_points({"hub": np.array([4.0, 0, 0])})
    disk = parameterize(model, inner_loop="hub")
    radii = np.linalg.norm(model.mesh.vertices, axis=1)
    on_rim, on_hub = np.isclose(radii, 10), np.isclose(radii, 4)
    np.testing.assert_allclose(np.linalg.norm(disk.points[on_rim], axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(disk.u[on_rim], 1, atol=1e-12)
    np.testing.assert_allclose(disk.u[on_hub], 0, atol=1e-12)
    assert np.corrcoef(disk.u, np.log(radii))[0, 1] > 0.999
    report = disk.report()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert report["flipped_triangles"] == report["critical_points"] == report["notes"] == []
    assert report["loop_ambiguity"] == pytest.approx(0.4)
    assert report["inner_loop"] == model.loop_names["hub"]
    assert report["anisotropy"]["least"] >= 1


@needs_map
def test_an_ambiguous_choice_of_the_outer_loop_is_noted():
    mesh = annulus(inner=9, outer=10)
    (note,) = parameterize(mesh).notes
    assert "only 1.11 times as long" in note
    assert parameterize(mesh, outer_loop=0).notes == ()
    assert parameterize(annulus()).notes == ()


@needs_map
def test_the_inner_point_is_where_u_is_zero():
    model = flat()
    disk = parameterize(model, inner_point=[5.1, 4.0, 0.3])
    assert model.mesh.vertices[np.argmin(disk.u)].tolist() == [5, 4, 0]
    with pytest.raises(Error):
        parameterize(model, inner_point=[math.nan, 0, 0])


@pytest.mark.skipif(_core.has_parameterization(), reason="pectinate was built with CGAL")
def test_a_build_without_the_map_says_so():
    for call in (
        lambda: parameterize(flat()),
        lambda: pectinate.interpolate(flat(), pectinate.TractSet(), method="reference_frame"),
        lambda: pectinate.interpolate(flat(), pectinate.TractSet(), outer_loop=0),
    ):
        with pytest.raises(Error, match="built without CGAL"):
            call()


def test_an_inner_point_that_is_none():
    for point in ("abc", [1, 2], [[5, 5, 0]], [0, math.nan, 0]):
        with pytest.raises(InvalidOption, match="inner_point"):
            parameterize(grid(4), inner_point=point)
