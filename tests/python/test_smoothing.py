"""Smoothing of measured fields, as models."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import pectinate
from meshes import grid
from pectinate import Model, _core, smooth
from pectinate.errors import InvalidField, InvalidOption


def square(vectors: np.ndarray | None = None) -> Model:
    """A square of 20 mm with fibres along x, tags 7 on the left half and 9 on the right."""
    vertices, triangles = grid(20, 20)
    fibres = np.tile([1.0, 0, 0], (len(triangles), 1)) if vectors is None else vectors
    model = pectinate.load((vertices, triangles, fibres))
    return Model.from_data(replace(model.data, tags=np.where(left(model), 7, 9)))


def left(model: Model) -> np.ndarray:
    return model.data.vertices[model.data.triangles][:, :, 0].mean(axis=1) < 10


def test_it_is_what_the_core_does():
    noisy = pectinate.add_noise(square(), math.radians(20))
    result = smooth(noisy, length=2, outlier_angle=0.2)
    expected = _core.smooth(noisy.mesh, noisy.field, length=2, outlier_angle=0.2)
    assert result.field.directions.tobytes() == expected.field.directions.tobytes()
    assert result.moved_angles.tobytes() == expected.moved_angles.tobytes()
    assert result.outliers.tolist() == expected.outliers.astype(bool).tolist()


def test_outliers_are_brought_back():
    vectors = np.tile([1.0, 0, 0], (800, 1))
    vectors[::37] = [0.2, 1, 0]
    result = smooth(square(vectors), length=1.5)
    angles = np.arccos(np.minimum(1, np.abs(result.field.directions[:, 0])))
    assert np.degrees(angles.max()) < 10
    moved = result.report()["moved"]
    assert moved["count"] == 800
    assert moved["median"] < 1
    assert moved["below_30"] == pytest.approx(1 - len(vectors[::37]) / 800)
    assert set(result.report()["moved_per_region"]) == {"7", "9"}
    assert result.model.data.vectors.tolist() == result.field.directions.tolist()
    assert result.model.data.notes[-1] == "the field is smoothed"


def test_tags_are_barriers():
    model = square()
    vectors = np.where(left(model)[:, None], [1.0, 0, 0], [0.5, math.sqrt(0.75), 0])
    kept = smooth(square(vectors), length=3, barriers="tags").moved_angles
    np.testing.assert_allclose(kept, 0, atol=1e-6)
    assert np.degrees(smooth(square(vectors), length=3).moved_angles.max()) > 5


def test_missing_directions_are_filled_if_asked():
    vectors = np.tile([0, 1.0, 0], (800, 1))
    vectors[100:110] = 0
    assert smooth(square(vectors)).field.count(_core.DirectionStatus.zero) == 10
    filled = smooth(square(vectors), fill_missing=True)
    np.testing.assert_allclose(np.abs(filled.field.directions[:, 1]), 1, atol=1e-9)
    assert filled.report()["moved"]["missing"] == 10


def test_the_report_is_json_in_degrees():
    report = smooth(square(), outlier_angle=math.radians(12)).report()
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert report["options"] == {"outlier_angle": pytest.approx(12), "fill_missing": False, "barriers": "none"}
    assert report["outliers"] == 0


def test_the_move_is_a_cell_array(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    result = smooth(pectinate.add_noise(square(), 0.2))
    result.save(tmp_path / "s.vtp")
    assert pyvista.read(tmp_path / "s.vtp").cell_data["moved_angle"].tolist() == result.moved_angles.tolist()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"length": 0.0}, "length"),
        ({"length": math.nan}, "length"),
        ({"outlier_angle": 2.0}, "outlier_angle"),
        ({"barriers": "walls"}, "none, tags"),
    ],
)
def test_bad_options(options, said):
    with pytest.raises(InvalidOption, match=said):
        smooth(square(), **options)


def test_what_is_needed_must_be_there():
    with pytest.raises(InvalidField, match="no orientation field"):
        smooth(grid())
    with pytest.raises(InvalidOption, match="no region tags"):
        smooth((*grid(), np.tile([1.0, 0, 0], (24, 1))), barriers="tags")
