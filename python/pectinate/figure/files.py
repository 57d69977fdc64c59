"""Pictures as files."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from PIL import Image

from pectinate.errors import InvalidFile, InvalidOption

DOTS_PER_INCH = 300.0
"""Pixels per inch that files tell, if nothing else is wished."""

# For JPEG, which is also within PDF; other kinds ignore it.
_BEST_QUALITY: Mapping[str, Any] = MappingProxyType({"quality": 95, "subsampling": 0})


def check_picture_path(path: str | os.PathLike[str] | None) -> None:
    """Refuse a path whose suffix is none of a picture, before any long work.

    Raises
    ------
    InvalidOption
        There is no such kind of picture.
    """
    if path is not None and Path(path).suffix.lower() not in Image.registered_extensions():
        raise InvalidOption(f"{path}: the suffix is none of a picture; use .png, .jpg, .tif or .pdf")


def save_picture(
    picture: Image.Image, path: str | os.PathLike[str] | None, *, dpi: float = DOTS_PER_INCH
) -> Image.Image:
    """Write a picture where it is wanted, and return it; without a path, write nothing.

    A PDF holds the picture as one page of the size that `dpi`, pixels per inch, gives.

    Raises
    ------
    InvalidOption
        The dots per inch are not above 0.
    InvalidFile
        The picture cannot be written.
    """
    if not (math.isfinite(dpi) and dpi > 0):
        raise InvalidOption(f"dpi {dpi}: give a number above 0")
    if path is not None:
        options: dict[str, Any] = {"resolution": dpi} if Path(path).suffix.lower() == ".pdf" else {"dpi": (dpi, dpi)}
        try:
            picture.save(path, **options, **_BEST_QUALITY)
        except OSError as error:
            raise InvalidFile.at(path, f"cannot be written ({error.strerror or error})", "check the folder") from error
    return picture
