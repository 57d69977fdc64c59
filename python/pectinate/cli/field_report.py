"""Rows for people about fields that were made, smoothed or compared."""

from __future__ import annotations

from typing import Any

from pectinate.cli.report import Row, listing


def interpolation_rows(found: dict[str, Any]) -> list[Row]:
    """Rows about an interpolated field; `found` is the report of an `InterpolatedField`."""
    singularities = [
        f"index {one['index']:+g} at ({', '.join(f'{x:.1f}' for x in one['position'])})"
        for one in found["singularities"]
    ]
    rows = [
        ("method", found["method"].replace("_", " ")),
        ("constrained", f"{found['constrained_triangles']:,} of {found['triangles']:,} triangles"),
        *listing("tract", [_tract(tract) for tract in found["tracts"]]),
        *(("boundary", f"loop {one['loop']}: {one['rule']}") for one in found["boundary"]),
        *(("conflict", _conflict(one)) for one in found["conflicts"]),
        *listing("singular point", singularities),
        ("energy", f"{found['energy']:.4g}"),
        (
            "confidence",
            f"{found['confidence']['median']:.2f} (median), {found['confidence']['p05']:.2f} (5th percentile)",
        ),
    ]
    disk = [] if found["disk"] is None else disk_rows(found["disk"])
    return rows + disk + [("note", note) for note in found["notes"]]


def disk_rows(found: dict[str, Any]) -> list[Row]:
    """Rows about a map onto the disk; `found` is the report of a `DiskMap`."""
    inner = "none" if found["inner_loop"] is None else f"loop {found['inner_loop']}"
    stretch = found["anisotropy"]
    rows = [
        ("disk", f"outer loop {found['outer_loop']}, inner {inner}"),
        ("flipped triangles", f"{len(found['flipped_triangles']):,}"),
        ("anisotropy", ", ".join(f"{'infinite' if x is None else f'{x:.2f}'} ({at})" for at, x in stretch.items())),
        ("critical points", f"{len(found['critical_points']):,}"),
        ("borrowed frames", f"{found['borrowed_triangles']:,}"),
    ]
    return rows + [("note", note) for note in found["notes"]]


def smoothing_rows(found: dict[str, Any]) -> list[Row]:
    """Rows about a smoothed field; `found` is the report of a `SmoothedField`."""
    return [
        *_angle_rows("moved by", found["moved"], found["moved_per_region"]),
        ("outliers replaced", f"{found['outliers']:,}"),
    ]


def comparison_rows(found: dict[str, Any]) -> list[Row]:
    """Rows about a comparison; `found` is the report of a `Comparison`."""
    rows = _angle_rows("angle", found["angles"], found["angles_per_region"])
    distances = found["distances"]
    if distances is not None:
        rows.append(("distance", f"{distances['median']:.2f} mm (median), at most {distances['greatest']:.2f} mm"))
    return rows


def _angle_rows(label: str, all_angles: dict[str, Any], regions: dict[str, dict[str, Any]] | None) -> list[Row]:
    rows = [(label, _angles(all_angles))]
    return rows + [(f"{label}, tag {tag}", _angles(angles)) for tag, angles in (regions or {}).items()]


def _angles(found: dict[str, Any]) -> str:
    if found["count"] == 0:
        return "no triangle has one"
    return (
        f"{found['median']:.1f} degrees (median), {found['mean']:.1f} (mean), {found['p95']:.1f} (95th percentile); "
        f"{found['below_15']:.1%} below 15, {found['below_30']:.1%} below 30; {found['count']:,} triangles"
    )


def _tract(tract: dict[str, Any]) -> str:
    return (
        f"{tract['name']}: {tract['length']:.1f} mm through {tract['triangles']:,} triangles, at most "
        f"{tract['greatest_distance']:.2f} mm from the surface"
    )


def _conflict(conflict: dict[str, Any]) -> str:
    what = (
        f"{conflict['kept']} crosses itself"
        if conflict["kept"] == conflict["dropped"]
        else f"{conflict['kept']} prevails over {conflict['dropped']}"
    )
    return f"{what} in {len(conflict['triangles']):,} triangles, up to {conflict['greatest_angle']:.0f} degrees"
