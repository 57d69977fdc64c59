"""Wavefront OBJ, read in the order of the file.

trimesh groups faces by material and splits vertices along texture seams; arrays per triangle would go astray.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidFile
from pectinate.io.text import TextRows, parse_table, read_rows

_CORNERS = 3


def read_obj(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64], int]:
    """Read vertices and faces; textures, normals, colours and groups are passed over.

    Returns
    -------
    vertices, triangles, split
        (V, 3); (T, 3), polygons split into fans in place; the number of polygons that were split.

    Raises
    ------
    InvalidFile
        The file is missing or malformed, or has no face.
    """
    rows = read_rows(path)
    keys = [line.split(None, 1)[0] for line in rows.lines]
    points = _select(rows, keys, "v")
    xyz = TextRows(path, [" ".join(line.split()[:3]) for line in points.lines], points.numbers)
    vertices = parse_table(xyz, (3,), "v x y z")
    faces = _select(rows, keys, "f")
    if len(faces) == 0:
        raise InvalidFile.at(path, "has no face", "give a surface, not a set of points")
    seen = np.searchsorted(points.numbers, faces.numbers)  # vertices above each face: what negative indices count from
    corners = [_corners(faces, row, int(count), len(vertices)) for row, count in enumerate(seen)]
    fans = [[(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)] for face in corners]
    triangles = np.array([triangle for fan in fans for triangle in fan], dtype=np.int64)
    return vertices, triangles, sum(len(face) > _CORNERS for face in corners)


def _select(rows: TextRows, keys: list[str], key: str) -> TextRows:
    """Take the lines that begin with a key, without it."""
    chosen = [row for row, found in enumerate(keys) if found == key]
    bodies = [rows.lines[row].strip()[len(key) :] for row in chosen]
    return TextRows(rows.path, bodies, [rows.numbers[row] for row in chosen])


def _corners(faces: TextRows, row: int, seen: int, vertex_count: int) -> list[int]:
    """Vertex indices of a face, from 0."""
    tokens = [token.partition("/")[0] for token in faces.lines[row].split("#")[0].split()]
    try:
        numbers = [int(token) for token in tokens]
    except ValueError:
        raise faces.error(row, f"{faces.lines[row].strip()[:30]!r} are no corners", "write f a b c") from None
    corners = [number - 1 if number > 0 else seen + number for number in numbers]
    if len(corners) < _CORNERS or not all(
        0 <= corner < vertex_count and number for corner, number in zip(corners, numbers, strict=True)
    ):
        rule = f"a face of {numbers} among {vertex_count} vertices"
        raise faces.error(row, rule, "a face has at least 3 corners, numbered from 1")
    return corners
