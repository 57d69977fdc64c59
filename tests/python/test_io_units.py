"""Units of length: the rule, the user's word, and the way back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pectinate.errors import InvalidOption
from pectinate.io.units import decide_unit, from_millimetres, to_millimetres

CUBE = np.array([[0.0, 0, 0], [1, 1, 1]])


@pytest.mark.parametrize(("diagonal", "unit"), [(1e-9, "mm"), (80, "mm"), (999.9, "mm"), (1000.1, "um"), (8e4, "um")])
def test_the_size_decides(diagonal: float, unit: str) -> None:
    decision = decide_unit(CUBE * diagonal / np.sqrt(3))
    assert (decision.unit, decision.decided_by) == (unit, "auto")
    assert f"{diagonal:.6g}" in decision.reason


def test_vertices_that_are_not_finite_have_no_say() -> None:
    assert decide_unit(np.vstack([CUBE, [np.inf, 0, 0], [np.nan, 1e9, 0]])).unit == "mm"
    assert decide_unit(np.full((2, 3), np.nan)).unit == "mm"


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1.0), ("um", 0.001), ("cm", 10.0), ("m", 1000.0)])
def test_the_user_decides(unit: str, factor: float) -> None:
    decision = decide_unit(CUBE * 5000, unit)
    assert (decision.unit, decision.factor, decision.decided_by) == (unit, factor, "user")
    np.testing.assert_allclose(to_millimetres(CUBE, decision), CUBE * factor, rtol=1e-15)


@pytest.mark.parametrize("unit", ["inch", "MM", ""])
def test_other_units_are_refused(unit: str) -> None:
    with pytest.raises(InvalidOption, match="use one of: auto, mm, um, cm, m"):
        decide_unit(CUBE, unit)
    with pytest.raises(InvalidOption, match="use one of"):
        from_millimetres(CUBE, unit)


@given(st.integers(-(10**12), 10**12), st.sampled_from(["mm", "um", "cm", "m"]))
def test_decimal_numbers_come_back_as_they_were(millionths: int, unit: str) -> None:
    written = np.array([[millionths / 1e6] * 3])
    millimetres = to_millimetres(written, decide_unit(written, unit))
    assert from_millimetres(millimetres, unit).tolist() == written.tolist()
