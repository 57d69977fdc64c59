"""Matplotlib, an optional extra: colour maps, round numbers for ticks, and the plot of the disk."""

from __future__ import annotations

import importlib
from typing import Any

from pectinate.errors import MissingDependency


def import_matplotlib(module: str = "matplotlib") -> Any:
    """Import Matplotlib or one of its modules, such as "matplotlib.ticker".

    Raises
    ------
    MissingDependency
        It is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        remedy = "install it with: pip install pectinate[figures]"
        raise MissingDependency(f"colours for values need Matplotlib ({error}); {remedy}") from error
