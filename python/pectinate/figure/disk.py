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
from pectinate.figure.shading import unit
from pectinate.figure.values import ColorScale

_INK, _PAPER = "#3c3836", "white"
# The disk's diameter is one inch, so that the resolution in dots per inch is its diameter in pixels. Inches:
_WIDTH, _HEIGHT, _LEFT, _BOTTOM = 1.2, 1.08, 0.02, 0.06
_BAR = (1.05, 0.24, 0.03, 0.64)
_POINTS_PER_INCH = 72
# Points:
_LETTERS, _OUTLINE, _ISOLINE, _DOT = 2.3, 0.12, 0.07, 0.6
_LEAST_SIZE, _GREATEST_SIZE = 100, 10_000
# Of a unit vector's component: more is not level, or not upright.
_SLANTED = 0.35

Circle = tuple[float, float, float]
"""x and y of the centre, and the radius, in the disk's coordinates."""

WHOLE_DISK: Circle = (0.0, 0.0, 1.0)


def draw_disk(  # noqa: PLR0913
    parameterization: _core.Parameterization,
    frame: _core.ReferenceFrame,
    mesh: _core.SurfaceMesh,
    path: str | os.PathLike[str] | None = None,
    *,
    loop_names: Mapping[int, str] | None = None,
    origin_name: str = "",
    window: Circle = WHOLE_DISK,
    lens: Circle | None = None,
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
        Names of boundary loops by their index in `mesh.boundary_loops`, empty for none; the others are numbered.
    origin_name : str
        Name of the place where u_D is 0, for frames with an inner point.
    window : tuple of 3 float
        x and y of the centre and radius of the part of the disk that is shown.
    lens : tuple of 3 float, optional
        A circle that is marked, such as the window of a second picture, of holes that the map has shrunk.
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
    for name, circle in (("window", window), ("lens", lens or WHOLE_DISK)):
        _check_circle(name, circle)
    _check_options(isoline_count, size)
    ColorScale(colormap, 0.0, 1.0)
    names = _loop_names(mesh, loop_names or {})
    figure = import_matplotlib("matplotlib.figure").Figure((_WIDTH, _HEIGHT), dpi=size, facecolor=_PAPER)
    axes = _round_axes(figure, window)
    _draw_function(axes, parameterization.points, mesh, frame.u, (colormap, isoline_count))
    origin = parameterization.points[frame.u == np.nanmin(frame.u)].mean(axis=0)
    _draw_holes(axes, parameterization, mesh, names, origin)
    if origin_name:
        axes.scatter(*origin, s=_DOT**2, facecolor=_INK, linewidth=0, zorder=3).set_clip_path(axes.patches[0])
        _write_beside(axes, origin_name, origin, np.array([0.0, -1.0]))
    if lens is not None:
        _draw_lens(axes, lens)
    if window == WHOLE_DISK:
        _write_below(figure, names[parameterization.outer_loop])
    _draw_color_bar(figure, axes)
    canvas = import_matplotlib("matplotlib.backends.backend_agg").FigureCanvasAgg(figure)
    canvas.draw()
    return save_picture(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"), path)


def _check(parameterization: _core.Parameterization, frame: _core.ReferenceFrame, mesh: _core.SurfaceMesh) -> None:
    for what, rows in (("parameterization", parameterization.points), ("frame", frame.u)):
        if len(rows) != len(mesh.vertices):
            raise InvalidOption(
                f"the {what} has {len(rows)} vertices, the mesh {len(mesh.vertices)}: give those of one surface"
            )


def _check_circle(name: str, circle: Circle) -> None:
    if len(circle) != 3 or not np.isfinite(circle).all() or circle[2] <= 0:  # noqa: PLR2004
        raise InvalidOption(f"{name} {circle}: give the centre's x and y and a radius above 0")


def _check_options(isoline_count: int, size: int) -> None:
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


def _round_axes(figure: Any, window: Circle) -> Any:
    """Axes that show the window as a circle of one inch, their first patch; what is drawn is to be cut off there."""
    x, y, radius = window
    axes = figure.add_axes((_LEFT / _WIDTH, _BOTTOM / _HEIGHT, 1 / _WIDTH, 1 / _HEIGHT))
    axes.set(xlim=(x - radius, x + radius), ylim=(y - radius, y + radius))
    axes.axis("off")
    outline = _circle(0.5, 0.5, 0.5, transform=axes.transAxes, linewidth=_OUTLINE, clip_on=False, zorder=4)
    axes.add_patch(outline)
    return axes


def _draw_lens(axes: Any, lens: Circle) -> None:
    axes.add_patch(_circle(*lens, linewidth=_OUTLINE, linestyle=(0, (8, 6)), zorder=4)).set_clip_path(axes.patches[0])


def _circle(x: float, y: float, radius: float, **properties: Any) -> Any:
    shape = import_matplotlib("matplotlib.patches").Circle
    return shape((x, y), radius, fill=False, edgecolor=_INK, **properties)


def _draw_function(
    axes: Any, points: NDArray[np.float64], mesh: _core.SurfaceMesh, u: NDArray[np.float64], look: tuple[str, int]
) -> None:
    """Colours, and a number of isolines, of a function per vertex, where it and the map are finite."""
    circle, (colormap, isoline_count) = axes.patches[0], look
    finite = np.isfinite(points).all(axis=1) & np.isfinite(u)
    mapped = mesh.triangles[finite[mesh.triangles].all(axis=1)]
    # Matplotlib refuses NaN even where no triangle uses it.
    x, y, values = (np.where(finite, array, 0.0) for array in (*points.T, u))
    colored = axes.tripcolor(x, y, mapped, values, shading="gouraud", cmap=colormap, vmin=0.0, vmax=1.0)
    colored.set_clip_path(circle)
    if isoline_count:
        levels = np.linspace(0.0, 1.0, isoline_count + 2)[1:-1]
        axes.tricontour(x, y, mapped, values, levels, colors=_PAPER, linewidths=_ISOLINE).set_clip_path(circle)


def _draw_holes(
    axes: Any,
    parameterization: _core.Parameterization,
    mesh: _core.SurfaceMesh,
    names: list[str],
    origin: NDArray[np.float64],
) -> None:
    """Holes in white, those too small to be seen as dots; names in holes with room, else away from where u is 0."""
    points_per_length = _POINTS_PER_INCH / np.ptp(axes.get_xlim())
    look = {"facecolor": _PAPER, "edgecolor": _INK, "linewidth": _OUTLINE, "zorder": 3}
    for loop, name in enumerate(names):
        outline = parameterization.points[mesh.boundary_loops[loop].vertices]
        if loop == parameterization.outer_loop or not np.isfinite(outline).all():
            continue
        centre, width = outline.mean(axis=0), points_per_length * np.ptp(outline, axis=0).min()
        hole = axes.scatter(*centre, s=_DOT**2, **look) if width < _DOT else axes.fill(*outline.T, **look)[0]
        hole.set_clip_path(axes.patches[0])
        if width > _LETTERS * (1 + len(name)):
            axes.annotate(name, centre, ha="center", va="center", fontsize=_LETTERS, color=_INK, zorder=5)
        elif name:
            # The hole where u is 0 has its name on the side where the middle of the disk is not.
            around = np.linalg.norm(centre - origin) <= np.ptp(outline, axis=0).max()
            away = unit((centre if around else centre - origin)[None])[0]
            _write_beside(axes, name, outline[np.argmax(outline @ away)], away)


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


def _write_below(figure: Any, text: str) -> None:
    place = ((_LEFT + 0.5) / _WIDTH, 0.4 * _BOTTOM / _HEIGHT)
    figure.text(*place, text, color=_INK, ha="center", va="center", fontsize=_LETTERS)


def _draw_color_bar(figure: Any, axes: Any) -> None:
    left, bottom, width, height = _BAR
    place = figure.add_axes((left / _WIDTH, bottom / _HEIGHT, width / _WIDTH, height / _HEIGHT))
    bar = figure.colorbar(axes.collections[0], cax=place)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=_LETTERS, length=0.5, width=_OUTLINE, pad=0.5, colors=_INK)
    bar.ax.set_title("$u_D$", fontsize=1.2 * _LETTERS, color=_INK, pad=1.5)
