"""Pictures as files."""

from __future__ import annotations

import os
from pathlib import Path

from PIL import Image

from pectinate.errors import InvalidFile, InvalidOption


def check_picture_path(path: str | os.PathLike[str] | None) -> None:
    """Refuse a path whose suffix is none of a picture, before any long work.

    Raises
    ------
    InvalidOption
        There is no such kind of picture.
    """
    if path is not None and Path(path).suffix.lower() not in Image.registered_extensions():
        raise InvalidOption(f"{path}: the suffix is none of a picture; use .png, .jpg, .tif or .pdf")


def save_picture(picture: Image.Image, path: str | os.PathLike[str] | None) -> Image.Image:
    """Write a picture where it is wanted, and return it; without a path, write nothing.

    Raises
    ------
    InvalidFile
        The picture cannot be written.
    """
    if path is not None:
        try:
            picture.save(path)
        except OSError as error:
            raise InvalidFile.at(path, f"cannot be written ({error.strerror})", "check the folder") from error
    return picture
