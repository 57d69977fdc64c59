"""What a file held (`SurfaceData`) and what is computed with (`Model`: mesh, field, tags, provenance)."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from pectinate._core import DirectionStatus, OrientationField, SurfaceMesh
from pectinate.errors import InvalidField, InvalidMesh
from pectinate.figure.files import check_picture_path, save_picture
from pectinate.figure.sheet import draw_sheet

if TYPE_CHECKING:
    from pectinate.io.units import UnitDecision

Location = Literal["triangle", "vertex"]

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


@dataclass(frozen=True, eq=False)
class SurfaceData:
    """The triangles of a source with everything that is said about them, in the order of the source.

    Attributes
    ----------
    vertices
        (V, 3) float64, millimetres.
    triangles
        (T, 3) int64, indices of vertices.
    units
        The unit of the source and how it was decided.
    source
        The file, or the kind of object.
    vectors
        (T, 3) or (V, 3) float64, fibre directions as given: any length, any sign, NaN allowed.
    tensors
        (T, 6) or (V, 6) float64: xx, yy, zz, xy, yz, xz. At most one of `vectors` and `tensors` is there.
    vector_location
        What `vectors` or `tensors` belong to.
    second_vectors
        (T, 3) float64, the second direction (sheet) of each triangle.
    tags
        (T,) int64, region of each triangle.
    element_rows
        (T,) int64, number of each triangle among all elements of the source; None where there are only triangles.
    element_count
        Number of all elements of the source; None where there are only triangles.
    notes
        What a reader decided or left out, one sentence each.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    units: UnitDecision
    source: str
    vectors: NDArray[np.float64] | None = None
    tensors: NDArray[np.float64] | None = None
    vector_location: Location = "triangle"
    second_vectors: NDArray[np.float64] | None = None
    tags: NDArray[np.int64] | None = None
    element_rows: NDArray[np.int64] | None = None
    element_count: int | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Model:
    """A surface with its orientation field and region tags, in millimetres.

    Attributes
    ----------
    mesh
        The surface, cut and oriented; `mesh.input_triangle` leads back to `data.triangles`.
    field
        The orientation of the fibres in every mesh triangle; None where the source gives none.
    data
        What the source held.
    """

    mesh: SurfaceMesh
    field: OrientationField | None
    data: SurfaceData

    @classmethod
    def from_data(cls, data: SurfaceData) -> Model:
        """Make the mesh and the field.

        Raises
        ------
        InvalidMesh
            An index is out of range, or no valid triangle is left.
        InvalidField
            The counts do not fit, or no triangle gets a direction.
        """
        try:
            mesh = SurfaceMesh(data.vertices, data.triangles)
        except InvalidMesh as error:
            raise InvalidMesh(f"{data.source}: {error}") from error
        try:
            return cls(mesh, _orientation_field(mesh, data), data)
        except InvalidField as error:
            raise InvalidField(f"{data.source}: {error}") from error

    @property
    def tags(self) -> NDArray[np.int64] | None:
        """Region of each mesh triangle, (T,); None where the source has no tags."""
        return None if self.data.tags is None else self.data.tags[self.mesh.input_triangle]

    @property
    def second_vectors(self) -> NDArray[np.float64] | None:
        """Second direction of each mesh triangle as given, (T, 3); None where the source has none."""
        return None if self.data.second_vectors is None else self.data.second_vectors[self.mesh.input_triangle]

    def figure(self, path: str | os.PathLike[str] | None = None, **sheet_options: Any) -> Image.Image:
        """Draw the surface without streamlines, in one or several views, such as for a map of values on it.

        Parameters
        ----------
        path
            Where to write the picture; by default nowhere.
        sheet_options
            Of `pectinate.figure.draw_sheet`: `surface_values` (per triangle or vertex of `mesh`), `layers`, ...

        Raises
        ------
        InvalidOption, InvalidFile, RenderingUnavailable, MissingDependency
            As `Placement.figure`.
        """
        check_picture_path(path)
        return save_picture(draw_sheet((self.mesh.vertices, self.mesh.triangles), **sheet_options), path)

    def summary(self) -> dict[str, Any]:
        """Everything worth knowing before streamlines are placed, ready for JSON.

        Lengths are in mm, areas in mm^2, angles in degrees; triangle and vertex indices are those of the source.
        """
        return {
            "source": self.data.source,
            "units": vars(self.data.units).copy(),
            "input": {"vertices": len(self.data.vertices), "triangles": len(self.data.triangles)},
            "mesh": _mesh_summary(self.mesh),
            "components": [_component_summary(component) for component in self.mesh.components],
            "boundary_loops": self._boundary_loops(),
            "area_per_tag": self._area_per_tag(),
            "repairs": _repairs_summary(self.mesh),
            "field": None if self.field is None else self._field_summary(self.field),
            "notes": list(self.data.notes),
        }

    def _boundary_loops(self) -> list[dict[str, Any]]:
        return [
            {
                "vertices": len(loop.vertices),
                "length": float(loop.length),
                "diameter": float(loop.diameter),
                "centroid": [float(x) for x in loop.centroid],
                "component": int(loop.component),
                "tags": tags,
            }
            for loop, tags in zip(self.mesh.boundary_loops, _loop_tags(self.mesh, self.tags), strict=True)
        ]

    def _area_per_tag(self) -> dict[str, float] | None:
        if self.tags is None:
            return None
        values, group = np.unique(self.tags, return_inverse=True)
        areas = np.bincount(group, weights=self.mesh.triangle_areas)
        return {str(tag): float(area) for tag, area in zip(values, areas, strict=True)}

    def _field_summary(self, field: OrientationField) -> dict[str, Any]:
        angles = np.degrees(field.out_of_plane_angles[field.status == DirectionStatus.valid])
        return {
            "given_as": "vectors" if self.data.vectors is not None else "tensors",
            "given_per": self.data.vector_location,
            "status": {status.name: int(np.count_nonzero(field.status == status)) for status in DirectionStatus},
            "out_of_plane_median": float(np.median(angles)),
            "out_of_plane_p95": float(np.percentile(angles, 95)),
        }


def _orientation_field(mesh: SurfaceMesh, data: SurfaceData) -> OrientationField | None:
    per_triangle = data.vector_location == "triangle"
    if data.vectors is not None:
        of_vectors = OrientationField.from_triangle_vectors if per_triangle else OrientationField.from_vertex_vectors
        return of_vectors(mesh, data.vectors)
    if data.tensors is not None:
        of_tensors = OrientationField.from_triangle_tensors if per_triangle else OrientationField.from_vertex_tensors
        return of_tensors(mesh, data.tensors)
    return None


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
