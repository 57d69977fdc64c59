"""Polylines in space with numbers at their points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.lines import located_tubes
from pectinate.figure.shading import unit
from pectinate.figure.values import NamedValues, SurfaceValues

_FEWEST_POINTS = 2
# Of a closed line, so that it encloses something.
_FEWEST_SIDES = 3
# Tubes get a ring every so many radii; closer ones do not show.
_RING_SPACING = 1.5
# Nor are rings farther apart than this share of the taper length, so that the taper is followed.
_TAPER_STEP = 0.5


class TubeMesh(Protocol):
    """Tubes as `pectinate.figure.lines.LineTubes` and the engine have them."""

    @property
    def vertices(self) -> NDArray[np.float64]:
        """(V, 3) float64, mm."""

    @property
    def triangles(self) -> NDArray[np.integer[Any]]:
        """(T, 3) int."""

    @property
    def vertex_points(self) -> NDArray[np.float64]:
        """(V,) float64: the point that each vertex is at, and the share of the way to the next one."""


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
    make_tubes : callable, optional
        Makes the tubes for pictures, when they are needed; by default tubes with round ends.
    values : mapping from str to SurfaceValues or (N,) float
        Numbers per point that can colour the tubes, by name.
    height : float
        Of the tubes over their width on a page, above 0 and at most 1; below 1 they lie flat on the surface.
    normals : (N, 3) float, optional
        Outward normals of the surface at the points, of any length; needed for tubes that are not round.

    Raises
    ------
    InvalidOption
        A point is not finite, a line has fewer than two, the offsets do not part the points, a length is out of its
        range, or there is not one value per point.
    """

    points: NDArray[np.float64]
    offsets: NDArray[np.int64]
    radius: float
    taper_length: float = 0.0
    make_tubes: Callable[[], TubeMesh] | None = None
    values: NamedValues = field(default_factory=dict)
    height: float = 1.0
    normals: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        if not (np.isfinite(self.radius) and self.radius > 0):
            raise InvalidOption(f"tube radius is {self.radius}, but must be positive and finite")
        if not (np.isfinite(self.taper_length) and self.taper_length >= 0):
            raise InvalidOption(f"taper_length is {self.taper_length}, but must be finite and not negative")
        if not 0 < self.height <= 1:
            raise InvalidOption(f"tube height is {self.height} of the width, but must be above 0 and at most 1")
        if self.height < 1 and self.normals is None:
            raise InvalidOption("lines: flat tubes need normals of the surface, (N, 3)")
        if self.normals is not None and not (
            self.normals.shape == self.points.shape and np.isfinite(self.normals).all()
        ):
            raise InvalidOption(f"lines: normals of shape {self.normals.shape}; give finite numbers, one row per point")
        if self.points.ndim != 2 or self.points.shape[1] != 3 or not np.isfinite(self.points).all():  # noqa: PLR2004
            raise InvalidOption(f"lines: points of shape {self.points.shape}; give finite numbers, (N, 3)")
        ends = (0, len(self.points))
        if self.offsets.ndim != 1 or not len(self.offsets) or (self.offsets[0], self.offsets[-1]) != ends:
            raise InvalidOption(f"lines: offsets must go from 0 to the number of points, {len(self.points)}")
        if (np.diff(self.offsets) < _FEWEST_POINTS).any():
            raise InvalidOption("lines: one has fewer than two points; remove it")
        for name, given in self.values.items():
            _check_point_values(name, SurfaceValues.of(given), len(self.points))

    @classmethod
    def of(cls, lines: Sequence[ArrayLike], radius: float) -> Lines:
        """Join lines of (k, 3) points each.

        Raises
        ------
        InvalidOption
            A line is no array (k, 3), or breaks another rule of `Lines`.
        """
        arrays = [_line(index, line) for index, line in enumerate(lines)]
        offsets = np.cumsum([0] + [len(line) for line in arrays])
        return cls(np.concatenate([np.zeros((0, 3)), *arrays]), offsets, radius)

    def closed(self) -> NDArray[np.bool_]:
        """Tell which lines, (n,), are closed: they end where they begin, with two points or more between."""
        first, last = self.offsets[:-1], self.offsets[1:] - 1
        return np.asarray((self.points[first] == self.points[last]).all(axis=1) & (last - first >= _FEWEST_SIDES))

    def tubes(self) -> TubeMesh:
        """Make the tubes."""
        if self.make_tubes is not None:
            return self.make_tubes()
        lines = np.split(self.points, self.offsets[1:-1]) if len(self.offsets) > 1 else []
        return located_tubes(lines, self.radius)


