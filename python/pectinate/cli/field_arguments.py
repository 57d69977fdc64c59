"""The arguments of the commands that make and compare orientation fields."""

from __future__ import annotations

import argparse
from pathlib import Path

from pectinate.cli import field_commands
from pectinate.cli.shared_arguments import (
    EXIT_CODES,
    Parser,
    add_common,
    add_input,
    add_surface,
    add_tract_names,
    add_units,
    add_views,
    degrees,
    loop,
    loop_pair,
    point,
)
from pectinate.comparison import HOW
from pectinate.interpolation import METHODS

_LOOP = "index, name or X,Y,Z near it"


def add_field_commands(subparsers: argparse._SubParsersAction[Parser]) -> None:
    """Add `interpolate`, `atlas`, `parameterize`, `smooth` and `compare`."""
    _add_interpolate(subparsers)
    _add_atlas(subparsers)
    _add_parameterize(subparsers)
    _add_smooth(subparsers)
    _add_compare(subparsers)


def _add_interpolate(subparsers: argparse._SubParsersAction[Parser]) -> None:
    text = "make a field from a few tracts and boundary conditions"
    parser = subparsers.add_parser("interpolate", help=text, description=_sentence(text), epilog=EXIT_CODES)
    parser.set_defaults(run=field_commands.interpolate)
    add_surface(parser)
    parser.add_argument("tracts", metavar="TRACTS", type=Path, help="file of tracts and boundary conditions, .json")
    group = parser.add_argument_group("interpolation")
    group.add_argument("--method", metavar="METHOD", help=f"{METHODS[0]} (the default), or the paper's {METHODS[1]}")
    _add_frame(group)
    group.add_argument("--maximum-distance", type=float, metavar="MM", help="of tract points from the surface")
    group.add_argument(
        "--conflict-angle", type=degrees(90), metavar="DEGREES", help="tracts that differ by more are in conflict"
    )
    _add_outputs(parser)
    add_common(parser)


def _add_atlas(subparsers: argparse._SubParsersAction[Parser]) -> None:
    text = "give a bare atrium the fibres of the built-in one"
    parser = subparsers.add_parser("atlas", help=text, description=_sentence(text), epilog=EXIT_CODES)
    parser.set_defaults(run=field_commands.atlas)
    add_surface(parser)
    parser.add_argument(
        "--loops",
        type=Path,
        required=True,
        metavar="FILE",
        help='names of openings, each with a point near it, mm: {"mitral valve": [x, y, z], ...}, .json',
    )
    group = parser.add_argument_group("atlas")
    group.add_argument("--chamber", metavar="CHAMBER", help="left_atrium or right_atrium (default: as the names tell)")
    group.add_argument("--layer", metavar="LAYER", help="epicardium (default) or endocardium")
    group.add_argument("--maximum-distance", type=float, metavar="MM", help="tracts farther off are left out")
    group.add_argument("--method", metavar="METHOD", help=f"{METHODS[0]} (the default), or the paper's {METHODS[1]}")
    group.add_argument(
        "--conflict-angle", type=degrees(90), metavar="DEGREES", help="tracts that differ by more are in conflict"
    )
    _add_outputs(parser)
    parser.add_argument("--tracts-out", type=Path, metavar="FILE", help="the tracts as carried, .json")
    add_common(parser)


def _add_parameterize(subparsers: argparse._SubParsersAction[Parser]) -> None:
    text = "map a surface onto the unit disk"
    parser = subparsers.add_parser("parameterize", help=text, description=_sentence(text), epilog=EXIT_CODES)
    parser.set_defaults(run=field_commands.parameterize)
    add_surface(parser)
    add_tract_names(parser)
    _add_frame(parser.add_argument_group("reference frame"))
    parser.add_argument("--figure", type=Path, metavar="FILE", help="picture of the disk, such as f.png")
    add_common(parser)


def _add_smooth(subparsers: argparse._SubParsersAction[Parser]) -> None:
    text = "smooth a measured field, robust against outliers"
    parser = subparsers.add_parser("smooth", help=text, description=_sentence(text), epilog=EXIT_CODES)
    parser.set_defaults(run=field_commands.smooth)
    add_input(parser)
    group = parser.add_argument_group("smoothing")
    group.add_argument("--length", type=float, metavar="MM", help="over which fibres are brought to agree")
    group.add_argument("--barriers", metavar="KIND", help="tags: nothing is exchanged between regions; none (default)")
    group.add_argument(
        "--outlier-angle",
        type=degrees(90),
        metavar="DEGREES",
        help="fibres that differ by more are replaced",
    )
    group.add_argument("--fill-missing", action="store_true", help="give a direction to triangles that have none too")
    _add_outputs(parser)
    add_common(parser)


def _add_compare(subparsers: argparse._SubParsersAction[Parser]) -> None:
    text = "compare the fields of two files"
    parser = subparsers.add_parser("compare", help=text, description=_sentence(text), epilog=EXIT_CODES)
    parser.set_defaults(run=field_commands.compare)
    for name, words in (("first", "a surface with its field"), ("second", "another, on which the angles are given")):
        parser.add_argument(name, metavar=name.upper(), type=Path, help=words)
    add_units(parser)
    group = parser.add_argument_group("comparison")
    group.add_argument("--how", metavar="HOW", help=f"{', '.join(HOW)}: on the same triangles, or how to carry fields")
    group.add_argument("--maximum-distance", type=float, metavar="MM", help="of nearest: the farther are left out")
    group = parser.add_argument_group("comparison by disks")
    for which in ("first", "second"):
        group.add_argument(f"--outer-{which}", type=loop, metavar="LOOP", help=f"outer loop of the disk: {_LOOP}")
    group.add_argument(
        "--tracts",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="file of tracts that names boundary loops, of both surfaces or, given twice, of each; loops of the same "
        "name correspond",
    )
    group.add_argument(
        "--pair",
        dest="pairs",
        type=loop_pair,
        action="append",
        metavar="LOOP=LOOP",
        help="inner loops of the first and second surface that correspond; may be repeated",
    )
    _add_files(parser)
    parser.add_argument("--figure", type=Path, metavar="FILE", help="picture of the angles, such as f.png")
    add_views(parser)
    add_common(parser)


def _add_frame(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--outer", type=loop, metavar="LOOP", help=f"loop that becomes the circle: {_LOOP}")
    group.add_argument("--inner", type=loop, metavar="LOOP", help="loop where u is 0, such as the fossa ovalis")
    group.add_argument(
        "--inner-point", type=point, metavar="X,Y,Z", help="mm; where there is no such loop (--inner-point=-1,2,3)"
    )


def _add_outputs(parser: argparse.ArgumentParser) -> None:
    """Where the field goes, and its picture."""
    _add_files(parser)
    group = parser.add_argument_group("picture")
    group.add_argument("--figure", type=Path, metavar="FILE", help="picture of its streamlines, such as f.png")
    add_views(group)
    group.add_argument("--separation", dest="separation_distance", type=float, metavar="MM", help="of the streamlines")


def _add_files(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("output")
    group.add_argument(
        "--out",
        dest="outputs",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="surface and field: .lon (with .pts and .elem), .vtp, .vtu or .vtk; may be repeated",
    )
    group.add_argument(
        "--second", dest="second_vectors", metavar="KIND", help="second vectors: none, transverse or normal"
    )
    group.add_argument("--per-vertex", action="store_true", help="VTK files get the field per vertex too")


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."
