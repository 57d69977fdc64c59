"""An interpolated orientation field, and what there is to say about it."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pectinate import _core
from pectinate.io import save_surface
from pectinate.loops import distance_to_loop
from pectinate.model import Model
from pectinate.parameterization import DiskMap
from pectinate.tracts import TractSet

_LONG_DETOUR = 1.6  # half way round a tube
_PERCENTILES = {"least": 0, "p05": 5, "median": 50}


@dataclass(frozen=True, eq=False)
class InterpolatedField:
    """An orientation field made of tracts and boundary conditions.

    Attributes
    ----------
    model
        The surface with the field.
    confidence
        (T,) float64 per mesh triangle, in [0, 1]: near 0 around singularities and where tracts disagree; small too, on
        curved surfaces, where only weak weights act: the direction may be good nevertheless.
    tracts
        What the field was interpolated from.
    tract_numbers
        By which messages and reports call tracts without a name: those of the `FieldEditor`.
    constraints
        What that asked of triangles, and the tracts as curves on the surface, a `Constraints`.
    conditions
        Of the boundary, with the indices of their loops.
    method
        "connection" or "reference_frame".
    disk_map
        The `DiskMap` with the reference frame, where one was made.
    notes
        What to check, one sentence each.
    """

    model: Model
    confidence: NDArray[np.float64]
    tracts: TractSet
    tract_numbers: tuple[int, ...]
    constraints: _core.Constraints
    conditions: tuple[_core.BoundaryCondition, ...]
    method: str
    disk_map: DiskMap | None
    notes: tuple[str, ...]

    @property
    def field(self) -> _core.OrientationField:
        """The field, per mesh triangle."""
        return self.model.require_field()

    @cached_property
    def angles(self) -> NDArray[np.float64] | None:
        """Theta in the reference frame, (T,) per mesh triangle, radians in (-pi/2, pi/2]; None without a frame."""
        return None if self.disk_map is None else _core.field_angles(self.disk_map.frame, self.field)

    @cached_property
    def topology(self) -> _core.FieldTopology:
        """Singularities, and how the field turns along the boundary loops."""
        return _core.field_topology(self.model.mesh, self.field)

    @cached_property
    def energy(self) -> float:
        """Dirichlet energy of the field: how much it varies; no unit."""
        return _core.dirichlet_energy(self.model.mesh, self.field)

    def save(self, path: str | os.PathLike[str], **options: Any) -> list[Path]:
        """Write surface and field as `pectinate.save_surface` does; VTK files with `confidence` and, if known, `angle`.

        Parameters
        ----------
        path
            The file.
        options
            Of `save_surface`: `units`, `second`, `per_vertex`.

        Raises
        ------
        InvalidFile, InvalidOption, MissingDependency
            As in `save_surface`.
        """
        arrays = {"confidence": self.confidence}
        if self.angles is not None:
            arrays["angle"] = self.angles
        return save_surface(self.model, path, cell_data=arrays, **options)

    def report(self) -> dict[str, Any]:
        """Everything worth knowing about the field, ready for JSON; lengths in mm, angles in degrees."""
        triangles, weights = self.constraints.triangles, self.constraints.weights
        confidence = {name: float(np.percentile(self.confidence, at)) for name, at in _PERCENTILES.items()}
        return {
            "method": self.method,
            "triangles": int(self.model.mesh.triangle_count),
            "constrained_triangles": len(triangles),
            "exact_triangles": int(np.count_nonzero(np.isinf(weights))),
            "tracts": self._tracts(),
            "boundary": self._boundary(),
            "conflicts": self._conflicts(),
            "named_loops": self._named_loops(),
            "singularities": [
                {"index": found.half_turns / 2, "position": [float(x) for x in found.position]}
                for found in self.topology.singularities
            ],
            "loop_turns": [None if half is None else half / 2 for half in self.topology.loop_half_turns],
            "energy": float(self.energy),
            "confidence": confidence,
            "disk": None if self.disk_map is None else self.disk_map.report(),
            "notes": [*self.notes, *self._detours()],
        }

    def _tracts(self) -> list[dict[str, Any]]:
        return [
            {
                "name": self._label(index),
                "weight": _weight(tract.weight),
                "triangles": len(np.unique(curve.triangles)),
                "length": float(np.linalg.norm(np.diff(curve.points, axis=0), axis=1).sum()),
                "greatest_distance": float(curve.greatest_distance),
                "greatest_detour": float(curve.greatest_detour),
            }
            for index, (tract, curve) in enumerate(zip(self.tracts.tracts, self.constraints.tracts, strict=True))
        ]

    def _boundary(self) -> list[dict[str, Any]]:
        return [
            {"loop": int(condition.loop), "rule": condition.rule.name, "weight": _weight(condition.weight)}
            for condition in self.conditions
        ]

    def _conflicts(self) -> list[dict[str, Any]]:
        """Contradictions, one entry for each pair of tracts."""
        found = self.constraints
        pairs, group = np.unique(found.conflict_tracts.reshape(-1, 2), axis=0, return_inverse=True)
        result = []
        for number, (kept, dropped) in enumerate(pairs):
            rows = np.flatnonzero(group.ravel() == number)
            result.append(
                {
                    "kept": self._label(kept),
                    "dropped": self._label(dropped),
                    "triangles": self.model.mesh.input_triangle[found.conflict_triangles[rows]].tolist(),
                    "greatest_angle": math.degrees(found.conflict_angles[rows].max()),
                }
            )
        return result

    def _named_loops(self) -> dict[str, dict[str, Any]]:
        points = self.model.data.loop_points
        return {
            name: {"loop": loop, "distance": distance_to_loop(self.model, loop, points[name])}
            for name, loop in self.model.loop_names.items()
        }

    def _detours(self) -> list[str]:
        return [
            f"{self._label(index)} takes a way {curve.greatest_detour:.1f} times as long as straight between two "
            "points: check that they lie on the same wall, on one side of holes"
            for index, curve in enumerate(self.constraints.tracts)
            if curve.greatest_detour > _LONG_DETOUR
        ]

    def _label(self, index: int) -> str:
        """Name of a tract; -1 is the boundary."""
        if index < 0:
            return "boundary"
        return self.tracts.tracts[index].name or f"tract {self.tract_numbers[index]}"


def _weight(weight: float) -> float | str:
    return "exact" if math.isinf(weight) else float(weight)
