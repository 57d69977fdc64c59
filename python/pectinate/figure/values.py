"""Numbers on a surface, shown as colours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.plotting import import_matplotlib
from pectinate.figure.shading import Color

_MOST_TICK_INTERVALS = 5


@dataclass(frozen=True, eq=False)
class SurfaceValues:
    """A number per triangle or per vertex of a surface, and how to colour it.

    Parameters
    ----------
    values : (T,) or (V,) float
        Per triangle, or per vertex; with as many vertices as triangles, per triangle. Those that are not finite, and
        the triangles of vertices that have such a value, are drawn in `Style.no_value_color`.
    colormap : str
        A name of Matplotlib's: "viridis", "magma" and "cividis" are perceptually even, "twilight" is cyclic.
    value_range : tuple of 2 float, optional
        The numbers at the ends of the map; those beyond have the ends' colours. By default the least and the greatest.
    label : str
        What the numbers are, with their unit; written beside the colour bar.
    """

    values: ArrayLike
    colormap: str = "viridis"
    value_range: tuple[float, float] | None = None
    label: str = ""


@dataclass(frozen=True)
class ColorScale:
    """Which colour stands for which number: a map of Matplotlib's between two numbers."""

    colormap: str
    low: float
    high: float

    def __post_init__(self) -> None:
        if not (np.isfinite([self.low, self.high]).all() and self.low < self.high):
            raise InvalidOption(f"value_range {(self.low, self.high)}: give two finite numbers, the smaller one first")
        if self.colormap not in import_matplotlib().colormaps:
            raise InvalidOption(f"colormap {self.colormap!r}: give a name that Matplotlib knows, such as viridis")

    def colors(self, values: NDArray[np.float64], missing: Color) -> NDArray[np.float64]:
        """Display RGB, (..., 3) float64 in 0 to 1, of numbers (...); `missing` for those that are not finite."""
        finite = np.isfinite(values)
        # Halves, because the difference of two finite numbers may be infinite.
        fraction = (0.5 * np.where(finite, values, 0.0) - 0.5 * self.low) / (0.5 * self.high - 0.5 * self.low)
        rgb = import_matplotlib().colormaps[self.colormap](np.clip(fraction, 0.0, 1.0))[..., :3]
        return np.where(finite[..., None], rgb, missing)

    def ticks(self) -> list[float]:
        """Round numbers from one end of the scale to the other, at least two where there is room."""
        locator = import_matplotlib("matplotlib.ticker").MaxNLocator(_MOST_TICK_INTERVALS, steps=[1, 2, 2.5, 5, 10])
        # Rounding may put the tick that belongs to an end just beyond it.
        slack = 1e-9 * (self.high - self.low)
        values = locator.tick_values(self.low, self.high)
        return [float(value) for value in values if self.low - slack <= value <= self.high + slack]


@dataclass(frozen=True)
class CornerColors:
    """The colours of a surface with values: `colors` (T, 3, 3) float64, display RGB of each triangle's corners."""

    colors: NDArray[np.float64]
    scale: ColorScale
    label: str
    some_missing: bool


def corner_colors(
    surface_values: SurfaceValues | ArrayLike, triangles: NDArray[np.int64], vertex_count: int, missing: Color
) -> CornerColors:
    """Give a colour to each corner of the triangles (T, 3) of a surface.

    Raises
    ------
    InvalidOption
        There is not one value per triangle or vertex, the range is not one, or the colour map is unknown.
    MissingDependency
        Matplotlib is not installed.
    """
    given = surface_values if isinstance(surface_values, SurfaceValues) else SurfaceValues(surface_values)
    values = corner_values(given.values, triangles, vertex_count)
    finite = np.isfinite(values)
    low, high = given.value_range or range_of(values[finite])
    scale = ColorScale(given.colormap, float(low), float(high))
    return CornerColors(scale.colors(values, missing), scale, given.label, not finite.all())


def joined_scale(colors: Sequence[CornerColors]) -> CornerColors | None:
    """What one colour bar explains, of surfaces that share a scale; None without any."""
    some_missing = any(one.some_missing for one in colors)
    return replace(colors[0], some_missing=some_missing) if colors else None


def corner_values(values: ArrayLike, triangles: NDArray[np.int64], vertex_count: int) -> NDArray[np.float64]:
    """Values (T, 3) at the corners of triangles; NaN at all three of a triangle where one is not finite."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidOption(f"surface_values: {error}; give one number per triangle or vertex") from error
    if array.shape == (len(triangles),):
        corners = np.repeat(array[:, None], 3, axis=1)
    elif array.shape == (vertex_count,):
        corners = array[triangles]
    else:
        raise InvalidOption(
            f"surface_values of shape {array.shape}: give one number per triangle ({len(triangles)},) or vertex "
            f"({vertex_count},)"
        )
    corners[~np.isfinite(corners).all(axis=1)] = np.nan
    return corners


def range_of(finite_values: NDArray[np.float64]) -> tuple[float, float]:
    """Least and greatest value; one more than the least where all are the same, 0 and 1 where there is none."""
    if not len(finite_values):
        return 0.0, 1.0
    low, high = float(finite_values.min()), float(finite_values.max())
    # Twice the rounding, so that adding it to a huge number changes it.
    return low, high if high > low else low + max(1.0, 2 * np.spacing(abs(low)))
