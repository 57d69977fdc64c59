"""Tables of numbers in text files, parsed by numpy; errors name the line."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidFile

_LONGEST_QUOTE = 30


@dataclass(frozen=True)
class TextRows:
    """Lines of a file that are not blank, with their numbers in the file (from 1)."""

    path: Path
    lines: Sequence[str]
    numbers: Sequence[int]

    def __len__(self) -> int:
        return len(self.lines)

    def tail(self) -> TextRows:
        """All but the first line."""
        return TextRows(self.path, self.lines[1:], self.numbers[1:])

    def error(self, row: int, rule: str, remedy: str) -> InvalidFile:
        """Make the error for one of the lines."""
        return InvalidFile.at(self.path, rule, remedy, line=self.numbers[row])


def read_rows(path: Path) -> TextRows:
    """Read the lines of a text file that are not blank.

    Raises
    ------
    InvalidFile
        The file does not exist, cannot be read, is no text, or has nothing but blanks.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InvalidFile.at(path, "there is no such file", "check the path") from None
    except OSError as error:
        rule = f"cannot be read ({error.strerror})"
        raise InvalidFile.at(path, rule, "check the file and its permissions") from error
    except UnicodeDecodeError as error:
        raise InvalidFile.at(path, "is not a text file", "write it as plain text") from error
    lines = text.split("\n")
    kept = [number for number, line in enumerate(lines, start=1) if line and not line.isspace()]
    if not kept:
        raise InvalidFile.at(path, "is empty", "write the file again")
    if len(kept) == len(lines) - (not lines[-1]):
        return TextRows(path, lines[: len(kept)], range(1, len(kept) + 1))
    return TextRows(path, [lines[number - 1] for number in kept], kept)


def parse_table(rows: TextRows, widths: Collection[int], expected: str) -> NDArray[np.float64]:
    """Parse lines that all hold the same number of numbers; NaN and infinity are numbers.

    Parameters
    ----------
    rows
        The lines.
    widths
        The admissible numbers of columns.
    expected
        What a line holds, for the message.

    Returns
    -------
    (n, w) float64 with w one of `widths`; (0, least width) without lines.

    Raises
    ------
    InvalidFile
        A line holds a word, or another number of columns than the first one or than is admissible.
    """
    if len(rows) == 0:
        return np.empty((0, min(widths)))
    width = len(rows.lines[0].split())
    if width not in widths:
        raise rows.error(0, f"{width} columns", f"every line must hold {expected}")
    try:
        table = np.loadtxt(rows.lines, dtype=np.float64, comments=None, ndmin=2)
    except ValueError as error:
        raise _table_error(rows, width, expected, str(error)) from error
    if len(table) != len(rows):  # numpy skips a line of which nothing but the type of element is left
        raise _table_error(rows, width, expected, "lines without numbers")
    return table


def parse_counted(rows: TextRows, what: str) -> TextRows:
    """Take a first line that holds the number of the others away.

    Raises
    ------
    InvalidFile
        The first line is no such number, or the count is wrong.
    """
    tokens = rows.lines[0].split()
    if len(tokens) != 1 or not tokens[0].isdecimal():
        raise rows.error(0, f"{_quote(rows.lines[0])} is not a count", f"the first line must hold the number of {what}")
    found, stated = len(rows) - 1, int(tokens[0])
    if found != stated:
        rule = f"the first line announces {stated} {what}, the file holds {found}"
        raise rows.error(0, rule, "correct the count, or write the file again if it was cut off")
    return rows.tail()


def check_indices(rows: TextRows, values: NDArray[np.float64], count: int | None) -> NDArray[np.int64]:
    """Turn numbers, one row per line, into indices from 0.

    Parameters
    ----------
    rows, values
        The lines and what was parsed from them, (n,) or (n, w).
    count
        One more than the largest admissible index; None for any.

    Raises
    ------
    InvalidFile
        A number is no integer or out of range.
    """
    largest = 2**31 - 1 if count is None else count - 1
    table = values.reshape(len(rows), -1)
    good = (table == np.floor(table)) & (table >= 0) & (table <= largest)
    if not good.all():
        row, column = (int(k) for k in np.argwhere(~good)[0])
        raise rows.error(
            row, f"{table[row, column]:.15g} is not the index of a vertex", f"use integers from 0 to {largest}"
        )
    return values.astype(np.int64)


def check_integers(rows: TextRows, values: NDArray[np.float64], what: str) -> NDArray[np.int64]:
    """Turn integral numbers (n,), such as 4.0, into integers.

    Raises
    ------
    InvalidFile
        A number is not integral.
    """
    good = (values == np.floor(values)) & (np.abs(values) <= 2.0**53)
    if not good.all():
        row = int(np.argmin(good))
        raise rows.error(row, f"{values[row]:.15g} is not a {what}", f"a {what} is an integer")
    return values.astype(np.int64)


def format_rows(table: NDArray[np.float64] | NDArray[np.int64]) -> list[str]:
    """One line of text per row; reading a line back gives the very same numbers."""
    return [" ".join(map(repr, row)) for row in table.tolist()]


def write_lines(path: Path, lines: Sequence[str]) -> None:
    """Write a text file.

    Raises
    ------
    InvalidFile
        It cannot be written.
    """
    try:
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    except OSError as error:
        raise unwritable(path, error) from error


def unwritable(path: Path, error: OSError) -> InvalidFile:
    """Make the error for a file that cannot be written."""
    return InvalidFile.at(path, f"cannot be written ({error.strerror})", "check the folder and its permissions")


def _table_error(rows: TextRows, width: int, expected: str, message: str) -> InvalidFile:
    """Find the line that numpy refused."""
    remedy = f"every line must hold {expected}"
    for row, line in enumerate(rows.lines):
        tokens = line.split()
        for token in tokens:
            if not _is_number(token):
                return rows.error(row, f"{_quote(token)} is not a number", remedy)
        if len(tokens) != width:
            return rows.error(row, f"{len(tokens)} columns where line {rows.numbers[0]} has {width}", remedy)
    return InvalidFile.at(rows.path, message, remedy)


def _is_number(token: str) -> bool:
    try:
        float(token)
    except ValueError:
        return False
    return "_" not in token


def _quote(text: str) -> str:
    text = text.strip()
    return repr(text if len(text) <= _LONGEST_QUOTE else text[:_LONGEST_QUOTE] + "...")
