"""Letters in pictures: their ink, and the paper under them."""

from __future__ import annotations

from PIL import ImageFont

from pectinate.figure.shading import Style

LETTERS = 0.045
"""Size of letters as a share of the height of a view."""

# On light paper, on dark paper.
_DARK_INK, _LIGHT_INK = (60, 56, 54), (230, 228, 224)

Rgb = tuple[int, int, int]


def paper_color(style: Style) -> Rgb:
    """Colour of the paper, 0 to 255."""
    red, green, blue = (round(255 * channel) for channel in style.background_color)
    return red, green, blue


def ink_color(style: Style) -> Rgb:
    """Colour that stands out from the paper, 0 to 255."""
    return _DARK_INK if sum(paper_color(style)) > sum(_LIGHT_INK) / 2 else _LIGHT_INK


def font(pixels: float) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """Letters of a size, but never too small to be read."""
    return ImageFont.load_default(max(8, round(pixels)))
