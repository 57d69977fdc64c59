"""The command that makes interactive pages."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import pectinate
from pectinate.cli import report
from pectinate.cli.files import check_folders, check_suffixes, check_views, given, load_surface, writing
from pectinate.cli.progress import ProgressBar
from pectinate.cli.shared_arguments import UsageError
from pectinate.errors import InvalidFile, InvalidOption
from pectinate.figure import SurfaceValues
from pectinate.io import opencarp
from pectinate.model import Model
from pectinate.placement import DEFAULTS
from pectinate.viewer import Page, Part
from pectinate.viewer.page import SUFFIXES

_VALUE_SUFFIXES = frozenset({".npy", ".dat"})
_TUBES = {name: name for name in ("tube_radius", "taper_length")}


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
    check_suffixes("--values", arguments.values, _VALUE_SUFFIXES)
    if arguments.contours is not None and not arguments.values:
        raise UsageError("--contours serves --values alone, which is not given; add it or leave --contours out")
    if len(arguments.meshes) > 1 and (arguments.values or arguments.tracts is not None):
        raise InvalidOption("--values and --tracts belong to one surface: give one MESH")
    check_views(arguments)


def _part(path: Path, arguments: argparse.Namespace) -> Part:
    model = load_surface(arguments, path)
    values = {file.stem: SurfaceValues(_values(model, file), contours=arguments.contours) for file in arguments.values}
    tracts = [] if arguments.tracts is None else pectinate.read_tracts(arguments.tracts).curves_on(model)
    options: dict[str, Any] = {"surface_values": values, "tracts": tracts}
    if model.field is None:
        return model.part(path.stem, **options)
    with ProgressBar("placing", enabled=not arguments.quiet) as bar:
        placement = pectinate.place_streamlines(
            model, progress=bar, **given(arguments, {name: name for name in DEFAULTS})
        )
    return placement.part(path.stem, **options, **given(arguments, _TUBES))


def _values(model: Model, path: Path) -> NDArray[np.float64]:
    """Numbers of a file per triangle or vertex of the source, taken to the mesh."""
    try:
        array = np.load(path, allow_pickle=False) if path.suffix.lower() == ".npy" else opencarp.read_dat(path)
        return model.to_mesh(array)
    except (OSError, ValueError, EOFError) as error:
        if isinstance(error, pectinate.errors.Error):
            raise
        raise InvalidFile.at(path, f"is no array ({error})", "write it with numpy.save") from error
