"""Surfaces with fields that a formula gives, in mm: smooth ones, a flat one, and hard cases."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Shape = tuple[Floats, Ints, Floats]  # vertices, triangles, a vector per triangle


def make_shape(name: str) -> Shape:
    """Make one of `SHAPES`."""
    return SHAPES[name]()


# Surfaces ------------------------------------------------------------------------------------------------------------


def _grid(columns: int, rows: int) -> tuple[Floats, Ints]:
    """Corners (column, row) of a grid of cells and their halves, diagonals in turn; counterclockwise."""
    first = np.arange(columns + 1)[None, :] + (columns + 1) * np.arange(rows + 1)[:, None]
    a, b, c, d = (corner.ravel() for corner in (first[:-1, :-1], first[:-1, 1:], first[1:, 1:], first[1:, :-1]))
    rising = ((np.arange(columns)[None, :] + np.arange(rows)[:, None]) % 2 == 0).ravel()[:, None]
    one = np.where(rising, np.column_stack([a, b, c]), np.column_stack([a, b, d]))
    other = np.where(rising, np.column_stack([a, c, d]), np.column_stack([b, c, d]))
    points = np.stack(np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0)), axis=-1).reshape(-1, 2)
    return points, np.concatenate([one, other])


def _rectangle(columns: int, rows: int, width: float, height: float) -> tuple[Floats, Ints]:
    points, triangles = _grid(columns, rows)
    flat = points * [width / columns, height / rows] - [width / 2, height / 2]
    return np.column_stack([flat, np.zeros(len(flat))]), triangles


def _torus(around: int, across: int, radius: float, tube: float) -> tuple[Floats, Ints, Floats]:
    """Return vertices, triangles, and the two angles at each triangle's middle, (T, 2)."""
    points, triangles = _grid(around, across)
    steps = points[triangles].mean(axis=1)
    joined = (points % [around, across]) @ [1, around]
    _, kept, ranks = np.unique(joined, return_index=True, return_inverse=True)
    angles = 2 * np.pi * points[kept] / [around, across]
    vertices = _on_torus(angles, radius, tube)
    return vertices, ranks.reshape(-1)[triangles], 2 * np.pi * steps / [around, across]


def _on_torus(angles: Floats, radius: float, tube: float) -> Floats:
    u, v = angles.T
    out = radius + tube * np.cos(v)
    return np.column_stack([out * np.cos(u), out * np.sin(u), tube * np.sin(v)])


def _sphere(frequency: int) -> tuple[Floats, Ints]:
    """Return the unit sphere: an icosahedron with sides cut into `frequency` parts; 20 frequency^2 triangles."""
    golden = (1 + 5**0.5) / 2
    corners = np.array([[0, s, t * golden] for s in (-1, 1) for t in (-1, 1)])
    corners = np.concatenate([np.roll(corners, turn, axis=1) for turn in range(3)])
    near = np.linalg.norm(corners[:, None] - corners[None], axis=2) < 2.1
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(12)
        for k in range(12)
        if i < min(j, k) and near[i, j] and near[j, k] and near[k, i] and np.linalg.det(corners[[i, j, k]]) > 1
    ]
    lattice = [(i, j) for i in range(frequency + 1) for j in range(frequency + 1 - i)]
    index = {place: number for number, place in enumerate(lattice)}
    up = [(index[i, j], index[i + 1, j], index[i, j + 1]) for i, j in lattice if i + j < frequency]
    down = [(index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]) for i, j in lattice if i + j < frequency - 1]
    weights = np.array([[frequency - i - j, i, j] for i, j in lattice]) / frequency
    points = np.concatenate([weights @ corners[list(face)] for face in faces])
    triangles = np.concatenate([np.array(up + down) + len(lattice) * number for number in range(len(faces))])
    _, kept, ranks = np.unique(points.round(9) + 0.0, axis=0, return_index=True, return_inverse=True)
    vertices = points[kept]
    return vertices / np.linalg.norm(vertices, axis=1)[:, None], ranks.reshape(-1)[triangles]


# Fields --------------------------------------------------------------------------------------------------------------


def _middles(vertices: Floats, triangles: Ints) -> Floats:
    middles: Floats = vertices[triangles].mean(axis=1)
    return middles


