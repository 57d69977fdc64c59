"""The unit of length of a file: stated by the user or guessed from the size of the surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidOption

Unit = Literal["mm", "um", "cm", "m"]

#: Multiply by the first, divide by the second: both are exact, so micrometres lose no digit to a factor 0.001.
_TO_MILLIMETRES: dict[str, tuple[float, float]] = {"mm": (1, 1), "um": (1, 1000), "cm": (10, 1), "m": (1000, 1)}

#: A surface with a longer bounding box diagonal, taken as millimetres, would be larger than any heart.
LARGEST_MILLIMETRES = 1000.0


@dataclass(frozen=True)
class UnitDecision:
    """Which unit of length a file was taken to be in, and why.

    Attributes
    ----------
    unit
        "mm", "um", "cm" or "m".
    factor
        Millimetres in one unit.
    reason
        One clause for the reader.
    decided_by
        "user" or "auto".
    """

    unit: Unit
    factor: float
    reason: str
    decided_by: Literal["user", "auto"]


def decide_unit(vertices: NDArray[np.float64], units: str = "auto") -> UnitDecision:
    """Decide the unit of coordinates.

    Parameters
    ----------
    vertices
        (V, 3), in the unknown unit; rows that are not finite are left out of the bounding box.
    units
        "auto", "mm", "um", "cm" or "m". "auto" takes a bounding box diagonal above 1000 for micrometres and anything
        else for millimetres.

    Raises
    ------
    InvalidOption
        For any other name of a unit.
    """
    if units in _TO_MILLIMETRES:
        return _decision(cast(Unit, units), "stated by the user", "user")
    if units != "auto":
        raise InvalidOption(f"units = {units!r} is not known; use one of: auto, {', '.join(_TO_MILLIMETRES)}")
    diagonal = _bounding_box_diagonal(vertices)
    if diagonal > LARGEST_MILLIMETRES:
        return _decision("um", f"the bounding box diagonal {diagonal:.6g} is above 1000", "auto")
    return _decision("mm", f"the bounding box diagonal {diagonal:.6g} is not above 1000", "auto")


def to_millimetres(vertices: NDArray[np.float64], decision: UnitDecision) -> NDArray[np.float64]:
    """Convert coordinates (V, 3) from the decided unit to millimetres; returns a new array."""
    numerator, denominator = _TO_MILLIMETRES[decision.unit]
    return vertices * numerator / denominator


def from_millimetres(vertices: NDArray[np.float64], unit: str) -> NDArray[np.float64]:
    """Convert millimetres (V, 3) to a unit; numbers of at most 15 digits that came from that unit come back as such.

    Raises
    ------
    InvalidOption
        For an unknown unit; "auto" is none.
    """
    if unit not in _TO_MILLIMETRES:
        raise InvalidOption(f"units = {unit!r} is not known; use one of: {', '.join(_TO_MILLIMETRES)}")
    numerator, denominator = _TO_MILLIMETRES[unit]
    if numerator == denominator:
        return vertices.copy()
    plain = vertices * denominator / numerator
    short = np.array([float(f"{value:.15g}") for value in plain.ravel().tolist()]).reshape(plain.shape)
    return np.where(short * numerator / denominator == vertices, short, plain)


def _decision(unit: Unit, reason: str, decided_by: Literal["user", "auto"]) -> UnitDecision:
    numerator, denominator = _TO_MILLIMETRES[unit]
    return UnitDecision(unit, numerator / denominator, reason, decided_by)


def _bounding_box_diagonal(vertices: NDArray[np.float64]) -> float:
    finite = vertices[np.isfinite(vertices).all(axis=1)]
    if len(finite) == 0:
        return 0.0
    return float(np.linalg.norm(finite.max(axis=0) - finite.min(axis=0)))
