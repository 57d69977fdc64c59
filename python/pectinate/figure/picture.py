"""One picture of a surface with tubes on it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.depth_map import DepthMap, Grid, Window, draw_depth_map, pick_depth_map
from pectinate.figure.frame import Frame, extent, fitting_scale, middle
from pectinate.figure.offscreen import Canvas, Stage, open_canvas
from pectinate.figure.patient_axes import PatientAxes
from pectinate.figure.shading import Style, box_downsample, fold_losses, fold_shadow
from pectinate.figure.shape import Drawing, Layer, check_drawing, patches
from pectinate.figure.triangles import Triangles
from pectinate.figure.values import SurfaceValues
from pectinate.figure.views import View, resolve_view

FOLD_SIZE = 0.035
"""The folds that are darkened: those about this share of the surface's diagonal wide and half as deep."""

TILE = 2304
"""Pixels, with supersampling, across the tiles that a large picture is drawn in."""

_STRIP = 64
"""Rows of a tile that are finished together: what is made of them on the way stays small."""

_LARGEST_SUPERSAMPLING = 8

_Tile: TypeAlias = tuple[NDArray[np.int64], NDArray[np.int64]]


def render_view(  # noqa: PLR0913
    surface: Triangles,
    tubes: Triangles | None = None,
    *,
    layers: Sequence[Layer] = (),
    surface_values: SurfaceValues | ArrayLike | None = None,
    view: str | View = "anterior",
    axes: str | PatientAxes = "LPS",
    size: tuple[int, int] = (700, 700),
    mm_per_pixel: float | None = None,
    supersampling: int = 2,
    transparent: bool = False,
    style: Style = Style(),  # noqa: B008  (immutable)
) -> NDArray[np.uint8]:
    """Draw a surface, with tubes on it, from one direction in orthographic projection.

    The middle of the picture is the middle of what is drawn. The same input gives the same bytes on the same OpenGL.

    Parameters
    ----------
    surface : (vertices, triangles)
        (V, 3) float in mm and (T, 3) int, counter-clockwise seen from outside.
    tubes : (vertices, triangles), optional
        Closed tubes, likewise, in `style.tube_color`.
    layers : sequence of Layer
        More tubes, in colours of their own.
    surface_values : SurfaceValues or (T,) or (V,) float, optional
        Numbers per triangle or vertex that colour the outside of the surface.
    view : str or View
        One of `STANDARD_VIEWS`, "principal", or any `View`.
    axes : str or PatientAxes
        Where +x, +y and +z point in the patient, for the standard views.
    size : tuple of 2 int
        Width and height in pixels.
    mm_per_pixel : float, optional
        Scale; by default the largest picture that fits with a margin.
    supersampling : int
        Pixels drawn across each pixel of the picture, 1 to 8.
    transparent : bool
        Whether to leave out the background and return RGBA.
    style : Style
        Colours and light.

    Returns
    -------
    (height, width, 3) uint8, or (height, width, 4) if `transparent`
        RGB, or RGBA with straight (not premultiplied) alpha.

    Raises
    ------
    InvalidMesh
        If there is no triangle to draw, a vertex in use is not finite, or an index is out of range.
    InvalidOption
        If an option is out of its range, or there is not one value per triangle or vertex.
    RenderingUnavailable
        If there is no offscreen OpenGL; the message names the packages to install.
    MissingDependency
        If there are values to show, but Matplotlib is not installed.
    """
    drawing = check_drawing(surface, tubes, layers, surface_values, style)
    points = drawing.points
    looking = resolve_view(view, points, axes)
    if mm_per_pixel is None:
        mm_per_pixel = fitting_scale(extent(points, looking), size)
    frame = Frame(looking, middle(points, looking), size, mm_per_pixel)
    with open_canvas() as canvas:
        return draw_frame(canvas, drawing, frame, supersampling, style, transparent=transparent).picture


@dataclass(frozen=True)
class Drawn:
    """A picture, (h, w, 3) or (h, w, 4) uint8, and what hides what in it."""

    picture: NDArray[np.uint8]
    frame: Frame
    nearest: float
    depth_map: DepthMap

    def sees(self, points: NDArray[np.float64], tolerance: float) -> NDArray[np.bool_]:
        """Whether points (n, 3) lie within the picture, and no deeper in mm than a tolerance behind what is drawn."""
        pixels, depth = self.frame.pixels(points), self.nearest - self.frame.seen(points)[:, 2]
        inside = ((pixels >= 0) & (pixels < self.frame.size)).all(axis=1)
        return np.asarray(inside & (depth <= self.depth_map.depth_at(pixels) + tolerance))


