"""JSON that is checked while it is taken apart; errors name the place, such as tracts[3].points[7]."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from pectinate.errors import InvalidFile
from pectinate.io.text import read_rows

_LONGEST_QUOTE = 40
_COORDINATES = 3


@dataclass(frozen=True)
class Place:
    """A value in a document.

    Attributes
    ----------
    path
        The file.
    where
        The place, empty for the whole document.
    value
        What is there.
    """

    path: Path
    where: str
    value: Any

    def error(self, rule: str, remedy: str) -> InvalidFile:
        """Make the error for this place."""
        return InvalidFile.at(self.path, rule, remedy, place=self.where)

    def members(self) -> dict[str, Place]:
        """Places of the values of an object, by key."""
        if not isinstance(self.value, dict):
            raise self._not("an object {...}")
        return {key: Place(self.path, self._member(key), value) for key, value in self.value.items()}

    def keys(self, required: Sequence[str], optional: Sequence[str]) -> dict[str, Place]:
        """Places of the values of an object that has these keys and no others."""
        members = self.members()
        for key in members:
            if key not in required and key not in optional:
                raise self.error(f"the key {_quote(key)} is unknown", f"use {', '.join((*required, *optional))}")
        for key in required:
            if key not in members:
                raise self.error(f"the key {key!r} is missing", "add it")
        return members

    def items(self) -> list[Place]:
        """Places of the values of a list."""
        if not isinstance(self.value, list):
            raise self._not("a list [...]")
        return [Place(self.path, f"{self.where}[{index}]", value) for index, value in enumerate(self.value)]

    def point(self) -> list[float]:
        """Three finite numbers."""
        items = self.items()
        if len(items) != _COORDINATES:
            raise self.error(f"{len(items)} numbers", "a point is [x, y, z], mm")
        return [item.number() for item in items]

    def number(self) -> float:
        """A finite number."""
        if isinstance(self.value, bool) or not isinstance(self.value, (int, float)):
            raise self._not("a number")
        try:
            number = float(self.value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self._not("a finite number")
        return number

    def positive(self) -> float:
        """A finite number above 0."""
        number = self.number()
        if number <= 0:
            raise self._not("a positive number")
        return number

    def count(self, what: str) -> int:
        """A whole number from 0; `what` says of what in the message."""
        if isinstance(self.value, bool) or not isinstance(self.value, int) or self.value < 0:
            raise self._not(what)
        return self.value

    def text(self) -> str:
        """A string."""
        if not isinstance(self.value, str):
            raise self._not("text in quotation marks")
        return self.value

    def one_of(self, values: Sequence[Any]) -> Any:
        """Exactly one of the values, of the same type."""
        for value in values:
            if type(value) is type(self.value) and value == self.value:
                return value
        raise self._not(" or ".join(map(repr, values)))

    def _member(self, key: str) -> str:
        if not re.fullmatch(r"[A-Za-z_]\w*", key):
            return f"{self.where}[{_quote(key)}]"
        return f"{self.where}.{key}" if self.where else key

    def _not(self, what: str) -> InvalidFile:
        return self.error(f"{_quote(self.value)} is not {what}", f"give {what}")


def read_json(path: Path) -> Place:
    """Read a JSON document; numbers that are not finite and repeated keys are errors.

    Raises
    ------
    InvalidFile
        The file is missing or no JSON.
    """
    rows = read_rows(path)
    lines = dict(zip(rows.numbers, rows.lines, strict=True))
    text = "\n".join(lines.get(number, "") for number in range(1, rows.numbers[-1] + 1))

    def refuse_constant(name: str) -> NoReturn:
        raise InvalidFile.at(path, f"{name} is no number in JSON", "use finite numbers")

    def refuse_repetition(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        result = dict(pairs)
        if len(result) != len(pairs):
            keys = [key for key, _ in pairs]
            repeated = next(key for key in keys if keys.count(key) > 1)
            raise InvalidFile.at(path, f"the key {_quote(repeated)} is there twice in one object", "keep one of them")
        return result

    try:
        value = json.loads(text, parse_constant=refuse_constant, object_pairs_hook=refuse_repetition)
    except json.JSONDecodeError as error:
        rule = f"is no JSON ({error.msg}, column {error.colno})"
        raise InvalidFile.at(path, rule, "correct it there or just before", line=error.lineno) from error
    except (RecursionError, ValueError) as error:
        if isinstance(error, InvalidFile):
            raise
        raise InvalidFile.at(path, f"is no JSON that can be read ({error})", "write it again") from error
    return Place(path, "", value)


def _quote(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= _LONGEST_QUOTE else text[:_LONGEST_QUOTE] + "..."
