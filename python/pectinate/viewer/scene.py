"""A page's scene as JSON, and the arrays that it refers to."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.contours import contour_tubes
from pectinate.figure.frame import MARGIN
from pectinate.figure.parts import Marker, Part, nearest_parts, normal_at, used_vertices
from pectinate.figure.patient_axes import PatientAxes
from pectinate.figure.picture import FOLD_SIZE
from pectinate.figure.polylines import Lines, normals_at, resampled, values_at
from pectinate.figure.shading import Style, fold_losses, light_settings
from pectinate.figure.triangles import Triangles
from pectinate.figure.values import (
    CategoryScale,
    NamedValues,
    Scale,
    SurfaceValues,
    corner_values,
    make_scale,
    shared_label,
)
from pectinate.figure.views import View, resolve_view
from pectinate.figure.writing import ink_color
from pectinate.viewer.encoding import (
    ArrayPack,
    coherent_order,
    first_use_codes,
    quantized_directions,
    quantized_points,
    quantized_values,
)

_COLOR_COUNT = 256

_Scales: TypeAlias = dict[str, tuple[Scale, str]]
_Numbers: TypeAlias = Callable[[SurfaceValues], NDArray[np.float64]]


def describe_scene(
    parts: Sequence[Part],
    markers: Sequence[Marker],
    views: Sequence[str | View],
    axes: str | PatientAxes,
    style: Style,
) -> tuple[dict[str, Any], ArrayPack]:
    """Describe what a page shows.

    Returns
    -------
    dict
        Ready for JSON; lengths in mm, colours display RGB from 0 to 1.
    ArrayPack
        The arrays.

    Raises
    ------
    InvalidOption
        There is no part or no view, a view or axes are unknown, or values do not fit their surface or have no scale.
    MissingDependency
        There are values to show, but Matplotlib is not installed.
    """
    if not parts:
        raise InvalidOption("there is nothing to show: give at least one part")
    if not views:
        raise InvalidOption("views is empty: give at least one")
    vertices = [part.placed(used_vertices(part)) for part in parts]
    points = np.concatenate(vertices)
    pack = ArrayPack()
    scales, tube_scales = _scales_of_surfaces(parts), _scales_of_tubes(parts)
    scene = {
        "parts": [_part(part, (scales, tube_scales), pack, style) for part in parts],
        "markers": _markers(markers, parts),
        "views": [_view(resolve_view(view, points, axes)) for view in views],
        "scales": [_scale(name, scale, label, style) for name, (scale, label) in scales.items()],
        "tube_scales": [_scale(name, scale, label, style) for name, (scale, label) in tube_scales.items()],
        "style": _style(style),
        "light": light_settings(),
        "fold_size": FOLD_SIZE * max(float(np.linalg.norm(np.ptp(some, axis=0))) for some in vertices),
        "margin": MARGIN,
    }
    return scene, pack


def _part(part: Part, scales: tuple[_Scales, _Scales], pack: ArrayPack, style: Style) -> dict[str, Any]:
    vertices, triangles = part.placed(part.surface[0]), np.asarray(part.surface[1])
    triangle_order, vertex_order = coherent_order(vertices, triangles)
    rank = np.zeros(len(vertices), dtype=np.int64)
    rank[vertex_order] = np.arange(len(vertex_order))
    positions, place = quantized_points(vertices[vertex_order])
    surface = place | {
        "positions": pack.add(positions, differences=1),
        "triangles": pack.add(first_use_codes(rank[triangles[triangle_order]])),
    }
    values = []
    for name, (scale, _) in scales[0].items():
        if name in part.surface_values:
            given = SurfaceValues.of(part.surface_values[name])
            array = np.asarray(given.values, dtype=np.float64)
            per_triangle = array.shape == (len(triangles),)
            steps = _steps(array[triangle_order if per_triangle else vertex_order], scale)
            contours = _lines(contour_tubes(part.surface, given), part, {}, pack)
            packed = pack.add(steps, differences=1)
            values.append({"name": name, "per_triangle": per_triangle, "steps": packed, "contours": contours})
    return {
        "name": part.name,
        "visible": part.visible,
        "surface": surface,
        "surface_color": style.surface_color if part.surface_color is None else part.surface_color,
        "values": values,
        "streamlines": _lines(part.streamlines, part, scales[1], pack),
        "tracts": _lines(part.tracts, part, {}, pack),
    }


def _lines(lines: Lines | None, part: Part, scales: _Scales, pack: ArrayPack) -> dict[str, Any] | None:
    if lines is None or len(lines.offsets) < 2:  # noqa: PLR2004
        return None
    points, places, counts = resampled(lines)
    positions, place = quantized_points(part.placed(points))
    normals = normals_at(lines, places)
    values = []
    for name, (scale, _) in scales.items():
        if name in lines.values:
            given = values_at(SurfaceValues.of(lines.values[name]), places)
            steps = _steps(np.asarray(given.values, dtype=np.float64), scale)
            values.append({"name": name, "steps": pack.add(steps, differences=1)})
    return place | {
        "positions": pack.add(positions, differences=2),
        "counts": pack.add(counts.astype(np.uint32)),
        "closed": np.flatnonzero(lines.closed()).tolist(),
        "radius": lines.radius,
        "taper_length": lines.taper_length,
        "height": lines.height,
        "normals": None
        if normals is None
        else pack.add(quantized_directions(normals @ np.asarray(part.rotation).T), 1),
        "values": values,
    }


def _scales_of_surfaces(parts: Sequence[Part]) -> _Scales:
    return _scales([(part.surface_values, _corners_of(part.surface)) for part in parts])


def _corners_of(surface: Triangles) -> _Numbers:
    vertices, triangles = (np.asarray(array) for array in surface)
    return lambda values: corner_values(values, triangles, len(vertices)).ravel()


def _scales_of_tubes(parts: Sequence[Part]) -> _Scales:
    lines = [part.streamlines for part in parts if part.streamlines is not None]
    return _scales([(some.values, lambda values: np.asarray(values.values, dtype=np.float64)) for some in lines])


def _scales(given: Sequence[tuple[NamedValues, _Numbers]]) -> _Scales:
    """Scale and label of each name of values: the first range, map and label that are given count for all parts."""
    scales: _Scales = {}
    for name in dict.fromkeys(name for values, _ in given for name in values):
        told = [(SurfaceValues.of(values[name]), numbers_of) for values, numbers_of in given if name in values]
        numbers = np.concatenate([numbers_of(values) for values, numbers_of in told])
        shared = [values for values, _ in told]
        scales[name] = make_scale(shared, numbers[np.isfinite(numbers)]), shared_label(shared, name)
    return scales


def _steps(numbers: NDArray[np.float64], scale: Scale) -> NDArray[np.uint16]:
    """Numbers as whole steps of the colours that `_scale` lists."""
    if isinstance(scale, CategoryScale):
        indices = scale.indices(numbers)
        return quantized_values(np.where(indices < 0, np.nan, indices + 0.5), 0.0, float(max(len(scale.numbers), 1)))
    return quantized_values(numbers, scale.low, scale.high)


def _scale(name: str, scale: Scale, label: str, style: Style) -> dict[str, Any]:
    shares = (np.arange(_COLOR_COUNT) + 0.5) / _COLOR_COUNT
    if isinstance(scale, CategoryScale):
        palette = np.array([*scale.palette, style.no_value_color])
        colors = palette[(shares * len(scale.numbers)).astype(np.int64)]
        ends: dict[str, Any] = {"categories": scale.names, "low": 0, "high": 1, "ticks": []}
    else:
        colors = scale.colors(scale.low * (1 - shares) + scale.high * shares, style.no_value_color)
        ends = {"low": scale.low, "high": scale.high, "ticks": scale.ticks()}
    rgb = np.rint(255 * colors).astype(np.uint8).tobytes()
    return {"name": name, "label": label, "colors": base64.b64encode(rgb).decode("ascii"), **ends}


def _markers(markers: Sequence[Marker], parts: Sequence[Part]) -> list[dict[str, Any]]:
    """Markers, each with the part that it is shown with, and its places with the outward normals there."""
    described = []
    for marker, index in zip(markers, nearest_parts(markers, parts), strict=True):
        part, places = parts[index], [marker.position, *marker.alternatives]
        shown = [
            {"position": position.tolist(), "normal": normal_at(part, place).tolist()}
            for place, position in zip(places, part.placed(places), strict=True)
        ]
        described.append({"text": marker.text, "part": int(index), "places": shown})
    return described


def _view(view: View) -> dict[str, Any]:
    return {"name": view.name, "rotation": view.rotation().tolist()}


def _style(style: Style) -> dict[str, Any]:
    return {
        "inside_color": style.inside_color,
        "tube_color": style.tube_color,
        "tract_color": style.tract_color,
        "contour_color": style.contour_color,
        "no_value_color": style.no_value_color,
        "background_color": style.background_color,
        "ink_color": [channel / 255 for channel in ink_color(style)],
        "tube_gloss": style.tube_gloss,
        "shadow_color": style.shadow_color,
        "fold_losses": fold_losses(style, shows_values=False),
        "value_fold_losses": fold_losses(style, shows_values=True),
        "edge_darkness": style.edge_darkness,
    }
