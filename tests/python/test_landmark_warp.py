"""The map of space that takes landmarks to landmarks, as Python sees it."""

import numpy as np
import pytest

from pectinate import _core
from pectinate.errors import InvalidOption


def landmarks(count, seed=1):
    random = np.random.default_rng(seed)
    points = random.uniform(-30, 30, (count, 3))
    return points, points @ [[1, 0.2, 0], [0, 0.8, 0.1], [-0.3, 0, 1.1]] + random.normal(0, 2, (count, 3)) + 50


@pytest.mark.parametrize("stiffness", [0, 0.01, 1])
def test_it_is_scipys_spline(stiffness):
    interpolate = pytest.importorskip("scipy.interpolate")
    points, images = landmarks(25)
    spread = np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean())
    # Theirs measures in the unit of the points, and not per landmark.
    smoothing = stiffness * len(points) * spread
    theirs = interpolate.RBFInterpolator(points, images, kernel="linear", degree=1, smoothing=smoothing)
    places = np.random.default_rng(2).uniform(-60, 60, (100, 3))
    ours = _core.warp_points(_core.make_landmark_warp(points, images, stiffness=stiffness), places)
    np.testing.assert_allclose(ours, theirs(places), atol=1e-9)


def test_its_parts_are_the_map():
    points, images = landmarks(7)
    warp = _core.make_landmark_warp(points, images)
    assert warp.landmarks.tolist() == points.tolist()
    place = np.array([3.0, -4.0, 5.0])
    by_hand = np.array(warp.linear) @ place + warp.offset + np.linalg.norm(place - points, axis=1) @ warp.weights
    np.testing.assert_allclose(_core.warp_points(warp, place[None])[0], by_hand, atol=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda a, b: (a[:3], b[:3]), "at least four"),
        (lambda a, b: (a, b[:-1]), "one each"),
        (lambda a, b: (a * [1, 1, 0], b), "one plane"),
        (lambda a, b: (a, b * [1, 1, 0]), "one plane"),
        (lambda a, b: (a[[0, 1, 2, 3, 4, 1]], b), "landmarks 1 and 5 are in one place"),
        (lambda a, b: (a, b * [-1, 1, 1]), "exchanged"),
        (lambda a, b: (a, b + np.eye(6, 3) * np.nan), "finite"),
    ],
)
def test_what_makes_no_map(change, message):
    with pytest.raises(InvalidOption, match=message):
        _core.make_landmark_warp(*change(*landmarks(6)))
