"""Bringing one surface onto another by the names of its loops."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import pectinate
from pectinate import datasets
from pectinate.errors import InvalidOption
from pectinate.model import Model

SHEAR = np.array([[1.1, 0.2, 0.0], [-0.1, 0.9, 0.15], [0.1, 0.0, 1.0]])


@cache
def atrium(chamber="left_atrium"):
    return datasets.atrial_surface(chamber, edge_length=2)


def rotation(seed=4):
    matrix, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


def mapped(model, matrix, offset=(0, 0, 0)):
    """The surface under an affine map, with its names."""
    points = {name: matrix @ point + offset for name, point in model.data.loop_points.items()}
    return Model.from_data(replace(model.data, vertices=model.data.vertices @ matrix.T + offset, loop_points=points))


def without(model, *names):
    points = {name: point for name, point in model.data.loop_points.items() if name not in names}
    return Model.from_data(replace(model.data, loop_points=points))


@pytest.mark.parametrize("scale", [1.0, 0.01, 40.0])
def test_a_turned_copy_of_any_size_is_met_exactly(scale):
    matrix, offset = scale * rotation(), np.array([100.0, -20, 3])
    found = pectinate.correspond(atrium(), mapped(atrium(), matrix, offset))
    points = atrium().mesh.vertices
    np.testing.assert_allclose(found.carry(points), points @ matrix.T + offset, atol=1e-6 * scale)
    assert found.distances.max() < 1e-6 * scale
    assert found.landmark_distances.max() < 1e-6 * scale
    assert found.loops == tuple(atrium().loop_names)


def test_a_sheared_copy_is_met_closely():
    found = pectinate.correspond(atrium(), mapped(atrium(), SHEAR @ rotation()))
    missed = np.linalg.norm(
        found.carry(atrium().mesh.vertices) - atrium().mesh.vertices @ (SHEAR @ rotation()).T, axis=1
    )
    assert np.median(missed) < 1
    assert np.median(found.distances) < 0.2


def test_it_does_not_depend_on_where_the_target_is():
    target = mapped(datasets.atrial_surface("left_atrium", layer="endocardium", edge_length=2), SHEAR)
    first = pectinate.correspond(atrium(), target)
    second = pectinate.correspond(atrium(), mapped(target, rotation(), (5, 6, 7)))
    points = atrium().mesh.vertices
    apart = np.linalg.norm(first.carry(points) @ rotation().T + [5, 6, 7] - second.carry(points), axis=1)
    assert np.median(apart) < 0.01  # a tie among nearest points may fall otherwise


def test_windings_mean_nothing():
    data = atrium().data
    inside_out = Model.from_data(replace(data, triangles=data.triangles[:, ::-1]))
    found = pectinate.correspond(atrium(), inside_out)
    np.testing.assert_allclose(found.carry(data.vertices), data.vertices, atol=1e-6)


def test_left_and_right_exchanged_are_refused():
    points = dict(atrium().data.loop_points)

    def other(name):
        return name.replace("left", "*").replace("right", "left").replace("*", "right")

    swapped = {name: points[other(name)] for name in points}
    with pytest.raises(InvalidOption, match="left and right"):
        pectinate.correspond(atrium(), atrium().with_loop_points(swapped))
    with pytest.raises(InvalidOption, match="left and right"):
        pectinate.correspond(atrium(), mapped(atrium(), np.diag([-1.0, 1, 1])))


def test_three_names_are_enough_and_two_are_not():
    names = list(atrium().loop_names)
    found = pectinate.correspond(atrium(), without(atrium(), *names[3:]))
    assert found.loops == tuple(names[:3])
    assert found.distances.max() < 1e-6
    with pytest.raises(InvalidOption, match="2 loops have a name that both surfaces know"):
        pectinate.correspond(atrium(), without(atrium(), *names[2:]))


def test_names_that_are_nearly_right_are_suggested():
    bare = without(atrium(), *atrium().loop_names)
    named = bare.with_loop_points({"mitral valv": np.zeros(3)})
    with pytest.raises(InvalidOption, match="'mitral valve' instead of 'mitral valv'"):
        pectinate.correspond(atrium(), named)


def test_two_names_for_one_loop_are_refused():
    points = atrium().data.loop_points
    twice = atrium().with_loop_points({"fossa ovalis": points["mitral valve"]})
    with pytest.raises(InvalidOption, match="'mitral valve' and 'fossa ovalis' are nearest to the same"):
        pectinate.correspond(atrium(), twice)


def test_closed_surfaces_have_no_names():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    closed = pectinate.load((corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]), units="mm")
    with pytest.raises(InvalidOption, match="0 loops"):
        pectinate.correspond(atrium(), closed)


def test_pinholes_between_great_triangles_may_be_named():
    corners = np.eye(3) * 20
    outer = np.concatenate([corners, -corners])
    faces = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])
    vertices, triangles, names = [*outer], [*faces[4:]], {}
    for name, face in zip("abcd", faces[:4], strict=True):
        middle = outer[face].mean(axis=0)
        ring = len(vertices) + np.arange(3)
        vertices += [middle + 1e-3 * (outer[corner] - middle) for corner in face]
        a, b, c = face
        p, q, r = ring
        triangles += [[a, b, p], [b, q, p], [b, c, q], [c, r, q], [c, a, r], [a, p, r]]
        names[name] = middle
    model = pectinate.load((np.array(vertices), np.array(triangles)), units="mm").with_loop_points(names)
    assert len(model.mesh.boundary_loops) == 4
    found = pectinate.correspond(model, model)
    np.testing.assert_allclose(found.carry(model.mesh.vertices), model.mesh.vertices, atol=1e-6)


def test_its_report():
    report = pectinate.correspond(atrium(), mapped(atrium(), SHEAR)).report()
    assert list(report["loops"]) == list(atrium().loop_names)
    assert 0 <= report["distances"]["median"] <= report["distances"]["p95"] <= report["distances"]["greatest"]
