"""Fixtures shared by the tests."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from command_line import SIDE, write_lines
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


@pytest.fixture
def square(tmp_path: Path) -> Path:
    """A flat square with fibres along x, as openCARP files."""
    x, y = np.meshgrid(np.arange(SIDE + 1), np.arange(SIDE + 1))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(SIDE)[:, None] * (SIDE + 1) + np.arange(SIDE)).ravel()
    lower = np.column_stack([corner, corner + 1, corner + SIDE + 2])
    upper = np.column_stack([corner, corner + SIDE + 2, corner + SIDE + 1])
    triangles = np.concatenate([lower, upper])
    base = tmp_path / "square"
    write_lines(base.with_suffix(".pts"), [str(len(points)), *(f"{a} {b} {c}" for a, b, c in points)])
    write_lines(base.with_suffix(".elem"), [str(len(triangles)), *(f"Tr {a} {b} {c} 1" for a, b, c in triangles)])
    write_lines(base.with_suffix(".lon"), ["1", *("1 0 0" for _ in triangles)])
    return base.with_suffix(".elem")
