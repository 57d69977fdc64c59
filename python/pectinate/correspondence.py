"""Which place of one surface is which place of another: by loops of the same name, then by nearest points."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate import _core
from pectinate.errors import InvalidOption
from pectinate.io import load
from pectinate.model import Model

_LEAST_LOOPS = 3
# From landmarks alone to what both surfaces say, ever less stiff.
_LANDMARK_STIFFNESS = 1e-3
_STIFFNESSES = (1.0, 0.3, 0.1, 0.03, 0.01, 0.01, 0.003, 0.003)
_SAMPLES = 300
_RING_POINTS = 16
_RING_SHIFTS = 8  # per point
_ALIKE = 0.5  # least cosine between the normals of points that are taken for each other
_SAME_PLACE = 1e-6  # of the source's diagonal
_PERCENTILES = {"median": 50, "p95": 95, "greatest": 100}

_Points = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Correspondence:
    """A smooth map of space under which one surface comes to lie on another.

    Attributes
    ----------
    source, target
        The two models.
    loops
        Names of the loops that both have.
    warp
        The map, a thin-plate spline.
    distances
        (V,) float64, mm: from each vertex of the source, after the map, to the nearest point of the target.
    landmark_distances
        (n,) float64, mm: how far the loops' centres, in the order of `loops`, are from where they belong.
    """

    source: Model
    target: Model
    loops: tuple[str, ...]
    warp: _core.LandmarkWarp
    distances: _Points
    landmark_distances: _Points

    def carry(self, points: ArrayLike) -> _Points:
        """Map points (n, 3), mm, from the source's space to the target's."""
        return _core.warp_points(self.warp, np.asarray(points, dtype=np.float64))

    def report(self) -> dict[str, Any]:
        """How well the surfaces came together, ready for JSON; mm."""
        return {
            "loops": dict(zip(self.loops, self.landmark_distances.tolist(), strict=True)),
            "distances": {name: float(np.percentile(self.distances, at)) for name, at in _PERCENTILES.items()},
        }


def correspond(source: Any, target: Any) -> Correspondence:
    """Bring one surface onto another by the loops that have the same names.

    The centres of these loops, a point one radius in front of each and the centres of both surfaces begin it; then,
    round by round, the loops are drawn to each other and each surface's points to the nearest points of the other, less
    and less stiffly.

    Parameters
    ----------
    source, target
        Models, or anything that `pectinate.load` takes, with at least three loop names in common; see
        `Model.with_loop_points`.

    Raises
    ------
    InvalidOption
        Too few names in common, two names for one loop, or names that turn the surface inside out, because left and
        right are exchanged.
    """
    source, target = load(source), load(target)
    names = common_loops(source, target)
    sides = [_loop_landmarks(model, names) for model in (source, target)]
    pairs = np.stack(sides, axis=1)
    warp = _spline(pairs, _LANDMARK_STIFFNESS, source)
    matcher, rings = _Matcher(source, target), [_Rings(source, target, name) for name in names]
    for stiffness in _STIFFNESSES:
        matched = [*(ring.pairs(warp) for ring in rings), matcher.pairs(warp)]
        warp = _spline(np.concatenate([pairs, *matched]), stiffness, source)
    moved = _core.warp_points(warp, source.mesh.vertices)
    centres = sides[1][: len(names)]
    return Correspondence(
        source=source,
        target=target,
        loops=names,
        warp=warp,
        distances=_core.nearest_surface_points(target.mesh, moved)[2],
        landmark_distances=np.linalg.norm(_core.warp_points(warp, sides[0][: len(names)]) - centres, axis=1),
    )


def common_loops(source: Model, target: Model) -> tuple[str, ...]:
    """Names of loops that both models have, in the order of the source.

    Raises
    ------
    InvalidOption
        Fewer than three, or two names of one model for the same loop.
    """
    for model in (source, target):
        _check_distinct(model)
    names = tuple(name for name in source.loop_names if name in target.loop_names)
    if len(names) < _LEAST_LOOPS:
        raise InvalidOption(
            f"{len(names)} loops have a name that both surfaces know; name at least three of "
            f"{', '.join(map(repr, source.loop_names))}{suggestions(target.loop_names, source.loop_names)}"
        )
    return names


def suggestions(unknown: Any, known: Any) -> str:
    """Say which known names are probably meant by unknown ones; empty where nothing is like them."""
    found = [(name, difflib.get_close_matches(name, known, n=1)) for name in unknown if name not in known]
    clauses = [f"{close[0]!r} instead of {name!r}" for name, close in found if close]
    return f"; perhaps {', '.join(clauses)}" if clauses else ""


def _check_distinct(model: Model) -> None:
    owner: dict[int, str] = {}
    for name, loop in model.loop_names.items():
        if loop in owner:
            raise InvalidOption(
                f"{owner[loop]!r} and {name!r} are nearest to the same boundary loop of {model.data.source}; "
                "give points on the loops that are meant"
            )
        owner[loop] = name


def _loop_landmarks(model: Model, names: tuple[str, ...]) -> _Points:
    """Centres of loops, then points in front of them, then the surface's centre."""
    loops = [_opening(model.mesh, model.loop_names[name]) for name in names]
    return np.array([*(centre for centre, _ in loops), *(front for _, front in loops), _centre(model.mesh)])


