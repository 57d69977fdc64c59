"""The arguments of the command line. Defaults are those of the library; what the user leaves out is not passed on."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from pathlib import Path

import pectinate
from pectinate.cli import commands, demo_command, view_command
from pectinate.cli.field_arguments import add_field_commands
from pectinate.cli.shared_arguments import (
    EXIT_CODES,
    Parser,
    add_common,
    add_field,
    add_input,
    add_tract_names,
    add_units,
    add_views,
    degrees,
    seed,
    whole,
)
from pectinate.cli.value_arguments import add_values
from pectinate.placement import DEFAULTS, DRAWN_TUBE_HEIGHT


def make_parser() -> argparse.ArgumentParser:
    """Make the parser; the namespace that it returns has `run`, the command to call with the namespace.

    Returns
    -------
    argparse.ArgumentParser
        Raises UsageError instead of leaving the process.
    """
    parser = Parser(
        prog="pectinate",
        description="Fibre orientation fields on triangulated surfaces, and evenly spaced streamlines of them.",
        epilog=EXIT_CODES,
    )
    parser.add_argument("--version", action="version", version=f"pectinate {pectinate.__version__}")
    subparsers = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_place(subparsers)
    _add_view(subparsers)
    _add_info(subparsers)
    add_field_commands(subparsers)
    _add_demo(subparsers)
    return parser


def _add_place(subparsers: argparse._SubParsersAction[Parser]) -> None:
    parser = subparsers.add_parser(
        "place", help="place streamlines, save and draw them", description="Place streamlines.", epilog=EXIT_CODES
    )
    parser.set_defaults(run=commands.place)
    add_input(parser)
    _add_placement(parser)
    _add_outputs(parser)
    add_common(parser)


def _add_view(subparsers: argparse._SubParsersAction[Parser]) -> None:
    parser = subparsers.add_parser(
        "view",
        help="turn surfaces and their streamlines in the browser",
        description="Show surfaces with their streamlines on one interactive page, which needs no network.",
        epilog=EXIT_CODES,
    )
    parser.set_defaults(run=view_command.view)
    parser.add_argument(
        "meshes", metavar="MESH", type=Path, nargs="+", help="surfaces, as for place; without fibres no streamlines"
    )
    add_units(parser)
    add_field(parser)
    _add_placement(parser)
    group = parser.add_argument_group("page")
    group.add_argument("--out", type=Path, metavar="FILE", help=".html; by default the page opens in the browser")
    group.add_argument("--title", metavar="TEXT", help="above the controls")
    add_values(group, "")
    group.add_argument("--tracts", type=Path, metavar="FILE", help="file of tracts, drawn as black lines")
    add_views(group)
    _add_tubes(group)
    add_common(parser)


def _add_info(subparsers: argparse._SubParsersAction[Parser]) -> None:
    parser = subparsers.add_parser(
        "info", help="describe a surface and its field", description="Describe a surface.", epilog=EXIT_CODES
    )
    parser.set_defaults(run=commands.info)
    add_input(parser)
    add_tract_names(parser)
    add_common(parser)


def _add_demo(subparsers: argparse._SubParsersAction[Parser]) -> None:
    parser = subparsers.add_parser(
        "demo",
        help="make both atria with their fibres, and pictures, a page and files of them",
        description="Make both atria, outside and inside, with fibres after the paper's tables; place streamlines, "
        "draw them, and write files for solvers and viewers.",
        epilog=EXIT_CODES,
    )
    parser.set_defaults(run=demo_command.demo)
    parser.add_argument(
        "--out", type=Path, default=Path("demo"), metavar="DIR", help="folder to write to (default: %(default)s)"
    )
    parser.add_argument(
        "--edge-length", type=float, metavar="MM", help="edge length of the surfaces, 0.1 to 2 (default: 1)"
    )
    _add_placement(parser)
    add_common(parser)


def _add_placement(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("placement")

    def add(flag: str, name: str, kind: Callable[[str], object], metavar: str, text: str) -> None:
        group.add_argument(flag, dest=name, type=kind, metavar=metavar, help=f"{text} (default: {DEFAULTS[name]})")

    add("--separation", "separation_distance", float, "MM", "streamlines come no closer than this")
    add("--method", "method", str, "METHOD", "longest first, or the paper's: random, neighborhood or distance")
    add("--occupancy", "occupancy", str, "MODEL", "exact, or the paper's edge_mask")
    add("--seeds", "seed_count", whole, "N", "candidates a step of the paper's methods, of which the longest is kept")
    add("--seed-distance-factor", "seed_distance_factor", float, "FACTOR", "of method distance, in separations")
    add(
        "--seed-clearance",
        "seed_clearance",
        float,
        "FACTOR",
        "place short streamlines only where a point of them is this many separations from all others",
    )
    add("--test-distance", "test_distance", float, "FACTOR", "run on until this many separations from others")
    add("--minimum-length", "minimum_length", float, "MM", "shorter streamlines are not placed")
    add("--singularity-radius", "singularity_radius", float, "MM", "stop this near to singularities of the field")
    add("--polishing-rounds", "polishing_rounds", whole, "N", "so often replace some streamlines by longer ones")
    add("--polishing-time", "polishing_time", float, "SECONDS", "end that after so long; 0: no limit")
    add("--max-steps", "max_steps", whole, "N", "triangles that a streamline crosses each way at most")
    add("--random-seed", "random_seed", seed, "N", "the same number gives the same result")
    add("--threads", "thread_count", whole, "N", "the result does not depend on it")
    group.add_argument(
        "--close-loops",
        action="store_true",
        default=None,
        help="make closed streamlines of closed curves of the field (method longest)",
    )
    group.add_argument(
        "--abrupt-turn-angle",
        type=degrees(180),
        metavar="DEGREES",
        help="a streamline ends where the field turns by more between two triangles "
        f"(default: {math.degrees(DEFAULTS['abrupt_turn_angle']):g}; 180: never)",
    )


def _add_outputs(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("output")
    group.add_argument(
        "--out",
        dest="outputs",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help=".npz or .vtp for streamlines, .ply, .obj or .glb for their tubes, .html for a page; may be repeated",
    )
    group.add_argument(
        "--tubes", type=Path, action="append", default=[], metavar="FILE", help=".ply, .obj or .glb; may be repeated"
    )
    group.add_argument("--figure", type=Path, metavar="FILE", help="picture of surface and tubes, such as f.png")
    add_values(group, ", for pages")
    add_views(group)
    _add_tubes(group)
    group.add_argument("--tube-sides", dest="side_count", type=whole, metavar="N", help="3 to 12")


def _add_tubes(group: argparse._ActionsContainer) -> None:
    group.add_argument("--tube-radius", type=float, metavar="MM", help="by default in proportion to the separation")
    group.add_argument("--taper-length", type=float, metavar="MM", help="over which tubes grow thin at their ends")
    words = f"over their width, at most 1: by default {DRAWN_TUBE_HEIGHT:g} in pictures and pages, 1 (round) in files"
    group.add_argument("--tube-height", type=float, metavar="SHARE", help=words)
