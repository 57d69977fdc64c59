"""The bar that says which colour stands for which number."""

from __future__ import annotations

import numpy as np
from PIL import Image, ImageDraw

from pectinate.figure.shading import Style
from pectinate.figure.values import ColorScale, CornerColors
from pectinate.figure.writing import LETTERS, Rgb, font, ink_color, lay_on, paper_color, upright, write

# Shares of a view's height.
_BAR_HEIGHT, _BAR_WIDTH, _MARGIN, _TICK = 0.62, 0.04, 0.035, 0.012
_MISSING_TEXT = "none"


def beside_color_bar(sheet: Image.Image, values: CornerColors, view_height: int, style: Style) -> Image.Image:
    """Lay a sheet beside the colour bar of its values: ticks and label on the right, what has no value below.

    Parameters
    ----------
    sheet : PIL.Image.Image
        The views.
    values : CornerColors
        What the bar explains.
    view_height : int
        Of one view in pixels; sets the size of the bar and its letters.
    style : Style
        Colours of the paper and of what has no value.
    """
    strip = _strip(values, view_height, sheet, style)
    whole = _paper(sheet.mode, (sheet.width + strip.width, sheet.height), style)
    whole.paste(sheet, (0, 0))
    whole.paste(strip, (sheet.width, 0))
    return whole


def _strip(values: CornerColors, view_height: int, sheet: Image.Image, style: Style) -> Image.Image:
    """Draw the bar with its ticks and its label in a strip of a sheet's height."""
    margin, width, tick = (round(share * view_height) for share in (_MARGIN, _BAR_WIDTH, _TICK))
    letters, ink = font(LETTERS * view_height), ink_color(style)
    ticks = values.scale.ticks()
    texts = [f"{value:.6g}" for value in ticks] + [_MISSING_TEXT] * values.some_missing
    text_width = max((round(letters.getlength(text)) for text in texts), default=0)
    label = upright(values.label, LETTERS * view_height, ink)
    label_left = margin + width + 2 * tick + text_width + margin
    strip = _paper(sheet.mode, (label_left + label.width + margin, sheet.height), style)
    draw = ImageDraw.Draw(strip)
    top, bar_height = bar_rows(view_height, sheet.height)
    bottom = top + bar_height
    strip.paste(_gradient(values.scale, width, bar_height), (margin, top))
    for value, text in zip(ticks, texts, strict=False):
        share = (value - values.scale.low) / (values.scale.high - values.scale.low)
        y = bottom - 1 - round(share * (bar_height - 1))
        draw.line((margin + width, y, margin + width + tick, y), fill=ink, width=max(1, round(0.15 * tick)))
        write(strip, (margin + width + 2 * tick, y), text, ink, LETTERS * view_height, anchor="lm")
    if values.some_missing:
        box = (margin, bottom + margin, margin + width - 1, bottom + margin + width - 1)
        draw.rectangle(box, fill=_bytes(style.no_value_color))
        beside = (margin + width + 2 * tick, (box[1] + box[3]) / 2)
        write(strip, beside, _MISSING_TEXT, ink, LETTERS * view_height, anchor="lm")
    lay_on(strip, label, (label_left, top + (bar_height - label.height) // 2))
    return strip


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


def _bytes(color: tuple[float, float, float]) -> Rgb:
    red, green, blue = (round(255 * channel) for channel in color)
    return red, green, blue
