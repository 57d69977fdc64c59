"""The command that makes the built-in atria: surfaces, fibres, streamlines, pictures, a page and files."""

from __future__ import annotations

import argparse
import importlib.util
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pectinate
from pectinate.cli import report
from pectinate.cli.files import OutputError, given, writing
from pectinate.cli.progress import ProgressBar
from pectinate.datasets import atria
from pectinate.datasets.sheets import AtrialFibres, AtrialLayers, atria_page, fibre_sheet, tract_sheet
from pectinate.placement import DEFAULTS

_LAYERS = ("epicardium", "endocardium")


def demo(arguments: argparse.Namespace) -> None:
    """Make both atria, outside and inside, and write everything that one may want to open next to a folder."""
    _make_folders(arguments.out)
    rows: list[dict[str, Any]] = []
    layers = {layer: dict(_fibres(layer, arguments, rows)) for layer in _LAYERS}
    if not (arguments.json or arguments.quiet):
        report.print_rows(_describe(row) for row in rows)
        report.print_rows([("triangles", f"{sum(row['triangles'] for row in rows if row['layer'] == _LAYERS[0]):,}")])
    with writing(), ProgressBar("drawing and writing", enabled=not arguments.quiet) as bar:
        files = [str(path) for path in _write(layers, arguments.out, bar)]
    if arguments.json:
        report.print_json({"surfaces": rows, "files": files})
    elif not arguments.quiet:
        report.print_rows(("written", path) for path in files)


def _make_folders(folder: Path) -> None:
    try:
        for layer in _LAYERS:
            (folder / layer).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(str(error)) from error


def _fibres(
    layer: str, arguments: argparse.Namespace, rows: list[dict[str, Any]]
) -> Iterator[tuple[str, AtrialFibres]]:
    """Place streamlines on the surfaces of a layer; adds a row of figures for each."""
    for chamber, made in atria(layer=layer, **given(arguments, {"edge_length": "edge_length"})).items():
        started = time.perf_counter()
        with ProgressBar(f"placing on the {chamber.replace('_', ' ')}", enabled=not arguments.quiet) as bar:
            placement = pectinate.place_streamlines(
                made.model, progress=bar, **given(arguments, {name: name for name in DEFAULTS})
            )
        seconds = time.perf_counter() - started
        rows.append(
            {
                "chamber": chamber,
                "layer": layer,
                "triangles": made.model.mesh.triangle_count,
                "tracts": len(made.tracts.tracts),
                "singularities": len(made.topology.singularities),
                "statistics": placement.statistics.to_dict(),
                "seconds": seconds,
            }
        )
        yield chamber, AtrialFibres(made, placement)


def _describe(row: dict[str, Any]) -> report.Row:
    statistics = row["statistics"]
    return (
        row["chamber"].replace("_", " "),
        f"{row['layer']}: {row['triangles']:,} triangles, {row['tracts']} tracts; {statistics['streamline_count']} "
        f"streamlines of {statistics['mean_length']:.1f} mm on average, placed in {row['seconds']:.2f} s",
    )


def _write(layers: AtrialLayers, folder: Path, progress: ProgressBar) -> Iterator[Path]:
    """Write pictures, the page and the files of every surface; yields what was written."""
    count = 3 + sum(len(chambers) for chambers in layers.values())
    fibre_sheet(layers, folder / "fibres.png")
    tract_sheet(layers, folder / "tracts.png")
    atria_page(layers).save(folder / "atria.html")
    yield from (folder / name for name in ("fibres.png", "tracts.png", "atria.html"))
    done = 3
    for layer, chambers in layers.items():
        for chamber, shown in chambers.items():
            progress(done / count)
            yield from _write_surface(shown, folder / layer / chamber)
            done += 1


def _write_surface(shown: AtrialFibres, stem: Path) -> Iterator[Path]:
    """Surface and fibres for solvers, the tracts, the streamlines and their tubes; files of VTK if PyVista is there."""
    vtk = importlib.util.find_spec("pyvista") is not None
    for suffix in (".pts", ".vtp") if vtk else (".pts",):
        yield from shown.made.save(stem.with_suffix(suffix))
    yield _tracts_file(shown, stem)
    for name in ("streamlines.npz", "tubes.glb", *(("streamlines.vtp",) if vtk else ())):
        path = stem.with_name(f"{stem.name}_{name}")
        shown.placement.save(path)
        yield path


def _tracts_file(shown: AtrialFibres, stem: Path) -> Path:
    path = stem.with_name(f"{stem.name}_tracts.json")
    shown.made.tracts.save(path)
    return path
