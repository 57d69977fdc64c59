"""Surfaces, tracts and constraints that `fields.py` measures with: deterministic, made once."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

import pectinate
from pectinate import _core
from surfaces import find_file

SURFACES = ("la_epi", "la_endo", "ra_epi", "ra_endo")
TRACT_COUNT = 15
TRACT_SEPARATION = 5.0  # mm


@cache
def measured(name: str) -> pectinate.Model:
    """A measured surface with its fibres."""
    return pectinate.load(find_file(f"human_atrium_1/{name}.pts"))


@cache
def measured_tracts(name: str) -> list[_core.Tract]:
    """The longest streamlines of the measured fibres, placed 5 mm apart."""
    model = measured(name)
    lines = polylines(_core.place_streamlines(model.mesh, model.require_field(), separation_distance=TRACT_SEPARATION))
    return [_core.Tract(line) for line in sorted(lines, key=length_of, reverse=True)[:TRACT_COUNT]]


def parallel_borders(mesh: _core.SurfaceMesh) -> list[_core.BoundaryCondition]:
    """Fibres run along all boundary loops."""
    loops = range(len(mesh.boundary_loops))
    return [_core.BoundaryCondition(loop, _core.BoundaryRule.parallel) for loop in loops]


@cache
def constraints(name: str) -> _core.Constraints:
    """What all loops and the measured tracts ask for."""
    mesh = measured(name).mesh
    return _core.make_constraints(mesh, measured_tracts(name), parallel_borders(mesh))


@cache
def disk(name: str) -> _core.Parameterization:
    """The surface on the unit disk."""
    return _core.parameterize(measured(name).mesh)


def reference_frame(name: str) -> _core.ReferenceFrame:
    """The frame between the longest loop and the second longest of its component."""
    mesh, parameterization = measured(name).mesh, disk(name)
    loops = mesh.boundary_loops
    outer = parameterization.outer_loop
    others = [k for k in range(len(loops)) if k != outer and loops[k].component == loops[outer].component]
    inner = max(others, key=lambda k: loops[k].length)
    return _core.make_reference_frame(mesh, parameterization, inner_loop=inner)


def polylines(placement: _core.Placement) -> list[NDArray[np.float64]]:
    """Points of each streamline."""
    return np.split(placement.points, placement.offsets[1:-1])


def length_of(line: NDArray[np.float64]) -> float:
    """Length of a polyline, mm."""
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def first_part(line: NDArray[np.float64], length: float) -> NDArray[np.float64]:
    """A polyline up to the point at which it has a length in mm."""
    travelled = np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))
    return line[: int(np.searchsorted(travelled, length)) + 2]


def with_outliers(model: pectinate.Model, noise: float, share: float) -> _core.OrientationField:
    """Fibres with normal noise of a standard deviation in radians; a share of them turned anyhow instead."""
    mesh = model.mesh
    noisy = _core.add_angular_noise(mesh, model.require_field(), standard_deviation=noise)
    random = np.random.default_rng(1)
    turns = np.where(random.random(mesh.triangle_count) < share, random.uniform(0, np.pi, mesh.triangle_count), 0)
    across = np.cross(mesh.triangle_normals, noisy.directions)
    vectors = np.zeros((mesh.input_triangle_count, 3))
    vectors[mesh.input_triangle] = np.cos(turns)[:, None] * noisy.directions + np.sin(turns)[:, None] * across
    return _core.OrientationField.from_triangle_vectors(mesh, vectors)
