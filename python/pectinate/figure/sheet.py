"""Sheets: several views of one drawing at one scale, with labels and a scale bar."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw

from pectinate.errors import InvalidOption
from pectinate.figure.color_bar import beside_color_bar
from pectinate.figure.offscreen import open_canvas
from pectinate.figure.picture import Frame, draw_frame, extent, fitting_scale, middle, on_background
from pectinate.figure.shading import Style
from pectinate.figure.shape import Layer, Triangles, check_drawing
from pectinate.figure.values import SurfaceValues
from pectinate.figure.views import STANDARD_VIEWS, View, resolve_view
from pectinate.figure.writing import LETTERS, Rgb, font, ink_color, paper_color

# Of the height of a view: the band for its label.
_LABEL_BAND = 0.09
# Scale bars are one of these times a power of ten, at most this share of a view's width.
_ROUND_NUMBERS = (1, 2, 5)
_LONGEST_BAR = 0.28


def draw_sheet(  # noqa: PLR0913
    surface: Triangles,
    tubes: Triangles | None = None,
    *,
    layers: Sequence[Layer] = (),
    surface_values: SurfaceValues | ArrayLike | None = None,
    views: str | View | Sequence[str | View] = STANDARD_VIEWS,
    axes: str = "LPS",
    columns: int | None = None,
    size: tuple[int, int] = (640, 560),
    labels: bool = True,
    scale_bar: bool = True,
    title: str | None = None,
    supersampling: int = 2,
    style: Style = Style(),  # noqa: B008  (immutable)
) -> Image.Image:
    """Draw a surface, with tubes on it, in one or several views at the same scale.

    Parameters
    ----------
    surface, tubes : (vertices, triangles)
        As in `render_view`.
    layers, surface_values
        As in `render_view`. Values bring a colour bar beside the views.
    views : str, View or sequence of them
        What to show, row by row.
    axes : str
        Where +x, +y and +z point in the patient, for the standard views.
    columns : int, optional
        Views in a row; by default as even as can be, at most three.
    size : tuple of 2 int
        Width and height of each view in pixels.
    labels : bool
        Whether each view is named below it.
    scale_bar : bool
        Whether the lower right corner gets a bar of a round number of mm.
    title : str, optional
        A line above all views.
    supersampling, style
        As in `render_view`.

    Returns
    -------
    PIL.Image.Image
        RGB.

    Raises
    ------
    InvalidMesh, InvalidOption, RenderingUnavailable, MissingDependency
        As in `render_view`; InvalidOption also for no view or columns below 1.
    """
    drawing = check_drawing(surface, tubes, layers, surface_values, style)
    named = [views] if isinstance(views, str | View) else list(views)
    looking = [resolve_view(view, drawing.points, axes) for view in named]
    columns = _check_columns(columns, len(looking))
    extents = np.array([extent(drawing.points, view) for view in looking])
    width, height = extents.max(axis=0).tolist()
    scale = fitting_scale((width, height), size)
    with open_canvas() as canvas:
        pictures = [
            on_background(
                draw_frame(
                    canvas, drawing, Frame(view, middle(drawing.points, view), size, scale), supersampling, style
                ),
                style,
            )
            for view in looking
        ]
    names = [view.name for view in looking] if labels else None
    sheet = _arrange(pictures, names, columns, title, style)
    if scale_bar:
        _draw_bar(sheet, scale, size, ink_color(style))
    return sheet if drawing.colors is None else beside_color_bar(sheet, drawing.colors, size[1], style)


def _check_columns(columns: int | None, count: int) -> int:
    if count == 0:
        raise InvalidOption("views is empty: name at least one")
    if columns is None:
        return min(count, 3) if count != 4 else 2  # noqa: PLR2004
    if columns < 1:
        raise InvalidOption(f"columns {columns}: give at least 1")
    return min(columns, count)


def _arrange(
    pictures: list[NDArray[np.uint8]], names: list[str] | None, columns: int, title: str | None, style: Style
) -> Image.Image:
    """Lay pictures out in rows, each with its name below it."""
    height, width = pictures[0].shape[:2]
    band = round(_LABEL_BAND * height) if names else 0
    top = round(1.5 * _LABEL_BAND * height) if title else 0
    rows = math.ceil(len(pictures) / columns)
    sheet = Image.new("RGB", (columns * width, top + rows * (height + band)), paper_color(style))
    draw, ink = ImageDraw.Draw(sheet), ink_color(style)
    for i, picture in enumerate(pictures):
        x, y = i % columns * width, top + i // columns * (height + band)
        sheet.paste(Image.fromarray(picture), (x, y))
        if names:
            draw.text((x + width / 2, y + height + band / 2), names[i], ink, font(LETTERS * height), anchor="mm")
    if title:
        draw.text((sheet.width / 2, top / 2), title, ink, font(1.4 * LETTERS * height), anchor="mm")
    return sheet


def _draw_bar(sheet: Image.Image, mm_per_pixel: float, size: tuple[int, int], ink: Rgb) -> None:
    """Draw a bar of a round length in the sheet's lower right corner."""
    length = _round_length(_LONGEST_BAR * size[0] * mm_per_pixel)
    margin, thickness = round(0.04 * size[1]), max(2, round(0.006 * size[1]))
    right, bottom, pixels = sheet.width - margin, sheet.height - margin, round(length / mm_per_pixel)
    draw = ImageDraw.Draw(sheet)
    # Pillow's rectangles include their last row and column.
    draw.rectangle((right - pixels, bottom - thickness, right - 1, bottom - 1), fill=ink)
    text = f"{length:g} mm"
    draw.text((right - pixels / 2, bottom - 0.015 * size[1]), text, ink, font(LETTERS * size[1]), anchor="mb")


def _round_length(longest: float) -> float:
    """Return the greatest 1, 2 or 5 times a power of ten up to a length."""
    power = 10.0 ** math.floor(math.log10(longest))
    # One times the power always counts: the logarithm may have rounded a length just below a power of ten up to it.
    return max(factor * power for factor in _ROUND_NUMBERS if factor == 1 or factor * power <= longest)
