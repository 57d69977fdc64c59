"""The command that makes interactive pages."""

from __future__ import annotations

import argparse
from pathlib import Path

import pectinate
from pectinate.cli import report
from pectinate.cli.files import check_folders, check_suffixes, check_views, given, load_surface, writing
from pectinate.cli.progress import ProgressBar
from pectinate.cli.value_arguments import check_values, given_flags, read_values
from pectinate.errors import InvalidOption
from pectinate.placement import DEFAULTS
from pectinate.viewer import Page, Part
from pectinate.viewer.page import SUFFIXES

_TUBES = {name: name for name in ("tube_radius", "taper_length", "tube_height")}


def view(arguments: argparse.Namespace) -> None:
    """Show surfaces with their streamlines on an interactive page: in the browser, or as a file."""
    _check(arguments)
    parts = [_part(path, arguments) for path in arguments.meshes]
    title = arguments.title or ", ".join(path.stem for path in arguments.meshes)
    page = Page(parts, title=title, **given(arguments, {"views": "views"}))
    with writing():
        if arguments.out is None:
            page.show()
        else:
            page.save(arguments.out)
    files = [] if arguments.out is None else [str(arguments.out)]
    counts = [0 if part.streamlines is None else len(part.streamlines.offsets) - 1 for part in parts]
    if arguments.json:
        surfaces = [{"name": part.name, "streamlines": count} for part, count in zip(parts, counts, strict=True)]
        report.print_json({"surfaces": surfaces, "bytes": len(page.html), "files": files})
    elif not arguments.quiet:
        rows = [(part.name, f"{count:,} streamlines") for part, count in zip(parts, counts, strict=True)]
        report.print_rows(rows + [("written", path) for path in files])


def _check(arguments: argparse.Namespace) -> None:
    """Refuse what cannot be done before any long work."""
    if arguments.out is not None:
        check_suffixes("--out", [arguments.out], frozenset(SUFFIXES))
        check_folders([arguments.out])
    check_values(arguments)
    if len(arguments.meshes) > 1 and (given_flags(arguments) or arguments.tracts is not None):
        raise InvalidOption("--values, --tube-values and --tracts belong to one surface: give one MESH")
    check_views(arguments)


def _part(path: Path, arguments: argparse.Namespace) -> Part:
    model = load_surface(arguments, path)
    values = read_values(model, arguments)
    tracts = [] if arguments.tracts is None else pectinate.read_tracts(arguments.tracts).curves_on(model)
    if model.field is None:
        if arguments.tube_values:
            raise InvalidOption(f"--tube-values colour tubes, but {path} has no fibres: name them with --field")
        return model.part(path.stem, surface_values=values.surface, tracts=tracts)
    with ProgressBar("placing", enabled=not arguments.quiet) as bar:
        placement = pectinate.place_streamlines(
            model, progress=bar, **given(arguments, {name: name for name in DEFAULTS})
        )
    return placement.part(
        path.stem,
        surface_values=values.surface,
        tube_values=values.tubes,
        tracts=tracts,
        **given(arguments, _TUBES),
    )
