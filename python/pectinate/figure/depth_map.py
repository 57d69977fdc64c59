"""The depth of a whole picture, drawn coarsely: what folds are dark, and what hides what."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pectinate.figure.frame import Frame
from pectinate.figure.offscreen import Canvas, Stage
from pectinate.figure.shading import blurred_depth

# Cells of a map at most, in all and along a side: they take some 200 MB to draw.
_MOST_CELLS, _LONGEST_SIDE = 4_000_000, 4096
# Cells across the radius of a fold, where folds are so large in pixels.
_FOLD_CELLS = 8


@dataclass(frozen=True)
class DepthMap:
    """Depths of a frame; made by `draw_depth_map`.

    Attributes
    ----------
    samples
        (h, w) float32, mm behind the nearest vertex, in the middle of each cell; infinite where nothing is drawn.
    surroundings
        (h, w) float32, mm: mean depth around each cell.
    cell
        Pixels of the picture across a cell.
    origin
        Column and row of the picture's pixels where the map starts.
    """

    samples: NDArray[np.float32]
    surroundings: NDArray[np.float32]
    cell: int
    origin: tuple[int, int]

    def surroundings_at(self, columns: NDArray[np.int64], rows: NDArray[np.int64]) -> NDArray[np.float32]:
        """Mean depth around pixels of the picture, (rows, columns) float32, interpolated between cells."""
        left, right, x = self._between(columns, self.origin[0], self.surroundings.shape[1])
        above, below, y = self._between(rows, self.origin[1], self.surroundings.shape[0])
        upper, lower = self.surroundings[above], self.surroundings[below]
        between = upper + y[:, None] * (lower - upper)
        return np.asarray(between[:, left] + x * (between[:, right] - between[:, left]))

    def _between(
        self, pixels: NDArray[np.int64], start: int, count: int
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float32]]:
        """The cells on both sides of the middle of each pixel, and how far it is on the way to the second."""
        place = np.clip((pixels - start + 0.5) / self.cell - 0.5, 0, count - 1)
        first = np.floor(place).astype(np.int64)
        return first, np.minimum(first + 1, count - 1), (place - first).astype(np.float32)

    def depth_at(self, pixels: NDArray[np.float64]) -> NDArray[np.float32]:
        """Depth of what is seen at places (n, 2) in pixels of the picture; infinite where nothing is."""
        column, row = np.floor((pixels - self.origin) / self.cell).astype(np.int64).T
        height, width = self.samples.shape
        inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
        depth = np.full(len(pixels), np.inf, dtype=np.float32)
        depth[inside] = self.samples[row[inside], column[inside]]
        return depth


def draw_depth_map(
    canvas: Canvas, stage: Stage, frame: Frame, window: tuple[NDArray[np.int64], NDArray[np.int64]], fold_size: float
) -> DepthMap:
    """Draw the depth of a frame where there is something to see.

    It does not depend on the tiles that the picture is drawn in.

    Parameters
    ----------
    canvas, stage, frame
        What to draw on, what, and what of it is seen.
    window : two (2,) int64
        The pixels where there may be something, of `Frame.window`.
    fold_size : float
        Width in mm of the folds that shall be darkened: the size of the surroundings.
    """
    first, last = window
    radius = 0.5 * fold_size / frame.mm_per_pixel
    extent = last - first
    cell = max(
        1,
        int(radius // _FOLD_CELLS),
        math.ceil(math.sqrt(float(extent[0]) * float(extent[1]) / _MOST_CELLS)),
        math.ceil(extent.max() / _LONGEST_SIDE),
    )
    cells = -(-extent // cell)
    middle = (first + 0.5 * cell * cells - 0.5 * np.array(frame.size)) * (1, -1) * frame.mm_per_pixel
    size = (int(cells[0]), int(cells[1]))
    _, samples = canvas.draw(stage, size, frame.mm_per_pixel * cell, (float(middle[0]), float(middle[1])))
    blur = min(max(1, round(radius / cell)), int(cells.max()))
    return DepthMap(samples, blurred_depth(samples, blur), cell, (int(first[0]), int(first[1])))
