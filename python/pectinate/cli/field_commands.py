"""The commands that make and compare orientation fields."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pectinate
from pectinate.cli import field_report, report
from pectinate.cli.files import (
    check_figure,
    check_folders,
    check_suffixes,
    given,
    load_surface,
    with_loop_names,
    writing,
)
from pectinate.cli.progress import ProgressBar
from pectinate.cli.shared_arguments import UsageError
from pectinate.comparison import Comparison
from pectinate.interpolated_field import InterpolatedField
from pectinate.io import opencarp, vtk
from pectinate.smoothing import SmoothedField

_SUFFIXES = frozenset({*opencarp.SUFFIXES, *vtk.SUFFIXES})
# The keywords of the library by argument.
_FRAME = {"outer": "outer_loop", "inner": "inner_loop", "inner_point": "inner_point"}
_INTERPOLATION = {name: name for name in ("method", "maximum_distance", "conflict_angle")} | _FRAME
_ATLAS = {name: name for name in ("chamber", "layer", "maximum_distance", "method", "conflict_angle")}
_SMOOTHING = {name: name for name in ("length", "barriers", "outlier_angle", "fill_missing")}
_COMPARISON = {"how": "how", "maximum_distance": "maximum_distance", "pairs": "loop_pairs"}


def interpolate(arguments: argparse.Namespace) -> None:
    """Make a field from a file of tracts, save and draw it."""
    _check_outputs(arguments)
    model = load_surface(arguments, field=None)
    started = time.perf_counter()
    result = pectinate.interpolate(model, arguments.tracts, **given(arguments, _INTERPOLATION))
    seconds = time.perf_counter() - started
    written = _save(result, arguments)
    _draw_streamlines(result, arguments)
    found = result.report()
    rows = field_report.interpolation_rows(found)
    _print(arguments, rows, {"surface": result.model.summary(), "interpolation": found, "seconds": seconds}, written)


def atlas(arguments: argparse.Namespace) -> None:
    """Carry the tracts of a built-in atrium to the surface of a file; save and draw them and their field."""
    _check_outputs(arguments)
    tract_files = [] if arguments.tracts_out is None else [arguments.tracts_out]
    check_suffixes("--tracts-out", tract_files, {".json"})
    check_folders(tract_files)
    model = load_surface(arguments, field=None)
    started = time.perf_counter()
    result = pectinate.atlas(model, arguments.loops, **given(arguments, _ATLAS))
    seconds = time.perf_counter() - started
    written = _save(result, arguments)
    with writing():
        for path in tract_files:
            result.tracts.save(path)
    _draw_streamlines(result, arguments)
    found = result.report()
    summary = {"surface": result.model.summary(), "interpolation": found, "seconds": seconds}
    _print(arguments, field_report.interpolation_rows(found), summary, [*written, *tract_files])


def parameterize(arguments: argparse.Namespace) -> None:
    """Map the surface of a file onto the unit disk, and draw it."""
    arguments.outputs = []
    _check_outputs(arguments)
    model = with_loop_names(load_surface(arguments, field=None), arguments.tracts)
    started = time.perf_counter()
    result = pectinate.parameterize(model, **given(arguments, _FRAME))
    seconds = time.perf_counter() - started
    if arguments.figure is not None:
        with writing():
            result.figure(arguments.figure)
    found = result.report()
    rows = field_report.disk_rows(found)
    _print(arguments, rows, {"surface": model.summary(), "disk": found, "seconds": seconds})


def smooth(arguments: argparse.Namespace) -> None:
    """Smooth the field of a file, save and draw it."""
    _check_outputs(arguments)
    model = load_surface(arguments)
    started = time.perf_counter()
    result = pectinate.smooth(model, **given(arguments, _SMOOTHING))
    seconds = time.perf_counter() - started
    written = _save(result, arguments)
    _draw_streamlines(result, arguments)
    found = result.report()
    rows = field_report.smoothing_rows(found)
    _print(arguments, rows, {"surface": model.summary(), "smoothing": found, "seconds": seconds}, written)


def compare(arguments: argparse.Namespace) -> None:
    """Compare the fields of two files, save and draw the angles."""
    _check_outputs(arguments)
    tracts = _tracts_of_two(arguments)
    models = [
        with_loop_names(load_surface(arguments, path), names)
        for path, names in zip((arguments.first, arguments.second), tracts, strict=True)
    ]
    outer_loops = (arguments.outer_first, arguments.outer_second)
    result = pectinate.compare(*models, outer_loops=outer_loops, **given(arguments, _COMPARISON))
    written = _save(result, arguments)
    if arguments.figure is not None:
        with writing():
            result.figure(arguments.figure, **given(arguments, {"views": "views"}))
    found = result.report()
    _print(arguments, field_report.comparison_rows(found), {"comparison": found}, written)


def _tracts_of_two(arguments: argparse.Namespace) -> Sequence[Path | None]:
    """The files that name the loops of the first and of the second surface."""
    files = arguments.tracts
    if not files:
        return None, None
    if arguments.how != "disks":
        raise UsageError("--tracts names loops, which --how disks alone compares by; leave it out")
    if len(files) > 2:  # noqa: PLR2004
        raise UsageError(f"--tracts is given {len(files)} times; give one for both surfaces, or one for each")
    return files[0], files[-1]


def _check_outputs(arguments: argparse.Namespace) -> None:
    """Refuse what cannot be written, and what is said of files that are not asked for, before any long work."""
    _check_serves(arguments, "--out", arguments.outputs, {"second_vectors": "--second", "per_vertex": "--per-vertex"})
    _check_serves(arguments, "--figure", arguments.figure, {"views": "--views", "separation_distance": "--separation"})
    check_suffixes("--out", arguments.outputs, _SUFFIXES)
    check_figure(arguments)
    check_folders(arguments.outputs if arguments.figure is None else [*arguments.outputs, arguments.figure])


def _check_serves(arguments: argparse.Namespace, output: str, wanted: object, flags: dict[str, str]) -> None:
    for name, flag in flags.items():
        if getattr(arguments, name, None) not in (None, False) and not wanted:
            raise UsageError(f"{flag} serves {output} alone, which is not given; add it or leave {flag} out")


def _save(result: InterpolatedField | SmoothedField | Comparison, arguments: argparse.Namespace) -> list[Path]:
    options = given(arguments, {"second_vectors": "second", "per_vertex": "per_vertex"})
    with writing():
        return [file for path in arguments.outputs for file in result.save(path, **options)]


def _draw_streamlines(result: InterpolatedField | SmoothedField, arguments: argparse.Namespace) -> None:
    if arguments.figure is None:
        return
    with ProgressBar("drawing", enabled=not arguments.quiet) as bar:
        placing = given(arguments, {"separation_distance": "separation_distance"})
        placement = pectinate.place_streamlines(result.model, progress=bar, **placing)
        with writing():
            placement.figure(arguments.figure, **given(arguments, {"views": "views"}))


def _print(
    arguments: argparse.Namespace, rows: list[report.Row], found: dict[str, Any], written: Sequence[Path] = ()
) -> None:
    pictures = [] if arguments.figure is None else [arguments.figure]
    files = [str(path) for path in (*written, *pictures)]
    if arguments.json:
        report.print_json(found | {"files": files})
    elif not arguments.quiet:
        if "surface" in found:
            report.print_rows(report.surface_rows(found["surface"]))
        seconds = [("time", f"{found['seconds']:.2f} s")] if "seconds" in found else []
        report.print_rows(rows + seconds + [("written", path) for path in files])
