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
    if source.shape is not None:
        vertices, triangles, field = make_shape(source.shape)
        return Arrays(source.scale * vertices, triangles, field)
    if source.edge_length is not None:
        model = pectinate.datasets.demo_atrium(edge_length=source.edge_length)
    else:
        model = pectinate.load(find_file(str(source.file)))
    data = model.data
    if data.vectors is None or data.vector_location != "triangle":
        raise SurfaceMissing(f"{data.source} has no vector per triangle, which the engines are compared on")
    return Arrays(source.scale * data.vertices, data.triangles, data.vectors)


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