def values_at(given: SurfaceValues, places: NDArray[np.float64]) -> SurfaceValues:
    """Take values per point of lines to places on them, such as those of the vertices of tubes.

    Between two points they are interpolated; categories are those of the nearer one.
    """
    numbers = np.asarray(given.values, dtype=np.float64)
    whole = given.categories is not None
    return replace(given, values=numbers[np.rint(places).astype(np.int64)] if whole else _between(numbers, places))


def resampled(lines: Lines) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Points at even distances along each line, its ends among them, as closely as tubes need them.

    Returns
    -------
    points : (M, 3) float64
        mm, one line after the other.
    places : (M,) float64
        Where on the lines the points are: the index of one of theirs, and the share of the way to the next one.
    counts : (n,) int64
        Points of each line, at least two; of a closed one, whose last point is its first, at least four.
    """
    if len(lines.offsets) < 2:  # noqa: PLR2004
        return np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=np.int64)
    spacing = _RING_SPACING * lines.radius
    if lines.taper_length > 0:
        spacing = min(spacing, _TAPER_STEP * lines.taper_length)
    steps = np.linalg.norm(np.diff(lines.points, axis=0), axis=1)
    first, last = lines.offsets[:-1], lines.offsets[1:] - 1
    # Whole numbers of lines apart, so that no line's samples reach into the next one.
    steps[last[:-1]] = 1.0
    arc = np.append(0.0, np.cumsum(steps))
    fewest = np.where(lines.closed(), 1 + _FEWEST_SIDES, _FEWEST_POINTS)
    counts = np.maximum(fewest, 1 + np.ceil((arc[last] - arc[first]) / spacing).astype(np.int64))
    rank = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    share = rank / np.repeat(counts - 1, counts)
    samples = np.repeat(arc[first], counts) * (1 - share) + np.repeat(arc[last], counts) * share
    places = np.interp(samples, arc, np.arange(len(arc)))
    return _between(lines.points, places), places, counts


def normals_at(lines: Lines, places: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Unit normals (n, 3) of the surface at places on lines, as of `resampled`; None where tubes are round."""
    if lines.normals is None or lines.height == 1:
        return None
    return unit(_between(lines.normals, places))


def _check_point_values(name: str, given: SurfaceValues, point_count: int) -> None:
    numbers = np.asarray(given.values)
    if numbers.shape != (point_count,) or numbers.dtype.kind not in "fiub":
        what = f"lines: values {name!r} of shape {numbers.shape} and type {numbers.dtype}"
        raise InvalidOption(f"{what}; give one number per point ({point_count},)")
    if given.contours is not None:
        raise InvalidOption(f"lines: values {name!r} have contours; only those of surfaces can have them")


def _between(table: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows of a table, interpolated between one and the next; one without weight takes no part, even if it is NaN."""
    first = np.floor(places).astype(np.int64)
    share = (places - first).reshape(-1, *[1] * (table.ndim - 1))
    second = np.where(places > first, first + 1, first)
    with np.errstate(invalid="ignore"):  # what is infinite becomes NaN: both have no colour
        return np.asarray((1 - share) * table[first] + share * table[second])


def _line(index: int, line: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(line, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:  # noqa: PLR2004
        raise InvalidOption(f"line {index}: points of shape {points.shape}; give an array (n, 3)")
    return points
