"""Letters in pictures: their ink, and the paper under them."""

from __future__ import annotations

import math

from PIL import Image, ImageDraw, ImageFont

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


def write(  # noqa: PLR0913
    image: Image.Image, place: tuple[float, float], text: str, ink: Rgb, pixels: float, *, anchor: str = "mm"
) -> None:
    """Write a text on a picture, which may be transparent.

    Parameters
    ----------
    image : PIL.Image.Image
        RGB or RGBA.
    place : tuple of 2 float
        Where the anchor is, in pixels.
    text : str
        One line.
    ink : tuple of 3 int
        0 to 255.
    pixels : float
        Size of the letters.
    anchor : str
        Which point of the text is meant, as Pillow names it.
    """
    letters = font(pixels)
    left, top, right, bottom = ImageDraw.Draw(image).textbbox(place, text, letters, anchor=anchor)
    box = (math.floor(left), math.floor(top), math.ceil(right), math.ceil(bottom))
    if not text or box[0] >= box[2] or box[1] >= box[3]:
        return
    cover = Image.new("L", (box[2] - box[0], box[3] - box[1]))
    ImageDraw.Draw(cover).text((place[0] - box[0], place[1] - box[1]), text, 255, letters, anchor=anchor)
    lay_on(image, _inked(cover, ink), box[:2])


def upright(text: str, pixels: float, ink: Rgb) -> Image.Image:
    """A text written from the bottom to the top, RGBA; without width where there is no text."""
    letters = font(pixels)
    left, top, right, bottom = (round(side) for side in letters.getbbox(text, anchor="ls"))
    cover = Image.new("L", (right - left + 2, bottom - top + 2 if text else 0))
    if text:
        ImageDraw.Draw(cover).text((1 - left, 1 - top), text, 255, letters, anchor="ls")
    return _inked(cover, ink).transpose(Image.Transpose.ROTATE_90)


def lay_on(image: Image.Image, layer: Image.Image, place: tuple[int, int]) -> None:
    """Lay an RGBA picture on another one, RGB or RGBA; what hangs over is cut off."""
    if image.mode == "RGB":
        image.paste(layer.convert("RGB"), place, layer.getchannel("A"))
        return
    under = image.crop((*place, place[0] + layer.width, place[1] + layer.height))
    under.alpha_composite(layer)
    image.paste(under, place)


def _inked(cover: Image.Image, ink: Rgb) -> Image.Image:
    layer = Image.new("RGBA", cover.size, (*ink, 0))
    layer.putalpha(cover)
    return layer