def _turned(vertices: Floats, triangles: Ints, direction: list[float], angles: Floats) -> Floats:
    """A fixed direction in the plane of each triangle, turned there by an angle."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    along = np.asarray(direction) - (normals @ direction)[:, None] * normals
    turned: Floats = np.cos(angles)[:, None] * along + np.sin(angles)[:, None] * np.cross(normals, along)
    return turned


def _on_plane(angles: Floats) -> Floats:
    return np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])


# What the scenarios name ---------------------------------------------------------------------------------------------

SEMI_AXES = (30.0, 20.0, 15.0)


def _ellipsoid(amplitude: float) -> Shape:
    vertices, triangles = _sphere(90)
    vertices = vertices * SEMI_AXES
    x, y, z = _middles(vertices, triangles).T
    angles = amplitude * (np.sin(x / 12) + np.cos(y / 9 + z / 15))
    return vertices, triangles, _turned(vertices, triangles, [0.3, 0.5, 0.8], angles)


GOLDEN = (1 + 5**0.5) / 2


def _helical_torus(mean_slope: float, amplitude: float) -> Shape:
    """Lines that turn round the tube so many times on their way round, on average."""
    vertices, triangles, angles = _torus(400, 200, 20, 8)
    slope = mean_slope + amplitude * np.sin(angles[:, 0]) * np.cos(2 * angles[:, 1])
    step = 1e-6 * np.column_stack([np.ones(len(angles)), slope])
    return vertices, triangles, (_on_torus(angles + step, 20, 8) - _on_torus(angles - step, 20, 8)) / 2e-6


def _flat(angle_at: Callable[[Floats], Floats]) -> Shape:
    vertices, triangles = _rectangle(250, 200, 100, 80)
    return vertices, triangles, _on_plane(angle_at(_middles(vertices, triangles)))


def _constant(degrees: float) -> Shape:
    return _flat(lambda middles: np.full(len(middles), np.radians(degrees)))


def _convergent(middles: Floats) -> Floats:
    """Towards a line in every strip of 2 mm: streamlines run together everywhere."""
    angles: Floats = np.where(middles[:, 1] % 2 < 1, 0.46, -0.46)
    return angles


def _vortices(middles: Floats) -> Floats:
    """Centres 10 mm apart."""
    x, y, _ = (np.pi * middles / 10).T
    angles: Floats = np.arctan2(np.cos(x) * np.sin(y), -np.sin(x) * np.cos(y)) + np.pi / 2
    return angles


def _vortex(middles: Floats) -> Floats:
    return np.arctan2(middles[:, 1], middles[:, 0]) + np.pi / 2


def _spiral(middles: Floats) -> Floats:
    """Nearly a vortex: streamlines come back beside themselves."""
    return _vortex(middles) - 0.01


def _random(middles: Floats) -> Floats:
    return np.random.default_rng(1).uniform(0, np.pi, len(middles))


def _stretched() -> Shape:
    """Triangles fifty times as long as high, fibres oblique to them."""
    vertices, triangles = _rectangle(32, 1600, 100, 100)
    return vertices, triangles, _on_plane(0.5 + np.sin(_middles(vertices, triangles)[:, 0] / 20))


def _components() -> Shape:
    """A hundred spheres of 4 mm."""
    vertices, triangles = _sphere(7)
    field = _turned(vertices, triangles, [0.3, 0.5, 0.8], np.zeros(len(triangles)))
    places = [[10.0 * i, 10.0 * j, 0.0] for i in range(10) for j in range(10)]
    return (
        np.concatenate([4 * vertices + place for place in places]),
        np.concatenate([triangles + len(vertices) * number for number in range(len(places))]),
        np.tile(field, (len(places), 1)),
    )


HELIX_SLOPES = [round(0.37 + 0.1137 * i, 4) for i in range(20)]
RECTANGLE_DEGREES = (0, 17, 30, 45, 73, 90)
HARD_CASES: dict[str, Callable[[], Shape]] = {
    "converging everywhere": lambda: _flat(_convergent),
    "vortices": lambda: _flat(_vortices),
    "one vortex": lambda: _flat(_vortex),
    "one spiral": lambda: _flat(_spiral),
    "random directions": lambda: _flat(_random),
    "stretched triangles": _stretched,
    "a hundred spheres": _components,
}
SHAPES: dict[str, Callable[[], Shape]] = {
    "ellipsoid": lambda: _ellipsoid(0),
    "ellipsoid, turned field": lambda: _ellipsoid(0.8),
    "torus": lambda: _helical_torus(GOLDEN, 0),
    "torus, varied field": lambda: _helical_torus(GOLDEN, 1),
    **{f"torus, slope {slope}": partial(_helical_torus, slope, 0) for slope in HELIX_SLOPES},
    **{f"rectangle, {degrees} degrees": partial(_constant, degrees) for degrees in RECTANGLE_DEGREES},
    **HARD_CASES,
}
