"""The demo atrium's tracts, the fields that they make, and what a picture of them needs."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import pectinate
from pectinate import _core
from pectinate.figure import Layer, line_tubes

TRACTS_FILE = Path(__file__).with_name("demo_tracts.json")
BLACK = (0.08, 0.07, 0.07)
LOOP_ABBREVIATIONS = {
    "mitral valve": "MV",
    "right superior pulmonary vein": "RSPV",
    "left superior pulmonary vein": "LSPV",
    "right inferior pulmonary vein": "RIPV",
    "left inferior pulmonary vein": "LIPV",
}


class DemoFields:
    """Interpolates on the demo atrium with some of its tracts; fibres run along all of its borders."""

    def __init__(self) -> None:
        self.model = pectinate.datasets.demo_atrium()
        self.mesh = self.model.mesh
        self._document = json.loads(TRACTS_FILE.read_text(encoding="utf-8"))
        self._interpolator = _core.FieldInterpolator(self.mesh)

    def loop_names(self) -> dict[int, str]:
        """Short names of the boundary loops by index."""
        points = self._document["loops"]
        return {
            _core.nearest_boundary_loop(self.mesh, points[name]): short for name, short in LOOP_ABBREVIATIONS.items()
        }

    def constraints(self, groups: Sequence[str]) -> _core.Constraints:
        """What the borders ask for, and the tracts whose names start with one of the groups."""
        tracts = [
            _core.Tract(np.array(tract["points"]), name=tract["name"])
            for tract in self._document["tracts"]
            if tract["name"].startswith(tuple(groups))
        ]
        boundary = [_core.BoundaryCondition(loop, _core.BoundaryRule.parallel) for loop in self.loop_names()]
        return _core.make_constraints(self.mesh, tracts, boundary)

    def interpolate(self, constraints: _core.Constraints) -> _core.OrientationField:
        """The field that meets the constraints."""
        return self._interpolator.interpolate(constraints).field

    def place(self, field: _core.OrientationField, separation_distance: float) -> pectinate.Placement:
        """Streamlines of a field on the demo atrium."""
        model = dataclasses.replace(self.model, field=field)
        return pectinate.place_streamlines(model, separation_distance=separation_distance)


def tract_layer(constraints: _core.Constraints) -> Layer:
    """Projected tracts as black tubes."""
    return Layer(line_tubes([tract.points for tract in constraints.tracts], 0.6), BLACK)


def streamline_layer(placement: pectinate.Placement, color: tuple[float, float, float]) -> Layer:
    """Streamlines as tubes of a colour."""
    tubes: Any = placement.tubes()
    return Layer((tubes.vertices, tubes.triangles), color)
