"""Small triangle meshes with known topology, as (vertices (V, 3) float64, triangles (T, 3) int64)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]


def single_triangle() -> Mesh:
    """A right triangle with legs of 1."""
    return np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])


def grid(columns: int = 4, rows: int = 3, *, spacing: float = 1.0) -> Mesh:
    """A rectangle in the plane z = 0: 2 columns rows triangles facing +z, vertices row by row."""
    x, y = np.meshgrid(np.arange(columns + 1), np.arange(rows + 1))
    vertices = spacing * np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(columns) + (columns + 1) * np.arange(rows)[:, None]).ravel()
    right, up, diagonal = corner + 1, corner + columns + 1, corner + columns + 2
    lower, upper = np.column_stack([corner, right, diagonal]), np.column_stack([corner, diagonal, up])
    return vertices, np.stack([lower, upper], axis=1).reshape(-1, 3)


def with_hole(columns: int, size: float) -> Mesh:
    """A square of one size with a square hole in its middle, a little to the right."""
    vertices, triangles = grid(columns, columns, spacing=size / columns)
    centres = vertices[triangles].mean(axis=1)
    inside = (np.abs(centres[:, 0] - 0.6 * size) < size / 8) & (np.abs(centres[:, 1] - size / 2) < size / 8)
    return vertices, triangles[~inside]


def octahedron() -> Mesh:
    """A closed surface of 8 triangles facing outwards, radius 1."""
    vertices = np.concatenate([np.eye(3), -np.eye(3)])
    signs = [(a, b, c) for a in (0, 3) for b in (1, 4) for c in (2, 5)]
    flipped = [sum(k >= 3 for k in corners) % 2 == 1 for corners in signs]
    return vertices, np.array(
        [(a, c, b) if flip else (a, b, c) for (a, b, c), flip in zip(signs, flipped, strict=True)]
    )


def sphere(subdivisions: int = 2, *, radius: float = 1.0) -> Mesh:
    """An octahedron, each triangle split in four `subdivisions` times, on the sphere: 8 * 4^subdivisions triangles."""
    vertices, triangles = octahedron()
    for _ in range(subdivisions):
        sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, middle = np.unique(sides, axis=0, return_inverse=True)
        ab, bc, ca = (len(vertices) + middle.reshape(-1, 3)).T
        a, b, c = triangles.T
        vertices = np.concatenate([vertices, vertices[edges].mean(axis=1)])
        children = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = np.concatenate([np.column_stack(child) for child in children])
    return radius * vertices / np.linalg.norm(vertices, axis=1, keepdims=True), triangles


def torus(around: int = 24, across: int = 12, *, radius: float = 2.0, tube_radius: float = 0.7) -> Mesh:
    """A closed surface of genus 1 with 2 around across triangles facing outwards."""
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    ring = radius + tube_radius * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), tube_radius * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(around), np.arange(across), indexing="ij"))
    a, b = i * across + j, (i + 1) % around * across + j
    c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
    return vertices, np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def moebius_strip(segments: int = 30, *, radius: float = 2.0, width: float = 1.0) -> Mesh:
    """A strip with a half twist: 2 segments triangles, not orientable, one boundary loop."""
    angle = np.arange(segments) * 2 * np.pi / segments
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(segments)])
    half = width / 2 * (np.cos(angle / 2)[:, None] * out + np.sin(angle / 2)[:, None] * [0, 0, 1])
    vertices = np.concatenate([radius * out - half, radius * out + half])
    low = np.arange(segments)
    next_low = np.append(low[1:], segments)  # behind the last segment the two borders change places
    high, next_high = low + segments, np.append(low[1:] + segments, 0)
    first, second = np.column_stack([low, next_low, next_high]), np.column_stack([low, next_high, high])
    return vertices, np.concatenate([first, second])


def annulus(around: int = 48, across: int = 8, *, inner: float = 4.0, outer: float = 10.0) -> Mesh:
    """A flat ring, its longer loop outside."""
    radii = np.linspace(inner, outer, across + 1)
    angles = np.arange(around) * 2 * np.pi / around
    vertices = np.stack(np.broadcast_arrays(radii * np.cos(angles)[:, None], radii * np.sin(angles)[:, None], 0.0), -1)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(around), np.arange(across), indexing="ij"))
    a, b = i * (across + 1) + j, (i + 1) % around * (across + 1) + j
    quads = np.column_stack([a, a + 1, b + 1]), np.column_stack([a, b + 1, b])
    return vertices.reshape(-1, 3), np.concatenate(quads)


def three_triangles_on_an_edge() -> Mesh:
    """Three triangles that share the edge (0, 1): not a manifold."""
    angle = np.arange(3) * 2 * np.pi / 3
    tips = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(3)])
    return np.concatenate([[[0, 0, -1.0], [0, 0, 1.0]], tips]), np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])


def two_components() -> Mesh:
    """Two copies of `grid`, one 10 above the other."""
    vertices, triangles = grid()
    return np.concatenate([vertices, vertices + np.array([0, 0, 10])]), np.concatenate(
        [triangles, triangles + len(vertices)]
    )
