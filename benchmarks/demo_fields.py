"""The demo atrium's tracts, the fields that they make, and what a picture of them needs."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import pectinate
from pectinate import _core
from pectinate.figure import Layer, line_tubes
from pectinate.placement import DRAWN_TUBE_HEIGHT

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
        loops = {name: _core.nearest_boundary_loop(self.mesh, points[name]) for name in points}
        return {loop: LOOP_ABBREVIATIONS[name] for name, loop in loops.items()}

    def constraints(self, groups: Sequence[str]) -> _core.Constraints:
        """What the borders ask for, and the tracts whose names start with one of the groups."""
        tracts = [
            _core.Tract(np.array(tract["points"]), name=tract["name"])
            for tract in self._document["tracts"]
            if tract["name"].startswith(tuple(groups))
        ]
        boundary = [_core.BoundaryCondition(loop, _core.BoundaryRule.parallel) for loop in self.loop_names()]
        return _core.make_constraints(self.mesh, tracts, boundary)

    def interpolate(self, constraints: _core.Constraints) -> _core.Interpolation:
        """The field that meets the constraints."""
        return self._interpolator.interpolate(constraints)

    def drawn_lines(self, constraints: _core.Constraints) -> Layer:
        """Projected tracts, and the borders that fibres run along, as black tubes."""
        borders = [loop.vertices[np.r_[0 : len(loop.vertices), 0]] for loop in self.mesh.boundary_loops]
        lines = [tract.points for tract in constraints.tracts] + [self.mesh.vertices[border] for border in borders]
        return Layer(line_tubes(lines, 0.6), BLACK)

    def place(self, field: _core.OrientationField, separation_distance: float) -> pectinate.Placement:
        """Streamlines of a field on the demo atrium."""
        model = dataclasses.replace(self.model, field=field)
        return pectinate.place_streamlines(model, separation_distance=separation_distance)


def streamline_layer(placement: pectinate.Placement, radius: float, color: tuple[float, float, float]) -> Layer:
    """Streamlines as tubes of a radius in mm and a colour."""
    tubes = placement.tubes(radius=radius, height=DRAWN_TUBE_HEIGHT)
    return Layer((tubes.vertices, tubes.triangles), color)
