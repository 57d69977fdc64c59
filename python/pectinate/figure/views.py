"""Directions to look from: the six anatomical views, and views along the principal axes of a shape."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.patient_axes import PATIENT_DIRECTIONS, PatientAxes, patient_to_vertices

# Looking direction and the direction that points up in the picture. Superior and inferior are the anterior view tipped
# forwards and backwards, so that the patient's left stays on the viewer's right in all three.
_LOOKING_AND_UP: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "anterior": ("P", "S"),
        "posterior": ("A", "S"),
        "left": ("R", "S"),
        "right": ("L", "S"),
        "superior": ("I", "P"),
        "inferior": ("S", "A"),
    }
)

STANDARD_VIEWS = tuple(_LOOKING_AND_UP)
"""Names of the six anatomical views, in the order a sheet shows them."""

_SAME_DIRECTION = 1e-12


@dataclass(frozen=True)
class View:
    """A direction to look along, without distance: pictures are orthographic.

    Parameters
    ----------
    name : str
        Label in a sheet.
    direction : tuple of 3 float
        From the viewer to the object, in the coordinates of the vertices; any length but zero.
    up : tuple of 3 float
        What points up in the picture; need not be perpendicular to `direction`, only not parallel to it.

    Raises
    ------
    InvalidOption
        If a direction is zero or not finite, or both are parallel.
    """

    name: str
    direction: tuple[float, float, float]
    up: tuple[float, float, float]

    def __post_init__(self) -> None:
        self.rotation()

    def rotation(self) -> NDArray[np.float64]:
        """Rotation from the coordinates of the vertices to those of the picture.

        Returns
        -------
        (3, 3) float64
            Rows: right, up, and towards the viewer, as unit vectors.
        """
        forward, up = np.array(self.direction, dtype=np.float64), np.array(self.up, dtype=np.float64)
        if forward.shape != (3,) or up.shape != (3,) or not np.isfinite([forward, up]).all():
            raise InvalidOption(f"view '{self.name}': direction and up must each be three finite numbers")
        right = np.cross(forward, up)
        if np.linalg.norm(right) <= _SAME_DIRECTION * np.linalg.norm(forward) * np.linalg.norm(up):
            raise InvalidOption(
                f"view '{self.name}': direction {self.direction} and up {self.up} must not be zero or parallel"
            )
        rows = np.stack([right, np.cross(right, forward), -forward])
        return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


def standard_view(name: str, axes: str | PatientAxes = "LPS") -> View:
    """One of the six anatomical views.

    Parameters
    ----------
    name : str
        One of `STANDARD_VIEWS`. The anterior view has the patient's left on the viewer's right.
    axes : str or PatientAxes
        Where +x, +y and +z point in the patient, one letter each of L/R, A/P, S/I; "LPS" is the convention of DICOM.
        Or the directions of the patient, for a surface in any pose.

    Raises
    ------
    InvalidOption
        If the name is unknown, or the axes are not a right-handed choice of three patient directions.
    """
    if name not in _LOOKING_AND_UP:
        raise InvalidOption(f"unknown view '{name}': choose one of {', '.join(STANDARD_VIEWS)}, principal, or a View")
    to_vertices = patient_to_vertices(axes)
    direction, up = (to_vertices @ PATIENT_DIRECTIONS[letter] for letter in _LOOKING_AND_UP[name])
    return _view(name, direction, up)


def principal_views(vertices: ArrayLike) -> tuple[View, ...]:
    """Six views along the principal axes of points, for shapes of unknown orientation.

    Parameters
    ----------
    vertices : (V, 3) float
        Positions in mm.

    Returns
    -------
    tuple of View
        First the two views that show the two longest axes, with the longest one upright; then those from its sides;
        then those along it. Axis signs are fixed by the shape (towards its longer tail), so that they do not depend on
        the pose of the points.
    """
    first, second, third = _principal_axes(np.asarray(vertices, dtype=np.float64))
    looking_and_up = {
        "principal, front": (-third, first),
        "principal, back": (third, first),
        "principal, side": (-second, first),
        "principal, other side": (second, first),
        "principal, top": (-first, third),
        "principal, bottom": (first, third),
    }
    return tuple(_view(name, direction, up) for name, (direction, up) in looking_and_up.items())


def resolve_view(view: str | View, vertices: ArrayLike, axes: str | PatientAxes = "LPS") -> View:
    """The `View` that a name stands for: itself, a standard view, or "principal" (the first principal view)."""
    if isinstance(view, View):
        return view
    return principal_views(vertices)[0] if view == "principal" else standard_view(view, axes)


def _principal_axes(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Right-handed principal axes as rows, longest first."""
    centred = points - points.mean(axis=0)
    _, directions = np.linalg.eigh(centred.T @ centred)
    axes = directions.T[::-1].copy()
    tails = ((centred @ axes.T) ** 3).sum(axis=0)
    axes[tails < 0] *= -1
    axes[2] = np.cross(axes[0], axes[1])
    return axes


def _view(name: str, direction: NDArray[np.float64], up: NDArray[np.float64]) -> View:
    (dx, dy, dz), (ux, uy, uz) = direction.tolist(), up.tolist()
    return View(name, (dx, dy, dz), (ux, uy, uz))
