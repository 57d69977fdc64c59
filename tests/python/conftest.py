"""Fixtures shared by the tests."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from pectinate.errors import RenderingUnavailable
from pectinate.figure.context import offscreen_context

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of measured data: the environment variable PECTINATE_DATA, or ../shared/data beside the repository."""
    folder = Path(os.environ.get("PECTINATE_DATA", REPOSITORY.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"measured data not found at {folder}: set PECTINATE_DATA to the folder that holds human_atrium_1")
    return folder


@pytest.fixture(scope="session")
def human_atrium(real_data: Path) -> Path:
    """The folder of the surfaces la_endo, la_epi, ra_endo, ra_epi."""
    folder = real_data / "human_atrium_1"
    if not folder.is_dir():
        pytest.skip(f"{folder} not found")
    return folder


@pytest.fixture(scope="session")
def opengl() -> None:
    """Skip where nothing can be drawn."""
    try:
        with offscreen_context():
            pass
    except RenderingUnavailable as error:
        pytest.skip(str(error))
