"""Statistics of angles between lines, for reports."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

_SHARES_BELOW = (15, 30)  # degrees


def angle_statistics(angles: NDArray[np.float64]) -> dict[str, Any]:
    """Describe angles, ready for JSON; in degrees.

    Parameters
    ----------
    angles
        (n,), radians; NaN where there is none.

    Returns
    -------
    dict
        `count` of angles that are there and `missing` of the others; `median`, `mean`, `p95`, and the shares
        `below_15` and `below_30` degrees: None where no angle is there.
    """
    known = np.degrees(angles[~np.isnan(angles)])
    counts = {"count": len(known), "missing": len(angles) - len(known)}
    names = ("median", "mean", "p95", *(f"below_{limit}" for limit in _SHARES_BELOW))
    if len(known) == 0:
        return counts | dict.fromkeys(names)
    shares = [float(np.mean(known < limit)) for limit in _SHARES_BELOW]
    values = (float(np.median(known)), float(known.mean()), float(np.percentile(known, 95)), *shares)
    return counts | dict(zip(names, values, strict=True))


def angle_statistics_per_region(
    angles: NDArray[np.float64], regions: NDArray[np.int64] | None
) -> dict[str, dict[str, Any]] | None:
    """Describe the angles of each region, (n,) tags, by its tag; None without regions."""
    if regions is None:
        return None
    return {str(tag): angle_statistics(angles[regions == tag]) for tag in np.unique(regions)}
