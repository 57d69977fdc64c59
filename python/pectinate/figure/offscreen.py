"""Drawing triangles of given colours into a picture and a depth map, with pyrender and no window."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidOption, RenderingUnavailable
from pectinate.figure.context import offscreen_context


@dataclass(frozen=True)
class Patch:
    """Triangles ready to be drawn, in picture coordinates: x right, y up, z towards the viewer, in mm.

    Parameters
    ----------
    vertices : (V, 3) float
        Positions relative to the middle of the picture.
    triangles : (T, 3) int
        Vertices of each triangle, at least one.
    colors : (V, 3) float
        Display RGB of each vertex, 0 to 1.
    """

    vertices: NDArray[np.floating[Any]]
    triangles: NDArray[np.integer[Any]]
    colors: NDArray[np.floating[Any]]


class Canvas:
    """Draws patches with an orthographic camera; made by `open_canvas`."""

    def __init__(self, pyrender: Any, largest_size: int) -> None:
        self._pyrender = pyrender
        self._renderer = pyrender.Renderer(1, 1)
        self._largest_size = largest_size

    def draw(
        self, patches: Sequence[Patch], size: tuple[int, int], mm_per_pixel: float
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """Draw patches on nothing.

        Parameters
        ----------
        patches : sequence of Patch
            What to draw; nearer hides farther.
        size : tuple of 2 int
            Width and height in pixels.
        mm_per_pixel : float
            Scale; pixels are square.

        Returns
        -------
        color : (height, width, 4) uint8
            RGB premultiplied by A, the share of the pixel that is covered.
        depth : (height, width) float32
            Distance in mm behind the nearest vertex; infinite where nothing is drawn.

        Raises
        ------
        InvalidOption
            If the picture is larger than OpenGL can draw.
        """
        width, height = size
        if max(size) > self._largest_size:
            raise InvalidOption(
                f"a picture of {width} x {height} pixels (with supersampling) is more than the {self._largest_size} "
                "that OpenGL can draw here: choose a smaller size or less supersampling"
            )
        heights = [patch.vertices[:, 2] for patch in patches]
        nearest, farthest = max(z.max() for z in heights), min(z.min() for z in heights)
        # Room for rounding at both ends; a flat patch gets a box of the picture's size.
        slack = 0.01 * (float(nearest - farthest) or mm_per_pixel * max(size))
        near = float(nearest - farthest) + 2 * slack
        camera = self._pyrender.OrthographicCamera(1.0, 0.5 * height * mm_per_pixel, znear=near, zfar=2 * near)
        pose = np.eye(4)
        pose[2, 3] = nearest + slack + near
        color, depth = self._render(patches, camera, pose, size)
        return color, _undo_perspective(depth, near) - np.float32(slack)

    def _render(
        self, patches: Sequence[Patch], camera: Any, pose: NDArray[np.float64], size: tuple[int, int]
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        scene = self._pyrender.Scene(bg_color=np.zeros(4))
        scene.add(self._pyrender.Mesh([self._primitive(patch) for patch in patches]))
        scene.add(camera, pose=pose)
        self._renderer.viewport_width, self._renderer.viewport_height = size
        flags = self._pyrender.RenderFlags
        color, depth = self._renderer.render(scene, flags.FLAT | flags.RGBA | flags.OFFSCREEN | flags.SKIP_CULL_FACES)
        return color, depth

    def _primitive(self, patch: Patch) -> Any:
        opaque = np.ones((len(patch.vertices), 4), dtype=np.float32)
        opaque[:, :3] = patch.colors
        return self._pyrender.Primitive(
            positions=patch.vertices.astype(np.float32),
            indices=patch.triangles,
            color_0=opaque,
            mode=self._pyrender.GLTF.TRIANGLES,
        )

    def close(self) -> None:
        """Free what the canvas holds in OpenGL."""
        self._renderer.delete()


@contextlib.contextmanager
def open_canvas() -> Iterator[Canvas]:
    """A canvas for any number of pictures, with an OpenGL context of its own.

    Raises
    ------
    RenderingUnavailable
        If there is no offscreen OpenGL, or pyrender cannot be imported.
    """
    with offscreen_context():
        try:
            import pyrender  # noqa: PLC0415  (binds PyOpenGL to the platform that the context has just chosen)
            from OpenGL import GL  # noqa: PLC0415
        except ImportError as error:
            raise RenderingUnavailable(f"pyrender cannot be imported ({error}): pip install pyrender") from error
        canvas = Canvas(pyrender, int(GL.glGetIntegerv(GL.GL_MAX_RENDERBUFFER_SIZE)))
        try:
            yield canvas
        finally:
            canvas.close()


def _undo_perspective(depth: NDArray[np.float32], near: float) -> NDArray[np.float32]:
    """Distances from the near plane, from what pyrender makes of an orthographic depth buffer (near to 2 near).

    pyrender takes every camera for a perspective one; it marks the background by 0.
    """
    with np.errstate(divide="ignore"):
        distance = np.float32(2 * near) * (1 - np.float32(near) / depth)
    return np.where(depth == 0, np.float32(np.inf), distance)
