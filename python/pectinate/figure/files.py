"""Pictures as files."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

from PIL import Image

from pectinate.errors import InvalidFile, InvalidOption

DOTS_PER_INCH = 300.0
"""Pixels per inch that files tell, if nothing else is wished."""

_JPEG_QUALITY = {"quality": 95, "subsampling": 0}


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
        try:
            picture.save(path, **_save_options(Path(path).suffix.lower(), dpi))
        except (OSError, ValueError) as error:
            what = f"cannot be written ({getattr(error, 'strerror', None) or error})"
            raise InvalidFile.at(path, what, "check the folder, or use the suffix .png") from error
    return picture


def _save_options(suffix: str, dpi: float) -> dict[str, Any]:
    if suffix == ".pdf":
        # The page holds a JPEG; where it is transparent, a JPEG 2000 without loss.
        return {"resolution": dpi, **_JPEG_QUALITY}
    return {"dpi": (dpi, dpi), **(_JPEG_QUALITY if suffix in {".jpg", ".jpeg"} else {})}
