"""Arguments of wrong types at the public functions: every error names the argument, none comes from the bindings."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

import pectinate
from drawings import SLANTED, flat
from marks import needs_map
from meshes import grid
from pectinate import BoundaryCondition, FieldEditor, Tract, TractSet
from pectinate.errors import Error

MODEL = pectinate.load((*grid(), np.tile([1.0, 0.5, 0], (24, 1))))
RAGGED = [[1, 2, 3], [4]]
WRONG: tuple[Any, ...] = (
    object(),
    "word",
    b"bytes",
    True,
    [1, 2],
    RAGGED,
    {"a": 1},
    np.zeros((2, 2)),
    np.array(["a", "b"]),
    1j,
    10**400,
    lambda: None,
)
WRONG_OR_NUMBER = (*WRONG, 3, 2.5)


@cache
def coarse_atrium() -> pectinate.Model:
    return pectinate.datasets.atrial_surface("left_atrium", edge_length=2)


def set_condition(**changed: Any) -> None:
    FieldEditor(flat()).set_condition(**{"loop": 0, "rule": "parallel", **changed})


def move(**changed: Any) -> None:
    FieldEditor(flat(), TractSet([SLANTED])).move(**{"number": 0, "points": SLANTED.points, **changed})


# What is called, with which argument, and values that are right for it.
CALLS: list[tuple[Callable[..., Any], str, tuple[Any, ...]]] = [
    (lambda tracts: pectinate.interpolate(flat(), tracts), "tracts", ()),
    *(
        (lambda _name=name, **given: pectinate.interpolate(flat(), TractSet([SLANTED]), **given), name, right)
        for name, right in (
            ("method", ()),
            ("maximum_distance", (3, 2.5)),
            ("conflict_angle", (1,)),
        )
    ),
    (lambda tract: FieldEditor(flat()).add(tract), "tract", ()),
    (lambda number: FieldEditor(flat(), TractSet([SLANTED])).remove(number), "number", (3,)),
    (move, "number", (3,)),
    (move, "points", ()),
    (set_condition, "loop", ()),
    (set_condition, "rule", ()),
    (set_condition, "weight", (3, 2.5)),
    (Tract, "points", ()),
    (lambda name: Tract(SLANTED.points, name=name), "name", ("word",)),
    (lambda weight: Tract(SLANTED.points, weight=weight), "weight", (3, 2.5)),
    (lambda description: Tract(SLANTED.points, description=description), "description", ("word",)),
    (lambda rule: BoundaryCondition(0, rule), "rule", ()),
    (lambda weight: BoundaryCondition(0, "free", weight), "weight", (3, 2.5)),
    (lambda tracts: TractSet(tracts=tracts), "tracts", ()),
    (lambda boundary: TractSet(boundary=boundary), "boundary", ()),
    (lambda loops: TractSet(loops=loops), "loops", ()),
    (lambda surface: TractSet(surface=surface), "surface", ()),
    (lambda length: pectinate.smooth(MODEL, length=length), "length", (3, 2.5)),
    (lambda outlier_angle: pectinate.smooth(MODEL, outlier_angle=outlier_angle), "outlier_angle", ()),
    (lambda barriers: pectinate.smooth(MODEL, barriers=barriers), "barriers", ()),
    (lambda fill_missing: pectinate.smooth(MODEL, fill_missing=fill_missing), "fill_missing", (True,)),
    (lambda how: pectinate.compare(MODEL, MODEL, how=how), "how", ()),
    (lambda regions: pectinate.compare(MODEL, MODEL, regions=regions), "regions", ()),
    (
        lambda maximum_distance: pectinate.compare(MODEL, MODEL, how="nearest", maximum_distance=maximum_distance),
        "maximum_distance",
        (3, 2.5),
    ),
    (lambda outer_loops: pectinate.compare(MODEL, MODEL, how="disks", outer_loops=outer_loops), "outer_loops", ()),
    (lambda loop_pairs: pectinate.compare(MODEL, MODEL, how="disks", loop_pairs=loop_pairs), "loop_pairs", ()),
    (lambda standard_deviation: pectinate.add_noise(MODEL, standard_deviation), "standard_deviation", (3, 2.5)),
    (lambda random_seed: pectinate.add_noise(MODEL, 0.1, random_seed=random_seed), "random_seed", (3,)),
    (lambda tracts: pectinate.carry_tracts(tracts, MODEL, MODEL), "tracts", ()),
    (lambda loops: pectinate.atlas(MODEL, loops), "loops", ()),
    *(
        (lambda _name=name, **given: pectinate.atlas(MODEL, {"mitral valve": [0, 0, 0]}, **given), name, ())
        for name in ("chamber", "layer")
    ),
    (
        lambda maximum_distance: pectinate.carry_tracts(
            TractSet(), coarse_atrium(), coarse_atrium(), maximum_distance=maximum_distance
        ),
        "maximum_distance",
        (3, 2.5),
    ),
    (lambda outer_loop: pectinate.parameterize(flat(), outer_loop=outer_loop), "outer_loop", ()),
    (lambda inner_loop: pectinate.parameterize(flat(), inner_loop=inner_loop), "inner_loop", ()),
    (lambda inner_point: pectinate.parameterize(flat(), inner_point=inner_point), "inner_point", ()),
]
# Words by which messages name an argument where they need not say its name.
KNOWN_AS = {"number": "tract"} | dict.fromkeys(
    ("outer_loop", "inner_loop", "outer_loops", "loops", "loop_pairs"), "loop"
)


@pytest.mark.parametrize(("call", "name", "right"), CALLS, ids=lambda value: value if isinstance(value, str) else "")
def test_wrong_types_are_refused_by_name(call, name, right):
    refused = 0
    for value in WRONG_OR_NUMBER:
        try:
            call(**{name: value})
        except (Error, TypeError) as error:
            message = str(error)
            known = KNOWN_AS.get(name, name) in message
            assert known or (isinstance(value, str) and value in message), message
            assert "incompatible" not in message, message  # what pybind11 says
            assert len(message) < 300, message
            refused += 1
        else:
            assert any(value is other for other in right), (name, value)
    assert refused >= len(WRONG_OR_NUMBER) - len(right)


@pytest.mark.parametrize(
    "call",
    [
        lambda surface: pectinate.interpolate(surface, TractSet()),
        FieldEditor,
        pectinate.smooth,
        lambda surface: pectinate.compare(surface, MODEL),
        lambda surface: pectinate.compare(MODEL, surface),
        lambda surface: pectinate.add_noise(surface, 0.1),
        pectinate.parameterize,
        lambda surface: pectinate.correspond(surface, MODEL),
        lambda surface: pectinate.carry_tracts(TractSet(), MODEL, surface),
        lambda surface: pectinate.atlas(surface, {"mitral valve": [0, 0, 0]}),
    ],
)
def test_what_is_no_surface_is_refused(call):
    for value in (*WRONG_OR_NUMBER, None, (), (1, 2), ("a", "b"), (RAGGED, RAGGED)):
        with pytest.raises((Error, TypeError)) as caught:
            call(value)
        assert "incompatible" not in str(caught.value)


@needs_map
def test_numbers_of_numpy_are_numbers():
    assert pectinate.smooth(MODEL, length=np.float32(1.5), fill_missing=np.bool_(True)).options["length"] == 1.5
    assert pectinate.smooth(MODEL, length=np.array(2)).options["length"] == 2
    assert Tract(SLANTED.points, weight=np.int64(2)).weight == 2
    assert pectinate.parameterize(flat(), outer_loop=np.int32(0)).parameterization.outer_loop == 0
    noisy = [pectinate.add_noise(MODEL, 0.1, random_seed=seed).data.vectors.tolist() for seed in (3, np.uint64(3))]
    assert noisy[0] == noisy[1]
    editor = FieldEditor(flat(), TractSet([SLANTED]))
    editor.remove(np.int64(0))
    assert editor.tracts.tracts == ()
