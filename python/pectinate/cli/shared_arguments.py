"""Arguments that several commands share, and the kinds of values that arguments have."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from pectinate.figure import STANDARD_VIEWS

EXIT_CODES = "exit codes: 0 done, 1 failed, 2 wrong usage, 3 input rejected, 130 interrupted"


class UsageError(Exception):
    """Arguments that cannot be understood."""


class Parser(argparse.ArgumentParser):
    """A parser that raises UsageError instead of leaving the process."""

    def error(self, message: str) -> NoReturn:
        """Raise it."""
        raise UsageError(f"{message}; see {self.prog} --help")


def add_surface(parser: argparse.ArgumentParser) -> None:
    """The file of a surface."""
    parser.add_argument(
        "mesh", metavar="MESH", type=Path, help="surface: openCARP (.pts or .elem), VTK, PLY, OBJ, OFF, STL, GLB"
    )
    add_units(parser)


def add_input(parser: argparse.ArgumentParser) -> None:
    """The file of a surface and its field."""
    add_surface(parser)
    add_field(parser)


def add_field(parser: argparse.ArgumentParser) -> None:
    """Where the field is."""
    parser.add_argument("--field", metavar="NAME|FILE", help="name of the array of fibres, or a file that holds them")


def add_units(parser: argparse.ArgumentParser) -> None:
    """The unit of length of the surface's file."""
    parser.add_argument(
        "--units", metavar="UNIT", help="unit of length of the file: auto (the default), mm, um, cm or m"
    )


def add_tract_names(parser: argparse.ArgumentParser) -> None:
    """A file of tracts of which only the names of loops are used."""
    parser.add_argument("--tracts", type=Path, metavar="FILE", help="file of tracts that names boundary loops")


def add_views(group: argparse._ActionsContainer) -> None:
    """What a picture shows."""
    group.add_argument("--views", type=names, metavar="VIEW,...", help=f"of the picture: {','.join(STANDARD_VIEWS)}")


def add_common(parser: argparse.ArgumentParser) -> None:
    """What is printed."""
    group = parser.add_argument_group("reporting")
    group.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    group.add_argument("--quiet", action="store_true", help="print nothing but errors")
    group.add_argument("--debug", action="store_true", help="show where an error comes from")


def degrees(highest: int) -> Callable[[str], float]:
    """Make a reader of angles above 0 and at most this many degrees; the library has radians."""

    def angle(text: str) -> float:
        number = float(text)
        if not 0 < number <= highest:
            raise argparse.ArgumentTypeError(f"{text} is not above 0 and at most {highest} degrees")
        return math.radians(number)

    return angle


def names(text: str) -> list[str]:
    """Read words with commas between them."""
    return [name.strip() for name in text.split(",")]


def loop(text: str) -> int | str | tuple[float, ...]:
    """Read an index, three coordinates or else a name."""
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return point(text)
    except ValueError:
        return text


def loop_pair(text: str) -> tuple[int | str | tuple[float, ...], ...]:
    """Read a loop of the first surface and one of the second."""
    first, second = text.split("=")
    return loop(first.strip()), loop(second.strip())


def point(text: str) -> tuple[float, ...]:
    """Read three coordinates."""
    x, y, z = (float(word) for word in text.split(","))
    return x, y, z


def whole(text: str) -> int:
    """Read a number that fits the library's integers; what is legal is for the library to say."""
    return _integer(text, -(2**31), 2**31 - 1)


def seed(text: str) -> int:
    """Read a number in [0, 2^64)."""
    return _integer(text, 0, 2**64 - 1)


def _integer(text: str, lowest: int, highest: int) -> int:
    try:
        number = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None
    if not lowest <= number <= highest:
        raise argparse.ArgumentTypeError(f"{text} is not between {lowest} and {highest}")
    return number


# argparse names it in its message: "invalid pair of loops value: 'x'".
loop_pair.__name__ = "pair of loops"
