"""Evenly spaced streamlines: placing them, and what can be done with them."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from pectinate import _core
from pectinate.choices import member
from pectinate.errors import InvalidOption
from pectinate.figure.files import check_picture_path, save_picture
from pectinate.figure.parts import Part, Values, named_values
from pectinate.figure.plots import draw_lengths
from pectinate.figure.polylines import Lines, TubeMesh, values_at
from pectinate.figure.shading import Style
from pectinate.figure.shape import Layer
from pectinate.figure.sheet import draw_sheet
from pectinate.figure.values import SurfaceValues
from pectinate.io import lines, load, streamlines
from pectinate.io.gltf import make_scene
from pectinate.model import Model
from pectinate.statistics import PlacementStatistics
from pectinate.viewer import Page

_OPTION_NAMES = (
    "separation_distance",
    "method",
    "occupancy",
    "seed_count",
    "seed_distance_factor",
    "seed_clearance",
    "test_distance",
    "minimum_length",
    "close_loops",
    "singularity_radius",
    "polishing_rounds",
    "polishing_time",
    "abrupt_turn_angle",
    "max_steps",
    "random_seed",
    "thread_count",
)
_PAGE_OPTIONS = inspect.signature(Page).parameters.keys() - {"parts"}
_ENUMERATIONS: dict[str, type[Enum]] = {"method": _core.PlacementMethod, "occupancy": _core.OccupancyModel}


def _plain_options(options: _core.PlacementOptions) -> dict[str, Any]:
    values = {name: getattr(options, name) for name in _OPTION_NAMES}
    return values | {name: values[name].name for name in _ENUMERATIONS}


#: The options of `place_streamlines` and their defaults, as the engine has them.
DEFAULTS: dict[str, Any] = _plain_options(_core.PlacementOptions())

#: Height over width of tubes in pictures: nearly as flat as ink, they hide less of each other towards outlines.
DRAWN_TUBE_HEIGHT = 0.3


def place_streamlines(
    surface: Any, *, progress: Callable[[float], bool | None] | None = None, **options: Any
) -> Placement:
    """Fill a surface with evenly spaced streamlines of its orientation field (paper sections 2.4 to 2.7).

    Streamlines are placed one by one until nothing is free. With exact occupancy whole streamlines are at least the
    separation distance apart, and no point is much farther than that from one. The same arguments give the same bytes,
    whatever `thread_count`, unless `polishing_time` ends the polishing.

    Parameters
    ----------
    surface
        A `Model`, or anything that `pectinate.load` takes.
    progress
        Called now and then with the coverage in [0, 1]; returning False ends the placement with what is there.
    separation_distance : float or array
        d_sep, mm: streamlines come no closer. An array, (T,) or (V,) per triangle or vertex of the source, asks for
        that distance from streamlines that lie there.
    method : str
        "longest": always the longest streamline that still fits, of a dense pool. The paper's methods keep the longest
        of `seed_count` candidates, which start at random: "random" anywhere free, "neighborhood" just beside placed
        streamlines, "distance" at `seed_distance_factor` d_sep from them.
    occupancy : str
        "exact", or "edge_mask", the paper's: exact where streamlines cross edges only. Not for method "longest".
    seed_count : int
        Candidates a step of the paper's methods, at least 1.
    seed_distance_factor : float
        c_seed of method "distance", at least 1.
    seed_clearance : float
        In [1, 2]: a streamline is placed only where some point of it is this many d_sep from the others. Above 1 (1.155
        is good) they are fewer and longer, still d_sep apart, and leave small gaps. Those of method "longest" that are
        at least 9 d_sep long need it not, unless `test_distance` is below 1.
    test_distance : float
        In (0, 1]: streamlines run on until they are this many d_sep from others. Below 1 they are longer, but only
        this far apart.
    minimum_length : float
        mm; shorter streamlines are not placed.
    close_loops : bool
        Closed curves of the field become closed streamlines, placed before others that wind onto them, if they are at
        least 4 d_sep long: the last point repeats the first one, and both stop reasons are `closed`. Else they end
        near themselves. Method "longest" only.
    singularity_radius : float
        mm: streamlines stop this near to singularities, the vertices about which the field turns (as
        `InterpolatedField.topology` lists them); 0 lets them come as near as they do. What is that near counts as
        covered. Exact occupancy only.
    polishing_rounds : int
        Rounds of polishing after the placement, 0 for none: each takes out a few streamlines that lie together and
        fills their place with others. In the end the mean length is greater, total length and coverage are no less
        (as they are before ends run on into the midst of triangles), and everything else is as promised. Which places
        are tried depends on `random_seed`. Method "longest" only.
    polishing_time : float
        Seconds of wall time after which polishing ends; 0 is no limit. Without `polishing_rounds` there are as many
        rounds as there is time for; `statistics.polishing_rounds` tells how many that were, and so many without a limit
        give the same bytes.
    abrupt_turn_angle : float
        Radians in (0, pi]: a streamline ends where the field turns by more from one triangle to the next; pi disables
        this.
    max_steps : int
        Triangles that a streamline crosses each way at most.
    random_seed : int
        In [0, 2^64).
    thread_count : int
        At least 1. Methods with random seeds use more than one, at steps with enough to trace.

    Returns
    -------
    Placement

    Raises
    ------
    InvalidOption
        An option out of its range.
    InvalidField
        The surface has no orientation field.
    TypeError
        An unknown option.
    """
    model = load(surface)
    field = model.require_field()
    for name in _ENUMERATIONS.keys() & options.keys():
        options[name] = member(_ENUMERATIONS[name], name, options[name])
    if np.ndim(options.get("separation_distance", 0.0)) > 0:
        options["separation_distances"] = _per_mesh_triangle(model, options.pop("separation_distance"))
    return Placement(model, _core.place_streamlines(model.mesh, field, progress=progress, **options))


def _per_mesh_triangle(model: Model, values: ArrayLike) -> NDArray[np.float64]:
    """Take values per triangle or vertex of the source to the triangles of the mesh; vertex values are averaged."""
    array = np.asarray(values, float)
    triangles, vertices = model.mesh.input_triangle_count, model.mesh.input_vertex_count
    if array.shape == (triangles,):
        return np.asarray(array[model.mesh.input_triangle])
    if array.shape == (vertices,):
        return np.asarray(array[model.mesh.input_vertex][model.mesh.triangles].mean(axis=1))
    raise InvalidOption(
        f"separation_distance has the shape {array.shape}, but must be one number, or one per triangle ({triangles},) "
        f"or vertex ({vertices},) of the source"
    )


class Placement:
    """Streamlines on a surface, in the order in which they were placed.

    All arrays are read-only. Triangle indices are those of `mesh`; `mesh.input_triangle` leads back to the input's.

    Attributes
    ----------
    model, mesh, field
        What the streamlines lie on.
    points
        (N, 3) float64, mm: all streamlines, one after the other. Each lies on an edge, but for ends of method
        "longest" that stop near others or themselves: those are where the others, or a part of their own, are d_sep
        away, in the midst of triangles (on edges where that is less than 1e-3 d_sep farther on, where the rest of the
        triangle is longer than 64 d_sep, and of those near themselves where they come back to the same triangle, or
        where the part that they stopped for is none of the streamline any more).
    offsets
        (n + 1,) int64: streamline i owns points[offsets[i]:offsets[i + 1]].
    segment_triangles
        (N - n,) int32: the triangle that each segment crosses.
    point_triangles, barycentric
        (N,) int32 and (N, 3) float64: a triangle that each point lies on, and the weights of its corners, sum 1.
    lengths
        (n,) float64, mm.
    stop_reasons
        (n, 2) uint8: why it ends at its first and at its last point, by `StopReason` value.
    seed_points
        (n,) int64: the index in `points` of each streamline's seed.
    statistics
        `PlacementStatistics`.
    options
        The options as used, defaults included.
    end
        "complete" or "cancelled".
    """

    def __init__(self, model: Model, core: _core.Placement) -> None:
        self._core = core
        self.model = model
        self.mesh = model.mesh
        self.points: NDArray[np.float64] = core.points
        self.offsets: NDArray[np.int64] = core.offsets
        self.segment_triangles: NDArray[np.int32] = core.segment_triangles
        self.point_triangles: NDArray[np.int32] = core.point_triangles
        self.barycentric: NDArray[np.float64] = core.barycentric
        self.lengths: NDArray[np.float64] = core.lengths
        self.stop_reasons: NDArray[np.uint8] = core.stop_reasons
        self.seed_points: NDArray[np.int64] = core.seed_points
        self.statistics = PlacementStatistics.from_core(core.statistics)
        self.options = _plain_options(core.options)
        self.end: str = core.end.name

    @property
    def field(self) -> _core.OrientationField:
        """The orientation field that the streamlines follow."""
        return self.model.require_field()

    def __len__(self) -> int:
        """Count the streamlines."""
        return len(self.lengths)

    def __iter__(self) -> Iterator[NDArray[np.float64]]:
        """Iterate over the streamlines' points, (k, 3) each."""
        return iter(np.split(self.points, self.offsets[1:-1]) if len(self) else [])

    def __repr__(self) -> str:
        """Say how many and how long."""
        mean = self.statistics.mean_length
        return f"<Placement of {len(self)} streamlines, mean length {mean:.2f} mm, {self.end}>"

    def tubes(
        self,
        *,
        radius: float | None = None,
        taper_length: float | None = None,
        side_count: int | None = None,
        height: float | None = None,
    ) -> _core.Tubes:
        """Make watertight tapered tubes (paper section 2.8 and equation 3).

        Parameters
        ----------
        radius
            rho_0, mm. By default `default_tube_radius()`.
        taper_length
            lambda, mm: over which the ends grow thin; 0 gives blunt ends.
        side_count
            3 to 12.
        height
            Of the tubes over their width, above 0 and at most 1: below 1 they lie flat on the surface. By default 1,
            round; pictures have `DRAWN_TUBE_HEIGHT`.

        Raises
        ------
        InvalidOption
            An option out of its range.
        """
        given: dict[str, Any] = {
            "radius": self.default_tube_radius() if radius is None else radius,
            "taper_length": taper_length,
            "side_count": side_count,
            "height": height,
        }
        return _core.make_tubes(self.mesh, self._core, **{k: v for k, v in given.items() if v is not None})

    def default_tube_radius(self) -> float:
        """Return the tube radius, mm, in the paper's proportion: 0.18 mm for a separation distance of 0.8 mm."""
        radius: float = 0.18 / 0.8 * self.options["separation_distance"]
        return radius

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Write the streamlines, in the format that the suffix names.

        Parameters
        ----------
        path
            `.npz`: all arrays with the surface and the field, see `pectinate.io.streamlines`. `.vtp`: poly-lines with
            their data as of `to_pyvista`, for ParaView (extra `vtk`). `.ply`, `.obj`: tubes. `.glb`: surface and tubes
            with materials, in metres with +y up as glTF demands, see `pectinate.io.gltf`. `.html`: an interactive page.
        options
            Of `tubes` for files of tubes, of `page` for pages, `values` of `to_pyvista` for `.vtp`.

        Raises
        ------
        InvalidOption
            An unknown suffix, or an option out of its range.
        InvalidFile
            The file cannot be written.
        MissingDependency
            `.vtp` without PyVista.
        """
        streamlines.save(self, Path(path), **options)

    def to_trimesh(self, **tube_options: Any) -> trimesh.Scene:
        """Make a `trimesh.Scene`, in mm, with the nodes `surface` and `streamlines` (tubes; none without streamlines).

        Parameters
        ----------
        tube_options
            Of `tubes`.

        Raises
        ------
        InvalidOption
            An option out of its range.
        """
        return make_scene(self.mesh, self.tubes(**tube_options))

    def to_pyvista(self, values: Mapping[str, ArrayLike] | None = None) -> Any:
        """Make a PyVista data set of poly-lines; the surface is that of `model.to_pyvista()`.

        Cells have `line`, `length` (mm), `point_count`, `stop_reason_first` and `stop_reason_last` (by value, with the
        names in the field data), `triangle_first`, `triangle_last` and `triangle_seed`; points have `line`,
        `arc_length` (mm), `triangle`, `input_triangle` and `barycentric`.

        Parameters
        ----------
        values
            More arrays of points by name: numbers per triangle or vertex of `mesh`, vertex values interpolated.

        Raises
        ------
        MissingDependency
            PyVista is not installed.
        InvalidOption
            There is not one number per triangle or vertex.
        """
        return lines.to_polylines(self, values)

    def to_pandas(self, values: Mapping[str, ArrayLike] | None = None) -> Any:
        """Make a pandas table, a row per streamline, with the cell arrays of `to_pyvista`; stop reasons by name.

        Parameters
        ----------
        values
            More columns by name: means along the lines, by length, of numbers per triangle or vertex of `mesh`.

        Raises
        ------
        MissingDependency
            pandas is not installed.
        InvalidOption
            There is not one number per triangle or vertex.
        """
        return lines.to_table(self, values)

    def plot_lengths(self, path: str | os.PathLike[str] | None = None, **options: Any) -> Image.Image:
        """Draw the histogram of lengths (the paper's Fig. 7), with `pectinate.figure.draw_lengths` and its options."""
        return draw_lengths([self.lengths], path, **options)

    def part(  # noqa: PLR0913
        self,
        name: str = "",
        *,
        tube_radius: float | None = None,
        taper_length: float | None = None,
        side_count: int | None = None,
        tube_height: float = DRAWN_TUBE_HEIGHT,
        tube_values: Values | None = None,
        **options: Any,
    ) -> Part:
        """Make a part of a page or of a sheet of pictures, which may have several.

        See `pectinate.viewer.Page` and `pectinate.figure_sheet`.

        Parameters
        ----------
        name
            Of the part.
        tube_radius, taper_length, side_count, tube_height
            As `radius`, `taper_length`, `side_count` and `height` of `tubes`; a page has a slider for the radius.
        tube_values
            Numbers that colour the tubes, as in `figure`; several by name.
        options
            Of `Model.part`: `tracts`, `surface_values`, `offset`, ...

        Raises
        ------
        InvalidOption
            An option is out of its range.
        """

        def make_tubes() -> TubeMesh:
            return self.tubes(radius=tube_radius, taper_length=taper_length, side_count=side_count, height=tube_height)

        drawn = Lines(
            self.points,
            self.offsets,
            self.default_tube_radius() if tube_radius is None else tube_radius,
            _core.default_taper_length if taper_length is None else taper_length,
            make_tubes,
            {name: self._at_points(values) for name, values in named_values(tube_values).items()},
            tube_height,
            self.mesh.triangle_normals[self.point_triangles],
        )
        return replace(self.model.part(name, **options), streamlines=drawn)

    def page(self, **options: Any) -> Page:
        """Make an interactive page: one HTML file that needs neither a server nor the network.

        Parameters
        ----------
        options
            Of `part` (`tube_radius`, `tracts`, `surface_values`, ...) and of `pectinate.viewer.Page` (`title`,
            `markers`, `views`, ...).

        Raises
        ------
        InvalidOption, MissingDependency
            As `part` and `Page`.
        """
        of_page = {key: options.pop(key) for key in _PAGE_OPTIONS & options.keys()}
        statistics = self.statistics
        notes = [
            f"{statistics.streamline_count:,} streamlines, {self.options['separation_distance']:g} mm apart, mean "
            f"length {statistics.mean_length:.1f} mm"
        ]
        return Page(self.part(**options), **{"notes": notes, **of_page})

    def show(self, **options: Any) -> Page:
        """Show the surface with the streamlines in the browser, to be turned and zoomed; in Jupyter, in the notebook.

        Parameters
        ----------
        options
            As of `page`.

        Raises
        ------
        InvalidOption, MissingDependency
            As `page`.
        """
        return self.page(**options).show()

    def figure(  # noqa: PLR0913
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        tube_radius: float | None = None,
        taper_length: float | None = None,
        side_count: int | None = None,
        tube_height: float = DRAWN_TUBE_HEIGHT,
        tube_values: SurfaceValues | ArrayLike | None = None,
        **sheet_options: Any,
    ) -> Image.Image:
        """Draw the surface with the streamlines as tubes, in one or several views.

        Parameters
        ----------
        path
            Where to write the picture; by default nowhere.
        tube_radius, taper_length, side_count, tube_height
            As `radius`, `taper_length`, `side_count` and `height` of `tubes`.
        tube_values
            Numbers that colour the tubes, per triangle or vertex of `mesh`, or per point of the streamlines: those at
            the points, interpolated between vertices and along the tubes.
        sheet_options
            Of `pectinate.figure.draw_sheet`: `views`, `size`, `surface_values` (per triangle or vertex of `mesh`), ...

        Raises
        ------
        InvalidOption
            The suffix of the path is none of a picture, or an option is out of its range.
        InvalidFile
            The picture cannot be written.
        RenderingUnavailable
            There is no OpenGL; the message names the packages that bring it.
        MissingDependency
            There are values to show, but Matplotlib is not installed.
        """
        check_picture_path(path)
        tubes = self.tubes(radius=tube_radius, taper_length=taper_length, side_count=side_count, height=tube_height)
        surface, drawn = (self.mesh.vertices, self.mesh.triangles), (tubes.vertices, tubes.triangles)
        if tube_values is None:
            return save_picture(draw_sheet(surface, drawn, **sheet_options), path)
        numbers = values_at(self._at_points(tube_values), tubes.vertex_points)
        layer = Layer(drawn, sheet_options.get("style", Style()).tube_color, numbers)
        sheet_options["layers"] = [layer, *sheet_options.get("layers", ())]
        return save_picture(draw_sheet(surface, **sheet_options), path)

    def _at_points(self, given: SurfaceValues | ArrayLike) -> SurfaceValues:
        """Values of the mesh, or per point, as values per point."""
        values = SurfaceValues.of(given)
        if values.contours is not None:
            raise InvalidOption("tube_values have contours; only those of surfaces can have them")
        numbers = lines.values_at_points(self, "tube_values", values.values)
        if values.categories is not None and np.shape(values.values) == (len(self.mesh.vertices),):
            raise InvalidOption("categories need one number per triangle or point: vertices would mix them")
        return replace(values, values=numbers)
