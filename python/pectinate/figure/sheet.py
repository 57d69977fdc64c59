"""Sheets: several views of one drawing at one scale, with labels and a scale bar."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image

from pectinate.errors import InvalidOption
from pectinate.figure.color_bar import beside_color_bar
from pectinate.figure.frame import Frame, extent, fitting_scale, middle
from pectinate.figure.layout import Layout
from pectinate.figure.offscreen import open_canvas
from pectinate.figure.patient_axes import PatientAxes
from pectinate.figure.picture import draw_frame
from pectinate.figure.scale_bar import draw_bar
from pectinate.figure.shading import Style
from pectinate.figure.shape import Layer, Triangles, check_drawing
from pectinate.figure.values import SurfaceValues
from pectinate.figure.views import STANDARD_VIEWS, View, resolve_view
from pectinate.figure.writing import ink_color


def draw_sheet(  # noqa: PLR0913
    surface: Triangles,
    tubes: Triangles | None = None,
    *,
    layers: Sequence[Layer] = (),
    surface_values: SurfaceValues | ArrayLike | None = None,
    views: str | View | Sequence[str | View] = STANDARD_VIEWS,
    axes: str | PatientAxes = "LPS",
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
    axes : str or PatientAxes
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
    layout = Layout(-(-len(looking) // columns), columns, size, labels, title)
    sheet = layout.sheet(style)
    with open_canvas() as canvas:
        for i, seen in enumerate(looking):
            frame = Frame(seen, middle(drawing.points, seen), size, scale)
            picture = Image.fromarray(draw_frame(canvas, drawing, frame, supersampling, style).picture)
            layout.put(sheet, (i // columns, i % columns), picture, seen.name, style)
    if scale_bar:
        draw_bar(sheet, scale, size, ink_color(style))
    colors = drawing.surfaces[0].colors
    return sheet if colors is None else beside_color_bar(sheet, colors, size[1], style)


def _check_columns(columns: int | None, count: int) -> int:
    if count == 0:
        raise InvalidOption("views is empty: name at least one")
    if columns is None:
        return min(count, 3) if count != 4 else 2  # noqa: PLR2004
    if columns < 1:
        raise InvalidOption(f"columns {columns}: give at least 1")
    return min(columns, count)
