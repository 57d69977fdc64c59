"""Comparing orientation fields, on one surface or on two, and making them noisy."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from pectinate import _core
from pectinate.angle_statistics import angle_statistics, angle_statistics_per_region
from pectinate.checks import one_of, quoted, real, whole
from pectinate.errors import InvalidField, InvalidOption
from pectinate.figure.values import SurfaceValues
from pectinate.io import load, save_surface
from pectinate.loops import LoopChoice, find_loop
from pectinate.model import Model
from pectinate.parameterization import DiskMap, parameterize

How = Literal["same", "nearest", "disks"]
HOW: tuple[How, ...] = ("same", "nearest", "disks")

_SAME_POSITION = 1e-6  # of the bounding box's diagonal


@dataclass(frozen=True, eq=False)
class Comparison:
    """The angles between two orientation fields on the second one's surface.

    Attributes
    ----------
    model
        The second surface with the first one's field, as it was carried there.
    angles
        (T,) float64 per mesh triangle, radians in [0, pi/2]; NaN where either field has no direction.
    distances
        (T,) float64, mm: from each triangle's centre to its counterpart; None on the same surface.
    regions
        (T,) int64; None without.
    how
        "same", "nearest" or "disks".
    """

    model: Model
    angles: NDArray[np.float64]
    distances: NDArray[np.float64] | None
    regions: NDArray[np.int64] | None
    how: str

    def save(self, path: str | os.PathLike[str], **options: Any) -> list[Path]:
        """Write surface and carried field as `pectinate.save_surface` does; VTK files with `angle`, radians.

        Raises
        ------
        InvalidFile, InvalidOption, MissingDependency
            As in `save_surface`.
        """
        return save_surface(self.model, path, cell_data={"angle": self.angles}, **options)

    def figure(self, path: str | os.PathLike[str] | None = None, **sheet_options: Any) -> Image.Image:
        """Draw the surface coloured by the angle, in degrees.

        Parameters
        ----------
        path
            Where to write the picture; by default nowhere.
        sheet_options
            Of `pectinate.figure.draw_sheet`.

        Raises
        ------
        InvalidOption, InvalidFile, RenderingUnavailable, MissingDependency
            As `Placement.figure`.
        """
        values = SurfaceValues(np.degrees(self.angles), value_range=(0, 90), label="angle, degrees")
        return self.model.figure(path, **{"surface_values": values, **sheet_options})

    def report(self) -> dict[str, Any]:
        """Statistics of the angles, of all triangles and per region, ready for JSON; in degrees, distances in mm."""
        found = None if self.distances is None else self.distances[np.isfinite(self.distances)]
        distances = None if found is None or len(found) == 0 else {"median": np.median(found), "greatest": found.max()}
        return {
            "how": self.how,
            "angles": angle_statistics(self.angles),
            "angles_per_region": angle_statistics_per_region(self.angles, self.regions),
            "distances": None if distances is None else {name: float(value) for name, value in distances.items()},
        }


def compare(  # noqa: PLR0913
    first: Any,
    second: Any,
    *,
    how: How = "same",
    regions: ArrayLike | None = None,
    maximum_distance: float = math.inf,
    outer_loops: tuple[LoopChoice | None, LoopChoice | None] = (None, None),
    loop_pairs: Sequence[tuple[LoopChoice, LoopChoice]] | None = None,
) -> Comparison:
    """Compare two orientation fields, triangle by triangle of the second one's surface.

    Parameters
    ----------
    first, second
        Models, or anything that `pectinate.load` takes.
    how
        "same": both fields are on the same triangles. "nearest": the first field is taken from the nearest point of
        its surface. "disks": both surfaces are mapped to the unit disk, and the first field is taken from the point at
        the same place.
    regions
        (T,) integers per triangle of the second source, for statistics; by default its tags.
    maximum_distance
        mm, of "nearest" only: triangles farther from the first surface are left out.
    outer_loops
        Of the first and the second surface, of "disks" only; by default the longest of each.
    loop_pairs
        Of "disks" only: loops of the first and of the second surface that correspond, at least one pair of inner loops;
        by default those of the same name.

    Raises
    ------
    InvalidField
        A surface has no field, or "same" is asked for and the surfaces differ.
    InvalidOption
        An option out of its range or of another `how`, a loop that does not exist, or no pairs.
    InvalidMesh
        "disks" for a surface that has no disk; see `pectinate.parameterize`.
    TypeError
        A distance that is no number.
    """
    one_of(how, "how", HOW)
    maximum_distance = real(maximum_distance, "maximum_distance")
    _check_how(how, "maximum_distance", "nearest", given=maximum_distance != math.inf)
    outers = _outer_loops(outer_loops)
    _check_how(how, "outer_loops", "disks", given=any(loop is not None for loop in outers))
    _check_how(how, "loop_pairs", "disks", given=loop_pairs is not None)
    source, target = load(first), load(second)
    field, own_field = source.require_field(), target.require_field()
    distances = None
    match how:
        case "same":
            _check_same(source, target)
        case "nearest":
            moved = _core.transfer_by_nearest_point(source.mesh, field, target.mesh, maximum_distance=maximum_distance)
            field, distances = moved.field, moved.distances
        case "disks":
            pairs = _loop_pairs(source, target, loop_pairs)
            disks = [parameterize(model, outer_loop=loop) for model, loop in zip((source, target), outers, strict=True)]
            moved = _transfer_through_disks(disks[0], disks[1], pairs)
            field, distances = moved.field, moved.distances
    return Comparison(
        model=target.with_field(field, f"the field is that of {source.data.source} ({how})"),
        angles=_core.angles_between(field, own_field),
        distances=distances,
        regions=target.tags if regions is None else _regions(target, regions),
        how=how,
    )


def add_noise(surface: Any, standard_deviation: float, *, random_seed: int = 1) -> Model:
    """Turn every fibre in its triangle's plane by a normal random angle (paper section 3.4).

    Parameters
    ----------
    surface
        A `Model`, or anything that `pectinate.load` takes.
    standard_deviation
        Radians, from 0 to pi.
    random_seed
        In [0, 2^64): the same number gives the same noise.

    Raises
    ------
    InvalidOption
        An option out of its range.
    InvalidField
        The surface has no orientation field.
    TypeError
        A standard deviation or a seed that is no number.
    """
    model = load(surface)
    deviation = real(standard_deviation, "standard_deviation")
    seed = whole(random_seed, "random_seed", 0, 2**64 - 1)
    noisy = _core.add_angular_noise(model.mesh, model.require_field(), standard_deviation=deviation, random_seed=seed)
    note = f"angular noise of standard deviation {math.degrees(deviation):g} degrees was added"
    return model.with_field(noisy, note)


def _transfer_through_disks(source: DiskMap, target: DiskMap, pairs: list[tuple[int, int]]) -> _core.Transfer:
    return _core.transfer_through_disks(
        source.model.mesh,
        source.parameterization,
        source.model.require_field(),
        target.model.mesh,
        target.parameterization,
        loop_pairs=pairs,
    )


def _check_how(how: How, option: str, of: How, *, given: bool) -> None:
    if given and how != of:
        raise InvalidOption(f"{option} is given, but belongs to how={of!r} alone, not to {how!r}; leave it out")


def _outer_loops(given: Any) -> tuple[LoopChoice | None, LoopChoice | None]:
    try:
        first, second = given
    except (TypeError, ValueError):
        raise InvalidOption(f"outer_loops is {quoted(given)}; give two, of the first and second surface") from None
    return first, second


def _loop_pairs(source: Model, target: Model, given: Any) -> list[tuple[int, int]]:
    if given is None:
        names = source.loop_names
        given = [(name, name) for name in target.loop_names if name in names]
    try:
        pairs = [(first, second) for first, second in given]
    except (TypeError, ValueError):
        remedy = "give pairs of loops, of the first and second surface"
        raise InvalidOption(f"loop_pairs is {quoted(given)}; {remedy}") from None
    if not pairs:
        raise InvalidOption(
            "no boundary loops of the two surfaces have the same name; say which correspond: loop_pairs"
        )
    return [(find_loop(source, first), find_loop(target, second)) for first, second in pairs]


def _check_same(source: Model, target: Model) -> None:
    first, second = source.mesh, target.mesh
    tolerance = _SAME_POSITION * float(second.bounding_box_diagonal)
    if not (
        np.array_equal(first.triangles, second.triangles)
        and first.vertices.shape == second.vertices.shape
        and np.allclose(first.vertices, second.vertices, rtol=0, atol=tolerance)
    ):
        pair = f"{source.data.source} and {target.data.source}"
        raise InvalidField(f"{pair} are not the same triangles; compare with how='nearest' or how='disks'")


def _regions(model: Model, regions: ArrayLike) -> NDArray[np.int64]:
    try:
        labels = np.asarray(regions)
    except ValueError:
        labels = np.empty(0)
    if labels.shape != (model.mesh.input_triangle_count,) or labels.dtype.kind not in "iu":
        rule = f"regions has the shape {labels.shape} of {labels.dtype}"
        raise InvalidOption(
            f"{rule}; give integers, one per triangle ({model.mesh.input_triangle_count},) of the source"
        )
    return labels[model.mesh.input_triangle].astype(np.int64)
