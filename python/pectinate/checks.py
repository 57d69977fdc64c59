"""Arguments of public functions, checked before they reach the engine; every error names the argument."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable
from numbers import Real
from typing import Any, TypeVar

import numpy as np

from pectinate.errors import InvalidOption

_T = TypeVar("_T")


def real(value: Any, name: str) -> float:
    """Take a real number.

    Raises
    ------
    TypeError
        It is none.
    InvalidOption
        It is beyond the range of float64.
    """
    scalar = value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value
    if isinstance(scalar, bool) or not isinstance(scalar, Real):
        raise TypeError(f"{name} is {quoted(value)}, but must be a number")
    try:
        return float(scalar)
    except OverflowError:
        raise InvalidOption(f"{name} is beyond the range of numbers; give a smaller one") from None


def whole(value: Any, name: str, lowest: float = -math.inf, highest: float = math.inf) -> int:
    """Take a whole number, in a range if one is given.

    Raises
    ------
    TypeError
        It is none.
    InvalidOption
        It is out of the range.
    """
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None:
        raise TypeError(f"{name} is {quoted(value)}, but must be a whole number")
    if not lowest <= number <= highest:
        raise InvalidOption(f"{name} is {quoted(value)}, but must be from {lowest} to {highest}")
    return number


def flag(value: Any, name: str) -> bool:
    """Take True or False.

    Raises
    ------
    TypeError
        It is neither.
    """
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is {quoted(value)}, but must be True or False")
    return bool(value)


def text(value: Any, name: str) -> str:
    """Take a string.

    Raises
    ------
    TypeError
        It is none.
    """
    if not isinstance(value, str):
        raise TypeError(f"{name} is {quoted(value)}, but must be a string")
    return value


def one_of(value: Any, name: str, values: tuple[str, ...]) -> None:
    """Check that a word is one of some.

    Raises
    ------
    InvalidOption
        It is none of them.
    """
    if not isinstance(value, str) or value not in values:
        raise InvalidOption(f"{name} is {quoted(value)}, but must be one of {', '.join(values)}")


def all_of(values: Any, name: str, kind: type[_T]) -> tuple[_T, ...]:
    """Take a sequence of objects of one kind.

    Raises
    ------
    TypeError
        It is none, or something else is in it.
    """
    wanted = f"but must be a sequence of {kind.__name__}"
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise TypeError(f"{name} is {quoted(values)}, {wanted}")
    items = tuple(values)
    for index, item in enumerate(items):
        if not isinstance(item, kind):
            raise TypeError(f"{name}[{index}] is {quoted(item)}, {wanted}")
    return items


def quoted(value: Any) -> str:
    """Write a value in one short line."""
    words = " ".join(repr(value).split())
    longest = 60
    return words if len(words) <= longest else words[: longest - 3] + "..."
