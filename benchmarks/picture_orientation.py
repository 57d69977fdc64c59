"""The local orientation that a picture shows: the structure tensor of its luminance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

LUMINANCE = (0.2126, 0.7152, 0.0722)
# Below this coherence no orientation is read: noise of the same window reaches about as much.
LEAST_COHERENCE = 0.1


@dataclass(frozen=True, eq=False)
class Scales:
    """How closely a picture is looked at, in pixels.

    Attributes
    ----------
    inner
        Standard deviation of the Gaussian whose derivatives are the gradients.
    window
        Standard deviation of the Gaussian over which gradients are averaged.
    """

    inner: float
    window: float


@dataclass(frozen=True, eq=False)
class Orientation:
    """What is read from a picture, pixel by pixel.

    Attributes
    ----------
    angles
        (h, w) float64, radians in (-pi/2, pi/2], from the picture's right counter-clockwise, as seen.
    coherence
        (h, w) float64: 1 where all gradients around are parallel, 0 where none is preferred.
    """

    angles: NDArray[np.float64]
    coherence: NDArray[np.float64]


def luminance(picture: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Brightness (h, w) as it is seen, 0 to 1, of display RGB (h, w, 3)."""
    return np.asarray((picture[:, :, :3] / 255.0) @ LUMINANCE)


def read_orientation(
    brightness: NDArray[np.float64], scales: Scales, shown: NDArray[np.bool_] | None = None
) -> Orientation:
    """Read the direction along which a picture changes least.

    Parameters
    ----------
    brightness : (h, w) float
        The picture.
    scales : Scales
        How closely to look.
    shown : (h, w) bool, optional
        Where the object is: the rest of the picture, its paper, takes no part. By default the whole picture.
    """
    weights = np.ones(brightness.shape) if shown is None else shown.astype(np.float64)
    filled = _with_paper_filled(brightness, weights, scales.inner)
    right = gaussian_filter(filled, scales.inner, order=(0, 1), mode="nearest")
    up = -gaussian_filter(filled, scales.inner, order=(1, 0), mode="nearest")
    tensor = (right * right - up * up, 2 * right * up, right * right + up * up)
    even, odd, total = (gaussian_filter(weights * part, scales.window, mode="constant") for part in tensor)
    strength = np.hypot(even, odd)
    along = 0.5 * np.arctan2(-odd, -even)
    return Orientation(along, np.divide(strength, total, out=np.zeros_like(total), where=total > 1e-12))


def _with_paper_filled(
    brightness: NDArray[np.float64], weights: NDArray[np.float64], inner: float
) -> NDArray[np.float64]:
    """Go on with the object's brightness beyond its outline, which would be the strongest stripe otherwise."""
    filled = brightness * weights
    known = weights.copy()
    for widening in (1, 2, 4, 8):
        blurred = gaussian_filter(filled * known, inner * widening)
        share = gaussian_filter(known, inner * widening)
        reached = (known == 0) & (share > 1e-3)
        filled[reached] = blurred[reached] / share[reached]
        known[reached] = 1.0
    return filled
