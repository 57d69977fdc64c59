"""Numbered circles on a picture."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from pectinate.figure.writing import Rgb, font, lay_on

RADIUS = 0.027
"""Of a marker's disc, as a share of the height of a picture."""

# Widths of a disc's rim and of what is added to its letters on each side, in radii.
_RIM, _BOLD = 0.13, 0.03
# Least distance of two discs, and how far from its place a disc may go and in what steps; in radii.
_SPACING, _FARTHEST, _STEP = 2.2, 14.0, 0.25
_DIRECTIONS = 32
# Pixels drawn across each pixel.
_FINE = 4
_PAPER: Rgb = (255, 255, 255)
_INK: Rgb = (40, 37, 36)


def place_discs(anchors: NDArray[np.float64], radius: float, size: tuple[int, int]) -> NDArray[np.float64]:
    """Middles of discs that keep apart, each as near as can be to its anchor.

    Discs are placed one after the other. One that has to go aside covers no other anchor. Where there is no room within
    reach, it stays.

    Parameters
    ----------
    anchors : (n, 2) float64
        What the discs mark, in pixels.
    radius : float
        Of the discs, in pixels.
    size : tuple of 2 int
        Of the picture, which no disc leaves.

    Returns
    -------
    (n, 2) float64
    """
    placed = np.zeros((0, 2))
    for i, anchor in enumerate(anchors):
        others = np.delete(anchors, i, axis=0)
        candidates = _within(_around(anchor, others, radius), radius, size)
        far = np.linalg.norm(candidates[:, None] - placed, axis=2).min(axis=1, initial=np.inf) >= _SPACING * radius
        clear = np.linalg.norm(candidates[:, None] - others, axis=2).min(axis=1, initial=np.inf) > radius
        clear[0] = True
        free = np.flatnonzero(far & clear)
        placed = np.vstack([placed, candidates[free[0] if len(free) else 0]])
    return placed


def _around(anchor: NDArray[np.float64], others: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """Places around an anchor, nearest first; of those at one distance first the ones away from the others nearby."""
    near = others[np.linalg.norm(others - anchor, axis=1) <= _FARTHEST * radius]
    away = anchor - near.mean(axis=0) if len(near) else np.zeros(2)
    first = np.arctan2(away[1], away[0]) if away.any() else -0.5 * np.pi
    # To both sides in turn.
    turns = np.array([(k + 1) // 2 * (-1) ** k for k in range(_DIRECTIONS)]) * 2 * np.pi / _DIRECTIONS
    directions = np.stack([np.cos(first + turns), np.sin(first + turns)], axis=1)
    distances = radius * np.arange(_STEP, _FARTHEST, _STEP)
    return np.vstack([anchor, anchor + (distances[:, None, None] * directions).reshape(-1, 2)])


def _within(places: NDArray[np.float64], radius: float, size: tuple[int, int]) -> NDArray[np.float64]:
    """The same places, moved into the picture."""
    margin = np.minimum(radius + 1, 0.5 * np.array(size))
    return np.clip(places, margin, size - margin)


def draw_markers(image: Image.Image, anchors: NDArray[np.float64], texts: Sequence[str], radius: float) -> None:
    """Draw discs with texts in them, and a line from each that went aside to its anchor.

    Parameters
    ----------
    image : PIL.Image.Image
        RGB or RGBA.
    anchors : (n, 2) float64
        In pixels.
    texts : sequence of str
        One for each.
    radius : float
        Of the discs, in pixels.
    """
    places = place_discs(anchors, radius, image.size)
    for anchor, place in zip(anchors, places, strict=True):
        if np.linalg.norm(anchor - place) > _RIM * radius:
            _draw_leader(image, anchor, place, radius)
    for place, text in zip(places, texts, strict=True):
        _draw_disc(image, place, text, radius)


def _draw_leader(image: Image.Image, anchor: NDArray[np.float64], place: NDArray[np.float64], radius: float) -> None:
    dot = max(1.0, 0.18 * radius)

    def draw(canvas: ImageDraw.ImageDraw, origin: NDArray[np.float64]) -> None:
        start, end = (tuple(_FINE * (point - origin)) for point in (anchor, place))
        for color, share in ((_PAPER, 0.2), (_INK, 0.08)):
            canvas.line((*start, *end), fill=(*color, 255), width=max(1, round(_FINE * share * radius)))
        _ellipse(canvas, anchor - origin, 1.4 * dot, _PAPER)
        _ellipse(canvas, anchor - origin, dot, _INK)

    _stamp(image, np.minimum(anchor, place) - radius, np.maximum(anchor, place) + radius, draw)


def _draw_disc(image: Image.Image, place: NDArray[np.float64], text: str, radius: float) -> None:
    def draw(canvas: ImageDraw.ImageDraw, origin: NDArray[np.float64]) -> None:
        middle = place - origin
        _ellipse(canvas, middle, radius, _INK)
        _ellipse(canvas, middle, (1 - _RIM) * radius, _PAPER)
        height = _FINE * 1.25 * radius
        width = canvas.textlength(text, font(height))
        height *= min(1.0, 1.45 * _FINE * radius / max(width, 1.0))
        bold = round(_BOLD * _FINE * radius)
        canvas.text(tuple(_FINE * middle), text, (*_INK, 255), font(height), anchor="mm", stroke_width=bold)

    _stamp(image, place - radius, place + radius, draw)


def _ellipse(canvas: ImageDraw.ImageDraw, middle: NDArray[np.float64], radius: float, color: Rgb) -> None:
    low, high = _FINE * (middle - radius), _FINE * (middle + radius)
    canvas.ellipse((*low, *(high - 1)), fill=(*color, 255))


def _stamp(
    image: Image.Image,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    draw: Callable[[ImageDraw.ImageDraw, NDArray[np.float64]], None],
) -> None:
    """Draw finely on a patch between two corners, and lay it smoothly on the picture."""
    first, last = np.floor(low).astype(int) - 1, np.ceil(high).astype(int) + 1
    width, height = (last - first).tolist()
    fine = Image.new("RGBA", (_FINE * width, _FINE * height), (*_PAPER, 0))
    draw(ImageDraw.Draw(fine), first.astype(np.float64))
    lay_on(image, fine.resize((width, height), Image.Resampling.BOX), (int(first[0]), int(first[1])))