def draw_frame(  # noqa: PLR0913
    canvas: Canvas,
    drawing: Drawing,
    frame: Frame,
    supersampling: int,
    style: Style,
    *,
    transparent: bool = False,
    tile: int = TILE,
) -> Drawn:
    """Draw one frame, in tiles: however large it is, little more memory than its pixels is needed.

    The size of the tiles does not show.
    """
    if not isinstance(supersampling, int) or not 1 <= supersampling <= _LARGEST_SUPERSAMPLING:
        raise InvalidOption(f"supersampling {supersampling}: give a whole number from 1 to {_LARGEST_SUPERSAMPLING}")
    stage = canvas.load(patches(drawing, frame.view, frame.centre, style))
    fold_size = FOLD_SIZE * drawing.diagonal
    window = frame.window(drawing.points)
    tiles = _tiles(window, max(1, min(tile, canvas.largest_size) // supersampling))
    grid = Grid(frame, window, fold_size, supersampling)
    drawn: Iterable[tuple[NDArray[np.uint8], NDArray[np.float32]]]
    drawn = (_draw_tile(canvas, stage, frame, pixels, supersampling) for pixels in tiles)
    if len(tiles) == 1:
        ((_, depth),) = drawn = list(drawn)
        depth_map = pick_depth_map(grid, depth)
    else:
        depth_map = draw_depth_map(grid, canvas, stage)
    losses = fold_losses(style, shows_values=drawing.shows_values)
    finish = straight_alpha if transparent else partial(on_background, style=style)
    picture = np.empty((*frame.size[::-1], 4 if transparent else 3), dtype=np.uint8)
    picture[:] = finish(np.zeros((1, 1, 4), dtype=np.float32))
    for (columns, rows), (color, depth) in zip(tiles, drawn, strict=True):
        for start in range(0, len(rows), _STRIP):
            strip = rows[start : start + _STRIP]
            samples = slice(start * supersampling, (start + len(strip)) * supersampling)
            shadow = None
            if style.fold_darkness > 0 and fold_size > 0:
                surroundings = depth_map.surroundings_at(columns, strip)
                shadow = fold_shadow(depth[samples], surroundings, 0.5 * fold_size)
            finished = finish(box_downsample(color[samples], supersampling, shadow, losses))
            picture[strip[0] : strip[-1] + 1, columns[0] : columns[-1] + 1] = finished
    return Drawn(picture, frame, stage.nearest, depth_map)


def _tiles(window: Window, side: int) -> list[_Tile]:
    """Columns and rows of each tile."""
    (left, top), (right, bottom) = window
    return [
        (np.arange(column, min(column + side, right)), np.arange(row, min(row + side, bottom)))
        for row, column in itertools.product(range(top, bottom, side), range(left, right, side))
    ]


def _draw_tile(
    canvas: Canvas,
    stage: Stage,
    frame: Frame,
    pixels: _Tile,
    supersampling: int,
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Draw some columns and rows of a frame: premultiplied RGBA and depth, with supersampling."""
    middle_x, middle_y = (
        (0.5 * (some[0] + some[-1] + 1) - 0.5 * whole) * frame.mm_per_pixel
        for some, whole in zip(pixels, frame.size, strict=True)
    )
    size = (len(pixels[0]) * supersampling, len(pixels[1]) * supersampling)
    return canvas.draw(stage, size, frame.mm_per_pixel / supersampling, (middle_x, -middle_y))


def on_background(premultiplied: NDArray[np.float32], style: Style) -> NDArray[np.uint8]:
    """RGB (h, w, 3) uint8 of a drawing laid on the background of its style."""
    uncovered = 1 - premultiplied[:, :, 3:]
    return _to_bytes(premultiplied[:, :, :3] + uncovered * np.asarray(style.background_color, dtype=np.float32))


def straight_alpha(premultiplied: NDArray[np.float32]) -> NDArray[np.uint8]:
    """RGBA (h, w, 4) uint8 of a drawing without background."""
    image = premultiplied.copy()
    alpha = image[:, :, 3:]
    image[:, :, :3] /= np.where(alpha > 0, alpha, 1)
    return _to_bytes(image)


def _to_bytes(image: NDArray[np.float32]) -> NDArray[np.uint8]:
    return np.rint(np.clip(image, 0, 1) * 255).astype(np.uint8)
