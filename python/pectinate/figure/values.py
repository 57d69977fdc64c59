"""Numbers on a surface or on tubes, shown as colours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.plotting import import_matplotlib
from pectinate.figure.shading import Color

_MOST_TICK_INTERVALS = 5
_DEFAULT_MAP = "viridis"
# Maps of separate colours, smaller ones first; their greys are left out, because grey means that there is no value.
_CATEGORY_MAPS = ("tab10", "tab20")
_MANY_CATEGORIES_MAP = "turbo"
_MOST_CATEGORIES = 64
_LEAST_SATURATION = 0.05


@dataclass(frozen=True, eq=False)
class SurfaceValues:
    """Numbers of a surface or of its streamlines, and how to colour it by them.

    Parameters
    ----------
    values : (T,) or (V,) float
        Per triangle, or per vertex; with as many vertices as triangles, per triangle. Those that are not finite, and
        the triangles of vertices that have such a value, are drawn in `Style.no_value_color`. On tubes they may also
        be per point of the lines.
    colormap : str, optional
        A name of Matplotlib's: "viridis" (the default), "magma" and "cividis" are perceptually even, "coolwarm" and
        "RdBu" diverge from the middle of a range, "twilight" is cyclic.
    value_range : tuple of 2 float, optional
        The numbers at the ends of the map; those beyond have the ends' colours. By default the least and the greatest.
    label : str
        What the numbers are, with their unit; written beside the colour bar.
    contours : float or sequence of float, optional
        Lines where the values, interpolated in triangles, have certain levels (isochrones of activation times): a
        step, for all its multiples between the least and the greatest value, or the levels. Of values per vertex only.
    categories : mapping from int to str, optional
        The values are whole numbers that stand for things such as regions: each gets a colour of its own, and a legend
        of names stands in for the bar. Numbers that are not in the mapping are their own names. Not of vertices.
    """

    values: ArrayLike
    colormap: str | None = None
    value_range: tuple[float, float] | None = None
    label: str = ""
    contours: float | Sequence[float] | NDArray[np.float64] | None = None
    categories: Mapping[int, str] | None = None

    @classmethod
    def of(cls, given: SurfaceValues | ArrayLike) -> SurfaceValues:
        """Values with how to colour them, as they are or by default."""
        return given if isinstance(given, SurfaceValues) else cls(given)


NamedValues: TypeAlias = Mapping[str, SurfaceValues | ArrayLike]


@dataclass(frozen=True)
class ColorScale:
    """Which colour stands for which number: a map of Matplotlib's between two numbers."""

    colormap: str
    low: float
    high: float

    def __post_init__(self) -> None:
        if not (np.isfinite([self.low, self.high]).all() and self.low < self.high):
            raise InvalidOption(f"value_range {(self.low, self.high)}: give two finite numbers, the smaller one first")
        _find_map(self.colormap)

    def colors(self, values: NDArray[np.float64], missing: Color) -> NDArray[np.float64]:
        """Display RGB, (..., 3) float64 in 0 to 1, of numbers (...); `missing` for those that are not finite."""
        finite = np.isfinite(values)
        # Halves, because the difference of two finite numbers may be infinite.
        fraction = (0.5 * np.where(finite, values, 0.0) - 0.5 * self.low) / (0.5 * self.high - 0.5 * self.low)
        rgb = _find_map(self.colormap)(np.clip(fraction, 0.0, 1.0))[..., :3]
        return np.where(finite[..., None], rgb, missing)

    def ticks(self) -> list[float]:
        """Round numbers from one end of the scale to the other, at least two where there is room."""
        locator = import_matplotlib("matplotlib.ticker").MaxNLocator(_MOST_TICK_INTERVALS, steps=[1, 2, 2.5, 5, 10])
        # Rounding may put the tick that belongs to an end just beyond it.
        slack = 1e-9 * (self.high - self.low)
        values = locator.tick_values(self.low, self.high)
        return [float(value) for value in values if self.low - slack <= value <= self.high + slack]


@dataclass(frozen=True)
class CategoryScale:
    """Which colour stands for which whole number; `numbers` ascend, and each has its name and its row of colours."""

    numbers: tuple[int, ...]
    names: tuple[str, ...]
    palette: tuple[Color, ...]

    def indices(self, values: NDArray[np.float64]) -> NDArray[np.int64]:
        """Position (...) of numbers (...) in `numbers`; -1 for those that are not there."""
        known = np.array(self.numbers, dtype=np.float64)
        place = np.minimum(np.searchsorted(known, values), len(known) - 1)
        return np.where(known[place] == values, place, -1) if len(known) else np.full(np.shape(values), -1)

    def colors(self, values: NDArray[np.float64], missing: Color) -> NDArray[np.float64]:
        """Display RGB, (..., 3) float64 in 0 to 1, of numbers (...); `missing` for those that have no colour."""
        return np.array([*self.palette, missing], dtype=np.float64)[self.indices(values)]


Scale: TypeAlias = ColorScale | CategoryScale


@dataclass(frozen=True)
class Key:
    """What a colour bar or a legend explains."""

    scale: Scale
    label: str
    some_missing: bool


@dataclass(frozen=True)
class ValueColors:
    """Display RGB of values: `colors` (T, 3, 3) float64 of the corners of triangles, or (V, 3) of vertices."""

    colors: NDArray[np.float64]
    key: Key


def corner_colors(
    given: SurfaceValues | ArrayLike, triangles: NDArray[np.int64], vertex_count: int, missing: Color
) -> ValueColors:
    """Give a colour to each corner of the triangles (T, 3) of a surface.

    Raises
    ------
    InvalidOption
        There is not one value per triangle or vertex, the range is not one, or the colour map is unknown.
    MissingDependency
        Matplotlib is not installed.
    """
    values = SurfaceValues.of(given)
    return _colored(values, corner_values(values, triangles, vertex_count), missing)


