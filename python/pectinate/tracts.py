"""Fibre tracts as drawn on a surface, what fibres do at its borders, and the file that holds both."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate import _core
from pectinate.errors import InvalidOption
from pectinate.loops import LoopChoice, find_loop, three_numbers
from pectinate.model import Model

Rule = Literal["free", "parallel", "perpendicular"]
RULES: tuple[Rule, ...] = ("free", "parallel", "perpendicular")

_LEAST_POINTS = 2
_CHECKSUM_GRID = 1e-3  # mm
_SAME_AREA = 1e-6  # relative


@dataclass(frozen=True, eq=False)
class Tract:
    """A fibre tract: a polyline in space near the surface. Its sense means nothing.

    Attributes
    ----------
    points
        (n, 3) float64, mm, at least two; the first again at the end closes it.
    name
        For messages and reports.
    weight
        Positive; infinity: fibres follow it exactly; 1 pulls about as much as one neighbouring triangle.
    description
        For people.

    Raises
    ------
    InvalidOption
        Points of another shape or not finite, or a weight that is not positive.
    """

    points: NDArray[np.float64]
    name: str = ""
    weight: float = math.inf
    description: str = ""

    def __post_init__(self) -> None:
        """Check and copy what was given."""
        object.__setattr__(self, "points", _points(self.points, self.name))
        _check_weight(self.weight, f"tract {self.name!r}")

    def to_core(self) -> _core.Tract:
        """The tract as the engine has it."""
        return _core.Tract(self.points, name=self.name, weight=self.weight)


@dataclass(frozen=True, eq=False)
class BoundaryCondition:
    """What fibres do along a boundary loop; loops without a condition are free.

    Attributes
    ----------
    loop
        Index, name or nearest point; see `pectinate.loops.find_loop`.
    rule
        "parallel", "perpendicular" or "free".
    weight
        As of a tract.

    Raises
    ------
    InvalidOption
        Another rule, or a weight that is not positive.
    """

    loop: LoopChoice
    rule: Rule
    weight: float = math.inf

    def __post_init__(self) -> None:
        """Check what was given."""
        if self.rule not in RULES:
            raise InvalidOption(f"boundary rule {self.rule!r} is not known; use one of: {', '.join(RULES)}")
        _check_weight(self.weight, f"the condition of loop {self.loop!r}")


@dataclass(frozen=True)
class SurfaceIdentity:
    """By what a surface is recognised.

    Attributes
    ----------
    source
        Where it came from.
    vertex_count, triangle_count
        Of the source.
    area
        mm^2, of the mesh.
    bounding_box
        Least and greatest coordinates of the mesh, mm.
    checksum
        Of the source's triangles and its vertices, rounded to 0.001 mm.
    """

    source: str
    vertex_count: int
    triangle_count: int
    area: float
    bounding_box: tuple[tuple[float, float, float], tuple[float, float, float]]
    checksum: str

    @classmethod
    def of(cls, model: Model) -> SurfaceIdentity:
        """Describe the surface of a model."""
        vertices, data = model.mesh.vertices, model.data
        box = tuple(tuple(float(x) for x in corner) for corner in (vertices.min(axis=0), vertices.max(axis=0)))
        return cls(
            source=data.source,
            vertex_count=len(data.vertices),
            triangle_count=len(data.triangles),
            area=float(model.mesh.area),
            bounding_box=cast(tuple[tuple[float, float, float], tuple[float, float, float]], box),
            checksum=_checksum(data.vertices, data.triangles),
        )

    def differences(self, other: SurfaceIdentity) -> list[str]:
        """Say in what another surface differs from this one, one clause each; nothing for the same surface."""
        if self.checksum == other.checksum:
            return []
        counts = [
            f"{getattr(self, name):,} {what} against {getattr(other, name):,}"
            for name, what in (("vertex_count", "vertices"), ("triangle_count", "triangles"))
            if getattr(self, name) != getattr(other, name)
        ]
        if not math.isclose(self.area, other.area, rel_tol=_SAME_AREA):
            counts.append(f"{self.area:.1f} mm2 against {other.area:.1f}")
        return counts or ["the same counts, but other vertices or triangles"]


@dataclass(frozen=True, eq=False)
class TractSet:
    """Tracts and boundary conditions: what a field is interpolated from.

    Attributes
    ----------
    tracts
        Of two that contradict each other, the first prevails; tracts prevail over boundary conditions.
    boundary
        At most one condition a loop.
    loops
        For each loop with a name a point (3,), mm: the name goes to the boundary loop nearest to it.
    surface
        The surface that the tracts were drawn on; None where nobody says. They may be used on others.
    """

    tracts: tuple[Tract, ...] = ()
    boundary: tuple[BoundaryCondition, ...] = ()
    loops: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    surface: SurfaceIdentity | None = None

    def __post_init__(self) -> None:
        """Take any sequences."""
        object.__setattr__(self, "tracts", tuple(self.tracts))
        object.__setattr__(self, "boundary", tuple(self.boundary))
        loops = {name: _point(point, name) for name, point in self.loops.items()}
        object.__setattr__(self, "loops", loops)

    def curves_on(self, model: Model) -> list[NDArray[np.float64]]:
        """Bring the tracts to the surface of a model, as curves (k, 3) on it, mm, such as for pictures.

        Raises
        ------
        InvalidOption
            A tract is too far from the surface.
        """
        projector = _core.TractProjector(model.mesh)
        constraints = projector.make_constraints([tract.to_core() for tract in self.tracts])
        return [curve.points for curve in constraints.tracts]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a `.json` file that people can read and edit; see `pectinate.io.tract_file`.

        Raises
        ------
        InvalidFile
            It cannot be written.
        """
        from pectinate.io.tract_file import write_tracts  # noqa: PLC0415  (it imports this module)

        write_tracts(self, path)


