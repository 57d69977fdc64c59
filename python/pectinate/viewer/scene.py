"""A page's scene as JSON, and the arrays that it refers to."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate.errors import InvalidOption
from pectinate.figure.frame import MARGIN
from pectinate.figure.parts import Lines, Marker, Part, nearest_parts, normal_at, used_vertices
from pectinate.figure.patient_axes import PatientAxes
from pectinate.figure.picture import FOLD_SIZE
from pectinate.figure.shading import Style, light_settings
from pectinate.figure.values import ColorScale, SurfaceValues, corner_values, range_of
from pectinate.figure.views import View, resolve_view
from pectinate.figure.writing import ink_color
from pectinate.viewer.encoding import (
    ArrayPack,
    coherent_order,
    first_use_codes,
    quantized_points,
    quantized_values,
)

# Tubes get a ring every so many radii; closer ones do not show.
_RING_SPACING = 1.5
# Nor are rings farther apart than this share of the taper length, so that the taper is followed.
_TAPER_STEP = 0.5
_COLOR_COUNT = 256


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
    scales = _scales(parts)
    scene = {
        "parts": [_part(part, scales, pack, style) for part in parts],
        "markers": _markers(markers, parts),
        "views": [_view(resolve_view(view, points, axes)) for view in views],
        "scales": [_scale(name, scale, label, style) for name, (scale, label) in scales.items()],
        "style": _style(style),
        "light": light_settings(),
        "fold_size": FOLD_SIZE * max(float(np.linalg.norm(np.ptp(some, axis=0))) for some in vertices),
        "margin": MARGIN,
    }
    return scene, pack


def resampled(lines: Lines) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points at even distances along each line, its ends among them, as closely as tubes need them.

    Returns
    -------
    points : (M, 3) float64
        mm, one line after the other.
    counts : (n,) int64
        Points of each line, at least two.
    """
    if len(lines.offsets) < 2:  # noqa: PLR2004
        return np.zeros((0, 3)), np.zeros(0, dtype=np.int64)
    spacing = _RING_SPACING * lines.radius
    if lines.taper_length > 0:
        spacing = min(spacing, _TAPER_STEP * lines.taper_length)
    steps = np.linalg.norm(np.diff(lines.points, axis=0), axis=1)
    first, last = lines.offsets[:-1], lines.offsets[1:] - 1
    # Whole numbers of lines apart, so that no line's samples reach into the next one.
    steps[last[:-1]] = 1.0
    arc = np.append(0.0, np.cumsum(steps))
    counts = np.maximum(2, 1 + np.ceil((arc[last] - arc[first]) / spacing).astype(np.int64))
    rank = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    share = rank / np.repeat(counts - 1, counts)
    samples = np.repeat(arc[first], counts) * (1 - share) + np.repeat(arc[last], counts) * share
    return np.column_stack([np.interp(samples, arc, lines.points[:, axis]) for axis in range(3)]), counts


def _part(part: Part, scales: dict[str, tuple[ColorScale, str]], pack: ArrayPack, style: Style) -> dict[str, Any]:
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
    for name, given in part.surface_values.items():
        array = np.asarray(given.values if isinstance(given, SurfaceValues) else given, dtype=np.float64)
        per_triangle = array.shape == (len(triangles),)
        scale = scales[name][0]
        steps = quantized_values(array[triangle_order if per_triangle else vertex_order], scale.low, scale.high)
        values.append({"name": name, "per_triangle": per_triangle, "steps": pack.add(steps, differences=1)})
    return {
        "name": part.name,
        "visible": part.visible,
        "surface": surface,
        "surface_color": style.surface_color if part.surface_color is None else part.surface_color,
        "values": values,
        "streamlines": _lines(part.streamlines, part, pack),
        "tracts": _lines(part.tracts, part, pack),
    }


def _lines(lines: Lines | None, part: Part, pack: ArrayPack) -> dict[str, Any] | None:
    if lines is None or len(lines.offsets) < 2:  # noqa: PLR2004
        return None
    points, counts = resampled(lines)
    positions, place = quantized_points(part.placed(points))
    return place | {
        "positions": pack.add(positions, differences=2),
        "counts": pack.add(counts.astype(np.uint32)),
        "radius": lines.radius,
        "taper_length": lines.taper_length,
    }


def _scales(parts: Sequence[Part]) -> dict[str, tuple[ColorScale, str]]:
    """Scale and label of each name of values: the first range, map and label that are given count for all parts."""
    scales: dict[str, tuple[ColorScale, str]] = {}
    for name in dict.fromkeys(name for part in parts for name in part.surface_values):
        given = [(part, part.surface_values[name]) for part in parts if name in part.surface_values]
        told = [values for _, values in given if isinstance(values, SurfaceValues)]
        numbers = np.concatenate([_finite_values(part, values) for part, values in given])
        ranges = [values.value_range for values in told if values.value_range is not None]
        low, high = ranges[0] if ranges else range_of(numbers)
        first = told[0] if told else SurfaceValues(())
        scales[name] = (ColorScale(first.colormap, float(low), float(high)), first.label or name)
    return scales


def _finite_values(part: Part, values: SurfaceValues | ArrayLike) -> NDArray[np.float64]:
    array = values.values if isinstance(values, SurfaceValues) else values
    corners = corner_values(array, np.asarray(part.surface[1]), len(np.asarray(part.surface[0])))
    return corners[np.isfinite(corners)]


def _scale(name: str, scale: ColorScale, label: str, style: Style) -> dict[str, Any]:
    shares = (np.arange(_COLOR_COUNT) + 0.5) / _COLOR_COUNT
    colors = scale.colors(scale.low * (1 - shares) + scale.high * shares, style.no_value_color)
    rgb = np.rint(255 * colors).astype(np.uint8).tobytes()
    return {
        "name": name,
        "label": label,
        "low": scale.low,
        "high": scale.high,
        "ticks": scale.ticks(),
        "colors": base64.b64encode(rgb).decode("ascii"),
    }


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
        "no_value_color": style.no_value_color,
        "background_color": style.background_color,
        "ink_color": [channel / 255 for channel in ink_color(style)],
        "tube_gloss": style.tube_gloss,
        "fold_darkness": style.fold_darkness,
        "edge_darkness": style.edge_darkness,
    }
