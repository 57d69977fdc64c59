"""Pictures and a page of the built-in atria, after the paper's Fig. 8 and 9."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from pectinate.datasets.atria import FIBRE_RULES
from pectinate.figure import Cell, Marker, Part, Style, View, figure_sheet
from pectinate.interpolated_field import InterpolatedField
from pectinate.placement import Placement
from pectinate.viewer import Page

#: From the right and above, where crista terminalis, free wall and the roots of the venae cavae are seen.
_RIGHT_SUPERIOR = View("right superior", (1.0, -0.25, -0.5), (0.0, 0.0, 1.0))
_FIBRE_VIEWS: Sequence[str | View] = ("anterior", "posterior", _RIGHT_SUPERIOR)
_TRACT_VIEWS = ("anterior", "posterior")
_PICTURE_SIZE = (900, 800)  # pixels
_TRACT_RADIUS = 0.5  # mm
_TRACT_COLOR = (0.72, 0.12, 0.10)  # beside black streamlines
#: How far along a tract its number stands; the next share if it is not seen there.
_MARKED_SHARES = (0.5, 0.7, 0.3, 0.85, 0.15)


@dataclass(frozen=True, eq=False)
class AtrialFibres:
    """One surface of the built-in atria: its field, and the streamlines of it."""

    made: InterpolatedField
    placement: Placement

    @property
    def curves(self) -> list[NDArray[np.float64]]:
        """The tracts as curves on the surface, (n, 3) each, mm."""
        return [curve.points for curve in self.made.constraints.tracts]

    def tract_part(self, name: str, **options: Any) -> Part:
        """Surface and tracts; options are those of `Model.part`."""
        return self.made.model.part(name, tracts=self.curves, tract_radius=_TRACT_RADIUS, **options)

    def markers(self) -> list[Marker]:
        """The number of its row on a tract, once for all tracts of one name."""
        groups: dict[tuple[str, str], list[NDArray[np.float64]]] = {}
        for tract, curve in zip(self.made.tracts.tracts, self.curves, strict=True):
            if tract.label:
                groups.setdefault((tract.label, tract.name), []).append(curve)
        return [_marker(label, curves) for (label, _), curves in groups.items()]


#: Chambers by name, per layer.
AtrialLayers = Mapping[str, Mapping[str, AtrialFibres]]


def fibre_sheet(layers: AtrialLayers, path: str | os.PathLike[str] | None = None, **options: Any) -> Image.Image:
    """Draw the streamlines of every layer in three views, with the numbers of `FIBRE_RULES` (paper Fig. 8).

    Parameters
    ----------
    layers
        A column for each.
    path
        Where to write the sheet; by default nowhere.
    options
        Of `pectinate.figure.figure_sheet`.
    """
    columns = {
        layer: ([shown.placement.part(name) for name, shown in chambers.items()], _markers(chambers))
        for layer, chambers in layers.items()
    }
    cells = [[Cell(parts, view, markers=markers) for parts, markers in columns.values()] for view in _FIBRE_VIEWS]
    return _draw(cells, _FIBRE_VIEWS, list(layers), path, options)


def tract_sheet(layers: AtrialLayers, path: str | os.PathLike[str] | None = None, **options: Any) -> Image.Image:
    """Draw the tracts of every layer as black lines, from the front and from behind (paper Fig. 9)."""
    columns = [[shown.tract_part(name) for name, shown in chambers.items()] for chambers in layers.values()]
    cells = [[Cell(parts, view) for parts in columns] for view in _TRACT_VIEWS]
    return _draw(cells, _TRACT_VIEWS, list(layers), path, options)


def atria_page(layers: AtrialLayers) -> Page:
    """Make a page of all surfaces, the first layer switched on, with tracts, numbers and what they stand for."""
    parts, markers = [], []
    for layer, chambers in layers.items():
        markers += _markers(chambers)
        for name, shown in chambers.items():
            title = f"{name.replace('_', ' ')}, {layer}"
            first = layer == next(iter(layers))
            parts.append(shown.placement.part(title, visible=first, tracts=shown.curves, tract_radius=_TRACT_RADIUS))
    notes = [f"{row} {rule}" for row, rule in FIBRE_RULES.items()]
    style = Style(tract_color=_TRACT_COLOR)
    return Page(parts, markers=markers, title="Fibres of the atria", notes=notes, style=style)


def _marker(label: str, curves: list[NDArray[np.float64]]) -> Marker:
    """A marker on the curve in the middle, or where else on the curves it is seen."""
    middle_first = sorted(range(len(curves)), key=lambda i: abs(i - len(curves) // 2))
    places = [_at(curves[i], share) for i in middle_first for share in _MARKED_SHARES]
    return Marker(places[0], label, places[1:])


def _at(curve: NDArray[np.float64], share: float) -> tuple[float, float, float]:
    x, y, z = curve[int(share * len(curve))].tolist()
    return x, y, z


def _markers(chambers: Mapping[str, AtrialFibres]) -> list[Marker]:
    return [marker for shown in chambers.values() for marker in shown.markers()]


def _draw(
    cells: list[list[Cell]],
    views: Sequence[str | View],
    columns: list[str],
    path: str | os.PathLike[str] | None,
    options: Mapping[str, Any],
) -> Image.Image:
    rows = [view if isinstance(view, str) else view.name for view in views]
    return figure_sheet(cells, path, **{"size": _PICTURE_SIZE, "row_titles": rows, "column_titles": columns, **options})