def _opening(mesh: _core.SurfaceMesh, loop: int) -> tuple[_Points, _Points]:
    """The centre of a loop, and the point one mean radius in front of it, out of the surface."""
    points = mesh.vertices[mesh.boundary_loops[loop].vertices]
    sides = np.roll(points, -1, axis=0) - points
    lengths = np.linalg.norm(sides, axis=1)
    centre = np.average(points + sides / 2, axis=0, weights=lengths)
    radius = lengths.sum() / (2 * np.pi)
    normal = _normal(points, centre)
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    distances = np.linalg.norm(centres - centre, axis=1)
    beside = distances <= max(2 * radius, distances.min())
    behind = np.average(centres[beside] - centre, axis=0, weights=mesh.triangle_areas[beside])
    outward = -normal if normal @ behind > 0 else normal
    size = np.linalg.norm(outward)
    return centre, centre + radius * outward / size if size > 0 else centre - behind


def _normal(points: _Points, centre: _Points) -> _Points:
    """Twice the area that a closed line of points goes round, as a vector."""
    return np.asarray(np.cross(points - centre, np.roll(points, -1, axis=0) - centre).sum(axis=0))


def _centre(mesh: _core.SurfaceMesh) -> _Points:
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    return np.asarray(np.average(centres, axis=0, weights=mesh.triangle_areas))


def _spline(pairs: _Points, stiffness: float, source: Model) -> _core.LandmarkWarp:
    """The map for pairs of points, without those that repeat an earlier one."""
    apart = np.linalg.norm(pairs[:, None, 0] - pairs[None, :, 0], axis=2)
    repeated = np.tril(apart <= _SAME_PLACE * source.mesh.bounding_box_diagonal, -1).any(axis=1)
    kept = pairs[~repeated]
    return _core.make_landmark_warp(kept[:, 0], kept[:, 1], stiffness=stiffness)


class _Rings:
    """Pairs of points along a loop that two surfaces have, once around both."""

    def __init__(self, source: Model, target: Model, name: str) -> None:
        self._source = _ring(source.mesh, source.loop_names[name], _RING_POINTS)
        self._target = _ring(target.mesh, target.loop_names[name], _RING_POINTS * _RING_SHIFTS)

    def pairs(self, warp: _core.LandmarkWarp) -> _Points:
        """Points of the source's loop with points of the target's, (n, 2, 3), begun where they fit best under a map."""
        moved = _core.warp_points(warp, self._source)
        places = np.arange(0, len(self._target), _RING_SHIFTS) + np.arange(len(self._target))[:, None]
        shifted = self._target[places % len(self._target)]
        best = np.linalg.norm(shifted - moved, axis=2).sum(axis=1).argmin()
        return np.stack([self._source, shifted[best]], axis=1)


