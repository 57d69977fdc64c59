"""The file of tracts and boundary conditions: JSON that people can read and edit, lengths in mm.

```
{
  "format": "pectinate tracts",
  "version": 1,
  "units": "mm",
  "surface": {"source": ..., "vertices": ..., "triangles": ..., "area": ..., "bounding_box": ..., "checksum": ...},
  "loops": {"mitral valve": [x, y, z]},
  "boundary": [{"loop": "mitral valve", "rule": "parallel"}, {"loop": 2, "rule": "perpendicular", "weight": 5.0}],
  "tracts": [{"name": "Bachmann's bundle", "label": "1", "points": [[x, y, z], [x, y, z]]}]
}
```

Only `format` and `version` must be there. A loop is named by its index, its name in `loops`, or a point near it. A
`weight` is from 1e-6 to 1e12; left out it means: exactly. `surface` tells on which surface the tracts were drawn; they
may be used on others.
"""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import Any

import numpy as np

from pectinate.io.json_place import Place, read_json
from pectinate.io.text import write_lines
from pectinate.tracts import RULES, WEIGHT_RANGE, BoundaryCondition, SurfaceIdentity, Tract, TractSet

FORMAT = "pectinate tracts"
VERSION = 1

_IDENTITY_KEYS = ("source", "vertices", "triangles", "area", "bounding_box", "checksum")
_LEAST_POINTS = 2


def read_tracts(path: str | os.PathLike[str]) -> TractSet:
    """Read a file of tracts.

    Raises
    ------
    InvalidFile
        The file is missing or malformed; the message names the place, such as tracts[3].points[7].
    """
    document = read_json(Path(path))
    keys = document.keys(("format", "version"), ("units", "surface", "loops", "boundary", "tracts"))
    keys["format"].one_of((FORMAT,))
    keys["version"].one_of((VERSION,))
    if "units" in keys:
        keys["units"].one_of(("mm",))
    return TractSet(
        tracts=tuple(_read_tract(place) for place in keys["tracts"].items()) if "tracts" in keys else (),
        boundary=tuple(_read_condition(place) for place in keys["boundary"].items()) if "boundary" in keys else (),
        loops={name: np.array(at.point()) for name, at in keys["loops"].members().items()} if "loops" in keys else {},
        surface=_read_identity(keys["surface"]) if "surface" in keys else None,
    )


def write_tracts(tracts: TractSet, path: str | os.PathLike[str]) -> None:
    """Write a file of tracts; reading it gives the very same numbers.

    Raises
    ------
    InvalidFile
        It cannot be written.
    """
    members = [f'"format": {_json(FORMAT)}', f'"version": {VERSION}', '"units": "mm"']
    if tracts.surface is not None:
        members.append(f'"surface": {_json(_identity(tracts.surface))}')
    if tracts.loops:
        rows = [f"{_json(name)}: {_json(point.tolist())}" for name, point in tracts.loops.items()]
        members.append(f'"loops": {_block("{", rows, "}")}')
    members.append(f'"boundary": {_block("[", [_json(_condition(c)) for c in tracts.boundary], "]")}')
    members.append(f'"tracts": {_block("[", [_tract(tract) for tract in tracts.tracts], "]")}')
    write_lines(Path(path), [_block("{", members, "}")])


def _read_tract(place: Place) -> Tract:
    keys = place.keys(("points",), ("name", "description", "label", "weight"))
    points = [point.point() for point in keys["points"].items()]
    if len(points) < _LEAST_POINTS:
        raise keys["points"].error(f"{len(points)} points", "a tract has at least two")
    return Tract(
        points=np.array(points),
        name=keys["name"].text() if "name" in keys else "",
        weight=_weight_at(keys["weight"]) if "weight" in keys else math.inf,
        description=keys["description"].text() if "description" in keys else "",
        label=keys["label"].text() if "label" in keys else "",
    )


def _read_condition(place: Place) -> BoundaryCondition:
    keys = place.keys(("loop", "rule"), ("weight",))
    loop = keys["loop"]
    match loop.value:
        case str():
            which: Any = loop.text()
        case list():
            which = loop.point()
        case _:
            which = loop.count("an index, a name in quotation marks or a point [x, y, z]")
    weight = _weight_at(keys["weight"]) if "weight" in keys else math.inf
    return BoundaryCondition(which, keys["rule"].one_of(RULES), weight)


def _weight_at(place: Place) -> float:
    weight, (least, greatest) = place.positive(), WEIGHT_RANGE
    if not least <= weight <= greatest:
        raise place.error(f"the weight is {weight:g}", f"give one from {least:g} to {greatest:g}, or none for exactly")
    return weight


def _read_identity(place: Place) -> SurfaceIdentity:
    keys = place.keys(_IDENTITY_KEYS, ())
    corners = [tuple(corner.point()) for corner in keys["bounding_box"].items()]
    if len(corners) != 2:  # noqa: PLR2004
        raise keys["bounding_box"].error(f"{len(corners)} points", "give the least and the greatest coordinates")
    return SurfaceIdentity(
        source=keys["source"].text(),
        vertex_count=keys["vertices"].count("a number of vertices"),
        triangle_count=keys["triangles"].count("a number of triangles"),
        area=keys["area"].positive(),
        bounding_box=(corners[0], corners[1]),  # type: ignore[arg-type]
        checksum=keys["checksum"].text(),
    )


def _identity(surface: SurfaceIdentity) -> dict[str, Any]:
    values = (surface.source, surface.vertex_count, surface.triangle_count, surface.area, surface.bounding_box)
    return dict(zip(_IDENTITY_KEYS, (*values, surface.checksum), strict=True))


def _condition(condition: BoundaryCondition) -> dict[str, Any]:
    loop = condition.loop if isinstance(condition.loop, str) else _plain(condition.loop)
    return {"loop": loop, "rule": condition.rule} | _weight(condition.weight)


def _tract(tract: Tract) -> str:
    head = {"name": tract.name, "label": tract.label, "description": tract.description} | _weight(tract.weight)
    rows = [f"{_json(key)}: {_json(value)}" for key, value in head.items() if value != ""]
    rows.append(f'"points": {_block("[", [_json(point) for point in tract.points.tolist()], "]")}')
    return _block("{", rows, "}")


def _weight(weight: float) -> dict[str, float]:
    return {} if math.isinf(weight) else {"weight": float(weight)}


def _plain(value: Any) -> Any:
    """An index, or a point as a list."""
    if hasattr(value, "tolist"):
        return value.tolist()
    return [float(x) for x in value] if isinstance(value, (list, tuple)) else value


def _block(opening: str, rows: list[str], closing: str) -> str:
    """One row a line, indented."""
    if not rows:
        return opening + closing
    body = ",\n".join(rows).replace("\n", "\n  ")
    return f"{opening}\n  {body}\n{closing}"


def _json(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False, allow_nan=False)
    try:
        text.encode()
    except UnicodeEncodeError:  # half of a surrogate pair
        return json.dumps(value, allow_nan=False)
    return text
