"""Runs the engines of a case in turn, each run in a process of its own."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from quality import Streamlines, measure_quality, run_checker
from scenarios import Case, Scenario
from surfaces import Arrays
from worker import PEER

WORKER = Path(__file__).with_name("worker.py")
CHAIN = ("mesh", "field", "placement")  # from arrays to streamlines; the peer does it all in one call


@dataclass(frozen=True)
class Setup:
    """How cases are run.

    Attributes
    ----------
    folder
        For files between processes.
    with_peer
        Run the peer too.
    repeats
        Instead of the scenario's own, where given.
    timeout
        Of one run, s.
    checker
        An external checker to run on one result of each engine.
    log
        Told of every run.
    again
        Place once more in the same process, as stage "again": memory then is memory that was touched before.
    """

    folder: Path
    with_peer: bool
    repeats: int | None
    timeout: float
    checker: Path | None
    log: Callable[[str], None]
    again: bool = False


@dataclass
class Row:
    """All runs of one engine in one case.

    Attributes
    ----------
    engine, method
        The peer's method is empty.
    runs
        Per run: "stages" (stage -> {"cpu", "wall"}, s), "peak_memory" and "placement_memory" (MB), and "quality" (of
        `measure_quality`).
    failure
        Why there is no result: refused, crashed, too slow. Empty where there is one.
    checked
        What the checker found in the last run.
    """

    engine: str
    method: str
    runs: list[dict[str, Any]] = field(default_factory=list)
    failure: str = ""
    checked: dict[str, float] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Engine, and method if there is a choice."""
        return f"{self.engine} {self.method}".strip()

    @property
    def is_peer(self) -> bool:
        """Whether it is the other engine."""
        return self.engine == PEER

    def seconds(self, clock: str, stages: tuple[str, ...] = CHAIN) -> list[float]:
        """Sum up stages in each run; `clock` is "cpu" or "wall"."""
        return [sum(run["stages"][name][clock] for name in stages if name in run["stages"]) for run in self.runs]

    def best(self, clock: str, stages: tuple[str, ...] = CHAIN) -> float:
        """Return the least of `seconds`: that of the run least disturbed."""
        return min(self.seconds(clock, stages))

    @property
    def peak_memory(self) -> float:
        """Median over the runs, MB."""
        return float(statistics.median(run["peak_memory"] for run in self.runs))

    @property
    def placement_memory(self) -> float:
        """Median of that of the placement alone, MB."""
        return float(statistics.median(run["placement_memory"] for run in self.runs))

    @property
    def quality(self) -> dict[str, float]:
        """Median of each figure over the runs, which differ in the random seed."""
        names = self.runs[0]["quality"] if self.runs else {}
        return {name: float(statistics.median(run["quality"][name] for run in self.runs)) for name in names}

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain data, with best and median times."""
        times = {
            clock: {"best": min(all_seconds), "median": statistics.median(all_seconds)}
            for clock in ("cpu", "wall")
            if (all_seconds := self.seconds(clock))
        }
        return asdict(self) | {"times": times, "quality": self.quality}


def run_case(scenario: Scenario, case: Case, arrays: Arrays, setup: Setup) -> list[Row]:
    """Run our methods and the peer in turn: A B C P, A B C P, ...; run k of each with random seed k."""
    rows = [Row("pectinate", method) for method in scenario.methods]
    if setup.with_peer:
        rows.append(Row(PEER, ""))
    arrays.save(arrays_file(setup))
    repeats = setup.repeats or scenario.repeats
    for repeat in range(1, repeats + 1):
        for row in rows:
            if not row.failure:
                _run_once(
                    row,
                    asdict(case) | {"method": row.method, "random_seed": repeat, "again": setup.again},
                    arrays.area,
                    setup,
                )
                outcome = row.failure or f"{row.seconds('cpu')[-1]:.2f} s CPU"
                setup.log(f"{scenario.surface}, {case}: {row.name}, run {repeat} of {repeats}: {outcome}")
    for row in rows:
        if setup.checker is not None and not row.failure:
            setup.log(f"checking {row.name}")
            streamlines = Streamlines.read(streamlines_file(row, setup))
            row.checked = run_checker(setup.checker, arrays, streamlines, case.separation_distance, setup.folder)
    return rows


def _run_once(row: Row, options: dict[str, Any], area: float, setup: Setup) -> None:
    figures = _figures_of_worker(row, options, setup)
    if "failure" in figures:
        row.failure = figures["failure"]
        return
    lengths = Streamlines.read(streamlines_file(row, setup)).lengths
    row.runs.append(figures | {"quality": measure_quality(lengths, area, options["separation_distance"])})


def _figures_of_worker(row: Row, options: dict[str, Any], setup: Setup) -> dict[str, Any]:
    figures_file = setup.folder / "figures.json"
    job_file = setup.folder / "job.json"
    job = {
        "engine": row.engine,
        "options": options,
        "arrays": str(arrays_file(setup)),
        "streamlines": str(streamlines_file(row, setup)),
        "figures": str(figures_file),
    }
    job_file.write_text(json.dumps(job))
    environment = os.environ | {"OMP_NUM_THREADS": str(options["threads"]), "OPENBLAS_NUM_THREADS": "1"}
    try:
        subprocess.run([sys.executable, str(WORKER), str(job_file)], check=True, env=environment, timeout=setup.timeout)
    except subprocess.TimeoutExpired:
        return {"failure": f"no result within {setup.timeout:g} s"}
    except subprocess.CalledProcessError as error:
        return {"failure": f"crashed with exit status {error.returncode}"}
    figures: dict[str, Any] = json.loads(figures_file.read_text())
    return figures


def arrays_file(setup: Setup) -> Path:
    """Where the surface of the case that ran last lies."""
    return setup.folder / "surface.npz"


def streamlines_file(row: Row, setup: Setup) -> Path:
    """Where the streamlines of an engine's last run lie."""
    return setup.folder / f"{row.name.replace(' ', '-')}.npz"
