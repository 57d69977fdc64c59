"""The surfaces of the built-in atria, as models."""

from __future__ import annotations

import time

import numpy as np
import pytest

from pectinate import Model, datasets
from pectinate.errors import InvalidOption

LEFT_VEINS = ["left superior pulmonary vein", "left inferior pulmonary vein"]
RIGHT_VEINS = ["right superior pulmonary vein", "right inferior pulmonary vein"]
LOOPS = {
    "left_atrium": {"mitral valve", "fossa ovalis", *LEFT_VEINS, *RIGHT_VEINS},
    "right_atrium": {
        "tricuspid valve",
        "fossa ovalis",
        "superior vena cava",
        "inferior vena cava",
        "coronary sinus",
    },
    "bachmann_bundle": {"bachmann bundle margin"},
}
SURFACES = [
    ("left_atrium", "epicardium"),
    ("left_atrium", "endocardium"),
    ("right_atrium", "epicardium"),
    ("right_atrium", "endocardium"),
    ("bachmann_bundle", "epicardium"),
]


def least_angles(model: Model) -> np.ndarray:
    """Of each triangle, degrees."""
    corners = model.mesh.vertices[model.mesh.triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    sides /= np.linalg.norm(sides, axis=2, keepdims=True)
    cosines = -np.einsum("tkx,tkx->tk", sides, np.roll(sides, 1, axis=1))
    return np.degrees(np.arccos(cosines)).min(axis=1)


def mean_edge(model: Model) -> float:
    return float(model.mesh.edge_lengths.mean())


@pytest.mark.parametrize(("chamber", "layer"), SURFACES)
def test_a_surface_has_its_loops_and_regions_but_no_field(chamber: str, layer: str) -> None:
    model = datasets.atrial_surface(chamber, layer=layer, edge_length=2)
    assert set(model.loop_names) == LOOPS[chamber]
    assert sorted(model.loop_names.values()) == list(range(len(model.mesh.boundary_loops)))
    assert model.field is None
    assert model.tags is not None
    assert set(model.tags) == set(range(len(model.data.notes)))
    assert model.data.units.unit == "mm"
    assert mean_edge(model) == pytest.approx(2, rel=0.03)
    np.testing.assert_array_equal(model.mesh.triangles, model.data.triangles)  # outwards already


def test_names_find_the_loops_they_name() -> None:
    model = datasets.atrial_surface("left_atrium", edge_length=2)
    centres = {
        name: model.mesh.vertices[model.mesh.boundary_loops[loop].vertices].mean(axis=0)
        for name, loop in model.loop_names.items()
    }
    assert all(centres[name][0] > 35 for name in LEFT_VEINS)
    assert all(centres[name][0] < -15 for name in RIGHT_VEINS)
    assert centres["mitral valve"][2] == min(centre[2] for centre in centres.values())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"chamber": "ventricle"}, "chamber is 'ventricle', but must be one of left_atrium, right_atrium, bachmann"),
        ({"chamber": ["left_atrium"]}, "chamber is .*, but must be one of left_atrium"),
        ({"layer": "mesocardium"}, "layer is 'mesocardium', but must be one of epicardium, endocardium"),
        ({"chamber": "bachmann_bundle", "layer": "endocardium"}, "no endocardium; ask for its epicardium"),
        ({"edge_length": 0.05}, r"must be in \[0.1, 2\]"),
        ({"edge_length": float("nan")}, "edge_length is nan"),
    ],
)
def test_what_cannot_be_made_is_refused(options: dict, message: str) -> None:
    with pytest.raises(InvalidOption, match=message):
        datasets.atrial_surface(**{"chamber": "left_atrium"} | options)


@pytest.mark.slow
@pytest.mark.parametrize("edge_length", [1, 0.5, 0.2])
@pytest.mark.parametrize(("chamber", "layer"), SURFACES)
def test_fine_surfaces_are_as_good_and_take_seconds(chamber: str, layer: str, edge_length: float) -> None:
    start = time.process_time()
    model = datasets.atrial_surface(chamber, layer=layer, edge_length=edge_length)
    assert time.process_time() - start < 60
    (component,) = model.mesh.components
    assert component.euler_characteristic == 2 - len(LOOPS[chamber])
    assert component.genus == 0
    assert len(model.mesh.boundary_loops) == len(LOOPS[chamber])
    angles = least_angles(model)
    assert angles.min() > 15
    assert np.percentile(angles, 1) > 35
    assert mean_edge(model) == pytest.approx(edge_length, rel=0.03)
