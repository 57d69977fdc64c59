"""What the commands read and write."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Set
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import pectinate
from pectinate.errors import InvalidFile, InvalidOption
from pectinate.figure.views import resolve_view
from pectinate.model import Model


class OutputError(Exception):
    """A result that could not be written; the input was fine."""


def given(arguments: argparse.Namespace, names: dict[str, str]) -> dict[str, Any]:
    """Keywords for the library from what the user said; `names` maps argument to keyword."""
    said = {keyword: getattr(arguments, name, None) for name, keyword in names.items()}
    return {keyword: value for keyword, value in said.items() if value is not None}


def load_surface(arguments: argparse.Namespace, path: Path | None = None, **options: Any) -> Model:
    """Load a file, by default that of the argument `mesh`, as `--units` and `--field` and the options say."""
    path = arguments.mesh if path is None else path
    try:
        return pectinate.load(path, **given(arguments, {"units": "units", "field": "field"}), **options)
    except OSError as error:
        raise InvalidFile(f"{path}: {error.strerror or error}") from error


def with_loop_names(model: Model, tracts: Path | None) -> Model:
    """Name the loops as a file of tracts does."""
    return model if tracts is None else model.with_loop_points(pectinate.read_tracts(tracts).loops)


def check_figure(arguments: argparse.Namespace) -> None:
    """Refuse a picture of an unknown kind or view."""
    if arguments.figure is not None:
        kinds = Image.registered_extensions()
        check_suffixes("--figure", [arguments.figure], {suffix for suffix in kinds if kinds[suffix] in Image.SAVE})
    check_views(arguments)


def check_views(arguments: argparse.Namespace) -> None:
    """Refuse an unknown view."""
    for view in getattr(arguments, "views", None) or ():
        resolve_view(view, np.eye(3))


def check_suffixes(flag: str, paths: list[Path], suffixes: Set[str]) -> None:
    """Refuse files of which the suffix is none of these."""
    for path in paths:
        if path.suffix.lower() not in suffixes:
            raise InvalidOption(f"{flag} {path}: use one of the suffixes {', '.join(sorted(suffixes))}")


def check_folders(paths: Iterable[Path]) -> None:
    """Refuse files in folders that are not there."""
    for path in paths:
        if not path.parent.is_dir():
            raise OutputError(f"{path}: there is no folder {path.parent}; make it first")


@contextmanager
def writing() -> Iterator[None]:
    """Turn errors about files into OutputError."""
    try:
        yield
    except (OSError, InvalidFile) as error:
        raise OutputError(str(error)) from error
