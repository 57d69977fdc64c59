"""A progress bar on standard error for long work, silent where nobody watches."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TextIO

_WIDTH = 40
_SECONDS_BETWEEN_DRAWINGS = 0.1


class ProgressBar:
    """A context manager that is called with the share of the work that is done.

    Draws only on a terminal, at most ten times a second, and leaves an empty line behind.

    Parameters
    ----------
    label
        What is being done.
    enabled
        False for a bar that never draws.
    stream
        Where to draw; standard error when left out.
    """

    def __init__(self, label: str, *, enabled: bool = True, stream: TextIO | None = None) -> None:
        self._label = label
        self._stream = sys.stderr if stream is None else stream
        self._enabled = enabled and self._stream.isatty()
        self._next_drawing = 0.0

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._enabled:
            self._stream.write("\r\033[K")
            self._stream.flush()

    def __call__(self, share: float) -> None:
        """Show that `share`, in [0, 1], is done."""
        now = time.monotonic()
        if not self._enabled or now < self._next_drawing:
            return
        self._next_drawing = now + _SECONDS_BETWEEN_DRAWINGS
        filled = round(_WIDTH * share)
        self._stream.write(f"\r{self._label} [{'#' * filled}{'.' * (_WIDTH - filled)}] {share:4.0%}")
        self._stream.flush()
