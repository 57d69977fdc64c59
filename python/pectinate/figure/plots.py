"""Plots of placements: how long streamlines are (the paper's Fig. 7), and how far apart (Fig. 6B)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from pectinate.errors import InvalidOption
from pectinate.figure.files import check_picture_path, save_picture
from pectinate.figure.plotting import import_matplotlib

_INK, _FILL, _PAPER = "#3c3836", "#b8aca0", "white"
_SIZE = (5.0, 3.4)  # inches
_RESOLUTION = 160  # dots per inch


def draw_lengths(
    lengths: Sequence[ArrayLike], path: str | os.PathLike[str] | None = None, *, bin_count: int = 20
) -> Image.Image:
    """Draw a histogram of streamlines' lengths; for several placements the mean and the standard deviation per bin.

    Parameters
    ----------
    lengths : sequence of (n,) float
        mm, of each placement.
    path
        Where to write the picture; by default nowhere.
    bin_count
        At least 1.

    Returns
    -------
    PIL.Image.Image
        RGB.

    Raises
    ------
    InvalidOption
        There is no placement, a length is no finite number of at least 0, or `bin_count` is below 1.
    InvalidFile
        The picture cannot be written.
    MissingDependency
        Matplotlib is not installed.
    """
    check_picture_path(path)
    edges, counts = length_bins(lengths, bin_count)
    figure, axes = _axes("streamline length (mm)", "streamlines")
    deviations = counts.std(axis=0) if len(counts) > 1 else None
    look = {"align": "edge", "color": _FILL, "edgecolor": _PAPER, "ecolor": _INK, "capsize": 2}
    axes.bar(edges[:-1], counts.mean(axis=0), np.diff(edges), yerr=deviations, **look)
    axes.set_xlim(0, edges[-1])
    axes.yaxis.set_major_locator(import_matplotlib("matplotlib.ticker").MaxNLocator(integer=len(counts) == 1))
    return _finish(figure, path)


def draw_spacing(
    separations: ArrayLike, spacings: ArrayLike, path: str | os.PathLike[str] | None = None
) -> Image.Image:
    """Draw the mean spacing d_avg against the separation distance d_sep, with the line through the origin that fits.

    Parameters
    ----------
    separations, spacings : (n,) float
        d_sep and d_avg of each placement, mm, above 0.
    path
        Where to write the picture; by default nowhere.

    Returns
    -------
    PIL.Image.Image
        RGB.

    Raises
    ------
    InvalidOption
        There is no pair of numbers, or one is not above 0.
    InvalidFile, MissingDependency
        As `draw_lengths`.
    """
    check_picture_path(path)
    pairs = [np.asarray(numbers, dtype=np.float64) for numbers in (separations, spacings)]
    if pairs[0].ndim != 1 or pairs[0].shape != pairs[1].shape or not len(pairs[0]):
        shapes = f"separations {pairs[0].shape} and spacings {pairs[1].shape}"
        raise InvalidOption(f"{shapes}: give a row of each, of the same length")
    if not all(np.isfinite(numbers).all() and (numbers > 0).all() for numbers in pairs):
        raise InvalidOption("separations and spacings must be finite and above 0")
    slope = spacing_slope(*pairs)
    figure, axes = _axes("$d_{sep}$ (mm)", "$d_{avg}$ (mm)")
    end = 1.08 * pairs[0].max()
    axes.plot([0, end], [0, slope * end], color=_FILL, zorder=1, label=rf"$d_{{avg}} = {slope:.3f}\, d_{{sep}}$")
    axes.scatter(*pairs, color=_INK, s=18, zorder=2)
    axes.set(xlim=(0, end), ylim=(0, None))
    axes.legend(frameon=False, labelcolor=_INK)
    return _finish(figure, path)


def length_bins(lengths: Sequence[ArrayLike], bin_count: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Count the lengths of each placement in equal bins from 0 to the longest of all.

    Returns
    -------
    edges : (bin_count + 1,) float64
        mm; up to 1 where there is no length.
    counts : (placements, bin_count) int64
        Streamlines.
    """
    if not isinstance(bin_count, int) or bin_count < 1:
        raise InvalidOption(f"bin_count {bin_count}: give a whole number of at least 1")
    arrays = [np.asarray(numbers, dtype=np.float64) for numbers in lengths]
    if not arrays:
        raise InvalidOption("lengths is empty: give those of at least one placement")
    if any(array.ndim != 1 or not np.isfinite(array).all() or (array < 0).any() for array in arrays):
        raise InvalidOption("lengths: give rows of finite numbers of at least 0")
    longest = max((array.max() for array in arrays if len(array)), default=0.0) or 1.0
    edges = np.linspace(0, longest, bin_count + 1)
    return edges, np.array([np.histogram(array, edges)[0] for array in arrays])


def spacing_slope(separations: NDArray[np.float64], spacings: NDArray[np.float64]) -> float:
    """Least-squares factor from separation distances to spacings."""
    return float(separations @ spacings / (separations @ separations))


def _axes(x_label: str, y_label: str) -> tuple[Any, Any]:
    figure = import_matplotlib("matplotlib.figure").Figure(
        _SIZE, dpi=_RESOLUTION, facecolor=_PAPER, layout="constrained"
    )
    axes = figure.subplots()
    axes.set_xlabel(x_label, color=_INK)
    axes.set_ylabel(y_label, color=_INK)
    axes.tick_params(colors=_INK)
    for name, spine in axes.spines.items():
        spine.set_color(_INK)
        spine.set_visible(name in ("left", "bottom"))
    return figure, axes


def _finish(figure: Any, path: str | os.PathLike[str] | None) -> Image.Image:
    canvas = import_matplotlib("matplotlib.backends.backend_agg").FigureCanvasAgg(figure)
    canvas.draw()
    return save_picture(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"), path)
