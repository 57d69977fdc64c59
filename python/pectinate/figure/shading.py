"""Soft light for drawings: computed per vertex before drawing, and from the depth map after it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption

Color = tuple[float, float, float]

Real = TypeVar("Real", np.float32, np.float64)


@dataclass(frozen=True)
class Style:
    """Colours and light of a drawing. Colours are display RGB, 0 to 1.

    Parameters
    ----------
    surface_color, inside_color, tube_color : tuple of 3 float
        Colour in full light of the surface, of its inside seen through openings, and of the tubes.
    tract_color : tuple of 3 float
        Colour in full light of tracts.
    no_value_color : tuple of 3 float
        Colour, where values are shown, of what has none.
    contour_color : tuple of 3 float
        Colour in full light of the contours of values.
    background_color : tuple of 3 float
        Colour of the paper.
    shadow_color : tuple of 3 float
        What full shadow leaves of the red, green and blue of a surface. Black shadows would take the tubes in them
        their contrast; a tint shows shape without. Where values are shown, shadows are grey.
    tube_gloss : float
        Strength of the highlight along the tubes, from 0 to 1.
    fold_darkness : float
        How much folds and hollows are darkened, from 0 (not at all) to 1 (to full shadow).
    edge_darkness : float
        How much the surface darkens where it turns away from the viewer, from 0 to 1.
    """

    surface_color: Color = (0.96, 0.93, 0.88)
    inside_color: Color = (0.82, 0.68, 0.62)
    tube_color: Color = (0.02, 0.02, 0.02)
    tract_color: Color = (0.0, 0.0, 0.0)
    no_value_color: Color = (0.72, 0.72, 0.72)
    contour_color: Color = (1.0, 1.0, 1.0)
    background_color: Color = (1.0, 1.0, 1.0)
    shadow_color: Color = (0.78, 0.58, 0.48)
    tube_gloss: float = 0.05
    fold_darkness: float = 0.3
    edge_darkness: float = 0.35


def check_color(color: Color) -> Color:
    """Return a colour, or raise InvalidOption where it is none."""
    if len(color) != 3 or not all(0 <= channel <= 1 for channel in color):  # noqa: PLR2004
        raise InvalidOption(f"color {color}: give red, green and blue, each from 0 to 1")
    return color


VALUE_SHADE = 0.6
"""Share of light and shadow that is left on a surface that shows values, so that their colours can be read."""

# Direction towards each light in picture coordinates, with its strength: upper left, right, viewer.
_LIGHTS = (((-0.55, 0.65, 0.53), 0.36), ((0.80, 0.05, 0.60), 0.16), ((0.0, 0.0, 1.0), 0.26))
_SKY, _GROUND = 0.40, 0.24
_GLOSS_DIRECTION, _GLOSS_EXPONENT = (-0.30, 0.36, 0.88), 12


def vertex_normals(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Unit normals of vertices: the mean of their triangles' normals, weighted by area.

    Parameters
    ----------
    vertices : (V, 3) float64
        Positions.
    triangles : (T, 3) int64
        Vertices of each triangle, counter-clockwise seen from outside.

    Returns
    -------
    (V, 3) float64
        Zero where a vertex has no triangle, or where its triangles cancel out.
    """
    corners = np.ascontiguousarray(triangles.T)
    sums = [
        sum(np.bincount(corner, weights=weights, minlength=len(vertices)) for corner in corners)
        for weights in triangle_normals(vertices, triangles).T
    ]
    return unit(np.stack(sums, axis=1))


