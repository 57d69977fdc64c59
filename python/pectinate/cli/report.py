"""What the commands print: aligned rows for people, one JSON object for programs."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

_LABEL_WIDTH = 22
_LARGEST_LISTING = 12

Row = tuple[str, str]


def print_rows(rows: Iterable[Row]) -> None:
    """Print labels and values in two columns."""
    for label, value in rows:
        print(f"{label:<{_LABEL_WIDTH}}{value}".rstrip())


def print_json(report: dict[str, Any]) -> None:
    """Print one JSON object (RFC 8259: no NaN) with numpy's numbers and arrays as plain ones."""
    print(json.dumps(report, default=_plain, allow_nan=False, indent=2))


def surface_rows(summary: dict[str, Any]) -> list[Row]:
    """Rows that say which surface was read and what was decided or repaired; `summary` is that of a model."""
    units = summary["units"]
    mesh = summary["mesh"]
    rows = [
        ("surface", summary["source"]),
        ("units", f"{units['unit']} ({units['decided_by']}: {units['reason']})"),
        ("triangles", f"{mesh['triangles']:,} of {summary['input']['triangles']:,}, {mesh['vertices']:,} vertices"),
        ("area", f"{mesh['area']:,.1f} mm2, mean edge length {mesh['mean_edge_length']:.3f} mm"),
        ("repairs", _repairs(summary["repairs"])),
        ("field", _field(summary["field"])),
    ]
    return rows + [("note", note) for note in summary["notes"]]


def topology_rows(summary: dict[str, Any]) -> list[Row]:
    """Rows for extent, components, boundary loops and regions; `summary` is that of a model."""
    low, high = summary["mesh"]["bounding_box"]
    rows = [("extent", " x ".join(f"{b - a:.2f}" for a, b in zip(low, high, strict=True)) + " mm")]
    rows += listing("component", [_component(component) for component in summary["components"]])
    rows += listing("boundary loop", [_loop(loop) for loop in summary["boundary_loops"]])
    rows += [(f"tag {tag}", f"{area:,.1f} mm2") for tag, area in (summary["area_per_tag"] or {}).items()]
    return rows


def statistics_rows(statistics: dict[str, Any]) -> list[Row]:
    """Rows for the figures of a placement."""
    rounds = statistics["polishing_rounds"]
    ends = {reason: count for reason, count in statistics["stop_counts"].items() if count}
    return [
        ("streamlines", f"{statistics['streamline_count']:,}, total length {statistics['total_length']:,.1f} mm"),
        ("mean length", f"{statistics['mean_length']:.2f} mm (weighted {statistics['length_weighted_mean']:.2f} mm)"),
        (
            "mean spacing",
            f"{statistics['mean_spacing']:.3f} mm = {statistics['mean_spacing_ratio']:.3f} separation distances",
        ),
        ("shorter than spacing", f"{statistics['short_fraction']:.1%} of the streamlines"),
        ("coverage", f"{statistics['coverage']:.2%}"),
        ("ends", ", ".join(f"{count:,} {reason}" for reason, count in ends.items())),
        *([("polishing", f"{rounds:,} rounds")] if rounds else []),
    ]


def listing(label: str, lines: list[str]) -> list[Row]:
    """Numbered rows, the first few of many."""
    rows = [(f"{label} {number}", line) for number, line in enumerate(lines[:_LARGEST_LISTING])]
    hidden = len(lines) - len(rows)
    return rows + ([(f"{label}s", f"{hidden:,} more, see --json")] if hidden else [])


def _repairs(repairs: dict[str, Any]) -> str:
    made = [f"{name.replace('_', ' ')}: {repair['count']:,}" for name, repair in repairs.items() if repair["count"]]
    return ", ".join(made) or "none"


def _field(field: dict[str, Any] | None) -> str:
    if field is None:
        return "none"
    status = ", ".join(f"{count:,} {name.replace('_', '-')}" for name, count in field["status"].items() if count)
    return (
        f"{field['given_as']} per {field['given_per']}: {status}; out of plane by {field['out_of_plane_median']:.1f} "
        f"degrees (median), {field['out_of_plane_p95']:.1f} (95th percentile)"
    )


def _component(component: dict[str, Any]) -> str:
    handles = "genus" if component["orientable"] else "not orientable, cross-caps"
    return (
        f"{component['triangles']:,} triangles, {component['area']:,.1f} mm2, {component['boundary_loops']} boundary "
        f"loops, {handles} {component['genus']}"
    )


def _loop(loop: dict[str, Any]) -> str:
    centroid = ", ".join(f"{x:.1f}" for x in loop["centroid"])
    tags = "" if loop["tags"] is None else f", tags {', '.join(map(str, loop['tags']))}"
    names = "".join(f"{name}: " for name in loop["names"])
    return f"{names}length {loop['length']:.2f} mm, diameter {loop['diameter']:.2f} mm, at ({centroid}){tags}"


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value)
