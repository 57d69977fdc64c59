"""What a picture of a field ought to show: the field's direction, as projected, at every pixel."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pectinate.figure.frame import Frame
from pectinate.figure.shading import triangle_normals, unit

# Pixels that are looked at together.
_AT_ONCE = 20_000_000


@dataclass(frozen=True, eq=False)
class ProjectedField:
    """The truth of a picture.

    Attributes
    ----------
    triangles
        (h, w) int64: the triangle that is seen in the middle of each pixel; -1 where there is none.
    directions
        (h, w, 2) float64: the field there, to the right and up, of length 1 where it lies in the picture's plane;
        zero where there is none.
    facing
        (h, w) float64: the cosine of the angle between the surface's normal and the line of sight.
    """

    triangles: NDArray[np.int64]
    directions: NDArray[np.float64]
    facing: NDArray[np.float64]

    @property
    def shown(self) -> NDArray[np.bool_]:
        """Where the surface is seen, (h, w)."""
        return self.triangles >= 0

    @property
    def angles(self) -> NDArray[np.float64]:
        """Angles of lines from the right, counter-clockwise, radians, (h, w); NaN where there is no direction."""
        there = np.linalg.norm(self.directions, axis=2) > 0
        return np.where(there, np.arctan2(self.directions[:, :, 1], self.directions[:, :, 0]), np.nan)


def project_field(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], field: NDArray[np.float64], frame: Frame
) -> ProjectedField:
    """Find what each pixel shows, and the field there.

    Parameters
    ----------
    vertices, triangles : (V, 3) float64, (T, 3) int
        The surface.
    field : (T, 3) float64
        Unit vectors, or zero.
    frame : Frame
        Where the picture looks.
    """
    seen = visible_triangles(vertices, triangles, frame)
    rotation = frame.view.rotation()
    across = np.vstack([(field @ rotation.T)[:, :2], np.zeros(2)])
    normals = unit(triangle_normals(vertices, np.asarray(triangles, dtype=np.int64))) @ rotation.T
    facing = np.append(np.abs(normals[:, 2]), 0.0)
    return ProjectedField(seen, across[seen], facing[seen])


def visible_triangles(vertices: NDArray[np.float64], triangles: NDArray[np.int64], frame: Frame) -> NDArray[np.int64]:
    """Cast a ray through the middle of each pixel; the index (h, w) of the nearest triangle it meets, or -1."""
    width, height = frame.size
    pixels, depths = frame.pixels(vertices), -frame.seen(vertices)[:, 2]
    corners = pixels[triangles]
    first = np.clip(np.ceil(corners.min(axis=1) - 0.5), 0, frame.size).astype(np.int64)
    last = np.clip(np.floor(corners.max(axis=1) - 0.5) + 1, first, frame.size).astype(np.int64)
    boxes = last - first
    counts = boxes.prod(axis=1)
    nearest = np.full(height * width, np.inf)
    result = np.full(height * width, -1, dtype=np.int64)
    groups = np.searchsorted(np.cumsum(counts), np.arange(0, counts.sum() + _AT_ONCE, _AT_ONCE), side="right")
    for start, end in itertools.pairwise(groups):
        some = np.arange(start, end)
        owner = np.repeat(some, counts[some])
        place = np.arange(len(owner)) - np.repeat(np.cumsum(counts[some]) - counts[some], counts[some])
        column, row = first[owner, 0] + place % boxes[owner, 0], first[owner, 1] + place // boxes[owner, 0]
        weights = _barycentric(corners[owner], np.stack([column, row], axis=1) + 0.5)
        hit = (weights >= 0).all(axis=1)
        depth = (weights[hit] * depths[triangles[owner[hit]]]).sum(axis=1)
        pixel, owner = (row * width + column)[hit], owner[hit]
        order = np.argsort(-depth, kind="stable")  # the nearest is written last
        pixel, owner, depth = pixel[order], owner[order], depth[order]
        nearer = depth < nearest[pixel]
        nearest[pixel[nearer]], result[pixel[nearer]] = depth[nearer], owner[nearer]
    return result.reshape(height, width)


def _barycentric(corners: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights (n, 3) of the corners (n, 3, 2) at points (n, 2); NaN, which hits nothing, in triangles seen edge-on."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]

    def doubled_area(p: NDArray[np.float64], q: NDArray[np.float64], r: NDArray[np.float64]) -> NDArray[np.float64]:
        (ux, uy), (vx, vy) = (q - p).T, (r - p).T
        return np.asarray(ux * vy - uy * vx)

    parts = np.stack([doubled_area(b, c, points), doubled_area(c, a, points), doubled_area(a, b, points)], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(parts / parts.sum(axis=1, keepdims=True))
