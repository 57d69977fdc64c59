"""How good streamlines are: the same code for every engine, from nothing but its polylines."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surfaces import Arrays


@dataclass(frozen=True, eq=False)
class Streamlines:
    """Polylines as in `pectinate.Placement`, on the triangles of the input."""

    points: NDArray[np.float64]
    offsets: NDArray[np.int64]
    segment_triangles: NDArray[np.int32]

    @classmethod
    def read(cls, path: Path) -> Streamlines:
        """Read what a run wrote."""
        with np.load(path) as data:
            return cls(data["points"], data["offsets"], data["segment_triangles"])

    @property
    def lengths(self) -> NDArray[np.float64]:
        """Length of each streamline, (n,) mm."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        steps[self.offsets[1:-1] - 1] = 0  # from one streamline to the next
        travelled = np.concatenate([[0], np.cumsum(steps)])
        lengths: NDArray[np.float64] = np.diff(travelled[np.append(self.offsets[:-1], len(self.points) - 1)])
        return lengths


def measure_quality(lengths: NDArray[np.float64], area: float, separation_distance: float) -> dict[str, float]:
    """Sum up lengths in mm on a surface of `area` mm^2.

    Returns
    -------
    dict
        n; mean_length (L_avg) and length_weighted_mean (sum of L^2 / sum of L), mm; mean_spacing_ratio (d_avg / d_sep
        with d_avg = area / sum of L); short_fraction (share of streamlines shorter than d_sep).
    """
    total = lengths.sum()
    return {
        "n": len(lengths),
        "mean_length": float(lengths.mean()),
        "length_weighted_mean": float((lengths**2).sum() / total),
        "mean_spacing_ratio": float(area / total / separation_distance),
        "short_fraction": float((lengths < separation_distance).mean()),
    }


def run_checker(
    checker: Path, arrays: Arrays, streamlines: Streamlines, separation_distance: float, folder: Path
) -> dict[str, float]:
    """Run an external program, `python CHECKER RESULT.npz D_SEP`, that prints one JSON object.

    Raises
    ------
    subprocess.CalledProcessError
        It failed.
    """
    result = folder / "checked.npz"
    np.savez(
        result,
        vertices=arrays.vertices,
        triangles=arrays.triangles,
        field=np.nan_to_num(arrays.field),
        points=streamlines.points,
        offsets=streamlines.offsets,
        segment_triangles=streamlines.segment_triangles,
    )
    command = [sys.executable, str(checker), str(result), str(separation_distance)]
    output = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    figures: dict[str, float] = json.loads(output)
    return figures
