"""The disk that a surface is mapped to, coloured by the function whose gradient is the reference field (paper Fig. 3A).

Drawn by Matplotlib's Agg backend, which needs neither a window nor OpenGL.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from pectinate import _core
from pectinate.errors import InvalidOption
from pectinate.figure.files import check_picture_path, save_picture
from pectinate.figure.plotting import import_matplotlib
from pectinate.figure.values import ColorScale

_INK, _PAPER = "#3c3836", "white"
# The disk's diameter is one inch, so that the resolution in dots per inch is its diameter in pixels. Inches:
_WIDTH, _HEIGHT, _LEFT, _BOTTOM = 1.2, 1.08, 0.02, 0.06
_BAR = (1.05, 0.24, 0.03, 0.64)
# Points, of which an inch has 72.
_LETTERS, _OUTLINE, _ISOLINE = 2.3, 0.12, 0.07
_LEAST_SIZE, _GREATEST_SIZE = 100, 10_000
# Of a unit vector's component: more is not level, or not upright.
_SLANTED = 0.35
_WHOLE_DISK = (0.0, 0.0, 1.0)


def draw_disk(  # noqa: PLR0913
    parameterization: _core.Parameterization,
    frame: _core.ReferenceFrame,
    mesh: _core.SurfaceMesh,
    path: str | os.PathLike[str] | None = None,
    *,
    loop_names: Mapping[int, str] | None = None,
    window: tuple[float, float, float] = _WHOLE_DISK,
    colormap: str = "viridis",
    isoline_count: int = 9,
    size: int = 900,
) -> Image.Image:
    """Draw the unit disk coloured by u_D, with isolines at even steps and with the holes in white.

    Parameters
    ----------
    parameterization, frame, mesh
        The map, the frame made with it, and the surface of both.
    path
        Where to write the picture; by default nowhere.
    loop_names : mapping of int to str, optional
        Names of boundary loops by their index in `mesh.boundary_loops`; the others are numbered.
    window : tuple of 3 float
        Centre and radius of the part of the disk that is shown: small for a lens on holes that the map has shrunk.
    colormap : str
        A name of Matplotlib's.
    isoline_count : int
        Isolines between 0 and 1; 0 for none.
    size : int
        Diameter of the disk in pixels, 100 to 10,000; the picture is 1.2 times as wide and 1.08 times as high.

    Returns
    -------
    PIL.Image.Image
        RGB.

    Raises
    ------
    InvalidOption
        The map or the frame is that of another mesh, a loop does not exist, or an option is out of its range.
    InvalidFile
        The picture cannot be written.
    MissingDependency
        Matplotlib is not installed.
    """
    check_picture_path(path)
    _check(parameterization, frame, mesh)
    _check_options(window, isoline_count, size)
    scale = ColorScale(colormap, 0.0, 1.0)
    names = _loop_names(mesh, loop_names or {})
    figure = import_matplotlib("matplotlib.figure").Figure((_WIDTH, _HEIGHT), dpi=size, facecolor=_PAPER)
    axes = _round_axes(figure, window)
    _draw_function(axes, parameterization.points, mesh.triangles, frame.u, scale, isoline_count)
    _draw_holes(axes, parameterization, mesh, names)
    _draw_margin(figure, axes, names[parameterization.outer_loop])
    canvas = import_matplotlib("matplotlib.backends.backend_agg").FigureCanvasAgg(figure)
    canvas.draw()
    return save_picture(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"), path)


def _check(parameterization: _core.Parameterization, frame: _core.ReferenceFrame, mesh: _core.SurfaceMesh) -> None:
    for what, rows in (("parameterization", parameterization.points), ("frame", frame.u)):
        if len(rows) != len(mesh.vertices):
            raise InvalidOption(
                f"the {what} has {len(rows)} vertices, the mesh {len(mesh.vertices)}: give those of one surface"
            )


def _check_options(window: tuple[float, float, float], isoline_count: int, size: int) -> None:
    if len(window) != 3 or not np.isfinite(window).all() or window[2] <= 0:  # noqa: PLR2004
        raise InvalidOption(f"window {window}: give the centre's x and y and a radius above 0")
    if not isinstance(isoline_count, int) or isoline_count < 0:
        raise InvalidOption(f"isoline_count {isoline_count}: give a whole number, 0 or more")
    if not isinstance(size, int) or not _LEAST_SIZE <= size <= _GREATEST_SIZE:
        raise InvalidOption(f"size {size}: give a whole number from {_LEAST_SIZE} to {_GREATEST_SIZE}")


def _loop_names(mesh: _core.SurfaceMesh, given: Mapping[int, str]) -> list[str]:
    count = len(mesh.boundary_loops)
    for loop in given:
        if loop not in range(count):
            raise InvalidOption(f"loop_names: there is no boundary loop {loop}; there are {count}, from 0")
    return [given.get(loop, str(loop)) for loop in range(count)]


def _round_axes(figure: Any, window: tuple[float, float, float]) -> Any:
    """Axes that show the window as a circle of one inch; what is drawn in them is cut off there."""
    x, y, radius = window
    axes = figure.add_axes((_LEFT / _WIDTH, _BOTTOM / _HEIGHT, 1 / _WIDTH, 1 / _HEIGHT))
    axes.set(xlim=(x - radius, x + radius), ylim=(y - radius, y + radius))
    axes.axis("off")
    circle = import_matplotlib("matplotlib.patches").Circle(
        (0.5, 0.5), 0.5, transform=axes.transAxes, fill=False, edgecolor=_INK, linewidth=_OUTLINE, clip_on=False
    )
    axes.add_patch(circle).set_zorder(4)
    return axes


def _draw_function(
    axes: Any,
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    u: NDArray[np.float64],
    scale: ColorScale,
    isoline_count: int,
) -> None:
    """Colours and isolines of a function per vertex, where it and the map are finite."""
    circle = axes.patches[0]
    finite = np.isfinite(points).all(axis=1) & np.isfinite(u)
    mapped = triangles[finite[triangles].all(axis=1)]
    # Matplotlib refuses NaN even where no triangle uses it.
    x, y, values = (np.where(finite, array, 0.0) for array in (*points.T, u))
    axes.tripcolor(
        x, y, mapped, values, shading="gouraud", cmap=scale.colormap, vmin=scale.low, vmax=scale.high
    ).set_clip_path(circle)
    if isoline_count:
        levels = np.linspace(scale.low, scale.high, isoline_count + 2)[1:-1]
        axes.tricontour(x, y, mapped, values, levels, colors=_PAPER, linewidths=_ISOLINE).set_clip_path(circle)


def _draw_holes(axes: Any, parameterization: _core.Parameterization, mesh: _core.SurfaceMesh, names: list[str]) -> None:
    """Holes in white, each with its name beside it, away from the other holes."""
    circle = axes.patches[0]
    points, centres = parameterization.points, parameterization.loop_centres
    holes = [loop for loop in range(len(names)) if loop != parameterization.outer_loop]
    holes = [loop for loop in holes if np.isfinite(points[mesh.boundary_loops[loop].vertices]).all()]
    for loop in holes:
        outline = points[mesh.boundary_loops[loop].vertices]
        axes.fill(*outline.T, facecolor=_PAPER, edgecolor=_INK, linewidth=_OUTLINE, zorder=3)[0].set_clip_path(circle)
        away = centres[loop] - centres[holes].mean(axis=0)
        away = away / (np.linalg.norm(away) or 1.0)
        _write_beside(axes, names[loop], centres[loop], away)


def _write_beside(axes: Any, text: str, point: NDArray[np.float64], away: NDArray[np.float64]) -> None:
    """Write at the end of a short leader line from a point."""
    axes.annotate(
        text,
        point,
        xytext=3.0 * _LETTERS * away,
        textcoords="offset points",
        ha="left" if away[0] > _SLANTED else "right" if away[0] < -_SLANTED else "center",
        va="bottom" if away[1] > _SLANTED else "top" if away[1] < -_SLANTED else "center",
        fontsize=_LETTERS,
        color=_INK,
        bbox={"boxstyle": "round,pad=0.2", "facecolor": _PAPER, "alpha": 0.75, "linewidth": 0},
        arrowprops={"arrowstyle": "-", "color": _INK, "linewidth": _OUTLINE, "shrinkA": 0, "shrinkB": 0},
        annotation_clip=True,
        zorder=5,
    )


def _draw_margin(figure: Any, axes: Any, outer_name: str) -> None:
    """The name of the outer loop below the disk, and the colour bar on its right."""
    figure.text(
        (_LEFT + 0.5) / _WIDTH,
        0.4 * _BOTTOM / _HEIGHT,
        outer_name,
        color=_INK,
        ha="center",
        va="center",
        fontsize=_LETTERS,
    )
    left, bottom, width, height = _BAR
    place = figure.add_axes((left / _WIDTH, bottom / _HEIGHT, width / _WIDTH, height / _HEIGHT))
    bar = figure.colorbar(axes.collections[0], cax=place)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=_LETTERS, length=0.5, width=_OUTLINE, pad=0.5, colors=_INK)
    bar.ax.set_title("$u_D$", fontsize=1.2 * _LETTERS, color=_INK, pad=1.5)
