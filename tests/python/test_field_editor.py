"""Tracts and conditions that change one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from drawings import SLANTED, flat, line
from pectinate import BoundaryCondition, FieldEditor, Tract, TractSet, interpolate
from pectinate.errors import InvalidOption


def test_edits_give_what_a_fresh_solve_gives():
    rng = np.random.default_rng(3)
    model = flat()
    editor = FieldEditor(model, TractSet([SLANTED], [BoundaryCondition(0, "parallel", 0.5)]))
    numbers = [0]
    for step in range(12):
        ends = np.column_stack([rng.uniform(0.5, [11.5, 7.5], size=(2, 2)), np.zeros(2)])
        choice = rng.integers(3)
        if choice == 0 or not numbers:
            numbers.append(editor.add(Tract(ends, str(step), weight=rng.choice([math.inf, 2.0]))))
        elif choice == 1:
            editor.remove(numbers.pop(rng.integers(len(numbers))))
        else:
            editor.move(int(rng.choice(numbers)), ends)
    editor.set_condition(0, "perpendicular")
    edited, fresh = editor.field(), interpolate(model, editor.tracts)
    assert edited.report() == fresh.report()
    assert edited.field.directions.tobytes() == fresh.field.directions.tobytes()
    assert len(editor.tracts.tracts) == len(numbers)


def test_numbers_of_tracts_stay_and_are_not_given_again():
    editor = FieldEditor(flat(), TractSet([SLANTED]))
    first, second = editor.add(line((1, 6), (5, 6), name="b")), editor.add(line((1, 7), (5, 7), name="c"))
    editor.remove(first)
    editor.move(second, [[1, 2, 0], [5, 2, 0]])
    third = editor.add(line((1, 6), (5, 6), name="d"))
    assert (first, second, third) == (1, 2, 3)
    assert [tract.name for tract in editor.tracts.tracts] == ["slanted", "c", "d"]
    assert editor.tracts.tracts[1].points[0].tolist() == [1, 2, 0]
    for edit in (lambda: editor.remove(first), lambda: editor.move(first, [[1, 2, 0], [5, 2, 0]])):
        with pytest.raises(InvalidOption, match="no tract 1; there are 0, 2, 3"):
            edit()


def test_a_failed_edit_changes_nothing():
    editor = FieldEditor(flat(), TractSet([SLANTED], [BoundaryCondition(0, "parallel")]))
    before = editor.field().report()
    for edit in (
        lambda: editor.add(line((1, 1, 5), (2, 2, 5))),
        lambda: editor.move(0, [[1, 1, 5], [2, 2, 5]]),
        lambda: editor.move(0, [[1, 1, 0]]),
        lambda: editor.set_condition(3, "parallel"),
        lambda: editor.set_condition(0, "along"),  # type: ignore[arg-type]
        lambda: editor.set_condition(0, "parallel", weight=-1),
    ):
        with pytest.raises(InvalidOption):
            edit()
    assert editor.field().report() == before
    assert editor.add(line((1, 6), (5, 6))) == 1


def test_a_condition_is_replaced_and_taken_away():
    editor = FieldEditor(flat())
    editor.set_condition(0, "parallel")
    editor.set_condition((0, 0, 0), "perpendicular", weight=2)
    assert editor.field().report()["boundary"] == [{"loop": 0, "rule": "perpendicular", "weight": 2.0}]
    editor.set_condition(0, "free")
    assert editor.field().report()["boundary"] == []
    assert editor.tracts.boundary == ()


def test_what_an_editor_saves_it_opens_again(tmp_path):
    model = flat().with_loop_points({"border": np.zeros(3)})
    editor = FieldEditor(model, TractSet([SLANTED], [BoundaryCondition("border", "parallel")]))
    editor.add(line((1, 6), (5, 6.5), weight=2.0))
    editor.tracts.save(tmp_path / "t.json")
    again = interpolate(flat(), tmp_path / "t.json")
    assert again.field.directions.tobytes() == editor.field().field.directions.tobytes()
    assert again.notes == ()
    assert again.model.loop_names == {"border": 0}


def test_messages_and_reports_call_tracts_by_their_numbers():
    editor = FieldEditor(flat(), TractSet([line((1, 6), (5, 6)), line((1, 7), (5, 7))]))
    editor.remove(0)
    editor.move(1, [[1, 1, 0], [5, 4, 0]])
    crossing = editor.add(line((3, 0.5), (3, 5)))
    assert crossing == 2
    with pytest.raises(InvalidOption, match=r"^tract 2: point 1 is 90"):
        editor.move(crossing, [[3, 1, 0], [3, 98, 0]])
    with pytest.raises(InvalidOption, match=r"^tract 3: point 0 is 5 away"):
        editor.add(line((1, 1, 5), (2, 2, 5)))
    report = editor.field().report()
    assert [tract["name"] for tract in report["tracts"]] == ["tract 1", "tract 2"]
    (conflict,) = report["conflicts"]
    assert (conflict["kept"], conflict["dropped"]) == ("tract 1", "tract 2")
