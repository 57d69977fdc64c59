"""The surfaces of the scenarios, as plain arrays that every engine gets alike."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import pectinate
from scenarios import SurfaceSource
from shapes import make_shape

REPOSITORY = Path(__file__).resolve().parents[1]


class SurfaceMissing(Exception):
    """A surface cannot be measured here; the message says why."""


@dataclass(frozen=True, eq=False)
class Arrays:
    """A surface as its source gives it, in mm.

    Attributes
    ----------
    vertices
        (V, 3) float64.
    triangles
        (T, 3) int64.
    field
        (T, 3) float64, a vector per triangle.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    field: NDArray[np.float64]

    @property
    def edge_length(self) -> float:
        """Mean length of the triangles' sides, mm."""
        sides = self.vertices[self.triangles] - self.vertices[np.roll(self.triangles, 1, axis=1)]
        return float(np.linalg.norm(sides, axis=2).mean())

    @property
    def area(self) -> float:
        """Surface area, mm^2."""
        a, b, c = (self.vertices[self.triangles[:, corner]] for corner in range(3))
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)

    def save(self, path: Path) -> None:
        """Write an uncompressed `.npz`."""
        np.savez(path, vertices=self.vertices, triangles=self.triangles, field=self.field)

    @classmethod
    def read(cls, path: Path) -> Arrays:
        """Read what `save` wrote."""
        with np.load(path) as data:
            return cls(data["vertices"], data["triangles"], data["field"])


def read_surface(source: SurfaceSource) -> Arrays:
    """Make or read a surface.

    Raises
    ------
    SurfaceMissing
        No such file, or no vector per triangle in it.
    """
    arrays = _read_original(source)
    for _ in range(source.refinements):
        arrays = _refined(arrays)
    return _repeated(arrays, source.copies)


def _read_original(source: SurfaceSource) -> Arrays:
    if source.shape is not None:
        return Arrays(*make_shape(source.shape))
    if source.edge_length is not None:
        model = pectinate.datasets.demo_atrium(edge_length=source.edge_length)
    else:
        model = pectinate.load(find_file(str(source.file)))
    data = model.data
    if data.vectors is None or data.vector_location != "triangle":
        raise SurfaceMissing(f"{data.source} has no vector per triangle, which the engines are compared on")
    return Arrays(data.vertices, data.triangles, data.vectors)


def _refined(arrays: Arrays) -> Arrays:
    """Cut each triangle in four."""
    corners = arrays.triangles
    sides = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, ranks = np.unique(sides @ [len(arrays.vertices), 1], return_inverse=True)
    ends = np.column_stack(np.divmod(edges, len(arrays.vertices)))
    middles = len(arrays.vertices) + ranks.reshape(-1, 3)  # of the sides after each corner
    parts = [np.column_stack([corners[:, k], middles[:, k], middles[:, k - 1]]) for k in range(3)]
    return Arrays(
        np.concatenate([arrays.vertices, arrays.vertices[ends].mean(axis=1)]),
        np.stack([*parts, middles], axis=1).reshape(-1, 3),
        np.repeat(arrays.field, 4, axis=0),
    )


def _repeated(arrays: Arrays, copies: int) -> Arrays:
    """Put copies side by side, half as far apart as they are wide."""
    step = np.array([1.5 * np.ptp(arrays.vertices[:, 0]), 0, 0])
    return Arrays(
        np.concatenate([arrays.vertices + number * step for number in range(copies)]),
        np.concatenate([arrays.triangles + number * len(arrays.vertices) for number in range(copies)]),
        np.tile(arrays.field, (copies, 1)),
    )


def find_file(name: str) -> Path:
    """Path of a file of the measured data.

    Raises
    ------
    SurfaceMissing
        There is no such file.
    """
    folder = Path(os.environ.get("PECTINATE_DATA", REPOSITORY.parent / "shared" / "data"))
    if not (folder / name).is_file():
        raise SurfaceMissing(f"{folder / name} not found: set PECTINATE_DATA to the folder that holds {name}")
    return folder / name
