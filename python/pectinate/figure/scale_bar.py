"""The bar of a round length that tells a sheet's scale."""

from __future__ import annotations

import math

from PIL import Image, ImageDraw

from pectinate.figure.writing import LETTERS, Rgb, write

# Scale bars are one of these times a power of ten, at most this share of a view's width.
_ROUND_NUMBERS = (1, 2, 5)
_LONGEST_BAR = 0.28


def draw_bar(sheet: Image.Image, mm_per_pixel: float, size: tuple[int, int], ink: Rgb) -> None:
    """Draw a bar of a round length in the sheet's lower right corner."""
    length = round_length(_LONGEST_BAR * size[0] * mm_per_pixel)
    margin, thickness = round(0.04 * size[1]), max(2, round(0.006 * size[1]))
    right, bottom, pixels = sheet.width - margin, sheet.height - margin, round(length / mm_per_pixel)
    # Pillow's rectangles include their last row and column.
    ImageDraw.Draw(sheet).rectangle((right - pixels, bottom - thickness, right - 1, bottom - 1), fill=ink)
    text = f"{length:g} mm"
    above = (right - pixels / 2, bottom - 0.015 * size[1])
    write(sheet, above, text, ink, LETTERS * size[1], anchor="mb")


def round_length(longest: float) -> float:
    """Return the greatest 1, 2 or 5 times a power of ten up to a length."""
    power = 10.0 ** math.floor(math.log10(longest))
    # One times the power always counts: the logarithm may have rounded a length just below a power of ten up to it.
    return max(factor * power for factor in _ROUND_NUMBERS if factor == 1 or factor * power <= longest)
