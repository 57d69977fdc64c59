"""The same field on the same surface as others draw it, with PyVista: arrows, strokes, line integral convolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree
from scipy.spatial import cKDTree
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

from pectinate.figure import Style
from pectinate.figure.frame import Frame

SURFACE, INK = Style().surface_color, Style().tube_color


@dataclass(frozen=True, eq=False)
class Fibres:
    """A surface with a unit vector, or zero, per triangle; mm."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    field: NDArray[np.float64]

    def to_pyvista(self) -> Any:
        """The surface, with normals per vertex for smooth shading."""
        return pyvista.PolyData.from_regular_faces(self.vertices, self.triangles)

    @property
    def centres(self) -> NDArray[np.float64]:
        """Middles of the triangles, (T, 3)."""
        return np.asarray(self.vertices[self.triangles].mean(axis=1))


def draw_glyphs(fibres: Fibres, frame: Frame, *, spacing: float, length: float, heads: bool) -> NDArray[np.uint8]:
    """Draw arrows or headless strokes on triangles that are evenly spread, at least `spacing` mm apart.

    `length` is that of each glyph, in mm; strokes are as thick as the tubes that our pictures have at this spacing.
    """
    some = _spread(fibres.centres, spacing)
    some = some[np.linalg.norm(fibres.field[some], axis=1) > 0]
    points = pyvista.PolyData(fibres.centres[some])
    points["direction"] = fibres.field[some]
    thickness = 0.18 / 0.8 * spacing / length
    if heads:
        shape = pyvista.Arrow(
            start=(-0.5, 0, 0), shaft_radius=0.6 * thickness, tip_radius=1.6 * thickness, tip_length=0.35
        )
    else:
        shape = pyvista.Cylinder(direction=(1, 0, 0), radius=thickness, height=1.0, resolution=8)
    glyphs = points.glyph(orient="direction", scale=False, factor=length, geom=shape)
    plotter = _plotter(frame)
    plotter.add_mesh(fibres.to_pyvista(), color=SURFACE, smooth_shading=True)
    plotter.add_mesh(glyphs, color=INK, smooth_shading=False)
    return _picture(plotter, frame)


def draw_line_integral_convolution(fibres: Fibres, frame: Frame, *, enhanced: bool) -> NDArray[np.uint8]:
    """Draw VTK's line integral convolution on the surface, in black and white.

    Either as it comes, or with all its means to enhance contrast, longer lines, and its range stretched to black and
    white afterwards. Vectors go to the vertices by the main axis of the tensor average, with senses
    that agree with their neighbours'.
    """
    surface = fibres.to_pyvista()
    surface["direction"] = _at_vertices(fibres)
    surface.active_vectors_name = "direction"
    mapper = vtkSurfaceLICMapper()
    mapper.SetInputDataObject(surface)
    mapper.SetInputArrayToProcess(0, 0, 0, 0, "direction")
    mapper.ScalarVisibilityOff()
    lic = mapper.GetLICInterface()
    if enhanced:
        lic.SetNumberOfSteps(40)
        lic.SetStepSize(0.5)
        lic.SetEnhanceContrast(lic.ENHANCE_CONTRAST_BOTH)
        lic.SetLICIntensity(1.0)
    plotter = _plotter(frame)
    actor = pyvista.Actor(mapper=None)
    actor.SetMapper(mapper)
    plotter.add_actor(actor)
    picture = _picture(plotter, frame)
    return _stretched(picture) if enhanced else picture


def _stretched(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """What is not paper, stretched from black to white."""
    drawn = picture[(picture < 255).any(axis=2)]
    dark, bright = np.percentile(drawn, [1, 99])
    stretched = np.clip((picture - dark) * (255 / (bright - dark)), 0, 255)
    return np.where(picture < 255, stretched, 255).astype(np.uint8)


def _plotter(frame: Frame) -> Any:
    plotter = pyvista.Plotter(off_screen=True, window_size=list(frame.size), lighting="light kit")
    plotter.set_background("white")
    return plotter


def look_along(plotter: Any, frame: Frame) -> None:
    """Let a plotter look where a frame does."""
    _, up, back = frame.view.rotation()
    camera = plotter.camera
    camera.focal_point = frame.centre
    camera.position = frame.centre + 500.0 * back
    camera.up = up
    camera.parallel_projection = True
    camera.parallel_scale = 0.5 * frame.size[1] * frame.mm_per_pixel
    plotter.reset_camera_clipping_range()


def _picture(plotter: Any, frame: Frame) -> NDArray[np.uint8]:
    look_along(plotter, frame)
    image = plotter.screenshot(return_img=True)
    plotter.close()
    return np.asarray(image)


def _spread(points: NDArray[np.float64], spacing: float) -> NDArray[np.int64]:
    """Indices of points, taken in random order, no two of them closer than a spacing."""
    tree = cKDTree(points)
    free = np.ones(len(points), dtype=bool)
    kept = []
    for index in np.random.default_rng(0).permutation(len(points)):
        if free[index]:
            kept.append(index)
            free[tree.query_ball_point(points[index], spacing)] = False
    return np.array(kept)


def _at_vertices(fibres: Fibres) -> NDArray[np.float64]:
    """Unit vectors per vertex: the main direction of the triangles around, as lines."""
    tensors = np.zeros((len(fibres.vertices), 3, 3))
    outer = np.einsum("ti,tj->tij", fibres.field, fibres.field)
    for corner in range(3):
        np.add.at(tensors, fibres.triangles[:, corner], outer)
    _, axes = np.linalg.eigh(tensors)
    return _combed(axes[:, :, 2], fibres.triangles)


def _combed(lines: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Choose senses so that neighbours agree wherever a tree of edges says so: opposite ones would cancel out."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).T
    # Along the edges where the field turns least first, so that disagreement ends up where it must turn.
    turns = 1.001 - np.abs((lines[ends[0]] * lines[ends[1]]).sum(axis=1))
    joined = csr_matrix((turns, ends), shape=(len(lines), len(lines)))
    tree = minimum_spanning_tree(joined.maximum(joined.T))
    combed = np.array(lines)
    done = np.zeros(len(lines), dtype=bool)
    while not done.all():
        order, parents = breadth_first_order(tree, np.argmin(done), directed=False)
        done[order] = True
        for vertex in order[1:]:
            if combed[vertex] @ combed[parents[vertex]] < 0:
                combed[vertex] *= -1
    return combed
