"""The file of names of boundary loops: JSON, `{"mitral valve": [x, y, z], ...}`, each with a point near the loop, mm.

A file of tracts is taken as well, for its `loops`; see `pectinate.io.tract_file`.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pectinate.io.json_place import read_json
from pectinate.io.tract_file import read_tracts


def read_loops(path: str | os.PathLike[str]) -> dict[str, NDArray[np.float64]]:
    """Read a file of loop names, or the `loops` of a file of tracts.

    Raises
    ------
    InvalidFile
        The file is missing or malformed; the message names the place.
    """
    members = read_json(Path(path)).members()
    if "format" in members:
        return dict(read_tracts(path).loops)
    return {name: np.array(at.point()) for name, at in members.items()}
