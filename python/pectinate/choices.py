"""Options that are names of a choice."""

from __future__ import annotations

from enum import Enum
from typing import Any, TypeVar

from pectinate.errors import InvalidOption

_Choice = TypeVar("_Choice", bound=Enum)


def member(choices: type[_Choice], name: str, value: Any) -> _Choice:
    """The choice called `value`.

    Raises
    ------
    InvalidOption
        There is none; the message calls the option `name` and lists the choices.
    """
    try:
        return choices[value]
    except (KeyError, TypeError):
        names = ", ".join(choices.__members__)
        raise InvalidOption(f"{name} is {value!r}, but must be one of {names}") from None
