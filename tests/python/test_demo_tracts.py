"""The tracts that the documentation draws on the demo atrium."""

from __future__ import annotations

import json

import numpy as np

from conftest import REPOSITORY
from pectinate import _core, datasets


def test_the_tracts_lie_on_the_demo_atrium_and_agree() -> None:
    document = json.loads((REPOSITORY / "benchmarks" / "demo_tracts.json").read_text(encoding="utf-8"))
    mesh = datasets.demo_atrium().mesh
    loops = [_core.nearest_boundary_loop(mesh, point) for point in document["loops"].values()]
    assert sorted(loops) == list(range(len(mesh.boundary_loops)))
    names = [tract["name"] for tract in document["tracts"]]
    assert len(set(names)) == len(names)
    for loop, point in zip(loops, document["loops"].values(), strict=True):
        assert np.linalg.norm(np.array(mesh.boundary_loops[loop].centroid) - point) < 0.2
    tracts = [_core.Tract(np.array(tract["points"])) for tract in document["tracts"]]
    boundary = [_core.BoundaryCondition(loop, _core.BoundaryRule.parallel) for loop in loops]
    constraints = _core.make_constraints(mesh, tracts, boundary)
    assert len(constraints.conflict_triangles) == 0
    assert max(tract.greatest_distance for tract in constraints.tracts) < 0.1
    assert max(tract.greatest_detour for tract in constraints.tracts) < 1.1