def core_conditions(model: Model, conditions: tuple[BoundaryCondition, ...]) -> list[_core.BoundaryCondition]:
    """Find the loops of conditions.

    Raises
    ------
    InvalidOption
        A loop that does not exist, or one with two conditions, naming both.
    """
    found: dict[int, BoundaryCondition] = {}
    for condition in conditions:
        loop = find_loop(model, condition.loop)
        if loop in found:
            both = f"{found[loop].loop!r} and {condition.loop!r}"
            raise InvalidOption(f"the conditions of {both} are for the same boundary loop {loop}; keep one")
        found[loop] = condition
    rules = _core.BoundaryRule.__members__
    return [_core.BoundaryCondition(loop, rules[c.rule], weight=c.weight) for loop, c in found.items()]


def _points(values: ArrayLike, name: str) -> NDArray[np.float64]:
    try:
        points = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidOption(f"the points of tract {name!r} are no numbers, (n, 3) ({error})") from error
    if points.shape[1:] != (3,) or len(points) < _LEAST_POINTS:
        raise InvalidOption(f"tract {name!r} has points of the shape {points.shape}; give (n, 3), at least two, mm")
    if not np.isfinite(points).all():
        row = int(np.argmin(np.isfinite(points).all(axis=1)))
        raise InvalidOption(f"tract {name!r}: point {row} is {points[row].tolist()}; use finite numbers")
    points.setflags(write=False)
    return points


def _point(values: ArrayLike, name: str) -> NDArray[np.float64]:
    point = three_numbers(values, f"the point of loop {name!r}")
    point.setflags(write=False)
    return point


def _check_weight(weight: float, what: str) -> None:
    if isinstance(weight, bool) or not isinstance(weight, Real) or not weight > 0:
        raise InvalidOption(f"the weight of {what} is {weight}; it must be positive, or infinite for exactly")


def _checksum(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> str:
    """A number for the whole surface that does not depend on the byte order of the machine, in hexadecimal digits."""
    rounded = np.rint(vertices / _CHECKSUM_GRID) + 0.0  # no negative zeros
    rounded[np.isnan(rounded)] = np.nan  # one kind of NaN
    digest = hashlib.blake2b(rounded.astype("<f8").tobytes(), digest_size=8)
    digest.update(triangles.astype("<i8").tobytes())
    return digest.hexdigest()
