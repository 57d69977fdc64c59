"""The arguments of the command line. Defaults are those of the library; what the user leaves out is not passed on."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

import pectinate
from pectinate.cli import commands
from pectinate.figure import STANDARD_VIEWS
from pectinate.placement import DEFAULTS

_EXIT_CODES = "exit codes: 0 done, 1 failed, 2 wrong usage, 3 input rejected, 130 interrupted"


class UsageError(Exception):
    """Arguments that cannot be understood."""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message}; see {self.prog} --help")


def make_parser() -> argparse.ArgumentParser:
    """Make the parser; the namespace that it returns has `run`, the command to call with the namespace.

    Returns
    -------
    argparse.ArgumentParser
        Raises UsageError instead of leaving the process.
    """
    parser = _Parser(
        prog="pectinate",
        description="Evenly spaced streamlines of fibre orientation fields on triangulated surfaces.",
        epilog=_EXIT_CODES,
    )
    parser.add_argument("--version", action="version", version=f"pectinate {pectinate.__version__}")
    subparsers = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_place(subparsers)
    _add_info(subparsers)
    _add_demo(subparsers)
    return parser


def _add_place(subparsers: argparse._SubParsersAction[_Parser]) -> None:
    parser = subparsers.add_parser(
        "place", help="place streamlines, save and draw them", description="Place streamlines.", epilog=_EXIT_CODES
    )
    parser.set_defaults(run=commands.place)
    _add_input(parser)
    _add_placement(parser)
    _add_outputs(parser)
    _add_common(parser)


def _add_info(subparsers: argparse._SubParsersAction[_Parser]) -> None:
    parser = subparsers.add_parser(
        "info", help="describe a surface and its field", description="Describe a surface.", epilog=_EXIT_CODES
    )
    parser.set_defaults(run=commands.info)
    _add_input(parser)
    _add_common(parser)


def _add_demo(subparsers: argparse._SubParsersAction[_Parser]) -> None:
    parser = subparsers.add_parser(
        "demo",
        help="place streamlines on an atrium made by pectinate",
        description="Make an atrium-like surface, place streamlines on it, save and draw them.",
        epilog=_EXIT_CODES,
    )
    parser.set_defaults(run=commands.demo)
    parser.add_argument(
        "--out", type=Path, default=Path("demo"), metavar="DIR", help="folder to write to (default: %(default)s)"
    )
    parser.add_argument("--edge-length", type=float, metavar="MM", help="edge length of the surface")
    _add_placement(parser)
    _add_common(parser)


def _add_input(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "mesh", metavar="MESH", type=Path, help="surface: openCARP (.pts or .elem), VTK, PLY, OBJ, OFF, STL, GLB"
    )
    parser.add_argument(
        "--units", metavar="UNIT", help="unit of length of the file: auto (the default), mm, um, cm or m"
    )
    parser.add_argument("--field", metavar="NAME|FILE", help="name of the array of fibres, or a file that holds them")


def _add_placement(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("placement")

    def add(flag: str, name: str, kind: Callable[[str], object], metavar: str, text: str) -> None:
        group.add_argument(flag, dest=name, type=kind, metavar=metavar, help=f"{text} (default: {DEFAULTS[name]})")

    add("--separation", "separation_distance", float, "MM", "streamlines come no closer than this")
    add("--method", "method", str, "METHOD", "longest first, or the paper's: random, neighborhood or distance")
    add("--occupancy", "occupancy", str, "MODEL", "exact, or the paper's edge_mask")
    add("--seeds", "seed_count", _whole, "N", "candidates a step of the paper's methods, of which the longest is kept")
    add("--seed-distance-factor", "seed_distance_factor", float, "FACTOR", "of method distance, in separations")
    add("--seed-clearance", "seed_clearance", float, "FACTOR", "start only where this many separations are free")
    add("--test-distance", "test_distance", float, "FACTOR", "run on until this many separations from others")
    add("--minimum-length", "minimum_length", float, "MM", "shorter streamlines are not placed")
    add("--max-steps", "max_steps", _whole, "N", "triangles that a streamline crosses each way at most")
    add("--random-seed", "random_seed", _seed, "N", "the same number gives the same result")
    add("--threads", "thread_count", _whole, "N", "the result does not depend on it")
    group.add_argument(
        "--abrupt-turn-angle",
        type=_degrees,
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
        help=".npz or .vtp for streamlines, .ply, .obj or .glb for their tubes; may be repeated",
    )
    group.add_argument(
        "--tubes", type=Path, action="append", default=[], metavar="FILE", help=".ply, .obj or .glb; may be repeated"
    )
    group.add_argument("--figure", type=Path, metavar="FILE", help="picture of surface and tubes, such as f.png")
    group.add_argument("--views", type=_names, metavar="VIEW,...", help=f"of the picture: {','.join(STANDARD_VIEWS)}")
    group.add_argument("--tube-radius", type=float, metavar="MM", help="by default in proportion to the separation")
    group.add_argument("--taper-length", type=float, metavar="MM", help="over which tubes grow thin at their ends")
    group.add_argument("--tube-sides", dest="side_count", type=_whole, metavar="N", help="3 to 12")


def _add_common(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("reporting")
    group.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    group.add_argument("--quiet", action="store_true", help="print nothing but errors")
    group.add_argument("--debug", action="store_true", help="show where an error comes from")


def _degrees(text: str) -> float:
    return math.radians(float(text))


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


def _whole(text: str) -> int:
    """Read a number that fits the library's integers; what is legal is for the library to say."""
    return _integer(text, -(2**31), 2**31 - 1)


def _seed(text: str) -> int:
    return _integer(text, 0, 2**64 - 1)


def _integer(text: str, lowest: int, highest: int) -> int:
    try:
        number = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None
    if not lowest <= number <= highest:
        raise argparse.ArgumentTypeError(f"{text} is not between {lowest} and {highest}")
    return number


# argparse names it in its message: "invalid degrees value: 'x'".
_degrees.__name__ = "degrees"