def vertex_colors(given: SurfaceValues | ArrayLike, vertex_count: int, missing: Color) -> ValueColors:
    """Give a colour to each vertex of tubes, (V, 3); errors as of `corner_colors`."""
    values = SurfaceValues.of(given)
    numbers = _numbers(values.values)
    if numbers.shape != (vertex_count,):
        raise InvalidOption(f"values of shape {numbers.shape} on tubes: give one per vertex ({vertex_count},)")
    return _colored(values, numbers, missing)


def _colored(values: SurfaceValues, numbers: NDArray[np.float64], missing: Color) -> ValueColors:
    finite = np.isfinite(numbers)
    scale = make_scale([values], numbers[finite])
    return ValueColors(scale.colors(numbers, missing), Key(scale, values.label, not bool(finite.all())))


def joined_keys(keys: Sequence[Key]) -> list[Key]:
    """What bars and legends explain, each scale with its label once, in the order of their first use."""
    joined: dict[tuple[Scale, str], Key] = {}
    for key in keys:
        known = joined.get((key.scale, key.label), key)
        joined[key.scale, key.label] = replace(known, some_missing=known.some_missing or key.some_missing)
    return list(joined.values())


def make_scale(given: Sequence[SurfaceValues], finite_values: NDArray[np.float64]) -> Scale:
    """The scale of values that are shown together; the first map, range and categories that are given count for all.

    Raises
    ------
    InvalidOption
        The range is not one, the map is unknown, or categories are not whole numbers or too many.
    MissingDependency
        Matplotlib is not installed.
    """
    colormap = _first(values.colormap for values in given)
    if any(values.categories is not None for values in given):
        return _category_scale(given, finite_values, colormap)
    low, high = _first(values.value_range for values in given) or range_of(finite_values)
    return ColorScale(colormap or _DEFAULT_MAP, float(low), float(high))


def shared_values(given: Sequence[SurfaceValues], numbers: NDArray[np.float64], name: str) -> list[SurfaceValues]:
    """Values (finite numbers of all of them are known) that are shown together: all with one scale and one label."""
    scale = make_scale(given, numbers)
    label = shared_label(given, name)
    if isinstance(scale, CategoryScale):
        names = dict(zip(scale.numbers, scale.names, strict=True))
        colormap = _first(values.colormap for values in given)
        return [replace(values, colormap=colormap, label=label, categories=names) for values in given]
    ends = (scale.low, scale.high)
    return [replace(values, colormap=scale.colormap, value_range=ends, label=label) for values in given]


def shared_label(given: Sequence[SurfaceValues], name: str) -> str:
    """The first label of values that are shown together, or their name."""
    return str(_first(values.label or None for values in given) or name)


def corner_values(
    given: SurfaceValues | ArrayLike, triangles: NDArray[np.int64], vertex_count: int
) -> NDArray[np.float64]:
    """Values (T, 3) at the corners of triangles; NaN at all three of a triangle where one is not finite."""
    values = SurfaceValues.of(given)
    array = _numbers(values.values)
    if array.shape == (len(triangles),):
        if values.contours is not None:
            raise InvalidOption(f"contours need one value per vertex ({vertex_count},): those per triangle have jumps")
        corners = np.repeat(array[:, None], 3, axis=1)
    elif array.shape == (vertex_count,):
        if values.categories is not None:
            raise InvalidOption(f"categories need one number per triangle ({len(triangles)},): vertices would mix them")
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


def _numbers(values: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidOption(f"surface_values: {error}; give one number per triangle or vertex") from error


def _first(items: Any) -> Any:
    """The first item that is not None, or None."""
    return next((item for item in items if item is not None), None)


def _find_map(name: str) -> Any:
    maps = import_matplotlib().colormaps
    if name not in maps:
        raise InvalidOption(f"colormap {name!r}: give a name that Matplotlib knows, such as viridis")
    return maps[name]


def _category_scale(
    given: Sequence[SurfaceValues], finite_values: NDArray[np.float64], colormap: str | None
) -> CategoryScale:
    there = np.unique(finite_values)
    if (there != np.rint(there)).any():
        raise InvalidOption(f"categories: {there[there != np.rint(there)][0]:g} among the values is no whole number")
    names = {int(number): f"{number:.0f}" for number in there[: _MOST_CATEGORIES + 1]}
    for values in reversed(given):
        names |= {int(number): str(name) for number, name in (values.categories or {}).items()}
    if len(names) > _MOST_CATEGORIES:
        raise InvalidOption(f"there are more than {_MOST_CATEGORIES} categories: nobody can tell so many colours apart")
    numbers = tuple(sorted(names))
    return CategoryScale(numbers, tuple(names[number] for number in numbers), _palette(len(numbers), colormap))


def _palette(count: int, colormap: str | None) -> tuple[Color, ...]:
    """As many colours of a map, all different: the first ones of a map of separate colours, others evenly spaced."""
    for name in _CATEGORY_MAPS if colormap is None else (colormap,):
        separate = [color for color in getattr(_find_map(name), "colors", []) if np.ptp(color[:3]) > _LEAST_SATURATION]
        if len(separate) < 256 and count <= len(separate):  # noqa: PLR2004  (maps of 256 colours are even ones)
            return tuple((float(r), float(g), float(b)) for r, g, b, *_ in separate[:count])
    even = _find_map(colormap or _MANY_CATEGORIES_MAP)((np.arange(count) + 0.5) / max(count, 1))
    return tuple((float(r), float(g), float(b)) for r, g, b, _ in even)
