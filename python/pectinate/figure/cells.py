"""Sheets of several surfaces: rows and columns of cells, each with parts of its own, all at one scale."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from pectinate.errors import InvalidOption
from pectinate.figure.color_bar import beside_color_bars
from pectinate.figure.files import check_picture_path, save_picture
from pectinate.figure.frame import Frame, fitting_scale, middle, rotated
from pectinate.figure.layout import Layout
from pectinate.figure.markers import RADIUS, draw_markers
from pectinate.figure.offscreen import open_canvas
from pectinate.figure.parts import Marker, Part, nearest_parts, normal_at, three_numbers
from pectinate.figure.patient_axes import PatientAxes
from pectinate.figure.picture import Drawn, draw_frame
from pectinate.figure.polylines import values_at
from pectinate.figure.scale_bar import draw_bar
from pectinate.figure.shading import Style
from pectinate.figure.shape import Drawing, Layer, check_layers, check_surface
from pectinate.figure.values import SurfaceValues, corner_values, shared_values
from pectinate.figure.views import View, resolve_view
from pectinate.figure.writing import ink_color


class MakesPart(Protocol):
    """What can make a part of itself: a `Model` or a `Placement`."""

    def part(self) -> Part:
        """Make the part."""


Shown: TypeAlias = Part | MakesPart
ValuesOf: TypeAlias = Callable[[object], SurfaceValues | None]


@dataclass(frozen=True, eq=False)
class Cell:
    """One picture of a sheet.

    Parameters
    ----------
    parts : Part, Model, Placement or sequence of them
        What is seen; parts that are not `visible` are left out.
    view : str or View
        As in `render_view`.
    title : str
        Below the picture.
    markers : sequence of Marker
        Numbered circles, each shown where nothing hides its place.
    centre : (3,) float, optional
        What lies in the middle, mm; by default the middle of all that is seen.
    """

    parts: Shown | Sequence[Shown]
    view: str | View = "anterior"
    title: str = ""
    markers: Sequence[Marker] = ()
    centre: ArrayLike | None = None


def figure_sheet(  # noqa: PLR0913
    cells: Cell | Sequence[Cell | Sequence[Cell | None] | None],
    path: str | os.PathLike[str] | None = None,
    *,
    size: tuple[int, int] = (640, 560),
    mm_per_pixel: float | None = None,
    axes: str | PatientAxes = "LPS",
    row_titles: Sequence[str] = (),
    column_titles: Sequence[str] = (),
    title: str | None = None,
    scale_bar: bool = True,
    shown_values: str | None = None,
    shown_tube_values: str | None = None,
    hidden_depth: float = 2.0,
    transparent: bool = False,
    supersampling: int = 2,
    style: Style = Style(),  # noqa: B008  (immutable)
    dpi: float = 300.0,
) -> Image.Image:
    """Draw surfaces in rows and columns of pictures, all at one scale.

    Parameters
    ----------
    cells : Cell, or sequence of Cell, or sequence of rows of Cell
        One picture, a row, or rows, in which None leaves a place empty.
    path : path, optional
        Where to write the sheet: `.png`, `.pdf`, ...; by default nowhere.
    size : tuple of 2 int
        Width and height of each picture in pixels.
    mm_per_pixel : float, optional
        Scale; by default the largest at which every picture fits with a margin.
    axes : str or PatientAxes
        Where +x, +y and +z point in the patient, for the standard views.
    row_titles, column_titles : sequence of str
        Left of the rows, above the columns; none, or one for each.
    title : str, optional
        A line above all.
    scale_bar : bool
        Whether the lower right corner gets a bar of a round number of mm.
    shown_values : str, optional
        Name of the values that colour the surfaces, for parts that have them; by default none.
    shown_tube_values : str, optional
        Name of the values that colour the tubes of streamlines, likewise.
    hidden_depth : float
        mm: a marker is hidden where its place lies deeper than this behind what is seen there.
    transparent : bool
        Whether to leave out the background.
    supersampling : int
        Pixels drawn across each pixel of the picture, 1 to 8.
    style : Style
        Colours and light.
    dpi : float
        Pixels per inch that the file tells; a PDF has the size that follows.

    Returns
    -------
    PIL.Image.Image
        RGB, or RGBA if `transparent`.

    Raises
    ------
    InvalidMesh
        A part has no triangle, or a vertex in use is not finite.
    InvalidOption
        There is no cell, a cell has no part, titles do not fit the rows, no part has the shown values, or an option is
        out of its range.
    RenderingUnavailable
        There is no offscreen OpenGL; the message names the packages to install.
    MissingDependency
        There are values to show, but Matplotlib is not installed.
    InvalidFile
        The file cannot be written.
    """
    check_picture_path(path)
    if not (np.isfinite(hidden_depth) and hidden_depth >= 0):
        raise InvalidOption(f"hidden_depth {hidden_depth}: give a finite number of mm, not below 0")
    rows = _rows(cells)
    places = {(i, j): cell for i, row in enumerate(rows) for j, cell in enumerate(row) if cell is not None}
    parts = {place: _parts(cell) for place, cell in places.items()}
    all_parts = [part for some in parts.values() for part in some]
    values = (
        _no_values if shown_values is None else _values_of_surfaces(all_parts, shown_values),
        _no_values if shown_tube_values is None else _values_of_lines(all_parts, shown_tube_values),
    )
    pictures = {place: _Picture.of(cell, parts[place], values, axes, style) for place, cell in places.items()}
    if mm_per_pixel is None:
        width, height = np.max([picture.extent() for picture in pictures.values()], axis=0).tolist()
        mm_per_pixel = fitting_scale((width, height), size)
    columns = max(len(row) for row in rows)
    titles = _titles(row_titles, len(rows), "row_titles"), _titles(column_titles, columns, "column_titles")
    layout = Layout(len(rows), columns, size, any(cell.title for cell in places.values()), title, *titles)
    sheet = layout.sheet(style, transparent=transparent)
    with open_canvas() as canvas:
        for place, picture in pictures.items():
            frame = Frame(picture.view, picture.centre, size, mm_per_pixel)
            drawn = draw_frame(canvas, picture.drawing, frame, supersampling, style, transparent=transparent)
            image = Image.fromarray(drawn.picture)
            _mark(image, drawn, picture, hidden_depth)
            layout.put(sheet, place, image, picture.cell.title, style)
    if scale_bar:
        draw_bar(sheet, mm_per_pixel, size, ink_color(style))
    sheet = beside_color_bars(
        sheet, [key for picture in pictures.values() for key in picture.drawing.keys], size[1], style
    )
    return save_picture(sheet, path, dpi=dpi)


@dataclass(frozen=True)
class _Picture:
    """A cell that is ready to be drawn."""

    cell: Cell
    parts: list[Part]
    drawing: Drawing
    view: View
    centre: NDArray[np.float64]

    @classmethod
    def of(
        cls, cell: Cell, parts: list[Part], values: tuple[ValuesOf, ValuesOf], axes: str | PatientAxes, style: Style
    ) -> _Picture:
        surfaces, layers = [], []
        of_surface, of_lines = values
        for part in parts:
            color = style.surface_color if part.surface_color is None else part.surface_color
            surface = part.placed(part.surface[0]), part.surface[1]
            surfaces.append(check_surface(f"part {part.name!r}", surface, color, of_surface(part), style))
            for lines, tube_color in ((part.streamlines, style.tube_color), (part.tracts, style.tract_color)):
                if lines is not None:
                    tubes, colored = lines.tubes(), of_lines(lines)
                    numbers = None if colored is None else values_at(colored, tubes.vertex_points)
                    layers.append(Layer((part.placed(tubes.vertices), tubes.triangles), tube_color, numbers))
        drawing = Drawing(tuple(surfaces), check_layers(layers, style))
        view = resolve_view(cell.view, drawing.points, axes)
        if cell.centre is None:
            return cls(cell, parts, drawing, view, middle(drawing.points, view))
        return cls(cell, parts, drawing, view, three_numbers(cell.centre, "cell: centre"))

    def extent(self) -> NDArray[np.float64]:
        """Least width and height in mm of a picture, with this centre, that shows everything."""
        seen = rotated(self.drawing.points - self.centre, self.view.rotation())
        return np.asarray(2 * np.abs(seen[:, :2]).max(axis=0))


def _rows(cells: Cell | Sequence[Cell | Sequence[Cell | None] | None]) -> list[list[Cell | None]]:
    given = [cells] if isinstance(cells, Cell) else list(cells)
    if all(cell is None or isinstance(cell, Cell) for cell in given):
        rows = [[cell for cell in given if cell is None or isinstance(cell, Cell)]]
    else:
        rows = [[row] if row is None or isinstance(row, Cell) else list(row) for row in given]
    if not any(isinstance(cell, Cell) for row in rows for cell in row):
        raise InvalidOption("there are no cells: give at least one")
    return rows


def _parts(cell: Cell) -> list[Part]:
    given = cell.parts if isinstance(cell.parts, Sequence) else [cell.parts]
    parts = [item if isinstance(item, Part) else item.part() for item in given]
    visible = [part for part in parts if part.visible]
    if not visible:
        raise InvalidOption(f"cell {cell.title!r} has no visible part: give at least one")
    return visible


def _titles(given: Sequence[str], count: int, name: str) -> tuple[str, ...]:
    titles = (given,) if isinstance(given, str) else tuple(given)
    if titles and len(titles) != count:
        raise InvalidOption(f"{name}: {len(titles)} titles; give {count} or none")
    return titles


def _no_values(_: object) -> None:
    """No part has values that are shown."""


def _values_of_surfaces(parts: list[Part], name: str) -> ValuesOf:
    """What gives each part its values of a name, all on one scale."""
    owners = []
    for part in parts:
        if name in part.surface_values:
            values = SurfaceValues.of(part.surface_values[name])
            vertices, triangles = (np.asarray(array) for array in part.surface)
            owners.append((part, values, corner_values(values, triangles, len(vertices))))
    return _shared(owners, name, "shown_values")


def _values_of_lines(parts: list[Part], name: str) -> ValuesOf:
    """What gives the streamlines of each part their values of a name, all on one scale."""
    owners = []
    for lines in (part.streamlines for part in parts):
        if lines is not None and name in lines.values:
            values = SurfaceValues.of(lines.values[name])
            owners.append((lines, values, np.asarray(values.values, dtype=np.float64)))
    return _shared(owners, name, "shown_tube_values")


def _shared(owners: Sequence[tuple[object, SurfaceValues, NDArray[np.float64]]], name: str, option: str) -> ValuesOf:
    if not owners:
        raise InvalidOption(f"{option} {name!r}: no part has values of that name")
    numbers = np.concatenate([numbers.ravel() for *_, numbers in owners])
    shared = shared_values([values for _, values, _ in owners], numbers[np.isfinite(numbers)], name)
    by_owner = {id(owner): values for (owner, *_), values in zip(owners, shared, strict=True)}
    return lambda owner: by_owner.get(id(owner))


def _mark(image: Image.Image, drawn: Drawn, picture: _Picture, hidden_depth: float) -> None:
    """Draw the markers that are seen."""
    markers = picture.cell.markers
    if not markers:
        return
    towards_viewer = picture.view.rotation()[2]
    texts, anchors = [], []
    for marker, index in zip(markers, nearest_parts(markers, picture.parts), strict=True):
        part, places = picture.parts[index], [marker.position, *marker.alternatives]
        shown = part.placed(places)
        outside = np.array([normal_at(part, place) @ towards_viewer > 0 for place in places])
        seen = np.flatnonzero(drawn.sees(shown, hidden_depth) & outside)
        if len(seen):
            texts.append(marker.text)
            anchors.append(shown[seen[0]])
    if texts:
        draw_markers(image, drawn.frame.pixels(np.stack(anchors)), texts, RADIUS * image.height)