class _Matcher:
    """Pairs of nearest points between the target and the source under a map, both ways."""

    def __init__(self, source: Model, target: Model) -> None:
        self._source, self._target = source.mesh, target.mesh
        self._projector = _core.TractProjector(target.mesh)
        self._from_source, self._from_target = _spread(source.mesh), _spread(target.mesh)

    def pairs(self, warp: _core.LandmarkWarp) -> _Points:
        """Points of the source with points of the target, (n, 2, 3)."""
        moved = _core.warp_points(warp, self._source.vertices)
        corners = moved[self._source.triangles]
        normals = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        return np.concatenate([self._forth(corners, normals), self._back(moved, corners, normals)])

    def _forth(self, corners: _Points, normals: _Points) -> _Points:
        chosen = self._from_source
        hit, nearest, _ = self._projector.nearest_surface_points(corners[chosen].mean(axis=1))
        alike = _alike(normals[chosen], self._target.triangle_normals[hit])
        points = self._source.vertices[self._source.triangles[chosen]].mean(axis=1)
        return np.stack([points, nearest], axis=1)[alike]

    def _back(self, moved: _Points, corners: _Points, normals: _Points) -> _Points:
        warped = _core.SurfaceMesh(moved, self._source.triangles)
        points = self._target.vertices[self._target.triangles[self._from_target]].mean(axis=1)
        hit, nearest, _ = _core.nearest_surface_points(warped, points)
        triangles = warped.input_triangle[hit]
        alike = _alike(normals[triangles], self._target.triangle_normals[self._from_target])
        origins = self._source.vertices[self._source.triangles[triangles]]
        places = np.einsum("tk,tki->ti", _weights(corners[triangles], nearest), origins)
        return np.stack([places, points], axis=1)[alike]


def _ring(mesh: _core.SurfaceMesh, loop: int, count: int) -> _Points:
    """Evenly spaced points along a loop, counter-clockwise seen from in front of it."""
    centre, front = _opening(mesh, loop)
    points = mesh.vertices[mesh.boundary_loops[loop].vertices]
    points = points if _normal(points, centre) @ (front - centre) > 0 else points[::-1]
    closed = np.vstack([points, points[:1]])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    places = np.linspace(0, along[-1], count, endpoint=False)
    return np.stack([np.interp(places, along, closed[:, axis]) for axis in range(3)], axis=1)


def _spread(mesh: _core.SurfaceMesh) -> NDArray[np.int64]:
    """Triangles far from each other, each next one as far as can be from those before."""
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    chosen = [0]
    distances = np.linalg.norm(centres - centres[0], axis=1)
    while len(chosen) < min(_SAMPLES, len(centres)):
        chosen.append(int(distances.argmax()))
        distances = np.minimum(distances, np.linalg.norm(centres - centres[chosen[-1]], axis=1))
    return np.array(chosen)


def _alike(first: _Points, second: _Points) -> NDArray[np.bool_]:
    """Where normals agree; surfaces that are wound the other way round as a whole make no difference."""
    cosines = np.einsum("ti,ti->t", first, second)
    return np.asarray(cosines * (1 if cosines.sum() >= 0 else -1) >= _ALIKE)


def _weights(corners: _Points, points: _Points) -> _Points:
    """Barycentric coordinates of points in triangles, (n, 3)."""
    first, second, offset = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], points - corners[:, 0]
    normal = np.cross(first, second)
    size = np.einsum("ti,ti->t", normal, normal)
    size[size == 0] = np.inf
    u = np.einsum("ti,ti->t", np.cross(offset, second), normal) / size
    v = np.einsum("ti,ti->t", np.cross(first, offset), normal) / size
    return np.stack([1 - u - v, u, v], axis=1)


def _unit(vectors: _Points) -> _Points:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(size > 0, size, 1))
