"""Fibre tracts as drawn on a surface, what fibres do at its borders, and the file that holds both."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate import _core
from pectinate.checks import all_of, one_of, quoted, real, text
from pectinate.errors import InvalidOption
from pectinate.loops import LoopChoice, find_loop, three_numbers
from pectinate.model import Model

Rule = Literal["free", "parallel", "perpendicular"]
RULES: tuple[Rule, ...] = ("free", "parallel", "perpendicular")

#: The least and the greatest weight that is not infinite.
WEIGHT_RANGE = (_core.LEAST_WEIGHT, _core.GREATEST_WEIGHT)

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
        Infinity: fibres follow it exactly. Else from 1e-6 to 1e12: 1 pulls about as much as one neighbouring triangle.
    description
        For people.
    label
        A few letters to mark it by in pictures, such as the number of a row in a table; several tracts may share one.

    Raises
    ------
    InvalidOption
        Points of another shape or not finite, or a weight out of its range.
    TypeError
        A weight that is no number, a name or a description that is no string.
    """

    points: NDArray[np.float64]
    name: str = ""
    weight: float = math.inf
    description: str = ""
    label: str = ""

    def __post_init__(self) -> None:
        """Check and copy what was given."""
        text(self.name, "name")
        text(self.description, "description")
        object.__setattr__(self, "points", _points(self.points, self.name))
        object.__setattr__(self, "weight", _weight(self.weight, f"tract {self.name!r}"))

    def to_core(self, number: int) -> _core.Tract:
        """The tract as the engine has it, with the number by which messages call it."""
        return _core.Tract(self.points, name=self.name, weight=self.weight, number=number)


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
        Another rule, or a weight out of its range.
    TypeError
        A weight that is no number.
    """

    loop: LoopChoice
    rule: Rule
    weight: float = math.inf

    def __post_init__(self) -> None:
        """Check what was given."""
        one_of(self.rule, "rule", RULES)
        object.__setattr__(self, "weight", _weight(self.weight, f"the condition of loop {quoted(self.loop)}"))


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

    Raises
    ------
    InvalidOption
        A point of a loop that is none.
    TypeError
        Something else than tracts, conditions, points by name or a `SurfaceIdentity`.
    """

    tracts: tuple[Tract, ...] = ()
    boundary: tuple[BoundaryCondition, ...] = ()
    loops: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    surface: SurfaceIdentity | None = None

    def __post_init__(self) -> None:
        """Take any sequences."""
        object.__setattr__(self, "tracts", all_of(self.tracts, "tracts", Tract))
        object.__setattr__(self, "boundary", all_of(self.boundary, "boundary", BoundaryCondition))
        if not isinstance(self.loops, Mapping):
            raise TypeError(f"loops is {quoted(self.loops)}, but must map names to points")
        if not (self.surface is None or isinstance(self.surface, SurfaceIdentity)):
            raise TypeError(f"surface is {quoted(self.surface)}, but must be a SurfaceIdentity or None")
        loops = {text(name, "the name of a loop"): _point(point, name) for name, point in self.loops.items()}
        object.__setattr__(self, "loops", loops)

    def curves_on(self, model: Model) -> list[NDArray[np.float64]]:
        """Bring the tracts to the surface of a model, as curves (k, 3) on it, mm, such as for pictures.

        Raises
        ------
        InvalidOption
            A tract is too far from the surface.
        """
        projector = _core.TractProjector(model.mesh)
        constraints = projector.make_constraints([tract.to_core(number) for number, tract in enumerate(self.tracts)])
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
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidOption(f"the points of tract {name!r} are {quoted(values)}; give numbers, (n, 3), mm") from error
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


def _weight(weight: Any, what: str) -> float:
    number, (least, greatest) = real(weight, f"the weight of {what}"), WEIGHT_RANGE
    if not (least <= number <= greatest or number == math.inf):
        rule = f"but must be from {least:g} to {greatest:g}, or infinite for exactly"
        raise InvalidOption(f"the weight of {what} is {number!r}, {rule}")
    return number


def _checksum(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> str:
    """A number for the whole surface that does not depend on the byte order of the machine, in hexadecimal digits."""
    rounded = np.rint(vertices / _CHECKSUM_GRID) + 0.0  # no negative zeros
    rounded[np.isnan(rounded)] = np.nan  # one kind of NaN
    digest = hashlib.blake2b(rounded.astype("<f8").tobytes(), digest_size=8)
    digest.update(triangles.astype("<i8").tobytes())
    return digest.hexdigest()
