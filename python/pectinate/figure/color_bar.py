"""The bar, or the legend, that says which colour stands for which number."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw

from pectinate.figure.shading import Color, Style
from pectinate.figure.values import CategoryScale, ColorScale, Key, joined_keys
from pectinate.figure.writing import LETTERS, Rgb, font, ink_color, lay_on, paper_color, upright, write

# Shares of a view's height.
_BAR_HEIGHT, _BAR_WIDTH, _MARGIN, _TICK = 0.62, 0.04, 0.035, 0.012
# Height of a line of a legend.
_LINE = 0.065
_MISSING_TEXT = "none"


def beside_color_bars(sheet: Image.Image, keys: Sequence[Key], view_height: int, style: Style) -> Image.Image:
    """Lay a sheet beside the colour bars of its values: ticks and label on the right, what has no value below.

    Categories get a legend of their names instead.

    Parameters
    ----------
    sheet : PIL.Image.Image
        The views.
    keys : sequence of Key
        What the bars explain; those that agree share one.
    view_height : int
        Of one view in pixels; sets the size of the bars and their letters.
    style : Style
        Colours of the paper and of what has no value.
    """
    strips = []
    for key in joined_keys(keys):
        make = _legend if isinstance(key.scale, CategoryScale) else _bar
        strips.append(make(key, view_height, sheet, style))
    if not strips:
        return sheet
    whole = _paper(sheet.mode, (sheet.width + sum(strip.width for strip in strips), sheet.height), style)
    x = 0
    for picture in (sheet, *strips):
        whole.paste(picture, (x, 0))
        x += picture.width
    return whole


def _bar(key: Key, view_height: int, sheet: Image.Image, style: Style) -> Image.Image:
    """Draw a bar with its ticks and its label in a strip of a sheet's height."""
    margin, width, tick = (round(share * view_height) for share in (_MARGIN, _BAR_WIDTH, _TICK))
    letters, ink = font(LETTERS * view_height), ink_color(style)
    scale = key.scale
    assert isinstance(scale, ColorScale)
    ticks = scale.ticks()
    texts = [f"{value:.6g}" for value in ticks] + [_MISSING_TEXT] * key.some_missing
    text_width = max((round(letters.getlength(text)) for text in texts), default=0)
    label = upright(key.label, LETTERS * view_height, ink)
    label_left = margin + width + 2 * tick + text_width + margin
    strip = _paper(sheet.mode, (label_left + label.width + margin, sheet.height), style)
    draw = ImageDraw.Draw(strip)
    top, bar_height = bar_rows(view_height, sheet.height)
    bottom = top + bar_height
    strip.paste(_gradient(scale, width, bar_height), (margin, top))
    for value, text in zip(ticks, texts, strict=False):
        share = (value - scale.low) / (scale.high - scale.low)
        y = bottom - 1 - round(share * (bar_height - 1))
        draw.line((margin + width, y, margin + width + tick, y), fill=ink, width=max(1, round(0.15 * tick)))
        write(strip, (margin + width + 2 * tick, y), text, ink, LETTERS * view_height, anchor="lm")
    if key.some_missing:
        _box(strip, (margin, bottom + margin), (style.no_value_color, _MISSING_TEXT), view_height, style)
    lay_on(strip, label, (label_left, top + (bar_height - label.height) // 2))
    return strip


def _legend(key: Key, view_height: int, sheet: Image.Image, style: Style) -> Image.Image:
    """Draw the colours of categories with their names, in a strip of a sheet's height."""
    scale = key.scale
    assert isinstance(scale, CategoryScale)
    entries = list(zip(scale.palette, scale.names, strict=True))
    entries += [(style.no_value_color, _MISSING_TEXT)] * key.some_missing
    # As large as in bars, unless there are so many that they must be smaller.
    size = min(view_height, sheet.height / (_LINE * (len(entries) + 2)))
    margin, width, tick, line = (round(share * size) for share in (_MARGIN, _BAR_WIDTH, _TICK, _LINE))
    letters, ink = font(LETTERS * size), ink_color(style)
    text_width = max(
        (round(letters.getlength(text)) for text in [key.label, *(name for _, name in entries)]), default=0
    )
    strip = _paper(sheet.mode, (margin + width + 2 * tick + text_width + margin, sheet.height), style)
    top = (sheet.height - line * (len(entries) + bool(key.label))) // 2
    if key.label:
        write(strip, (margin, top + 0.4 * line), key.label, ink, LETTERS * size, anchor="lm")
        top += line
    for entry in entries:
        _box(strip, (margin, top), entry, size, style)
        top += line
    return strip


def _box(strip: Image.Image, corner: tuple[int, int], entry: tuple[Color, str], size: float, style: Style) -> None:
    """Draw a square of a colour with a text beside it; `size` as the height of a view for bars."""
    width, tick = (round(share * size) for share in (_BAR_WIDTH, _TICK))
    left, top = corner
    color, text = entry
    ImageDraw.Draw(strip).rectangle((left, top, left + width - 1, top + width - 1), fill=_bytes(color))
    beside = (left + width + 2 * tick, top + (width - 1) / 2)
    write(strip, beside, text, ink_color(style), LETTERS * size, anchor="lm")


def bar_rows(view_height: int, sheet_height: int) -> tuple[int, int]:
    """First row and number of rows of the bar in a sheet."""
    rows = min(round(_BAR_HEIGHT * view_height), sheet_height)
    return (sheet_height - rows) // 2, rows


def _gradient(scale: ColorScale, width: int, height: int) -> Image.Image:
    """The colours from the greatest number at the top to the least; each row that of the number in its middle."""
    share = (np.arange(height)[::-1] + 0.5) / height
    numbers = scale.low * (1 - share) + scale.high * share
    rows = np.rint(255 * scale.colors(numbers, (0.0, 0.0, 0.0))).astype(np.uint8)
    return Image.fromarray(np.repeat(rows[:, None], width, axis=1))


def _paper(mode: str, size: tuple[int, int], style: Style) -> Image.Image:
    """Empty paper, transparent where the mode can be."""
    return Image.new(mode, size, (*paper_color(style), 0)[: len(mode)])


def _bytes(color: Color) -> Rgb:
    red, green, blue = (round(255 * channel) for channel in color)
    return red, green, blue
