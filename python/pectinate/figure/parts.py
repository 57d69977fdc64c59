"""What pictures and pages show: surfaces with lines and values on them, and markers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidMesh, InvalidOption
from pectinate.figure.polylines import Lines
from pectinate.figure.shading import Color, check_color
from pectinate.figure.triangles import Triangles, check_shape
from pectinate.figure.values import NamedValues, SurfaceValues

Values: TypeAlias = NamedValues | SurfaceValues | ArrayLike

# How far a rotation may be from a rotation.
_ROUNDING = 1e-6


@dataclass(frozen=True, eq=False)
class Part:
    """A surface and what lies on it. `Model.part` and `Placement.part` make one.

    Parameters
    ----------
    name : str
        Beside its switch, where there are several parts.
    surface : (vertices, triangles)
        (V, 3) float in mm and (T, 3) int, counter-clockwise seen from outside.
    streamlines : Lines, optional
        Drawn as dark tubes; their radius has a slider.
    tracts : Lines, optional
        Drawn as black tubes.
    surface_values : mapping from str to SurfaceValues or (T,) or (V,) float
        Numbers per triangle or vertex that can be shown in colours, by name. Parts that share a name share a scale.
    visible : bool
        Whether the part is switched on at first.
    surface_color : tuple of 3 float, optional
        Display RGB of the surface in full light, 0 to 1; by default that of the style.
    offset : (3,) float
        Where the part stands, mm: its points p are shown at `rotation` p + `offset`.
    rotation : (3, 3) float
        How it is turned.

    Raises
    ------
    InvalidMesh
        There is no triangle, an index is out of range, or a vertex in use is not finite.
    InvalidOption
        A colour is none, an offset is not finite, or a rotation is none.
    """

    name: str
    surface: Triangles
    streamlines: Lines | None = None
    tracts: Lines | None = None
    surface_values: NamedValues = field(default_factory=dict)
    visible: bool = True
    surface_color: Color | None = None
    offset: ArrayLike = (0.0, 0.0, 0.0)
    rotation: ArrayLike = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

    def __post_init__(self) -> None:
        if check_shape(f"part {self.name!r}", self.surface) is None:
            raise InvalidMesh(f"part {self.name!r} has no triangles: there is nothing to show")
        if self.surface_color is not None:
            check_color(self.surface_color)
        object.__setattr__(self, "offset", three_numbers(self.offset, f"part {self.name!r}: offset"))
        object.__setattr__(self, "rotation", _rotation(self.rotation, f"part {self.name!r}: rotation"))

    def placed(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points (n, 3) of the part are shown, (n, 3) float64 in mm."""
        turned = np.asarray(points, dtype=np.float64) @ np.asarray(self.rotation).T
        return np.asarray(turned + self.offset)

    def moved(self, offset: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None) -> Part:
        """The part turned about the origin from where it is shown, and then moved by an offset in mm."""
        turn = np.eye(3) if rotation is None else _rotation(rotation, f"part {self.name!r}: rotation")
        moved = turn @ np.asarray(self.offset) + three_numbers(offset, f"part {self.name!r}: offset")
        return replace(self, offset=moved, rotation=turn @ np.asarray(self.rotation))


@dataclass(frozen=True)
class Marker:
    """A label in a circle at a place on a surface; hidden where something hides its place, or only the inside is seen.

    It belongs to the part whose surface is nearest, and moves with it.

    Parameters
    ----------
    position : tuple of 3 float
        mm, in the coordinates of the part.
    text : str
        A number or a short word.
    alternatives : sequence of tuples of 3 float
        Places on the same part where the marker is shown instead, at the first that is seen, if its position is not.

    Raises
    ------
    InvalidOption
        A place is not three finite numbers.
    """

    position: tuple[float, float, float]
    text: str
    alternatives: Sequence[tuple[float, float, float]] = ()

    def __post_init__(self) -> None:
        for place in (self.position, *self.alternatives):
            three_numbers(place, f"marker {self.text!r}: position")


def three_numbers(given: ArrayLike, what: str) -> NDArray[np.float64]:
    """Check a place or a direction, (3,) float64; `what` begins the message where it is none."""
    vector = np.array(given, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InvalidOption(f"{what} {given!r}; give three finite numbers")
    return vector


def named_values(values: Values | None) -> NamedValues:
    """Values by name; those given without one get their label, or "values"."""
    if values is None:
        return {}
    if isinstance(values, Mapping):
        return values
    label = values.label if isinstance(values, SurfaceValues) else ""
    return {label or "values": values}


def used_vertices(part: Part) -> NDArray[np.float64]:
    """The vertices (n, 3) of a part's surface that triangles use, in its own coordinates."""
    vertices, triangles = np.asarray(part.surface[0], dtype=np.float64), np.asarray(part.surface[1])
    return np.asarray(vertices[np.unique(triangles)])


def nearest_parts(markers: Sequence[Marker], parts: Sequence[Part]) -> NDArray[np.int64]:
    """Which part each marker belongs to: the one with the nearest vertex, the first of several; (n,) int64."""
    vertices = [used_vertices(part) for part in parts]
    nearest = [
        np.argmin([np.linalg.norm(points - marker.position, axis=1).min() for points in vertices]) for marker in markers
    ]
    return np.array(nearest, dtype=np.int64)


def normal_at(part: Part, position: ArrayLike) -> NDArray[np.float64]:
    """Outward normal, (3,) as the part is shown, of any length, of its surface at the vertex nearest to a place."""
    vertices, triangles = np.asarray(part.surface[0], dtype=np.float64), np.asarray(part.surface[1])
    used = np.unique(triangles)
    nearest = used[np.linalg.norm(vertices[used] - position, axis=1).argmin()]
    a, b, c = np.moveaxis(vertices[triangles[(triangles == nearest).any(axis=1)]], 1, 0)
    return np.asarray(np.asarray(part.rotation) @ np.cross(b - a, c - a).sum(axis=0))


def _rotation(given: ArrayLike, what: str) -> NDArray[np.float64]:
    matrix = np.array(given, dtype=np.float64)
    good = matrix.shape == (3, 3) and np.isfinite(matrix).all()
    if not good or np.abs(matrix @ matrix.T - np.eye(3)).max() > _ROUNDING or np.linalg.det(matrix) < 0:
        raise InvalidOption(f"{what} {given!r}; give a matrix (3, 3) with perpendicular rows of length 1, no mirror")
    return matrix
