"""Choosing a boundary loop of a surface: by index, by name or by the nearest point."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from pectinate import _core
from pectinate.checks import quoted
from pectinate.errors import InvalidOption
from pectinate.model import Model

#: An index into `mesh.boundary_loops`, a name in `Model.loop_names`, or a point (3,), mm: the loop nearest to it.
LoopChoice: TypeAlias = "int | str | Sequence[float] | NDArray[np.float64]"

_COORDINATES = 3


def find_loop(model: Model, which: LoopChoice) -> int:
    """Find a boundary loop.

    Parameters
    ----------
    model
        The surface.
    which
        An index into `model.mesh.boundary_loops`, a name in `model.loop_names`, or a point (3,), mm.

    Returns
    -------
    int
        The index.

    Raises
    ------
    InvalidOption
        There is no such loop; the message lists those that are there.
    """
    count = len(model.mesh.boundary_loops)
    if count == 0:
        raise InvalidOption(f"loop {quoted(which)} does not exist: the surface is closed; choose none")
    if isinstance(which, str):
        names = model.loop_names
        if which not in names:
            raise InvalidOption(f"there is no loop named {quoted(which)}; {_known(names, count)}")
        return names[which]
    if isinstance(which, (int, np.integer)) and not isinstance(which, bool):
        if not 0 <= which < count:
            raise InvalidOption(f"loop {quoted(which)} does not exist; {_known(model.loop_names, count)}")
        return int(which)
    return _core.nearest_boundary_loop(model.mesh, _point(which))


def distance_to_loop(model: Model, loop: int, point: Sequence[float] | NDArray[np.float64]) -> float:
    """Distance, mm, of a point (3,) from the nearest vertex of a boundary loop."""
    vertices = model.mesh.vertices[model.mesh.boundary_loops[loop].vertices]
    return float(np.linalg.norm(vertices - np.asarray(point, float), axis=1).min())


def three_numbers(values: object, what: str) -> NDArray[np.float64]:
    """Take a point, (3,), mm; `what` names it in the message.

    Raises
    ------
    InvalidOption
        It is no three finite numbers.
    """
    try:
        point = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        point = np.empty(0)
    if point.shape != (_COORDINATES,) or not np.isfinite(point).all():
        raise InvalidOption(f"{what} is {quoted(values)}; give three finite numbers, mm")
    return point


def _known(names: dict[str, int], count: int) -> str:
    named = f"the named loops are {', '.join(map(repr, names))}" if names else "no loop has a name"
    return f"{named}; indices go from 0 to {count - 1}, and a point means the loop nearest to it"


def _point(which: object) -> NDArray[np.float64]:
    try:
        return three_numbers(which, "the loop")
    except InvalidOption:
        remedy = "give an index, a name or a point of three numbers, mm"
        raise InvalidOption(f"{quoted(which)} is no boundary loop; {remedy}") from None
