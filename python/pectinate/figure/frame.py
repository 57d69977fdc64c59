"""Where a picture looks, and where in it a place in space is seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.shading import Real
from pectinate.figure.views import View

MARGIN = 0.03
"""Least share of a picture's width and height that stays free at each side."""

# A picture's pixels at most: 1.5 GB, and the most that most programs open.
_MOST_PIXELS, _LONGEST_SIDE = 500_000_000, 65_500


@dataclass(frozen=True)
class Frame:
    """Where a picture looks: a view, the middle of the picture and its scale."""

    view: View
    centre: NDArray[np.float64]
    size: tuple[int, int]
    mm_per_pixel: float

    def __post_init__(self) -> None:
        check_size(self.size)
        if not np.isfinite(self.mm_per_pixel) or self.mm_per_pixel <= 0:
            raise InvalidOption(f"mm_per_pixel {self.mm_per_pixel}: give a number above 0")

    def seen(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (n, 3) relative to the middle of the picture: right, up and towards the viewer, (n, 3) in mm."""
        return rotated(points - self.centre, self.view.rotation())

    def pixels(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where points (n, 3) are seen, (n, 2) float64: to the right and down from the picture's upper left corner."""
        across = self.seen(points)[:, :2] * (1, -1) / self.mm_per_pixel
        return np.asarray(across + 0.5 * np.array(self.size))

    def window(self, points: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """First column and row, (2,), of the pixels that show all points, and those behind the last; at least one."""
        corners = self.pixels(np.array(seen_box(points, self.view)) @ self.view.rotation())
        size = np.array(self.size)
        first = np.clip(np.floor(corners.min(axis=0)), 0, size - 1).astype(np.int64)
        last = np.clip(np.ceil(corners.max(axis=0)), first + 1, size).astype(np.int64)
        return first, last


def rotated(points: NDArray[Real], rotation: NDArray[np.float64]) -> NDArray[Real]:
    """Products (n, 3) of a rotation (3, 3) and points (n, 3), stored coordinate by coordinate.

    That is as quick as a library for linear algebra, whose threads wait busily for more such small work.
    """
    x, y, z = points.T
    return np.array([a * x + b * y + c * z for a, b, c in rotation.astype(points.dtype)]).T


def seen_box(points: NDArray[np.float64], view: View) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Least and greatest coordinates, (3,) float64 each, of points seen along a view: right, up, towards the viewer."""
    seen = rotated(points, view.rotation()).T
    return seen.min(axis=1), seen.max(axis=1)


def extent(points: NDArray[np.float64], view: View) -> tuple[float, float]:
    """Width and height in mm of points seen along a view."""
    low, high = seen_box(points, view)
    width, height, _ = (high - low).tolist()
    return width, height


def middle(points: NDArray[np.float64], view: View) -> NDArray[np.float64]:
    """Middle, (3,) float64 in the coordinates of the points, of their box seen along a view."""
    low, high = seen_box(points, view)
    return np.asarray(0.5 * (low + high) @ view.rotation())


def fitting_scale(extent_mm: tuple[float, float], size: tuple[int, int]) -> float:
    """Scale in mm per pixel at which an extent in mm just fits into a picture with its margin."""
    check_size(size)
    scale = max(mm / (pixels * (1 - 2 * MARGIN)) for mm, pixels in zip(extent_mm, size, strict=True))
    return scale if scale > 0 else 1.0


def check_size(size: tuple[int, int]) -> None:
    """Raise InvalidOption unless a size is two positive whole numbers of a picture that can be had."""
    if not all(isinstance(pixels, (int, np.integer)) and pixels > 0 for pixels in size) or len(size) != 2:  # noqa: PLR2004
        raise InvalidOption(f"size {size}: give the width and the height in pixels, whole numbers above 0")
    width, height = (int(pixels) for pixels in size)
    if max(width, height) > _LONGEST_SIDE or width * height > _MOST_PIXELS:
        raise InvalidOption(
            f"a picture of {width} x {height} pixels is more than can be drawn: choose at most {_LONGEST_SIDE} a side "
            f"and {_MOST_PIXELS:,} in all"
        )
