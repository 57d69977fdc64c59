"""Exact occupancy against brute force on generated fields: all segments against all samples of segments and chords."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from meshes import Mesh, grid
from pectinate import Placement, load, place_streamlines

Floats = NDArray[np.float64]
METHODS = ("random", "neighborhood", "distance", "longest")


def bumpy_grid(random: np.random.Generator, height: float) -> Mesh:
    """A jittered grid on gentle hills: what is near in space is joined as near on the surface."""
    vertices, triangles = grid(9, 7)
    inner = (vertices[:, :2] > 0).all(axis=1) & (vertices[:, 0] < 9) & (vertices[:, 1] < 7)
    vertices[inner, :2] += random.uniform(-0.3, 0.3, (inner.sum(), 2))
    vertices[:, 2] = height * np.sin(0.7 * vertices[:, 0]) * np.cos(0.6 * vertices[:, 1])
    return vertices, triangles


def generated_field(mesh: Mesh, kind: str, random: np.random.Generator) -> Floats:
    """A vector per triangle: noise, slow turns, turns about a point, or these with holes."""
    x, y, _ = mesh[0][mesh[1]].mean(axis=1).T
    if kind == "noise":
        angle = random.uniform(0, np.pi, len(x))
    elif kind == "smooth":
        angle = random.uniform(0, np.pi) + 0.8 * np.sin(random.uniform(0.2, 0.8) * x + 0.5 * y)
    else:
        centre = random.uniform([2, 2], [7, 5])
        half_turns = random.choice([-1, 1, 2])
        angle = random.uniform(0, np.pi) + 0.5 * half_turns * np.arctan2(y - centre[1], x - centre[0])
    vectors = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(x))])
    if kind == "holes":
        vectors[random.random(len(x)) < 0.15] = 0
    return vectors * random.choice([-1.0, 1.0], len(x))[:, None]


def segments(placement: Placement) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Start, end and streamline of every segment."""
    line = np.repeat(np.arange(len(placement)), np.diff(placement.offsets))
    within = line[:-1] == line[1:]
    return placement.points[:-1][within], placement.points[1:][within], line[:-1][within]


def distances(points: Floats, start: Floats, end: Floats) -> Floats:
    """From every point (n, 3) to every segment (m, 3), (n, m)."""
    side = end - start
    share = np.clip(((points[:, None] - start) * side).sum(axis=2) / np.maximum((side**2).sum(axis=1), 1e-300), 0, 1)
    return np.asarray(np.linalg.norm(points[:, None] - start - share[:, :, None] * side, axis=2))


def samples(start: Floats, end: Floats, count: int) -> Floats:
    """Points on segments, ends included, (n count, 3)."""
    share = np.linspace(0, 1, count)[:, None]
    return np.asarray((start[:, None] * (1 - share) + end[:, None] * share).reshape(-1, 3))


def chords(placement: Placement, count: int) -> tuple[Floats, Floats]:
    """Lines across every triangle that has a direction, along it: `count` a triangle, evenly across it."""
    corners = placement.mesh.vertices[placement.mesh.triangles]
    directions = placement.field.directions
    known = np.linalg.norm(directions, axis=1) > 0.5
    corners, directions = corners[known], directions[known]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    across = np.cross(normal / np.linalg.norm(normal, axis=1, keepdims=True), directions)
    height = ((corners - corners[:, :1]) * across[:, None]).sum(axis=2)
    order = np.argsort(height, axis=1)
    low, middle, high = (np.take_along_axis(corners, order[:, [k], None], axis=1)[:, 0] for k in range(3))
    height = np.sort(height, axis=1)
    split = ((height[:, 1] - height[:, 0]) / (height[:, 2] - height[:, 0]))[:, None]
    starts, ends = [], []
    for share in (np.arange(count) + 0.5) / count:
        starts.append(low + share * (high - low))
        below = low + share / split * (middle - low)
        above = middle + (share - split) / (1 - split) * (high - middle)
        ends.append(np.where(share < split, below, above))
    return np.concatenate(starts), np.concatenate(ends)


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_segments_keep_their_distance_and_no_chord_is_left(data: st.DataObject) -> None:
    random = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    mesh = bumpy_grid(random, data.draw(st.sampled_from([0.0, 0.3])))
    vectors = generated_field(mesh, data.draw(st.sampled_from(["noise", "smooth", "turns", "holes"])), random)
    separation = data.draw(st.floats(0.4, 3))
    method = data.draw(st.sampled_from(METHODS))
    options: dict[str, Any] = {"method": method, "seed_count": 3, "random_seed": 7}
    options["seed_clearance"] = data.draw(st.sampled_from([1.0, 1.11]))
    options["test_distance"] = data.draw(st.sampled_from([1.0, 0.8]))
    options["close_loops"] = method == "longest" and data.draw(st.booleans())
    options["polishing_rounds"] = data.draw(st.sampled_from([0, 30])) if method == "longest" else 0
    placement = place_streamlines(
        load(mesh, field=vectors, field_location="triangle"), separation_distance=separation, **options
    )
    start, end, line = segments(placement)
    points = samples(start, end, 9)
    distance = distances(points, start, end)
    distance[np.repeat(line, 9)[:, None] == line] = np.inf
    assert distance.min() >= options["test_distance"] * separation

    # Sampled, a chord seems farther away than it is: by half a sample at the most.
    chord_start, chord_end = chords(placement, 5)
    nearest = distances(samples(chord_start, chord_end, 17), start, end).min(axis=1).reshape(-1, 17).min(axis=1)
    step = np.linalg.norm(chord_end - chord_start, axis=1) / 16
    assert (nearest <= options["seed_clearance"] * separation * (1 + 1e-5) + step / 2).all()