def triangle_normals(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Normals of triangles, (T, 3) float64, of length twice the area."""
    # Coordinate by coordinate, which takes half the time of `np.cross` on rows.
    sides, (a, b, c) = np.ascontiguousarray(vertices.T), np.ascontiguousarray(triangles.T)
    ux, uy, uz = (side[b] - side[a] for side in sides)
    wx, wy, wz = (side[c] - side[a] for side in sides)
    return np.array([uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx]).T


def turned_to_viewer(vertices: NDArray[Real], triangles: NDArray[np.int64]) -> NDArray[Real]:
    """The third coordinate of `triangle_normals`, (T,): above 0 for triangles that show their outside."""
    right, up = vertices[:, 0], vertices[:, 1]
    a, b, c = triangles.T
    return np.asarray((right[b] - right[a]) * (up[c] - up[a]) - (up[b] - up[a]) * (right[c] - right[a]))


def unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors scaled to length 1; zero vectors stay zero."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(lengths == 0, 1.0, lengths)


def light(normals: NDArray[Real], edge_darkness: float) -> NDArray[Real]:
    """Brightness of matt vertices under three lights fixed to the camera and a brighter sky than ground.

    Parameters
    ----------
    normals : (V, 3) float
        Unit normals in picture coordinates, on the side that is seen.
    edge_darkness : float
        Share of light that is lost where the surface turns away from the viewer.

    Returns
    -------
    (V,) float
        1 is full light.
    """
    brightness = (_SKY + _GROUND) / 2 + (_SKY - _GROUND) / 2 * normals[:, 1]
    for direction, strength in _LIGHTS:
        brightness += strength * np.maximum(_towards(normals, direction), 0.0)
    if edge_darkness:
        turned_away = 1.0 - np.clip(normals[:, 2], 0.0, 1.0)
        brightness *= 1.0 - edge_darkness * turned_away**3
    return np.asarray(brightness)


def value_light(normals: NDArray[Real], edge_darkness: float) -> NDArray[Real]:
    """Brightness as of `light`, but gentle, so that colours can be read: 1, their own, on all that faces the viewer."""
    facing = light(np.array([[0.0, 0.0, 1.0]], dtype=normals.dtype), edge_darkness)
    return np.asarray(1.0 - VALUE_SHADE * np.clip(1.0 - light(normals, edge_darkness) / facing, 0.0, None))


def gloss(normals: NDArray[Real]) -> NDArray[Real]:
    """Strength of a soft highlight, (V,) in 0 to 1, that shows dark tubes to be round."""
    return np.asarray(np.clip(_towards(normals, _GLOSS_DIRECTION), 0.0, 1.0) ** _GLOSS_EXPONENT)


def _towards(normals: NDArray[Real], direction: tuple[float, float, float]) -> NDArray[Real]:
    """Cosines (V,) between normals and a direction."""
    x, y, z = normals.T
    a, b, c = direction
    return np.asarray(a * x + b * y + c * z)


def shaded(color: ArrayLike, brightness: NDArray[Real], shadow_color: Color = (0.0, 0.0, 0.0)) -> NDArray[Real]:
    """Display RGB (V, 3) of vertices of one colour (3,) or one each (V, 3); full shadow leaves its share of each."""
    shadow = np.array(shadow_color, dtype=brightness.dtype)
    lit = shadow + (1 - shadow) * brightness[:, None]
    lit *= np.asarray(color, dtype=brightness.dtype)
    return np.clip(lit, 0, 1, out=lit)


def fold_losses(style: Style, *, shows_values: bool) -> Color:
    """Share of red, green and blue that is lost in the deepest fold: of values the same of each, to keep their hue."""
    if shows_values:
        return (style.fold_darkness * VALUE_SHADE,) * 3
    red, green, blue = (style.fold_darkness * (1 - left) for left in style.shadow_color)
    return red, green, blue


def light_settings() -> dict[str, Any]:
    """The numbers behind `light`, `value_light` and `gloss`, for other drawing programs; ready for JSON."""
    return {
        "lights": [{"direction": list(direction), "strength": strength} for direction, strength in _LIGHTS],
        "sky": _SKY,
        "ground": _GROUND,
        "gloss_direction": list(_GLOSS_DIRECTION),
        "gloss_exponent": _GLOSS_EXPONENT,
        "value_shade": VALUE_SHADE,
    }


def blurred_depth(depth: NDArray[np.float32], radius: int) -> NDArray[np.float32]:
    """Mean of a depth map around each pixel.

    Parameters
    ----------
    depth : (h, w) float32
        Depth in mm; infinite where there is nothing, which takes no part in the mean.
    radius : int
        Half width of the blur in pixels.

    Returns
    -------
    (h, w) float32
    """
    seen = np.isfinite(depth)
    weights, sums = seen.astype(np.float32), np.where(seen, depth, np.float32(0))
    for _ in range(3):
        weights, sums = _box_blur(weights, radius), _box_blur(sums, radius)
    return np.asarray(sums / np.maximum(weights, np.finfo(np.float32).tiny))


def fold_shadow(depth: NDArray[np.float32], surroundings: NDArray[np.float32], reach: float) -> NDArray[np.float32]:
    """How far each sample lies below its surroundings.

    Parameters
    ----------
    depth : (block * h, block * w) float32
        Depth in mm; infinite where there is nothing.
    surroundings : (h, w) float32
        Mean depth around each pixel.
    reach : float
        Difference in mm that counts as 1.

    Returns
    -------
    (block * h, block * w) float32
        From 0 (level with its surroundings or above them) to 1.
    """
    block = len(depth) // len(surroundings)
    seen = np.isfinite(depth)
    mean = np.repeat(np.repeat(surroundings, block, axis=0), block, axis=1)
    below = np.where(seen, depth, mean) - mean
    return np.asarray(np.clip(below / np.float32(reach), 0.0, 1.0))


def box_downsample(
    image: NDArray[np.uint8], block: int, shadow: NDArray[np.float32] | None = None, losses: Color = (1.0, 1.0, 1.0)
) -> NDArray[np.float32]:
    """Mean over blocks of samples, darkened before.

    Parameters
    ----------
    image : (block * h, block * w, 4) uint8
        Premultiplied RGBA.
    block : int
        Samples across a pixel.
    shadow : (block * h, block * w) float32, optional
        How deep in shadow each sample is, 0 to 1.
    losses : tuple of 3 float
        Share of red, green and blue that is lost in full shadow.

    Returns
    -------
    (h, w, 4) float32
        0 to 1.
    """
    height, width = image.shape[0] // block, image.shape[1] // block
    total = np.zeros((height, width, 4), dtype=np.float32)
    for row, column in np.ndindex(block, block):
        some = np.s_[row : height * block : block, column : width * block : block]
        if shadow is None:
            total += image[some]
            continue
        # One channel after the other: arrays are gone through quickest along long axes.
        for channel, loss in enumerate((*losses, 0.0)):
            total[:, :, channel] += image[some][:, :, channel] * (1 - np.float32(loss) * shadow[some])
    total /= np.float32(255 * block * block)
    return total


def _box_blur(image: NDArray[np.float32], radius: int) -> NDArray[np.float32]:
    """Mean over a square window, counting what lies beyond the border as zero."""
    for axis in (0, 1):
        length = image.shape[axis]
        padding = [(0, 0), (0, 0)]
        padding[axis] = (radius + 1, radius)
        total = np.cumsum(np.pad(image, padding), axis=axis, dtype=np.float64)
        ahead = np.take(total, range(2 * radius + 1, 2 * radius + 1 + length), axis=axis)
        image = ((ahead - np.take(total, range(length), axis=axis)) / (2 * radius + 1)).astype(np.float32)
    return image
