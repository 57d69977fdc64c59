"""How a sheet is divided: rows and columns of pictures, with room for their titles."""

from __future__ import annotations

from dataclasses import dataclass

from PIL import Image

from pectinate.figure.frame import check_size
from pectinate.figure.shading import Style
from pectinate.figure.writing import LETTERS, ink_color, paper_color, upright, write

# Of the height of a picture: the band for a label or for the title of a column or row, and that for the sheet's title.
_LABEL_BAND, _TITLE_BAND = 0.09, 0.135
_TITLE_LETTERS = 1.4 * LETTERS


@dataclass(frozen=True)
class Layout:
    """Where the pictures of a sheet and their titles are.

    Parameters
    ----------
    rows, columns : int
        Of pictures.
    size : tuple of 2 int
        Width and height of each picture.
    labels : bool
        Whether there is a band below each row of pictures.
    title : str, optional
        Of the sheet.
    row_titles, column_titles : tuple of str
        Left of the rows, above the columns; there is no room for them where there are none.
    """

    rows: int
    columns: int
    size: tuple[int, int]
    labels: bool = True
    title: str | None = None
    row_titles: tuple[str, ...] = ()
    column_titles: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_size((self._left + self.columns * self.size[0], self._top + self.rows * (self.size[1] + self._band)))

    @property
    def _band(self) -> int:
        return round(_LABEL_BAND * self.size[1]) if self.labels else 0

    @property
    def _title_height(self) -> int:
        return round(_TITLE_BAND * self.size[1]) if self.title else 0

    @property
    def _top(self) -> int:
        return self._title_height + (round(_LABEL_BAND * self.size[1]) if any(self.column_titles) else 0)

    @property
    def _left(self) -> int:
        return round(_LABEL_BAND * self.size[1]) if any(self.row_titles) else 0

    def corner(self, row: int, column: int) -> tuple[int, int]:
        """Upper left corner of a picture in the sheet."""
        return self._left + column * self.size[0], self._top + row * (self.size[1] + self._band)

    def sheet(self, style: Style, *, transparent: bool = False) -> Image.Image:
        """The sheet with its titles, without pictures."""
        width, height = self.size
        whole = (self._left + self.columns * width, self._top + self.rows * (height + self._band))
        paper, ink, letters = paper_color(style), ink_color(style), LETTERS * height
        sheet = Image.new("RGBA", whole, (*paper, 0)) if transparent else Image.new("RGB", whole, paper)
        if self.title:
            write(sheet, (whole[0] / 2, self._title_height / 2), self.title, ink, _TITLE_LETTERS * height)
        for column, title in enumerate(self.column_titles):
            x, y = self.corner(0, column)
            write(sheet, (x + width / 2, (self._title_height + y) / 2), title, ink, 1.15 * letters)
        for row, title in enumerate(self.row_titles):
            text = upright(title, 1.15 * letters, ink)
            place = (self._left - text.width) // 2, self.corner(row, 0)[1] + (height - text.height) // 2
            sheet.paste(ink if sheet.mode == "RGB" else (*ink, 255), place, text.getchannel("A"))
        return sheet

    def put(self, sheet: Image.Image, place: tuple[int, int], picture: Image.Image, label: str, style: Style) -> None:
        """Lay a picture in its row and column, with its label below it."""
        x, y = self.corner(*place)
        sheet.paste(picture, (x, y))
        if self.labels and label:
            width, height = self.size
            write(sheet, (x + width / 2, y + height + self._band / 2), label, ink_color(style), LETTERS * height)
