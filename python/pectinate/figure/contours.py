"""Lines on a surface along which a number is the same, such as isochrones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.polylines import Lines, resampled
from pectinate.figure.triangles import Triangles, check_shape
from pectinate.figure.values import SurfaceValues

_MOST_LEVELS = 500
# Of the tubes that contours are drawn as, as a share of the surface's diagonal.
_RADIUS = 1 / 700
# Their middle is this many radii above the surface, so that they cross streamlines above them.
_LIFT = 2
# Contours no longer than this many radii are not drawn: they would be dots.
_SHORTEST = 6


@dataclass(frozen=True, eq=False)
class Contour:
    """A line of one level.

    Attributes
    ----------
    level
        Of the values along it.
    points
        (k, 3) float64, mm: each lies on an edge of the surface. Closed lines end where they start.
    normals
        (k, 3) float64: of the surface there, about 1 long.
    """

    level: float
    points: NDArray[np.float64]
    normals: NDArray[np.float64]

    @property
    def closed(self) -> bool:
        """Whether it ends where it starts."""
        return bool((self.points[0] == self.points[-1]).all())


def contour_lines(
    surface: Triangles, values: ArrayLike, contours: float | Sequence[float] | NDArray[np.float64]
) -> list[Contour]:
    """Find the lines on a surface along which values, interpolated in the triangles, have certain levels.

    They end at boundaries and at triangles with a value that is not finite. The side where the values reach the level
    counts as above, so that there is a line around a plateau of just that value, and none where nothing is below.

    Parameters
    ----------
    surface : (vertices, triangles)
        (V, 3) float in mm and (T, 3) int.
    values : (V,) float
        Per vertex.
    contours : float or sequence of float
        A step: all its multiples between the least and the greatest value. Or the levels.

    Returns
    -------
    list of Contour
        By level; each has at least two different points.

    Raises
    ------
    InvalidMesh
        The surface is none.
    InvalidOption
        There is not one value per vertex, the step is not above 0, a level is not finite, or there are too many.
    """
    shape = check_shape("surface", surface)
    numbers = _per_vertex(values, len(np.asarray(surface[0])))
    if shape is None:
        return []
    numbers = numbers[np.unique(np.asarray(surface[1]))]
    corners = numbers[shape.triangles]
    triangles = shape.triangles[np.isfinite(corners).all(axis=1)]
    found = []
    for level in _levels(contours, numbers[np.unique(triangles)]):
        for low, high, share in _traces(triangles, numbers, level):
            points, normals = (
                (1 - share) * table[low] + share * table[high] for table in (shape.vertices, shape.normals)
            )
            if (points != points[0]).any():
                found.append(Contour(level, points, normals))
    return found


def contour_tubes(surface: Triangles, given: SurfaceValues) -> Lines | None:
    """The contours of values as thin lines that lie on the outside of a surface; None without any."""
    if given.contours is None:
        return None
    vertices, triangles = np.asarray(surface[0], dtype=np.float64), np.asarray(surface[1])
    radius = _RADIUS * float(np.linalg.norm(np.ptp(vertices[np.unique(triangles)], axis=0)))
    lifted = [
        line.points + _LIFT * radius * line.normals for line in contour_lines(surface, given.values, given.contours)
    ]
    drawn = [points for points in lifted if _length(points) > _SHORTEST * radius]
    if not drawn:
        return None
    # Steps across corners of triangles may be much shorter than the tubes are thick.
    points, _, counts = resampled(Lines.of(drawn, radius))
    return Lines(points, np.append(0, np.cumsum(counts)), radius)


def _length(points: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _per_vertex(values: ArrayLike, vertex_count: int) -> NDArray[np.float64]:
    try:
        numbers = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidOption(f"contours: {error}; give one number per vertex") from error
    if numbers.shape != (vertex_count,):
        raise InvalidOption(f"contours of values of shape {numbers.shape}: give one per vertex ({vertex_count},)")
    return numbers


def _levels(contours: float | Sequence[float] | NDArray[np.float64], finite: NDArray[np.float64]) -> list[float]:
    """Levels in ascending order; `finite` values tell where multiples of a step start and end."""
    try:
        given = np.asarray(contours, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidOption(f"contours {contours!r}: give a step or levels") from error
    if given.ndim > 1 or not np.isfinite(given).all() or (given.ndim == 0 and given <= 0):
        raise InvalidOption(f"contours {contours!r}: give a step above 0, or levels; finite numbers")
    if given.ndim == 1:
        levels = np.unique(given)
    elif not len(finite):
        return []
    else:
        first, last = np.ceil(finite.min() / given), np.floor(finite.max() / given)
        if last - first < _MOST_LEVELS:
            levels = np.arange(first, last + 1) * given
            levels = levels[(levels > finite.min()) & (levels < finite.max())]
        else:
            levels = np.zeros(_MOST_LEVELS + 1)
    if len(levels) > _MOST_LEVELS:
        raise InvalidOption(f"contours {contours!r}: these are more than {_MOST_LEVELS} levels; choose a larger step")
    return [float(level) for level in levels]


_Trace = tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]


def _traces(triangles: NDArray[np.int64], values: NDArray[np.float64], level: float) -> list[_Trace]:
    """Lines of a level: for each point the two vertices of its edge, and the share (k, 1) of the way to the second."""
    above = values[triangles] >= level
    count = above.sum(axis=1)
    crossed = (count == 1) | (count == 2)  # noqa: PLR2004
    corners, above = triangles[crossed], above[crossed]
    # The corner that is alone on its side: the line crosses the two edges that meet there.
    alone = np.argmax(above == (count[crossed] == 1)[:, None], axis=1)
    rows = np.arange(len(corners))
    ends = np.stack([corners[rows, (alone + turn) % 3] for turn in (1, 2)], axis=1)
    pairs = np.sort(np.stack([np.broadcast_to(corners[rows, alone][:, None], ends.shape), ends], axis=2), axis=2)
    edges, segments = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    low, high = edges.T
    # Halves, because the difference of two finite numbers may be infinite.
    share = (0.5 * level - 0.5 * values[low]) / (0.5 * values[high] - 0.5 * values[low])
    return [(low[chain], high[chain], share[chain, None]) for chain in _chains(segments.reshape(-1, 2), len(edges))]


def _chains(segments: NDArray[np.int64], node_count: int) -> list[NDArray[np.int64]]:
    """Join segments (m, 2) between nodes to chains of nodes, which end only where other than two segments meet."""
    at_node: list[list[int]] = [[] for _ in range(node_count)]
    ends = segments.tolist()
    for index, (first, second) in enumerate(ends):
        at_node[first].append(index)
        at_node[second].append(index)
    free = bytearray(b"\1" * len(ends))
    through = [len(some) == 2 for some in at_node]  # noqa: PLR2004
    chains = []
    for start in sorted(range(node_count), key=through.__getitem__):
        for first in at_node[start]:
            chain, segment = [start], first if free[first] else None
            while segment is not None:
                free[segment] = 0
                a, b = ends[segment]
                node = b if a == chain[-1] else a
                chain.append(node)
                segment = next((other for other in at_node[node] if free[other]), None) if through[node] else None
            if len(chain) > 1:
                chains.append(np.array(chain))
    return chains
