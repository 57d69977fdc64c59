"""Which arrays of a VTK data set are the orientation field, the second direction and the region tags."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidField
from pectinate.io.vtk_cells import TriangleCells
from pectinate.model import Location

#: Names of orientation arrays, most telling first; case, spaces, hyphens and underscores do not matter.
FIELD_NAMES = (
    *("fiber", "fibers", "fibre", "fibres", "f0", "orientation", "orientations", "direction", "directions"),
    *("fiberdirection", "fiberdirections", "fibredirection", "fibredirections"),
    *("fiberorientation", "fiberorientations", "fibreorientation", "fibreorientations"),
)
SECOND_NAMES = ("sheet", "sheets", "s0")
TAG_NAMES = (
    *("elemtag", "elementtag", "tag", "tags", "region", "regions", "regionid", "regionids"),
    *("material", "materials", "materialid", "materialids"),
)

_VECTOR_WIDTH = 3
_WIDTHS = (_VECTOR_WIDTH, 6, 9)


class DatasetArrays:
    """The arrays of a data set that hold one row of real numbers for each cell or point."""

    def __init__(self, dataset: Any, cells: TriangleCells, source: str) -> None:
        self._source, self._rows = source, cells.rows
        self._tables: dict[Location, dict[str, NDArray[Any]]] = {
            "triangle": _tables(dataset.cell_data, cells.cell_count),
            "vertex": _tables(dataset.point_data, dataset.n_points),
        }
        self.notes: list[str] = []  # what was chosen, and what else it could have been

    def values(self, location: Location, name: str) -> NDArray[np.float64]:
        """Rows of an array per triangle or per point, float64."""
        table = self._tables[location][name]
        return (table[self._rows] if location == "triangle" else table).astype(np.float64)

    def named(self, name: str) -> tuple[Location, str]:
        """Find an array that the user named.

        Raises
        ------
        InvalidField
            It is not there, or has another number of components than 3, 6 or 9.
        """
        found = [location for location, tables in self._tables.items() if name in tables]
        if not found:
            known = ", ".join(f"{key} (per {place})" for place, tables in self._tables.items() for key in tables)
            raise InvalidField(f"{self._source}: there is no array {name!r}; name one of: {known or 'it has none'}")
        width = self._tables[found[0]][name].shape[1]
        if width not in _WIDTHS:
            rule = f"array {name!r} has {width} components"
            raise InvalidField(f"{self._source}: {rule}; vectors have 3, tensors 6 or 9")
        if len(found) > 1:
            self.notes.append(f"{name!r} is both a cell and a point array: the cell array was taken")
        return found[0], name

    def field(self) -> tuple[Location, str] | None:
        """Choose the orientation field by its name: cell arrays first."""
        fitting: list[tuple[Location, str]] = []
        for location, tables in self._tables.items():
            for key in _matches(tables, FIELD_NAMES):
                width = tables[key].shape[1]
                if width in _WIDTHS:
                    fitting.append((location, key))
                else:
                    self.notes.append(f"array {key!r} has {width} components and was not taken for the field")
        if not fitting:
            self.notes.append(f"no array is called like an orientation field: no field{self._possible_fields()}")
            return None
        (location, key), *rest = fitting
        others = ", ".join(f"{other!r} (per {place})" for place, other in rest)
        more = f"; {others} could be it too: name the one you mean" if rest else ""
        self.notes.append(f"the field is array {key!r} (per {location}){more}")
        return location, key

    def second_vectors(self) -> NDArray[np.float64] | None:
        """Second direction of each triangle."""
        tables = self._tables["triangle"]
        keys = [key for key in _matches(tables, SECOND_NAMES) if tables[key].shape[1] == _VECTOR_WIDTH]
        return self.values("triangle", keys[0]) if keys else None

    def tags(self) -> NDArray[np.int64] | None:
        """Region of each triangle."""
        for key in _matches(self._tables["triangle"], TAG_NAMES):
            table = self._tables["triangle"][key][self._rows]
            if table.shape[1] == 1 and (table == np.floor(table)).all():
                self.notes.append(f"the region tags are array {key!r}")
                tags: NDArray[np.int64] = table[:, 0].astype(np.int64)
                return tags
            self.notes.append(f"array {key!r} does not hold one integer per cell and was not taken for region tags")
        return None

    def _possible_fields(self) -> str:
        names = [key for tables in self._tables.values() for key, table in tables.items() if table.shape[1] in _WIDTHS]
        return f"; arrays that could be one if you name them: {', '.join(names)}" if names else ""


def _tables(store: Any, count: int) -> dict[str, NDArray[Any]]:
    """Numeric arrays with `count` rows, made two-dimensional."""
    arrays = {key: np.asarray(store[key]) for key in store.keys()}  # noqa: SIM118  (PyVista's store is no dict)
    fitting = {key: array for key, array in arrays.items() if array.dtype.kind in "fiu" and len(array) == count}
    return {key: array.reshape(count, -1) for key, array in fitting.items()}


def _matches(keys: Any, names: tuple[str, ...]) -> list[str]:
    """Keys that are one of the names, in the order of the names."""
    plain = {key: re.sub(r"[ _-]", "", key.lower()) for key in keys}
    return [key for name in names for key in plain if plain[key] == name]
