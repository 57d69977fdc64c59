"""A first field for a bare patient surface: the fibre tracts of the built-in atria, carried over."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate import _core
from pectinate.checks import one_of, quoted, real, text
from pectinate.correspondence import Correspondence, correspond, suggestions
from pectinate.datasets import atrial_surface, atrial_tracts
from pectinate.errors import InvalidOption
from pectinate.interpolated_field import InterpolatedField
from pectinate.interpolation import interpolate
from pectinate.io import load
from pectinate.io.loop_file import read_loops
from pectinate.loops import find_loop, three_numbers
from pectinate.model import Model
from pectinate.tracts import BoundaryCondition, SurfaceIdentity, Tract, TractSet

_FARTHEST = 0.1  # of the target's diagonal
_LONGEST_DETOUR = 2.0  # over the straight distance
_SPACING = 3.0  # mm, of the carried tracts' points
_EDGE_LENGTH = 2.0  # mm, of the built-in atrium: only its shape matters
_CHAMBERS = ("left_atrium", "right_atrium")


@dataclass(frozen=True, eq=False)
class CarriedTracts:
    """Tracts and conditions on another surface than the one they were drawn on.

    Attributes
    ----------
    tracts
        On the target, their points brought to its surface, at most 3 mm apart.
    correspondence
        How the surfaces were brought together.
    left_out
        Tracts and conditions that could not be carried, one sentence each.
    """

    tracts: TractSet
    correspondence: Correspondence
    left_out: tuple[str, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """What to check, one sentence each."""
        found = self.correspondence.report()
        apart, source = found["distances"], self.correspondence.source.data.source
        fit = (
            f"the tracts are those of {source}, carried by {len(found['loops'])} loops and nearest points; it came to "
            f"lie {apart['median']:.1f} mm from the surface in the median, at most {apart['greatest']:.1f}"
        )
        return (fit, *self.left_out)


def carry_tracts(
    tracts: TractSet,
    source: Any,
    target: Any,
    *,
    maximum_distance: float | None = None,
) -> CarriedTracts:
    """Carry tracts and boundary conditions from one surface to another that has loops of the same names.

    Parameters
    ----------
    tracts
        Drawn on the source; the names of their loops are known to it, or are added.
    source, target
        Models, or anything that `pectinate.load` takes, with at least three loop names in common.
    maximum_distance
        mm: tracts that end up farther from the target are left out; by default a tenth of its bounding box's diagonal.

    Raises
    ------
    InvalidOption
        As in `pectinate.correspond`; a distance that is not positive; a condition of a loop that the source does not
        have, or a tract that does not lie on it.
    """
    if not isinstance(tracts, TractSet):
        raise TypeError(f"tracts is {quoted(tracts)}, but must be a TractSet")
    bare = load(target)
    limit = _limit(maximum_distance, bare)
    found = correspond(load(source).with_loop_points(tracts.loops), bare)
    conditions, missing = _conditions(tracts, found)
    carried, lost = _carried(tracts.tracts, found, limit)
    loops = {name: bare.data.loop_points[name] for name in found.loops}
    result = TractSet(carried, conditions, loops, SurfaceIdentity.of(bare))
    return CarriedTracts(result, found, (*missing, *lost))


def atlas(
    surface: Any,
    loops: Mapping[str, ArrayLike] | str | os.PathLike[str],
    *,
    chamber: str | None = None,
    layer: str = "epicardium",
    maximum_distance: float | None = None,
    **options: Any,
) -> InterpolatedField:
    """Give a bare atrial surface a first field: that of the tracts of the built-in atrium, carried over.

    It is no measurement: fibres differ from heart to heart, and so may this field from those of the patient.

    Parameters
    ----------
    surface
        A `Model`, or anything that `pectinate.load` takes; a field that it has is replaced.
    loops
        For each opening that is named a point (3,), mm, near it, or a file of them (see `pectinate.io.loop_file`). The
        names are those of `datasets.atrial_surface(chamber).loop_names`, at least three; openings that the surface does
        not have are left away.
    chamber
        `left_atrium` or `right_atrium`; by default the one that has all the names.
    layer
        `epicardium` or `endocardium`.
    maximum_distance
        As in `carry_tracts`.
    options
        Of `pectinate.interpolate`.

    Returns
    -------
    InterpolatedField
        Its notes say how well the surfaces came together, and what was left out.

    Raises
    ------
    InvalidOption
        A name that the chamber does not have, with those that it has; and as in `carry_tracts` and `interpolate`.
    InvalidFile
        The file of loops is missing or malformed.
    """
    points = _loop_points(loops)
    one_of(layer, "layer", tuple(_core.AtrialLayer.__members__))
    chosen = _chamber(tuple(points)) if chamber is None else chamber
    one_of(chosen, "chamber", _CHAMBERS)
    built_in = _built_in(chosen, layer)
    _check_names(tuple(points), built_in, chosen)
    bare = load(surface).with_loop_points(points)
    tracts = atrial_tracts(chosen, layer=layer)
    carried = carry_tracts(tracts, built_in, bare, maximum_distance=maximum_distance)
    made = interpolate(bare, carried.tracts, **options)
    return replace(made, notes=(*made.notes, *carried.notes))


def _loop_points(loops: Any) -> dict[str, NDArray[np.float64]]:
    if isinstance(loops, (str, os.PathLike)):
        given: Mapping[str, Any] = read_loops(loops)
    elif isinstance(loops, Mapping):
        given = loops
    else:
        raise TypeError(f"loops is {quoted(loops)}, but must be a file, or a dict of a point for each name")
    return {
        text(name, "a name in loops").replace("_", " "): three_numbers(at, f"the point of loop {name!r}")
        for name, at in given.items()
    }


def _limit(maximum_distance: Any, target: Model) -> float:
    if maximum_distance is None:
        return float(_FARTHEST * target.mesh.bounding_box_diagonal)
    limit = real(maximum_distance, "maximum_distance")
    if not limit > 0:
        raise InvalidOption(f"maximum_distance is {limit}, but must be positive, mm")
    return limit


@cache
def _built_in(chamber: str, layer: str) -> Model:
    return atrial_surface(chamber, layer=layer, edge_length=_EDGE_LENGTH)


def _chamber(names: tuple[str, ...]) -> str:
    """The chamber that has these names."""
    known = {chamber: list(_built_in(chamber, "epicardium").loop_names) for chamber in _CHAMBERS}
    fitting = [chamber for chamber, its in known.items() if set(names) <= set(its)]
    if len(fitting) == 1:
        return fitting[0]
    listed = "; ".join(f"{chamber}: {', '.join(its)}" for chamber, its in known.items())
    close = suggestions(names, [name for its in known.values() for name in its])
    raise InvalidOption(f"the names of the loops ({', '.join(names)}) do not tell the chamber; {listed}{close}")


def _check_names(names: tuple[str, ...], built_in: Model, chamber: str) -> None:
    known = list(built_in.loop_names)
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InvalidOption(
            f"the {chamber.replace('_', ' ')} has no {', '.join(map(repr, unknown))}; it has "
            f"{', '.join(map(repr, known))}{suggestions(unknown, known)}"
        )


def _conditions(tracts: TractSet, found: Correspondence) -> tuple[tuple[BoundaryCondition, ...], list[str]]:
    """Conditions by names that both surfaces have, and sentences about the others."""
    names = {loop: name for name, loop in found.source.loop_names.items()}
    kept, missing = [], []
    for condition in tracts.boundary:
        name = names.get(find_loop(found.source, condition.loop))
        if name in found.loops:
            kept.append(BoundaryCondition(name, condition.rule, condition.weight))
        else:
            missing.append(f"the surface has no loop named {name or condition.loop!r}: its condition was left out")
    return tuple(kept), missing


def _carried(tracts: tuple[Tract, ...], found: Correspondence, limit: float) -> tuple[tuple[Tract, ...], list[str]]:
    """Tracts on the target, and sentences about those that do not fit there."""
    source, target = _core.TractProjector(found.source.mesh), _core.TractProjector(found.target.mesh)
    kept, lost = [], []
    for number, tract in enumerate(tracts):
        what = f"tract {tract.name or number!r} was left out"
        points = found.carry(_resampled(source, tract, found.source))
        _, nearest, distances = target.nearest_surface_points(points)
        if distances.max() > limit:
            lost.append(f"{what}: it came to lie {distances.max():.1f} mm from the surface")
            continue
        try:
            curve = target.make_constraints([_core.Tract(nearest, name=tract.name)]).tracts[0]
        except InvalidOption as error:
            lost.append(f"{what}: {error}")
            continue
        if curve.greatest_detour > _LONGEST_DETOUR:
            lost.append(f"{what}: between two of its points the surface is {curve.greatest_detour:.1f} times as long")
            continue
        kept.append(replace(tract, points=nearest))
    return tuple(kept), lost


def _resampled(projector: _core.TractProjector, tract: Tract, source: Model) -> NDArray[np.float64]:
    """Points of a tract's curve on its surface, evenly spaced."""
    reach = source.mesh.bounding_box_diagonal
    curve = projector.make_constraints([_core.Tract(tract.points, name=tract.name)], maximum_distance=reach).tracts[0]
    lengths = np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
    along = np.concatenate([[0], np.cumsum(lengths)])
    places = np.linspace(0, along[-1], 1 + max(1, int(np.ceil(along[-1] / _SPACING))))
    return np.stack([np.interp(places, along, curve.points[:, axis]) for axis in range(3)], axis=1)
