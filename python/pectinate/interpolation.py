"""Interpolating an orientation field from a few tracts, once or live in an editor."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate import _core
from pectinate.checks import one_of, quoted, real, whole
from pectinate.errors import InvalidOption
from pectinate.interpolated_field import InterpolatedField
from pectinate.io import load
from pectinate.io.tract_file import read_tracts
from pectinate.loops import LoopChoice, find_loop
from pectinate.parameterization import parameterize
from pectinate.tracts import BoundaryCondition, Rule, SurfaceIdentity, Tract, TractSet, core_conditions

Method = Literal["connection", "reference_frame"]
METHODS: tuple[Method, ...] = ("connection", "reference_frame")


def interpolate(surface: Any, tracts: TractSet | str | os.PathLike[str], **options: Any) -> InterpolatedField:
    """Interpolate an orientation field from tracts and boundary conditions (paper section 2.3).

    Everywhere between them the phase exp(2 i theta) is as smooth as can be; a component of the surface without any gets
    the smoothest field that it can have.

    Parameters
    ----------
    surface
        A `Model`, or anything that `pectinate.load` takes; a field that it has is replaced.
    tracts
        A `TractSet`, or a file of one. They need not have been drawn on this surface: the notes say so.
    options
        Those of `FieldEditor`.

    Returns
    -------
    InterpolatedField

    Raises
    ------
    InvalidFile
        The file of tracts is missing or malformed.
    InvalidOption
        Naming the tract or the loop: a tract point too far from the surface, consecutive points on different
        components, a loop that does not exist or has two conditions; an option out of its range.
    InvalidMesh
        A reference frame is asked for, and the surface is closed, has handles or several components.
    TypeError
        An unknown option, or one of another type.
    """
    return FieldEditor(surface, tracts, **options).field()


class FieldEditor:
    """Tracts and conditions on one surface that change one by one; the field follows at a fraction of a fresh solve.

    An edit that fails leaves everything as it was. Not for several threads at once.

    Parameters
    ----------
    surface
        A `Model`, or anything that `pectinate.load` takes.
    tracts
        To begin with; a `TractSet` or a file of one.
    method
        "connection": the phase exp(2 i theta) is carried from triangle to triangle by unfolding them; for any surface.
        "reference_frame": the paper's way, theta in a frame for the whole surface; see `pectinate.parameterize`.
    outer_loop, inner_loop, inner_point
        Of the reference frame, as in `pectinate.parameterize`. Given with method "connection", the frame is made for
        `InterpolatedField.angles` only.
    maximum_distance
        mm: a tract point farther from the surface is an error; by default a hundredth of the bounding box's diagonal.
    conflict_angle
        Radians in (0, pi/2]: tracts that differ by more in a triangle are in conflict, else they are averaged; by
        default 30 degrees.

    Raises
    ------
    InvalidFile, InvalidOption, InvalidMesh, TypeError
        As in `interpolate`.
    """

    def __init__(  # noqa: PLR0913
        self,
        surface: Any,
        tracts: TractSet | str | os.PathLike[str] | None = None,
        *,
        method: Method = "connection",
        outer_loop: LoopChoice | None = None,
        inner_loop: LoopChoice | None = None,
        inner_point: ArrayLike | None = None,
        maximum_distance: float | None = None,
        conflict_angle: float | None = None,
    ) -> None:
        one_of(method, "method", METHODS)
        given = _tract_set(tracts)
        self.model = load(surface).with_loop_points(given.loops)
        self.method = method
        framed = method == "reference_frame" or any(x is not None for x in (outer_loop, inner_loop, inner_point))
        self.disk_map = (
            parameterize(self.model, outer_loop=outer_loop, inner_loop=inner_loop, inner_point=inner_point)
            if framed
            else None
        )
        limits = {"maximum_distance": maximum_distance, "conflict_angle": conflict_angle}
        self._limits: dict[str, Any] = {name: real(limit, name) for name, limit in limits.items() if limit is not None}
        identity = SurfaceIdentity.of(self.model)
        self._drawn_on = given.surface or identity
        self._notes = _surface_notes(self._drawn_on, identity)
        self._projector = _core.TractProjector(self.model.mesh)
        self._interpolator = self._make_interpolator()
        conditions = core_conditions(self.model, given.boundary)
        self._adopt(
            dict(enumerate(given.tracts)),
            {core.loop: condition for core, condition in zip(conditions, given.boundary, strict=True)},
        )
        self._next_number = len(given.tracts)

    @property
    def tracts(self) -> TractSet:
        """All tracts and conditions as they are now, to be saved."""
        return TractSet(
            tuple(self._tracts.values()), tuple(self._conditions.values()), self.model.data.loop_points, self._drawn_on
        )

    def add(self, tract: Tract) -> int:
        """Add a tract; returns the number by which it is moved and removed, which no other tract ever gets.

        Raises
        ------
        InvalidOption
            The tract does not lie on the surface; see `interpolate`.
        TypeError
            It is no `Tract`.
        """
        if not isinstance(tract, Tract):
            raise TypeError(f"tract is {quoted(tract)}, but must be a Tract")
        number = self._next_number
        self._adopt({**self._tracts, number: tract}, self._conditions)
        self._next_number += 1
        return number

    def remove(self, number: int) -> None:
        """Take a tract away; those given in the beginning are numbered from 0.

        Raises
        ------
        InvalidOption
            There is no tract of this number.
        """
        self._tract(number)
        self._adopt({key: tract for key, tract in self._tracts.items() if key != number}, self._conditions)

    def move(self, number: int, points: ArrayLike) -> None:
        """Give a tract other points, (n, 3), mm.

        Raises
        ------
        InvalidOption
            There is no tract of this number, or as in `add`.
        """
        moved = replace(self._tract(number), points=cast("NDArray[np.float64]", points))
        self._adopt({**self._tracts, number: moved}, self._conditions)

    def set_condition(self, loop: LoopChoice, rule: Rule, *, weight: float = math.inf) -> None:
        """Say what fibres do along a boundary loop; "free" takes a condition away.

        Raises
        ------
        InvalidOption
            There is no such loop or rule, or the weight is out of its range.
        """
        condition = BoundaryCondition(loop, rule, weight)
        index = find_loop(self.model, loop)
        conditions = {key: other for key, other in self._conditions.items() if key != index}
        self._adopt(self._tracts, conditions if rule == "free" else {**conditions, index: condition})

    def field(self) -> InterpolatedField:
        """Interpolate the field under the tracts and conditions as they are now."""
        solved = self._interpolator.interpolate(self._constraints)
        counts = f"{len(self._tracts)} tracts and {len(self._conditions)} boundary conditions"
        return InterpolatedField(
            model=self.model.with_field(solved.field, f"the field is interpolated from {counts} ({self.method})"),
            confidence=solved.confidence,
            tracts=self.tracts,
            tract_numbers=tuple(self._tracts),
            constraints=self._constraints,
            conditions=tuple(core_conditions(self.model, tuple(self._conditions.values()))),
            method=self.method,
            disk_map=self.disk_map,
            notes=self._notes,
        )

    def _make_interpolator(self) -> _core.FieldInterpolator:
        if self.method == "connection":
            return _core.FieldInterpolator(self.model.mesh)
        assert self.disk_map is not None
        return _core.FieldInterpolator(self.model.mesh, self.disk_map.frame)

    def _adopt(self, tracts: dict[int, Tract], conditions: dict[int, BoundaryCondition]) -> None:
        """Bring tracts and conditions to the surface, and keep them if that succeeds."""
        self._constraints = self._projector.make_constraints(
            [tract.to_core(number) for number, tract in tracts.items()],
            core_conditions(self.model, tuple(conditions.values())),
            **self._limits,
        )
        self._tracts, self._conditions = tracts, conditions

    def _tract(self, number: int) -> Tract:
        if whole(number, "the number of a tract") not in self._tracts:
            known = ", ".join(map(str, self._tracts)) or "none"
            raise InvalidOption(f"there is no tract {quoted(number)}; there are {known}")
        return self._tracts[number]


def _tract_set(tracts: Any) -> TractSet:
    if tracts is None:
        return TractSet()
    if isinstance(tracts, TractSet):
        return tracts
    if not isinstance(tracts, (str, os.PathLike)):
        raise TypeError(f"tracts is {quoted(tracts)}, but must be a TractSet or the path of a file of one")
    return read_tracts(tracts)


def _surface_notes(drawn_on: SurfaceIdentity, surface: SurfaceIdentity) -> tuple[str, ...]:
    differences = drawn_on.differences(surface)
    if not differences:
        return ()
    return (f"the tracts were drawn on another surface, {drawn_on.source}: {', '.join(differences)}",)
