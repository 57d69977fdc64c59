"""What a file held (`SurfaceData`) and what is computed with (`Model`: mesh, field, tags, provenance)."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from pectinate import _core
from pectinate._core import OrientationField, SurfaceMesh
from pectinate.errors import InvalidField, InvalidMesh, InvalidOption
from pectinate.figure.files import check_picture_path, save_picture
from pectinate.figure.parts import Part, Values, named_values
from pectinate.figure.polylines import Lines
from pectinate.figure.sheet import draw_sheet
from pectinate.io.gltf import make_trimesh
from pectinate.io.vtk_library import surface_dataset
from pectinate.summary import summarize
from pectinate.viewer import Page

if TYPE_CHECKING:
    from pectinate.io.units import UnitDecision

Location = Literal["triangle", "vertex"]

_TRACT_RADIUS = 0.005


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
    loop_points
        For each named boundary loop a point (3,), mm: the name goes to the loop nearest to it.
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
    loop_points: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)


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

    @property
    def loop_names(self) -> dict[str, int]:
        """Index in `mesh.boundary_loops` of each named loop: the one nearest to its point in `data.loop_points`."""
        if not self.mesh.boundary_loops:
            return {}
        points = self.data.loop_points
        return {name: _core.nearest_boundary_loop(self.mesh, point) for name, point in points.items()}

    def require_field(self) -> OrientationField:
        """Return the field.

        Raises
        ------
        InvalidField
            There is none.
        """
        if self.field is None:
            raise InvalidField(f"{self.data.source} has no orientation field; give one with load(..., field=...)")
        return self.field

    def with_loop_points(self, points: Mapping[str, NDArray[np.float64]]) -> Model:
        """Name more loops, each by a point (3,), mm, on it or near it; a name that is known gets the new point."""
        return replace(self, data=replace(self.data, loop_points={**self.data.loop_points, **points}))

    def with_field(self, field: OrientationField, note: str) -> Model:
        """Replace the field of this mesh, and with it vectors, tensors and second vectors of the data.

        Parameters
        ----------
        field
            Of `mesh`; triangles of the source that the mesh does not have get zero vectors.
        note
            One sentence for `data.notes`: where the field comes from.
        """
        vectors = self.per_input_triangle(field.directions, missing=0.0)
        notes = (*self.data.notes, note)
        data = replace(self.data, vectors=vectors, tensors=None, vector_location="triangle", notes=notes)
        return Model(self.mesh, field, replace(data, second_vectors=None))

    def vertex_directions(self) -> NDArray[np.float64]:
        """Average the field per vertex of the source, (V, 3): unit lines, by the tensors of the triangles around.

        Zero where no triangle around has a direction. A vertex where the mesh was cut gets that of its first fan.

        Raises
        ------
        InvalidField
            There is no field.
        """
        directions = _core.vertex_directions(self.mesh, self.require_field())
        vertices, first = np.unique(self.mesh.input_vertex, return_index=True)
        result = np.zeros((self.mesh.input_vertex_count, 3))
        result[vertices] = directions[first]
        return result

    def per_input_triangle(self, values: NDArray[np.float64], *, missing: float = np.nan) -> NDArray[np.float64]:
        """Take values (T, ...) of mesh triangles to the triangles of the source; `missing` for those left out."""
        result = np.full((self.mesh.input_triangle_count, *values.shape[1:]), missing)
        result[self.mesh.input_triangle] = values
        return result

    def to_mesh(self, values: ArrayLike) -> NDArray[np.float64]:
        """Take numbers of the source's triangles (T,) or vertices (V,) to those of `mesh`.

        Raises
        ------
        InvalidOption
            There is not one number per triangle or per vertex.
        """
        array, mesh = np.asarray(values), self.mesh
        rows = {mesh.input_vertex_count: mesh.input_vertex, mesh.input_triangle_count: mesh.input_triangle}
        if array.ndim != 1 or array.dtype.kind not in "fiu" or len(array) not in rows:
            raise InvalidOption(
                f"values of shape {array.shape} and type {array.dtype}: give one number per triangle "
                f"({mesh.input_triangle_count},) or vertex ({mesh.input_vertex_count},) of {self.data.source}"
            )
        return array.astype(np.float64)[rows[len(array)]]

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

    def to_trimesh(self) -> trimesh.Trimesh:
        """Make a `trimesh.Trimesh` of `mesh`, in mm, with the same rows."""
        return make_trimesh(self.mesh.vertices, self.mesh.triangles)

    def to_pyvista(self, values: Mapping[str, ArrayLike] | None = None) -> Any:
        """Make a PyVista data set of `mesh`.

        Cells have `fiber` (directions, zero where there is none), `elemTag`, both where the model has them, and
        `input_triangle`; points have `input_vertex`.

        Parameters
        ----------
        values
            More arrays by name, per triangle or vertex of `mesh`.

        Raises
        ------
        MissingDependency
            PyVista is not installed.
        InvalidOption
            There is not one row per triangle or vertex.
        """
        mesh, per_triangle, per_vertex = self.mesh, {}, {}
        for name, given in (values or {}).items():
            array = np.asarray(given)
            if array.shape[:1] == (mesh.triangle_count,):
                per_triangle[name] = array
            elif array.shape[:1] == (len(mesh.vertices),):
                per_vertex[name] = array
            else:
                raise InvalidOption(
                    f"values {name!r} of shape {array.shape}: give one row per triangle ({mesh.triangle_count}) or "
                    f"vertex ({len(mesh.vertices)}) of the mesh"
                )
        fibres = None if self.field is None else self.field.directions
        cells = {"fiber": fibres, "elemTag": self.tags, "input_triangle": mesh.input_triangle, **per_triangle}
        return surface_dataset(mesh.vertices, mesh.triangles, cells, {"input_vertex": mesh.input_vertex, **per_vertex})

    def part(
        self,
        name: str = "",
        *,
        tracts: Sequence[ArrayLike] = (),
        tract_radius: float | None = None,
        surface_values: Values | None = None,
        **options: Any,
    ) -> Part:
        """Make a part of a page or of a sheet of pictures, which may have several.

        See `pectinate.viewer.Page` and `pectinate.figure_sheet`.

        Parameters
        ----------
        name
            Beside its switch.
        tracts
            Lines (k, 3), mm, drawn black, such as `TractSet.curves_on` makes.
        tract_radius
            mm; by default a 200th of the surface's diagonal.
        surface_values
            Numbers per triangle or vertex of `mesh`, as in `figure`; several by name.
        options
            Of `Part`: `visible`, `surface_color`, `offset`, `rotation`.

        Raises
        ------
        InvalidOption
            A tract is no line, or an option is out of its range.
        """
        radius = _TRACT_RADIUS * self.mesh.bounding_box_diagonal if tract_radius is None else tract_radius
        return Part(
            name,
            (self.mesh.vertices, self.mesh.triangles),
            tracts=Lines.of(tracts, radius) if len(tracts) else None,
            surface_values=named_values(surface_values),
            **options,
        )

    def show(
        self,
        *,
        tracts: Sequence[ArrayLike] = (),
        surface_values: Values | None = None,
        **page_options: Any,
    ) -> Page:
        """Show the surface without streamlines in the browser, or in Jupyter.

        Parameters
        ----------
        tracts, surface_values
            As in `part`.
        page_options
            Of `pectinate.viewer.Page`: `markers`, `views`, `title`, ...

        Raises
        ------
        InvalidOption, MissingDependency
            As `part` and `Page`.
        """
        return Page(self.part(tracts=tracts, surface_values=surface_values), **page_options).show()

    def summary(self) -> dict[str, Any]:
        """Everything worth knowing before streamlines are placed, ready for JSON.

        Lengths are in mm, areas in mm^2, angles in degrees; triangle and vertex indices are those of the source.
        """
        return summarize(self)


def _orientation_field(mesh: SurfaceMesh, data: SurfaceData) -> OrientationField | None:
    per_triangle = data.vector_location == "triangle"
    if data.vectors is not None:
        of_vectors = OrientationField.from_triangle_vectors if per_triangle else OrientationField.from_vertex_vectors
        return of_vectors(mesh, data.vectors)
    if data.tensors is not None:
        of_tensors = OrientationField.from_triangle_tensors if per_triangle else OrientationField.from_vertex_tensors
        return of_tensors(mesh, data.tensors)
    return None
