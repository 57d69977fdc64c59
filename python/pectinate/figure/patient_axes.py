"""Where the patient's left, back and head lie in the coordinates of a surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption

PATIENT_DIRECTIONS = MappingProxyType(
    {"L": (1, 0, 0), "R": (-1, 0, 0), "P": (0, 1, 0), "A": (0, -1, 0), "S": (0, 0, 1), "I": (0, 0, -1)}
)

Vector = tuple[float, float, float] | Sequence[float] | NDArray[np.float64]

_FEWEST_DIRECTIONS = 2
# Least singular value, relative to the greatest, of directions that are told apart.
_SAME_DIRECTION = 1e-6


@dataclass(frozen=True, eq=False)
class PatientAxes:
    """Directions of the patient in the coordinates of a surface, for views of surfaces in any pose.

    At least two are needed. They need not be perpendicular: the axes are the perpendicular ones nearest to them.

    Parameters
    ----------
    left, posterior, superior : (3,) float, optional
        Of any length but zero, such as from one landmark to another.

    Raises
    ------
    InvalidOption
        Fewer than two directions, one that is zero or not finite, two that are parallel, or three that are left-handed.
    """

    left: Vector | None = None
    posterior: Vector | None = None
    superior: Vector | None = None

    def __post_init__(self) -> None:
        self.matrix()

    def matrix(self) -> NDArray[np.float64]:
        """Rotation from (left, posterior, superior) to the coordinates of the surface, (3, 3) float64."""
        given = {name: getattr(self, name) for name in ("left", "posterior", "superior")}
        units = {name: _unit(name, vector) for name, vector in given.items() if vector is not None}
        if len(units) < _FEWEST_DIRECTIONS:
            raise InvalidOption("patient axes need at least two of left, posterior and superior")
        columns = [units.get(name) for name in given]
        for i, column in enumerate(columns):
            if column is None:
                columns[i] = _cross(columns[(i + 1) % 3], columns[(i + 2) % 3])
        matrix = np.column_stack([column for column in columns if column is not None])
        # The nearest rotation, by the polar decomposition.
        u, sizes, v = np.linalg.svd(matrix)
        if sizes[-1] <= _SAME_DIRECTION * sizes[0]:
            raise InvalidOption(f"patient axes {given} are parallel or lie in a plane: give directions that differ")
        if np.linalg.det(matrix) < 0:
            raise InvalidOption(f"patient axes {given} are left-handed: left, posterior and superior are right-handed")
        return np.asarray(u @ v)


def patient_to_vertices(axes: str | PatientAxes) -> NDArray[np.float64]:
    """Matrix (3, 3) from (left, posterior, superior) to the coordinates of the vertices.

    Raises
    ------
    InvalidOption
        The letters are not a right-handed choice of three patient directions.
    """
    if isinstance(axes, PatientAxes):
        return axes.matrix()
    letters = axes.upper()
    if len(letters) == len("LPS") and all(letter in PATIENT_DIRECTIONS for letter in letters):
        matrix = np.array([PATIENT_DIRECTIONS[letter] for letter in letters], dtype=np.float64)
        if np.linalg.det(matrix) > 0:
            return matrix
    raise InvalidOption(
        f"axes '{axes}' are not right-handed patient axes: give where +x, +y and +z point, such as LPS, RAS or SLP"
    )


def _cross(a: NDArray[np.float64] | None, b: NDArray[np.float64] | None) -> NDArray[np.float64]:
    """Unit vector across both; zero where they are parallel."""
    normal = np.cross(np.asarray(a), np.asarray(b))
    length = np.linalg.norm(normal)
    return np.asarray(normal / length if length > _SAME_DIRECTION else 0 * normal)


def _unit(name: str, given: ArrayLike) -> NDArray[np.float64]:
    vector = np.asarray(given, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        raise InvalidOption(f"patient axes: {name} {given!r}; give three finite numbers that are not all zero")
    scaled = vector / np.abs(vector).max()
    return np.asarray(scaled / np.linalg.norm(scaled))
