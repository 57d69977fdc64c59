"""The depth of a whole picture, drawn coarsely: what folds are dark, and what hides what."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pectinate.figure.frame import Frame
from pectinate.figure.offscreen import Canvas, Stage
from pectinate.figure.shading import blurred_depth

Window = tuple[NDArray[np.int64], NDArray[np.int64]]
"""First column and row, (2,), of the pixels where there may be something, and those behind the last."""

# Cells of a map at most, in all and along a side: they take some 200 MB to draw.
_MOST_CELLS, _LONGEST_SIDE = 4_000_000, 4096
# Cells across the radius of a fold, where folds are so large in pixels.
_FOLD_CELLS = 8


@dataclass(frozen=True)
class DepthMap:
    """Depths of a frame; made by `pick_depth_map` or `draw_depth_map`.

    Attributes
    ----------
    samples
        (h, w) float32, mm behind the nearest vertex, near the middle of each cell; infinite where nothing is drawn.
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


@dataclass(frozen=True)
class Grid:
    """The cells of a map.

    Attributes
    ----------
    frame, window
        The picture, and which of its pixels the cells cover.
    fold_size
        Width in mm of the folds that shall be darkened: the size of the surroundings.
    supersampling
        Samples of the picture across a pixel. The depth of a cell is that of the sample next to its middle.
    """

    frame: Frame
    window: Window
    fold_size: float
    supersampling: int

    @property
    def cell(self) -> int:
        """Pixels across a cell: as many as folds allow and as the most cells ask for."""
        extent = self.window[1] - self.window[0]
        return max(
            1,
            int(self.radius // _FOLD_CELLS),
            math.ceil(math.sqrt(float(extent[0]) * float(extent[1]) / _MOST_CELLS)),
            math.ceil(int(extent.max()) / _LONGEST_SIDE),
        )

    @property
    def radius(self) -> float:
        """Pixels from the middle of the surroundings to their border."""
        return 0.5 * self.fold_size / self.frame.mm_per_pixel

    def complete(self, samples: NDArray[np.float32]) -> DepthMap:
        """The map with these depths (h, w) of cells."""
        cell, (left, top) = self.cell, self.window[0].tolist()
        blur = min(max(1, round(self.radius / cell)), max(samples.shape))
        return DepthMap(samples, blurred_depth(samples, blur), cell, (left, top))


def pick_depth_map(grid: Grid, depth: NDArray[np.float32]) -> DepthMap:
    """Pick the map out of the depths (supersampling * h, supersampling * w), of `Canvas.draw`, of all of the window."""
    step = grid.cell * grid.supersampling
    # Cells whose middle is beyond the window take what is nearest.
    rows, columns = (np.minimum(np.arange(0, length, step) + step // 2, length - 1) for length in depth.shape)
    return grid.complete(depth[np.ix_(rows, columns)])


def draw_depth_map(grid: Grid, canvas: Canvas, stage: Stage) -> DepthMap:
    """Draw the map of a picture that is not drawn at once: the same but for rounding, whatever its tiles are."""
    cell, frame = grid.cell, grid.frame
    first, last = grid.window
    cells = -(-(last - first) // cell)
    # In pixels, from where canvases take depths to where `pick_depth_map` does.
    place = canvas.depth_place()
    shift = (cell * grid.supersampling // 2 + place) / grid.supersampling - cell * place
    middle = (first + 0.5 * cell * cells - 0.5 * np.array(frame.size) + shift) * (1, -1) * frame.mm_per_pixel
    size = (int(cells[0]), int(cells[1]))
    _, samples = canvas.draw(stage, size, frame.mm_per_pixel * cell, (float(middle[0]), float(middle[1])))
    return grid.complete(samples)
