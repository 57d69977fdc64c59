"""The estimator of the benchmark of legibility reads what is drawn."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from numpy.typing import NDArray

from conftest import REPOSITORY

pytest.importorskip("scipy")
sys.path.insert(0, str(REPOSITORY / "benchmarks"))
from pectinate.figure.frame import Frame
from pectinate.figure.views import View
from picture_orientation import LEAST_COHERENCE, Scales, luminance, read_orientation
from projected_field import project_field, visible_triangles

PERIOD = 14.0
SCALES = Scales(PERIOD / 4, PERIOD / 2)


def stripes(degrees: float, size: int = 160) -> NDArray[np.float64]:
    """Stripes along a direction, counter-clockwise from the right as seen, black and white with soft edges."""
    rows, columns = np.mgrid[:size, :size] + 0.5
    across = -np.sin(np.radians(degrees)) * columns - np.cos(np.radians(degrees)) * rows
    return 0.5 + 0.4 * np.tanh(3 * np.sin(2 * np.pi * across / PERIOD))


def between(first: NDArray[np.float64], second: float | NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles between lines, degrees."""
    turned = np.degrees(first - second) % 180
    return np.minimum(turned, 180 - turned)


@pytest.mark.parametrize("degrees", [-75, -45, -10, 0, 20, 45, 63, 90])
def test_stripes_are_recovered(degrees: float) -> None:
    read = read_orientation(stripes(degrees), SCALES)
    inside = slice(40, -40)
    assert between(read.angles, np.radians(degrees))[inside, inside].max() < 0.5
    assert read.coherence[inside, inside].min() > 0.9


def test_neither_brightness_nor_contrast_nor_inversion_nor_a_slow_shade_matter() -> None:
    picture = stripes(30)
    expected = read_orientation(picture, SCALES).angles
    assert between(read_orientation(0.2 + 0.1 * picture, SCALES).angles, expected).max() < 1e-6
    assert between(read_orientation(1 - picture, SCALES).angles, expected).max() < 1e-6
    shade = np.linspace(0, 0.4, picture.shape[1])
    assert between(read_orientation(picture + shade, SCALES).angles, expected).max() < 2


def test_turning_and_mirroring_the_picture_turns_and_mirrors_what_is_read() -> None:
    picture = np.random.default_rng(3).random((90, 90))
    picture += stripes(25, 90)
    read = read_orientation(picture, SCALES)
    turned = read_orientation(np.rot90(picture), SCALES)
    assert between(turned.angles, np.rot90(read.angles) + np.pi / 2).max() < 1e-6
    np.testing.assert_allclose(turned.coherence, np.rot90(read.coherence), atol=1e-9)
    mirrored = read_orientation(picture[:, ::-1], SCALES)
    assert between(mirrored.angles, -read.angles[:, ::-1]).max() < 1e-6


def test_an_even_picture_shows_no_orientation() -> None:
    assert (read_orientation(np.full((50, 50), 0.7), SCALES).coherence < LEAST_COHERENCE).all()


def test_the_outline_of_the_object_is_no_stripe() -> None:
    rows, columns = np.mgrid[:160, :160] - 80
    shown = np.hypot(rows, columns) < 60
    read = read_orientation(np.where(shown, stripes(0), 1.0), SCALES, shown)
    errors = between(read.angles, 0.0)[shown]
    assert (errors < 15).mean() > 0.96
    assert np.median(errors) < 0.5


def test_luminance_is_that_of_the_eye() -> None:
    colors = np.array([[[255, 255, 255], [0, 0, 0], [0, 255, 0], [0, 0, 255]]], np.uint8)
    white, black, green, blue = luminance(colors)[0]
    assert (white, black) == (pytest.approx(1), 0)
    assert green > 5 * blue > 0


def test_each_pixel_shows_the_nearest_triangle_and_its_projected_field() -> None:
    random = np.random.default_rng(5)
    vertices = random.uniform(-1, 1, (60, 3))
    triangles = np.arange(60).reshape(20, 3)
    field = random.normal(size=(20, 3))
    frame = Frame(View("any", (0.3, 1, -0.2), (0, 0.1, 1)), np.array([0.1, 0, 0.2]), (48, 40), 0.05)
    seen = visible_triangles(vertices, triangles, frame)
    # One pixel after the other, by solving for where its ray meets each triangle.
    rotation = frame.view.rotation()
    for row, column in np.ndindex(40, 48):
        right, up = (column + 0.5 - 24) * 0.05, -(row + 0.5 - 20) * 0.05
        depths = np.full(20, -np.inf)
        for index, corners in enumerate((vertices[triangles] - frame.centre) @ rotation.T):
            weights = np.linalg.solve(np.vstack([corners[:, :2].T, np.ones(3)]), [right, up, 1])
            if weights.min() >= 0:
                depths[index] = weights @ corners[:, 2]
        assert seen[row, column] == (np.argmax(depths) if depths.max() > -np.inf else -1)
    projected = project_field(vertices, triangles, field, frame)
    shown = projected.shown
    np.testing.assert_allclose(projected.directions[shown], (field @ rotation.T)[seen[shown], :2])
    assert np.isnan(projected.angles[~shown]).all()
    assert shown.any()
    assert not shown.all()
