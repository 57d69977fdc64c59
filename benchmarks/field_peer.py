"""The connection Laplacian assembled with numpy and solved by scipy's SuperLU, to have something beside ours."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray
from scipy import sparse  # type: ignore[import-untyped]
from scipy.sparse.linalg import splu  # type: ignore[import-untyped]

from pectinate import _core

ORDERINGS = ("MMD_AT_PLUS_A", "COLAMD")
_LEAST_DUAL_LENGTH = 1e-3  # as in the library
_Complex = NDArray[np.complex128]


def solve_by_superlu(
    mesh: _core.SurfaceMesh, demands: _core.Constraints, ordering: str
) -> tuple[_core.OrientationField, float]:
    """The field under hard constraints on an orientable surface, and the CPU seconds of factorizing and solving."""
    phases: _Complex = np.zeros(mesh.triangle_count, complex)
    phases[demands.triangles] = _phases(mesh, demands.triangles, demands.directions)
    free = np.ones(mesh.triangle_count, bool)
    free[demands.triangles] = False
    matrix = _connection_laplacian(mesh)[free]
    start = time.process_time()
    factors = splu(matrix[:, free].tocsc(), permc_spec=ordering, diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    phases[free] = factors.solve(-(matrix[:, ~free] @ phases[~free]))
    seconds = time.process_time() - start
    along, across = _frames(mesh)
    half = np.sqrt(phases)
    vectors = np.zeros((mesh.input_triangle_count, 3))
    vectors[mesh.input_triangle] = half.real[:, None] * along + half.imag[:, None] * across
    return _core.OrientationField.from_triangle_vectors(mesh, vectors), seconds


def _frames(mesh: _core.SurfaceMesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    first, second = (mesh.vertices[mesh.triangles[:, k]] for k in (0, 1))
    along = (second - first) / np.linalg.norm(second - first, axis=1)[:, None]
    return along, np.cross(mesh.triangle_normals, along)


def _phases(mesh: _core.SurfaceMesh, triangles: NDArray[np.integer], vectors: NDArray[np.float64]) -> _Complex:
    """Of a vector in each of the triangles: exp(2 i angle) from its first side."""
    along, across = (axis[triangles] for axis in _frames(mesh))
    line = (vectors * along).sum(axis=1) + 1j * (vectors * across).sum(axis=1)
    phases: _Complex = (line / np.abs(line)) ** 2
    return phases


def _connection_laplacian(mesh: _core.SurfaceMesh) -> sparse.csr_matrix:
    corners = mesh.vertices[mesh.triangles]
    sides = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    tips = np.roll(corners, -2, axis=1)
    u, v = corners - tips, np.roll(corners, -1, axis=1) - tips
    cotangents = ((u * v).sum(axis=2) / (2 * mesh.triangle_areas[:, None])).ravel()
    order = np.lexsort(np.sort(sides, axis=1).T)
    ends = np.sort(sides, axis=1)[order]
    pairs = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    one, other = order[pairs], order[pairs + 1]
    first, second = one // 3, other // 3
    weights = 1 / np.maximum((cotangents[one] + cotangents[other]) / 2, _LEAST_DUAL_LENGTH)
    edges = mesh.vertices[sides[one, 1]] - mesh.vertices[sides[one, 0]]
    coupling = -weights * _phases(mesh, second, edges) / _phases(mesh, first, edges)
    count = mesh.triangle_count
    half = sparse.csr_matrix((coupling, (second, first)), shape=(count, count))
    diagonal = np.bincount(np.r_[first, second], np.r_[weights, weights], count)
    return sparse.csr_matrix(half + half.conj().T + sparse.diags(diagonal))
