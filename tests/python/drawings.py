"""Tracts drawn on flat surfaces, and lines without signs."""

from __future__ import annotations

import numpy as np

import pectinate
from meshes import grid
from pectinate import Model, Tract


def flat(columns: int = 12, rows: int = 8) -> Model:
    """A rectangle of squares of 1 mm."""
    return pectinate.load(grid(columns, rows))


def line(*points: tuple[float, ...], **options: object) -> Tract:
    """A tract through points of the plane, or of space."""
    return Tract(np.array([(*point, 0.0)[:3] for point in points]), **options)  # type: ignore[arg-type]


def lines_agree(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Absolute cosines of lines, 1 where they are the same."""
    return np.abs((first * second).sum(axis=1))


SLANTED = line((1.2, 1.1), (10.3, 6.2), name="slanted")
