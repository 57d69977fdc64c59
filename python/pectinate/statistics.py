"""Figures of a placement (paper section 2.7)."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate import _core


@dataclass(frozen=True)
class PlacementStatistics:
    """How many streamlines, how long and how dense; all 0 where there is none.

    Attributes
    ----------
    streamline_count
        n.
    total_length
        Of all streamlines, mm.
    mean_length
        L_avg, mm.
    length_weighted_mean
        Sum of L^2 over sum of L, mm: the mean over points of streamlines, not over streamlines.
    surface_area
        A, mm^2, of the triangles that have a direction.
    mean_spacing
        d_avg = A / (n L_avg), mm.
    mean_spacing_ratio
        d_avg over the separation distance.
    short_fraction
        Share of streamlines shorter than the separation distance.
    coverage
        Share of the edges' length that is within the separation distance of a streamline.
    stop_counts
        Ends by reason: `boundary`, `near_other`, `near_itself`, `abrupt_turn`, `no_field`, `max_steps`, `closed` (the
        last point is the first), `singularity`; two a
        streamline.
    polishing_rounds
        Played after the placement.
    """

    streamline_count: int
    total_length: float
    mean_length: float
    length_weighted_mean: float
    surface_area: float
    mean_spacing: float
    mean_spacing_ratio: float
    short_fraction: float
    coverage: float
    stop_counts: dict[str, int]
    polishing_rounds: int

    @classmethod
    def from_core(cls, core: _core.PlacementStatistics) -> PlacementStatistics:
        """Copy what the engine counted."""
        values = {field.name: getattr(core, field.name) for field in fields(cls)}
        values["stop_counts"] = {reason.name: core.stop_counts[reason.value] for reason in _core.StopReason}
        return cls(**values)

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain numbers, ready for JSON."""
        return asdict(self)


def length_histogram(lengths: ArrayLike, bin_count: int = 20) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Count lengths in equal bins from 0 to the longest.

    Parameters
    ----------
    lengths
        (n,), mm.
    bin_count
        At least 1, else InvalidOption.

    Returns
    -------
    edges, counts
        (bin_count + 1,) mm and (bin_count,); the counts sum to n.
    """
    return _core.length_histogram(np.asarray(lengths, float), bin_count)
