"""One picture of a surface with tubes on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.offscreen import Canvas, open_canvas
from pectinate.figure.shading import VALUE_SHADE, Style, box_downsample, fold_shadow
from pectinate.figure.shape import Drawing, Layer, Triangles, check_drawing, patches
from pectinate.figure.values import SurfaceValues
from pectinate.figure.views import View, resolve_view

MARGIN = 0.03
"""Least share of a picture's width and height that stays free at each side."""

FOLD_SIZE = 0.035
"""The folds that are darkened: those about this share of the surface's diagonal wide and half as deep."""

_LARGEST_SUPERSAMPLING = 8


@dataclass(frozen=True)
class Frame:
    """Where a picture looks: a view, the middle of the picture and its scale."""

    view: View
    centre: NDArray[np.float64]
    size: tuple[int, int]
    mm_per_pixel: float


def render_view(  # noqa: PLR0913
    surface: Triangles,
    tubes: Triangles | None = None,
    *,
    layers: Sequence[Layer] = (),
    surface_values: SurfaceValues | ArrayLike | None = None,
    view: str | View = "anterior",
    axes: str = "LPS",
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
    axes : str
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
        premultiplied = draw_frame(canvas, drawing, frame, supersampling, style)
    return straight_alpha(premultiplied) if transparent else on_background(premultiplied, style)


def extent(points: NDArray[np.float64], view: View) -> tuple[float, float]:
    """Width and height in mm of points seen along a view."""
    width, height, _ = np.ptp(points @ view.rotation().T, axis=0).tolist()
    return width, height


def middle(points: NDArray[np.float64], view: View) -> NDArray[np.float64]:
    """Middle, (3,) float64 in the coordinates of the points, of their box seen along a view."""
    rotation = view.rotation()
    seen = points @ rotation.T
    return np.asarray(0.5 * (seen.min(axis=0) + seen.max(axis=0)) @ rotation)


def fitting_scale(extent_mm: tuple[float, float], size: tuple[int, int]) -> float:
    """Scale in mm per pixel at which an extent in mm just fits into a picture with its margin."""
    check_size(size)
    scale = max(mm / (pixels * (1 - 2 * MARGIN)) for mm, pixels in zip(extent_mm, size, strict=True))
    return scale if scale > 0 else 1.0


def check_size(size: tuple[int, int]) -> None:
    """Raise InvalidOption unless a size is two positive whole numbers."""
    if not all(isinstance(pixels, (int, np.integer)) and pixels > 0 for pixels in size) or len(size) != 2:  # noqa: PLR2004
        raise InvalidOption(f"size {size}: give the width and the height in pixels, whole numbers above 0")


def draw_frame(canvas: Canvas, drawing: Drawing, frame: Frame, supersampling: int, style: Style) -> NDArray[np.float32]:
    """Draw one frame.

    Returns
    -------
    (height, width, 4) float32
        RGB premultiplied by alpha, all 0 to 1.
    """
    _check(frame, supersampling)
    width, height = frame.size
    fine_size = (width * supersampling, height * supersampling)
    seen = patches(drawing, frame.view, frame.centre, style)
    color, depth = canvas.draw(seen, fine_size, frame.mm_per_pixel / supersampling)
    lit = color.astype(np.float32) / np.float32(255)
    fold_size = FOLD_SIZE * float(np.linalg.norm(np.ptp(drawing.surface.vertices, axis=0)))
    darkness = style.fold_darkness * (1.0 if drawing.colors is None else VALUE_SHADE)
    if darkness > 0 and fold_size > 0:
        radius = min(max(1, round(0.5 * fold_size / frame.mm_per_pixel)), max(frame.size))
        shadow = fold_shadow(depth, supersampling, radius, 0.5 * fold_size)
        lit[:, :, :3] *= (1 - np.float32(darkness) * shadow)[:, :, None]
    return box_downsample(lit, supersampling)


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


def _check(frame: Frame, supersampling: int) -> None:
    check_size(frame.size)
    if not np.isfinite(frame.mm_per_pixel) or frame.mm_per_pixel <= 0:
        raise InvalidOption(f"mm_per_pixel {frame.mm_per_pixel}: give a number above 0")
    if not isinstance(supersampling, int) or not 1 <= supersampling <= _LARGEST_SUPERSAMPLING:
        raise InvalidOption(f"supersampling {supersampling}: give a whole number from 1 to {_LARGEST_SUPERSAMPLING}")
