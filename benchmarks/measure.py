"""Time and memory of the running process."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_PROCESS = Path("/proc/self")


class Stages:
    """CPU and wall time by stage.

    Attributes
    ----------
    seconds
        Stage -> {"cpu": s, "wall": s}; CPU time is that of all threads.
    """

    def __init__(self) -> None:
        self.seconds: dict[str, dict[str, float]] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time what is done inside."""
        cpu, wall = time.process_time(), time.perf_counter()
        yield
        self.seconds[name] = {"cpu": time.process_time() - cpu, "wall": time.perf_counter() - wall}


class PeakMemory:
    """How far the resident memory rises above what it is at construction.

    Linux lets the peak be reset, so that memory used and given back before does not hide a rise. Elsewhere it counts
    from the peak so far.
    """

    def __init__(self) -> None:
        _reset_peak()
        self._baseline = self._part_baseline = self._highest = _peak()

    def start_part(self) -> None:
        """Let `part_rise` count from here."""
        self._highest = max(self._highest, _peak())
        _reset_peak()
        self._part_baseline = _peak()

    def part_rise(self) -> float:
        """Return the rise of the peak since `start_part`, MB (10^6 bytes)."""
        return (_peak() - self._part_baseline) / 1e6

    def rise(self) -> float:
        """Return the rise of the peak so far, MB."""
        return (max(self._highest, _peak()) - self._baseline) / 1e6


def _reset_peak() -> None:
    if _PROCESS.is_dir():
        (_PROCESS / "clear_refs").write_text("5")


def _peak() -> int:
    """Return the peak of the resident memory, bytes.

    Not from getrusage on Linux: there a process inherits the peak of the one that started it.
    """
    if _PROCESS.is_dir():
        status = (_PROCESS / "status").read_text()
        return 1024 * next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM"))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
