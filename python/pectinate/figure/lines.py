"""Lines in space as tubes, such as fibre tracts drawn on a surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.shading import unit

_FEWEST_SIDES = 3
# Where the rings of a tube's round end lie, as shares of a quarter turn; the last one closes it.
_END_RINGS = np.array([0.0, 1 / 3, 2 / 3, 1.0])

_LEAST_AXIS = 1e-6

_Points = NDArray[np.float64]


class LineTubes(NamedTuple):
    """Tubes around lines: vertices (V, 3) in mm, triangles (T, 3), and which point of the lines each vertex is at.

    `vertex_points` (V,) float64 counts the points of all lines; a fraction is the share of the way to the next point.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    vertex_points: NDArray[np.float64]


def line_tubes(
    lines: Sequence[ArrayLike], radius: float, *, side_count: int = 10
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Make closed tubes with round ends around polylines.

    Parameters
    ----------
    lines : sequence of (n, 3) float
        Points in mm, at least two different ones each; a line may end where it starts.
    radius : float
        mm.
    side_count : int
        Sides of the tubes, at least 3.

    Returns
    -------
    vertices : (V, 3) float64
        mm.
    triangles : (T, 3) int64
        Counter-clockwise seen from outside; empty without lines.

    Raises
    ------
    InvalidOption
        A line has fewer than two different points or one that is not finite, the radius is not above 0, or there are
        too few sides.
    """
    tubes = located_tubes(lines, radius, side_count=side_count)
    return tubes.vertices, tubes.triangles


def located_tubes(lines: Sequence[ArrayLike], radius: float, *, side_count: int = 10) -> LineTubes:
    """As `line_tubes`, with the point that each vertex is at."""
    if not (np.isfinite(radius) and radius > 0):
        raise InvalidOption(f"radius {radius}: give a number above 0")
    if side_count < _FEWEST_SIDES:
        raise InvalidOption(f"side_count {side_count}: give at least {_FEWEST_SIDES}")
    vertices, triangles, places = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], [np.zeros(0)]
    count = point_count = 0
    for index, line in enumerate(lines):
        points, distinct = _distinct_points(index, line)
        rings = _rings(points, radius, side_count)
        used, corners = np.unique(_between_rings(len(rings), side_count), return_inverse=True)
        vertices.append(rings.reshape(-1, 3)[used])
        triangles.append(count + corners.reshape(-1, 3))
        # All rings of a round end belong to the point where it begins.
        ring_points = np.clip(used // side_count - len(_END_RINGS) + 1, 0, len(points) - 1)
        places.append(point_count + distinct[ring_points].astype(np.float64))
        count += len(used)
        point_count += len(np.asarray(line))
    return LineTubes(np.concatenate(vertices), np.concatenate(triangles), np.concatenate(places))


def _distinct_points(index: int, line: ArrayLike) -> tuple[_Points, NDArray[np.int64]]:
    """Return the points of a line without those that repeat the one before, and which of them these are."""
    points = np.asarray(line, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:  # noqa: PLR2004
        raise InvalidOption(f"line {index}: points of shape {points.shape}; give an array of shape (n, 3)")
    if not np.isfinite(points).all():
        raise InvalidOption(f"line {index}: a point is not finite; remove it")
    new = np.append(np.ones(min(len(points), 1), dtype=bool), np.any(np.diff(points, axis=0) != 0, axis=1))
    if np.count_nonzero(new) < 2:  # noqa: PLR2004
        raise InvalidOption(f"line {index}: it has fewer than two different points; remove it")
    return points[new], np.flatnonzero(new)


def _rings(points: _Points, radius: float, side_count: int) -> NDArray[np.float64]:
    """Return the tube's vertices, (rings, sides, 3)."""
    segments = unit(np.diff(points, axis=0))
    turning = segments[:-1] + segments[1:]
    # Where the line goes back the way it came, the sum is no direction.
    turning = np.where(np.any(turning != 0, axis=1, keepdims=True), turning, segments[1:])
    tangents = unit(np.concatenate([segments[:1], turning, segments[-1:]]))
    quarter = 0.5 * np.pi * _END_RINGS
    # The round ends: rings before the first point and behind the last one.
    ahead, radii = radius * np.sin(quarter), radius * np.cos(quarter)
    first, last = points[0] - ahead[::-1, None] * tangents[0], points[-1] + ahead[:, None] * tangents[-1]
    spine = np.concatenate([first, points[1:-1], last])
    along = np.repeat(tangents, [len(quarter)] + [1] * (len(points) - 2) + [len(quarter)], axis=0)
    thickness = np.concatenate([radii[::-1], np.full(len(points) - 2, radius), radii])
    side, other = _transported_axes(along)
    turn = 2 * np.pi * np.arange(side_count) / side_count
    offsets = np.cos(turn)[None, :, None] * side[:, None] + np.sin(turn)[None, :, None] * other[:, None]
    return np.asarray(spine[:, None] + thickness[:, None, None] * offsets)


def _transported_axes(tangents: _Points) -> tuple[_Points, _Points]:
    """Return two unit vectors across each tangent, turned as little as can be from one to the next."""
    side = _some_axis(tangents[0])
    sides = np.empty_like(tangents)
    for i, tangent in enumerate(tangents):
        across = side - (side @ tangent) * tangent
        # Nothing is left of the axis where the line turns by a right angle towards it.
        side = across if np.linalg.norm(across) > _LEAST_AXIS else _some_axis(tangent)
        side = side / np.linalg.norm(side)
        sides[i] = side
    return sides, np.cross(tangents, sides)


def _some_axis(tangent: _Points) -> _Points:
    """Return a vector across a tangent."""
    return np.cross(tangent, np.eye(3)[np.argmin(np.abs(tangent))])


def _between_rings(ring_count: int, side_count: int) -> NDArray[np.int64]:
    """Return the triangles between each ring and the next; the first and the last ring are one point each."""
    start = side_count * np.arange(ring_count - 1)[:, None]
    a, b = start + np.arange(side_count), start + (np.arange(side_count) + 1) % side_count
    lower, upper = np.stack([a, b, b + side_count], axis=-1), np.stack([a, b + side_count, a + side_count], axis=-1)
    triangles = np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])
    last = side_count * (ring_count - 1)
    triangles[triangles < side_count] = 0
    triangles[triangles >= last] = last
    return triangles[np.all(triangles != np.roll(triangles, 1, axis=1), axis=1)]
