"""The map of a surface onto the unit disk, and the reference frame that is made of it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from pectinate import _core
from pectinate.errors import InvalidOption
from pectinate.figure.disk import draw_disk
from pectinate.io import load
from pectinate.loops import LoopChoice, find_loop, three_numbers
from pectinate.model import Model

_AMBIGUOUS = 0.8
_PERCENTILES = {"least": 0, "p05": 5, "median": 50, "p95": 95, "greatest": 100}


@dataclass(frozen=True, eq=False)
class DiskMap:
    """A surface on the unit disk, with the reference frame of its fibres' angles.

    Attributes
    ----------
    model
        The surface.
    parameterization
        Its points in the disk and how they are distorted, a `Parameterization`.
    frame
        u and the basis (e_l, e_t) per triangle, a `ReferenceFrame`.
    inner_loop
        Index of the loop where u is 0; None where it is a point or none.
    notes
        What was decided, one sentence each.
    """

    model: Model
    parameterization: _core.Parameterization
    frame: _core.ReferenceFrame
    inner_loop: int | None
    notes: tuple[str, ...] = ()

    @property
    def points(self) -> NDArray[np.float64]:
        """Vertices of the mesh in the disk, (V, 2); NaN on fragments."""
        return self.parameterization.points

    @property
    def u(self) -> NDArray[np.float64]:
        """u_D at the vertices of the mesh, (V,), from 0 inside to 1 at the outer loop; NaN on fragments."""
        return self.frame.u

    def figure(self, path: str | os.PathLike[str] | None = None, **options: Any) -> Image.Image:
        """Draw the disk coloured by u_D, with its holes and their names (paper, Fig. 3A).

        Parameters
        ----------
        path
            Where to write the picture; by default nowhere.
        options
            Of `pectinate.figure.draw_disk`.

        Raises
        ------
        InvalidOption, InvalidFile, MissingDependency
            As in `draw_disk`.
        """
        names = {loop: name for name, loop in self.model.loop_names.items()}
        return draw_disk(self.parameterization, self.frame, self.model.mesh, path, **{"loop_names": names, **options})

    def report(self) -> dict[str, Any]:
        """Everything worth knowing about the map, ready for JSON; indices are those of the source."""
        mesh, disk, frame = self.model.mesh, self.parameterization, self.frame
        critical = [
            {"vertex": int(mesh.input_vertex[vertex]), "index": int(index)} for vertex, index in frame.critical_points
        ]
        return {
            "outer_loop": int(disk.outer_loop),
            "inner_loop": self.inner_loop,
            "loop_ambiguity": float(disk.loop_ambiguity),
            "flipped_triangles": mesh.input_triangle[disk.flipped_triangles].tolist(),
            "area_ratio": _distribution(disk.area_ratio),
            "anisotropy": _distribution(disk.anisotropy),
            "borrowed_triangles": len(frame.borrowed_triangles),
            "critical_points": critical,
            "notes": list(self.notes),
        }


def parameterize(
    surface: Any,
    *,
    outer_loop: LoopChoice | None = None,
    inner_loop: LoopChoice | None = None,
    inner_point: ArrayLike | None = None,
) -> DiskMap:
    """Map a surface onto the unit disk and make its reference frame (paper section 2.2).

    Parameters
    ----------
    surface
        A `Model`, or anything that `pectinate.load` takes: one orientable component without handles, with a boundary.
    outer_loop
        What becomes the circle, where u is 1: index, name or nearest point of a boundary loop; the longest by default.
    inner_loop
        Where u is 0, such as the fossa ovalis.
    inner_point
        (3,), mm: where there is no such loop, u is 0 at the vertex nearest to this point. Without either,
        u = (1 + x) / 2 of the disk.

    Raises
    ------
    InvalidMesh
        Another kind of surface.
    InvalidOption
        A loop that does not exist or does not serve, or both `inner_loop` and `inner_point`.
    SolverFailure
        A linear system has no solution.
    Error
        pectinate was built without CGAL.
    """
    model = load(surface)
    if inner_loop is not None and inner_point is not None:
        raise InvalidOption("inner_loop and inner_point are both given; u can be 0 at one of them only")
    outer = None if outer_loop is None else find_loop(model, outer_loop)
    inner = None if inner_loop is None else find_loop(model, inner_loop)
    point = None if inner_point is None else three_numbers(inner_point, "inner_point")
    disk = _core.parameterize(model.mesh, outer_loop=outer)
    frame = _core.make_reference_frame(model.mesh, disk, inner_loop=inner, inner_point=point)
    return DiskMap(model, disk, frame, inner, _notes(disk, frame, chosen=outer is not None))


def _notes(disk: _core.Parameterization, frame: _core.ReferenceFrame, *, chosen: bool) -> tuple[str, ...]:
    notes = []
    if not chosen and disk.loop_ambiguity > _AMBIGUOUS:
        longer = f"only {1 / disk.loop_ambiguity:.2f} times as long as the next"
        notes.append(
            f"the longest loop, {disk.outer_loop}, was taken for the outer one, but is {longer}: check the choice"
        )
    if len(disk.flipped_triangles):
        notes.append(f"{len(disk.flipped_triangles)} triangles are flipped in the disk")
    if len(frame.critical_points):
        notes.append(f"the reference field is singular at {len(frame.critical_points)} vertices: choose other loops")
    return tuple(notes)


def _distribution(values: NDArray[np.float64]) -> dict[str, float | None]:
    """Percentiles; None where they are not finite."""
    known = values[~np.isnan(values)]
    found = {name: float(np.percentile(known, share)) for name, share in _PERCENTILES.items()}
    return {name: value if np.isfinite(value) else None for name, value in found.items()}
