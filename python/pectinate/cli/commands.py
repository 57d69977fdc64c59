"""The commands about streamlines: each takes the parsed arguments, does its work and prints its report."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import pectinate
from pectinate.cli import report
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
from pectinate.cli.value_arguments import GivenValues, check_values, given_flags, read_values
from pectinate.errors import InvalidField
from pectinate.model import Model
from pectinate.placement import DEFAULTS, Placement
from pectinate.viewer.page import SUFFIXES as PAGE_SUFFIXES

_TUBE_SUFFIXES = frozenset({".ply", ".obj", ".glb"})
_SUFFIXES = frozenset({".npz", ".vtp", *PAGE_SUFFIXES}) | _TUBE_SUFFIXES
# The keywords of the library by argument, where they are given.
_TUBE_OPTIONS = {
    "tube_radius": "radius",
    "taper_length": "taper_length",
    "side_count": "side_count",
    "tube_height": "height",
}
_FIGURE_OPTIONS = {name: name for name in ("views", "tube_radius", "taper_length", "side_count", "tube_height")}
_PAGE_OPTIONS = {name: name for name in ("views", "tube_radius", "taper_length", "tube_height")}


def place(arguments: argparse.Namespace) -> None:
    """Place streamlines on the surface of a file, save and draw them."""
    _check_outputs(arguments)
    model = load_surface(arguments)
    if model.field is None:
        raise InvalidField(f"{arguments.mesh}: the file gives no fibres; name the array or a file with --field")
    _place(model, read_values(model, arguments), arguments)


def info(arguments: argparse.Namespace) -> None:
    """Describe the surface and the field of a file."""
    summary = with_loop_names(load_surface(arguments), arguments.tracts).summary()
    if arguments.json:
        report.print_json(summary)
    elif not arguments.quiet:
        report.print_rows(report.surface_rows(summary) + report.topology_rows(summary))


def _place(model: Model, values: GivenValues, arguments: argparse.Namespace) -> None:
    summary = model.summary()
    rows = [] if arguments.json or arguments.quiet else report.surface_rows(summary)
    report.print_rows(rows)
    started = time.perf_counter()
    with ProgressBar("placing", enabled=not arguments.quiet) as bar:
        placement = pectinate.place_streamlines(
            model, progress=bar, **given(arguments, {name: name for name in DEFAULTS})
        )
    seconds = time.perf_counter() - started
    _write(placement, values, arguments)
    files = [str(path) for path in _files(arguments)]
    statistics = placement.statistics.to_dict()
    if arguments.json:
        report.print_json(
            {
                "surface": summary,
                "options": placement.options,
                "statistics": statistics,
                "end": placement.end,
                "seconds": seconds,
                "files": files,
            }
        )
    elif not arguments.quiet:
        report.print_rows(report.statistics_rows(statistics))
        report.print_rows([("time", f"{seconds:.2f} s")] + [("written", path) for path in files])


def _write(placement: Placement, values: GivenValues, arguments: argparse.Namespace) -> None:
    """Save and draw what was asked for."""
    with writing():
        for path in _saved_files(arguments):
            shown = {"surface_values": values.surface, "tube_values": values.tubes} if _is_page(path) else {}
            placement.save(path, **shown, **given(arguments, _save_options(path)))
        if arguments.figure is not None:
            with ProgressBar("drawing", enabled=not arguments.quiet) as bar:
                bar(0)
                # Of each kind there is one at most.
                surface, tubes = (next(iter(some.values()), None) for some in (values.surface, values.tubes))
                options = given(arguments, _FIGURE_OPTIONS)
                placement.figure(arguments.figure, surface_values=surface, tube_values=tubes, **options)


def _save_options(path: Path) -> dict[str, str]:
    suffix = path.suffix.lower()
    return _PAGE_OPTIONS if _is_page(path) else _TUBE_OPTIONS if suffix in _TUBE_SUFFIXES else {}


def _is_page(path: Path) -> bool:
    return path.suffix.lower() in PAGE_SUFFIXES


def _check_outputs(arguments: argparse.Namespace) -> None:
    """Refuse what cannot be written before any long work."""
    check_suffixes("--out", arguments.outputs, _SUFFIXES)
    check_suffixes("--tubes", arguments.tubes, _TUBE_SUFFIXES)
    check_figure(arguments)
    check_values(arguments)
    flags = " and ".join(given_flags(arguments))
    if flags and arguments.figure is None and not any(map(_is_page, arguments.outputs)):
        raise UsageError(f"{flags}: only pictures and pages have colours; ask for one, with --figure or --out x.html")
    if arguments.figure is not None and max(len(arguments.values), len(arguments.tube_values)) > 1:
        raise UsageError("--figure: a picture shows one of --values and one of --tube-values; a page, .html, has all")
    check_folders(_files(arguments))


def _saved_files(arguments: argparse.Namespace) -> list[Path]:
    return [*arguments.outputs, *arguments.tubes]


def _files(arguments: argparse.Namespace) -> list[Path]:
    """All files that the user asked for."""
    return _saved_files(arguments) + ([] if arguments.figure is None else [arguments.figure])
