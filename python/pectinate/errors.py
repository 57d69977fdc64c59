"""Everything that pectinate raises on purpose; every message names the element, the rule and the remedy."""

from __future__ import annotations

import os

from pectinate._core import Error, InvalidField, InvalidMesh, InvalidOption, SolverFailure

__all__ = [
    "Error",
    "InvalidField",
    "InvalidFile",
    "InvalidMesh",
    "InvalidOption",
    "MissingDependency",
    "RenderingUnavailable",
    "SolverFailure",
]


class InvalidFile(Error, ValueError):
    """A file that does not exist, cannot be written, or breaks the rules of its format."""

    @classmethod
    def at(
        cls, path: str | os.PathLike[str], rule: str, remedy: str, *, line: int | None = None, place: str = ""
    ) -> InvalidFile:
        """Make the error for one place in a file.

        Parameters
        ----------
        path
            The file.
        rule
            What is wrong, in one clause.
        remedy
            What to do about it, in one clause.
        line
            Number of the line, from 1; None where the file has no lines or the whole file is wrong.
        place
            In a file of objects in objects, such as "tracts[3].points[7]".
        """
        where = [os.fspath(path)] + ([] if line is None else [f"line {line}"]) + ([place] if place else [])
        return cls(f"{', '.join(where)}: {rule}; {remedy}")


class MissingDependency(Error, ImportError):
    """An optional package is not installed; the message names the command that installs it."""


class RenderingUnavailable(Error, RuntimeError):
    """Pictures cannot be drawn here, for want of a library; the message names the packages that bring it."""
