"""Robust smoothing of measured orientation fields."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from pectinate import _core
from pectinate.angle_statistics import angle_statistics, angle_statistics_per_region
from pectinate.checks import flag, one_of, real
from pectinate.errors import InvalidOption
from pectinate.io import load, save_surface
from pectinate.model import Model

Barriers = Literal["none", "tags"]
BARRIERS: tuple[Barriers, ...] = ("none", "tags")


@dataclass(frozen=True, eq=False)
class SmoothedField:
    """A smoothed orientation field.

    Attributes
    ----------
    model
        The surface with the smoothed field.
    moved_angles
        (T,) float64 per mesh triangle, radians in [0, pi/2]: how far the fibre was moved; NaN where it had or has none.
    outliers
        (T,) bool per mesh triangle: the fibre was replaced by what the others around it say.
    options
        What was asked for; the library's defaults for the rest.
    """

    model: Model
    moved_angles: NDArray[np.float64]
    outliers: NDArray[np.bool_]
    options: dict[str, Any]

    @property
    def field(self) -> _core.OrientationField:
        """The field, per mesh triangle."""
        return self.model.require_field()

    def save(self, path: str | os.PathLike[str], **options: Any) -> list[Path]:
        """Write surface and field as `pectinate.save_surface` does; VTK files with `moved_angle`, radians.

        Raises
        ------
        InvalidFile, InvalidOption, MissingDependency
            As in `save_surface`.
        """
        return save_surface(self.model, path, cell_data={"moved_angle": self.moved_angles}, **options)

    def report(self) -> dict[str, Any]:
        """How far fibres were moved, of all triangles and per region tag, ready for JSON; angles in degrees."""
        options = self.options
        if "outlier_angle" in options:
            options = options | {"outlier_angle": math.degrees(options["outlier_angle"])}
        return {
            "options": options,
            "moved": angle_statistics(self.moved_angles),
            "moved_per_region": angle_statistics_per_region(self.moved_angles, self.model.tags),
            "outliers": int(np.count_nonzero(self.outliers)),
        }


def smooth(
    surface: Any,
    *,
    length: float | None = None,
    barriers: Barriers = "none",
    outlier_angle: float | None = None,
    fill_missing: bool = False,
) -> SmoothedField:
    """Smooth a measured field: without signs, and hardly drawn by outliers.

    Fibres that differ from the consensus around them are replaced by what the others say; these are smoothed lightly.
    The consensus minimises a robust loss of exp(2 i theta) plus a Dirichlet energy, with parallel transport between
    triangles.

    Parameters
    ----------
    surface
        A `Model`, or anything that `pectinate.load` takes.
    length
        mm: the size of what is smoothed away, the standard deviation of the weight that falls off around a fibre; from
        a millionth of the bounding box's diagonal to ten of them; by default 1.5.
    barriers
        "tags": nothing is exchanged between regions of different tag.
    outlier_angle
        Radians in (0, pi/2]: a fibre that differs by more from those around it is replaced; by default 17 degrees.
    fill_missing
        Give a direction to triangles that have none too.

    Raises
    ------
    InvalidOption
        An option out of its range, or barriers by tags without tags.
    InvalidField
        The surface has no orientation field.
    TypeError
        A length or an angle that is no number, or `fill_missing` neither True nor False.
    """
    model = load(surface)
    field = model.require_field()
    options = {"length": length, "outlier_angle": outlier_angle}
    given: dict[str, Any] = {name: real(value, name) for name, value in options.items() if value is not None}
    given["fill_missing"] = flag(fill_missing, "fill_missing")
    result = _core.smooth(model.mesh, field, barriers=_labels(model, barriers), **given)
    return SmoothedField(
        model=model.with_field(result.field, "the field is smoothed"),
        moved_angles=result.moved_angles,
        outliers=result.outliers.astype(bool),
        options={**given, "barriers": barriers},
    )


def _labels(model: Model, barriers: str) -> NDArray[np.int32] | None:
    one_of(barriers, "barriers", BARRIERS)
    if barriers == "none":
        return None
    if model.tags is None:
        raise InvalidOption(f"{model.data.source} has no region tags to serve as barriers; use barriers='none'")
    return np.unique(model.tags, return_inverse=True)[1].ravel().astype(np.int32)
