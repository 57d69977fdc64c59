"""Polishing: longer streamlines after the placement, and nothing else changed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from meshes import sphere
from pectinate import Model, Placement, load, place_streamlines
from pectinate.errors import InvalidOption

SEPARATION = 0.25


def model(level: int) -> Model:
    """A sphere with vectors that turn from place to place."""
    vertices, triangles = sphere(level)
    x, y, z = vertices[triangles].mean(axis=1).T
    vectors = np.column_stack([np.sin(3 * y + 0.3), np.cos(2 * x), np.sin(3 * z + 0.2)])
    return load((vertices, triangles), field=vectors, field_location="triangle")


def polished(rounds: int, **options: Any) -> Placement:
    return place_streamlines(model(4), separation_distance=SEPARATION, polishing_rounds=rounds, **options)


def samples(placement: Placement) -> tuple[np.ndarray, np.ndarray, float]:
    """Points along all segments, which line each is on, and how far apart they are at most."""
    ends = np.delete(np.arange(len(placement.points)), placement.offsets[1:] - 1)
    shares = np.linspace(0, 1, 9)[:, None]
    start, step = placement.points[ends], placement.points[ends + 1] - placement.points[ends]
    line = np.repeat(np.arange(len(placement)), np.diff(placement.offsets) - 1)
    points = (start[:, None] + shares * step[:, None]).reshape(-1, 3)
    return points, np.repeat(line, 9), float(np.linalg.norm(step, axis=1).max() / 8)


@pytest.mark.parametrize("options", [{}, {"seed_clearance": 1.16}, {"minimum_length": 0.3}], ids=str)
def test_streamlines_get_longer_and_keep_their_distance(options: dict[str, Any]) -> None:
    plain, better = polished(0, **options), polished(400, **options)
    assert better.statistics.mean_length > plain.statistics.mean_length
    assert better.statistics.total_length >= 0.99 * plain.statistics.total_length  # ends run on afterwards
    points, line, _ = samples(better)
    for one in range(len(better)):
        distance, _ = cKDTree(points[line == one]).query(points[line != one])
        assert distance.min() >= SEPARATION


def test_no_gap_is_left() -> None:
    better = polished(400)
    assert better.statistics.coverage == pytest.approx(1, abs=1e-6)
    points, _, step = samples(better)
    corners = better.mesh.vertices[better.mesh.triangles]
    distance, _ = cKDTree(points).query(corners.mean(axis=1))
    edge = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
    assert distance.max() <= SEPARATION + edge + step


def test_the_rounds_are_reported_and_saved(tmp_path: Path) -> None:
    assert polished(0).statistics.polishing_rounds == 0
    better = polished(7)
    assert (better.statistics.polishing_rounds, better.options["polishing_rounds"]) == (7, 7)
    better.save(tmp_path / "better.npz")
    with np.load(tmp_path / "better.npz") as file:
        assert json.loads(str(file["statistics"]))["polishing_rounds"] == 7
        assert json.loads(str(file["options"]))["polishing_time"] == 0


def test_a_run_by_time_is_repeated_by_its_rounds() -> None:
    by_time = polished(0, polishing_time=0.1)
    rounds = by_time.statistics.polishing_rounds
    assert rounds > 0
    np.testing.assert_array_equal(by_time.points, polished(rounds).points)
    assert polished(3, polishing_time=1000).statistics.polishing_rounds == 3


def test_polishing_can_be_cancelled() -> None:
    plain = polished(0)
    stopped = polished(2**63 - 1, progress=lambda coverage: coverage < 1 - 1e-6)
    assert stopped.end == "cancelled"
    assert stopped.statistics.mean_length >= plain.statistics.mean_length * (1 - 1e-12)


@pytest.mark.parametrize("option", [{"polishing_rounds": 1}, {"polishing_time": 1}], ids=str)
@pytest.mark.parametrize("way", [{"method": "random"}, {"method": "distance", "occupancy": "edge_mask"}], ids=str)
def test_other_methods_are_not_polished(option: dict[str, Any], way: dict[str, Any]) -> None:
    with pytest.raises(InvalidOption, match="polishing needs method longest"):
        place_streamlines(model(2), **option, **way)
