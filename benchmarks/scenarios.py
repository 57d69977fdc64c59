"""What is measured: read from `scenarios.toml`."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import tomllib

DATA_FILE = Path(__file__).with_name("scenarios.toml")


@dataclass(frozen=True)
class SurfaceSource:
    """The demo atrium with an `edge_length` in mm, or a `file` below the folder of measured data."""

    edge_length: float | None = None
    file: str | None = None

    def __post_init__(self) -> None:
        if (self.edge_length is None) == (self.file is None):
            raise ValueError("a surface is given by either edge_length or file")

    def __str__(self) -> str:
        if self.file is not None:
            return Path(self.file).stem
        return f"demo atrium, {self.edge_length:g} mm edges"


@dataclass(frozen=True)
class Case:
    """Options that every engine gets alike."""

    separation_distance: float
    seed_count: int
    threads: int

    def __str__(self) -> str:
        return f"d_sep {self.separation_distance:g} mm, {_count(self.seed_count, 'seed')}, " + _count(
            self.threads, "thread"
        )


@dataclass(frozen=True)
class Scenario:
    """One surface and all combinations of the options."""

    name: str
    about: str
    surface: SurfaceSource
    separations: list[float]
    methods: list[str]
    seed_counts: list[int]
    threads: list[int]
    repeats: int

    def cases(self) -> Iterator[Case]:
        """Combine the options."""
        for separation, seed_count, threads in itertools.product(self.separations, self.seed_counts, self.threads):
            yield Case(separation, seed_count, threads)


def read_scenarios(path: Path = DATA_FILE) -> tuple[dict[str, Scenario], list[str]]:
    """Read all scenarios by name, and the names of those that run by default.

    Raises
    ------
    TypeError
        A key is missing or unknown.
    """
    data = tomllib.loads(path.read_text())
    scenarios = [Scenario(**{**table, "surface": SurfaceSource(**table["surface"])}) for table in data["scenario"]]
    return {scenario.name: scenario for scenario in scenarios}, data["default"]


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
