"""Arguments that name files of numbers, which colour surfaces and tubes."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import pectinate
from pectinate.cli.files import check_suffixes
from pectinate.cli.shared_arguments import UsageError
from pectinate.errors import InvalidFile
from pectinate.figure import SurfaceValues
from pectinate.io import opencarp
from pectinate.model import Model

_SUFFIXES = frozenset({".npy", ".dat"})
_FLAGS = ("--values", "--tube-values")


@dataclass(frozen=True)
class GivenValues:
    """Values of the surface and of the tubes, by the stems of their files."""

    surface: dict[str, SurfaceValues]
    tubes: dict[str, SurfaceValues]


def add_values(group: argparse._ActionsContainer, times: str) -> None:
    """Files of values, and contours; `times` says when there may be several files."""
    for flag, what in zip(_FLAGS, ("shown in colours", "that colours the tubes"), strict=True):
        words = f".npy or .dat: a number per triangle or vertex, {what}; may be repeated{times}"
        group.add_argument(flag, type=Path, action="append", default=[], metavar="FILE", help=words)
    words = "lines every so many units of values per vertex, such as isochrones"
    group.add_argument("--contours", type=float, metavar="STEP", help=words)


def check_values(arguments: argparse.Namespace) -> None:
    """Refuse files of an unknown kind, and contours of nothing."""
    for flag, files in zip(_FLAGS, (arguments.values, arguments.tube_values), strict=True):
        check_suffixes(flag, files, _SUFFIXES)
    if arguments.contours is not None and not arguments.values:
        raise UsageError("--contours serves --values alone, which is not given; add it or leave --contours out")


def given_flags(arguments: argparse.Namespace) -> list[str]:
    """Which of the flags are used."""
    return [flag for flag, files in zip(_FLAGS, (arguments.values, arguments.tube_values), strict=True) if files]


def read_values(model: Model, arguments: argparse.Namespace) -> GivenValues:
    """Read the files for the mesh."""
    surface, tubes = (
        {file.stem: SurfaceValues(_read(model, file), label=file.stem) for file in files}
        for files in (arguments.values, arguments.tube_values)
    )
    return GivenValues({name: replace(some, contours=arguments.contours) for name, some in surface.items()}, tubes)


def _read(model: Model, path: Path) -> NDArray[np.float64]:
    """Numbers of a file per triangle or vertex of the source, taken to the mesh."""
    try:
        array = np.load(path, allow_pickle=False) if path.suffix.lower() == ".npy" else opencarp.read_dat(path)
        return model.to_mesh(array)
    except (OSError, ValueError, EOFError) as error:
        if isinstance(error, pectinate.errors.Error):
            raise
        raise InvalidFile.at(path, f"is no array ({error})", "write it with numpy.save") from error
