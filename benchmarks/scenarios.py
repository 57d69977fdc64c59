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
    """The demo atrium with an `edge_length` in mm, a `file` below the folder of measured data, or a `shape`.

    `refinements` times each triangle is cut in four that keep its plane and its fibre, for meshes finer than the demo
    atrium's finest; then there are so many `copies` of it all, side by side.
    """

    edge_length: float | None = None
    file: str | None = None
    shape: str | None = None
    refinements: int = 0
    copies: int = 1

    def __post_init__(self) -> None:
        if sum(source is not None for source in (self.edge_length, self.file, self.shape)) != 1:
            raise ValueError("a surface is given by one of edge_length, file and shape")

    def __str__(self) -> str:
        if self.file is not None:
            name = Path(self.file).stem
        else:
            name = self.shape or f"demo atrium, {self.edge_length:g} mm edges"
        cut = [f"cut in {4**self.refinements}"] if self.refinements > 0 else []
        repeated = [f"{self.copies} copies"] if self.copies > 1 else []
        return ", ".join([name, *cut, *repeated])


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
