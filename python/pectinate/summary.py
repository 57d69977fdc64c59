"""Everything worth knowing about a surface and its field, ready for JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pectinate._core import DirectionStatus, OrientationField, SurfaceMesh

if TYPE_CHECKING:
    from pectinate.model import Model, SurfaceData

_REPAIRS = (
    "degenerate_triangles",
    "duplicate_triangles",
    "non_finite_vertices",
    "non_finite_triangles",
    "unreferenced_vertices",
    "reversed_triangles",
    "split_vertices",
    "non_manifold_edges",
)
_FIRST_INDICES = 5


def summarize(model: Model) -> dict[str, Any]:
    """Describe a model; see `Model.summary`."""
    data, mesh = model.data, model.mesh
    return {
        "source": data.source,
        "units": vars(data.units).copy(),
        "input": {"vertices": len(data.vertices), "triangles": len(data.triangles)},
        "mesh": _mesh_summary(mesh),
        "components": [_component_summary(component) for component in mesh.components],
        "boundary_loops": _boundary_loops(model),
        "area_per_tag": _area_per_tag(model),
        "repairs": _repairs_summary(mesh),
        "field": None if model.field is None else _field_summary(data, model.field),
        "notes": list(data.notes),
    }


def _boundary_loops(model: Model) -> list[dict[str, Any]]:
    names = model.loop_names
    return [
        {
            "names": [name for name, named in names.items() if named == index],
            "vertices": len(loop.vertices),
            "length": float(loop.length),
            "diameter": float(loop.diameter),
            "centroid": [float(x) for x in loop.centroid],
            "component": int(loop.component),
            "tags": tags,
        }
        for index, (loop, tags) in enumerate(
            zip(model.mesh.boundary_loops, _loop_tags(model.mesh, model.tags), strict=True)
        )
    ]


def _area_per_tag(model: Model) -> dict[str, float] | None:
    if model.tags is None:
        return None
    values, group = np.unique(model.tags, return_inverse=True)
    areas = np.bincount(group, weights=model.mesh.triangle_areas)
    return {str(tag): float(area) for tag, area in zip(values, areas, strict=True)}


def _field_summary(data: SurfaceData, field: OrientationField) -> dict[str, Any]:
    angles = np.degrees(field.out_of_plane_angles[field.status == DirectionStatus.valid])
    return {
        "given_as": "vectors" if data.vectors is not None else "tensors",
        "given_per": data.vector_location,
        "status": {status.name: int(np.count_nonzero(field.status == status)) for status in DirectionStatus},
        "out_of_plane_median": float(np.median(angles)),
        "out_of_plane_p95": float(np.percentile(angles, 95)),
    }


def _mesh_summary(mesh: SurfaceMesh) -> dict[str, Any]:
    return {
        "vertices": len(mesh.vertices),
        "triangles": int(mesh.triangle_count),
        "edges": len(mesh.edges),
        "area": float(mesh.area),
        "mean_edge_length": float(np.mean(mesh.edge_lengths)),
        "bounding_box": [mesh.vertices.min(axis=0).tolist(), mesh.vertices.max(axis=0).tolist()],
        "bounding_box_diagonal": float(mesh.bounding_box_diagonal),
    }


def _component_summary(component: Any) -> dict[str, Any]:
    return {
        "triangles": int(component.triangle_count),
        "area": float(component.area),
        "euler_characteristic": int(component.euler_characteristic),
        "boundary_loops": int(component.boundary_loop_count),
        "orientable": bool(component.orientable),
        "genus": int(component.genus),
    }


def _repairs_summary(mesh: SurfaceMesh) -> dict[str, Any]:
    found = {name: np.asarray(getattr(mesh.repairs, name)) for name in _REPAIRS}
    return {name: {"count": len(rows), "first": rows[:_FIRST_INDICES].tolist()} for name, rows in found.items()}


def _loop_tags(mesh: SurfaceMesh, tags: NDArray[np.int64] | None) -> list[list[int]] | list[None]:
    """Collect the sorted tags of the triangles along each boundary loop; None without tags."""
    if tags is None:
        return [None] * len(mesh.boundary_loops)
    sides = mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    keys = _edge_keys(mesh, sides)
    order = np.argsort(keys)
    result = []
    for loop in mesh.boundary_loops:
        loop_keys = _edge_keys(mesh, np.column_stack([loop.vertices, np.roll(loop.vertices, -1)]))
        triangles = order[np.searchsorted(keys, loop_keys, sorter=order)] // 3
        result.append([int(tag) for tag in np.unique(tags[triangles])])
    return result


def _edge_keys(mesh: SurfaceMesh, ends: NDArray[np.int32]) -> NDArray[np.int64]:
    """One number per vertex pair, the same both ways."""
    ordered = np.sort(ends.astype(np.int64), axis=1)
    return ordered[:, 0] * len(mesh.vertices) + ordered[:, 1]
