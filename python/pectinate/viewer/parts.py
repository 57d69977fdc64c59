"""What a page shows: surfaces with lines and values on them, and markers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidMesh, InvalidOption
from pectinate.figure.shape import Triangles, check_shape
from pectinate.figure.values import SurfaceValues

Values: TypeAlias = Mapping[str, SurfaceValues | ArrayLike] | SurfaceValues | ArrayLike

_FEWEST_POINTS = 2


@dataclass(frozen=True, eq=False)
class Lines:
    """Polylines in space that are drawn as tubes.

    Parameters
    ----------
    points : (N, 3) float
        mm, one line after the other.
    offsets : (n + 1,) int
        Line i owns points[offsets[i]:offsets[i + 1]].
    radius : float
        Of the tubes, mm.
    taper_length : float
        mm, over which the ends grow thin (the paper's equation 3); 0 gives round ends.
    """

    points: NDArray[np.float64]
    offsets: NDArray[np.int64]
    radius: float
    taper_length: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.radius) and self.radius > 0):
            raise InvalidOption(f"tube radius is {self.radius}, but must be positive and finite")
        if not (np.isfinite(self.taper_length) and self.taper_length >= 0):
            raise InvalidOption(f"taper_length is {self.taper_length}, but must be finite and not negative")

    @classmethod
    def of(cls, lines: Sequence[ArrayLike], radius: float) -> Lines:
        """Join lines of (k, 3) points each.

        Raises
        ------
        InvalidOption
            A line is no array (k, 3) of finite numbers with at least two rows, or the radius is not above 0.
        """
        arrays = [_line(index, line) for index, line in enumerate(lines)]
        offsets = np.cumsum([0] + [len(line) for line in arrays])
        return cls(np.concatenate([np.zeros((0, 3)), *arrays]), offsets, radius)


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

    Raises
    ------
    InvalidMesh
        There is no triangle, an index is out of range, or a vertex in use is not finite.
    """

    name: str
    surface: Triangles
    streamlines: Lines | None = None
    tracts: Lines | None = None
    surface_values: Mapping[str, SurfaceValues | ArrayLike] = field(default_factory=dict)
    visible: bool = True

    def __post_init__(self) -> None:
        if check_shape(f"part {self.name!r}", self.surface) is None:
            raise InvalidMesh(f"part {self.name!r} has no triangles: there is nothing to show")


@dataclass(frozen=True)
class Marker:
    """A label in a circle at a place on a surface; hidden where the surface hides its place.

    Parameters
    ----------
    position : tuple of 3 float
        mm.
    text : str
        A number or a short word.

    Raises
    ------
    InvalidOption
        The position is not three finite numbers.
    """

    position: tuple[float, float, float]
    text: str

    def __post_init__(self) -> None:
        place = np.asarray(self.position, dtype=np.float64)
        if place.shape != (3,) or not np.isfinite(place).all():
            raise InvalidOption(f"marker {self.text!r}: position {self.position}; give three finite numbers")


def named_values(values: Values | None) -> Mapping[str, SurfaceValues | ArrayLike]:
    """Values by name; those given without one get their label, or "values"."""
    if values is None:
        return {}
    if isinstance(values, Mapping):
        return values
    label = values.label if isinstance(values, SurfaceValues) else ""
    return {label or "values": values}


def _line(index: int, line: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(line, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < _FEWEST_POINTS:  # noqa: PLR2004
        raise InvalidOption(f"line {index}: points of shape {points.shape}; give an array (n, 3) of at least two")
    if not np.isfinite(points).all():
        raise InvalidOption(f"line {index}: a point is not finite; remove it")
    return points
