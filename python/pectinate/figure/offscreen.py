"""Drawing triangles of given colours into a picture and a depth map, with pyrender and no window."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import RenderingUnavailable
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


@dataclass(frozen=True)
class Stage:
    """Patches that are ready to be drawn again and again; made by `Canvas.load`."""

    scene: Any
    nearest: float
    near_plane: float
    slack: float


class Canvas:
    """Draws patches with an orthographic camera; made by `open_canvas`."""

    def __init__(self, pyrender: Any, largest_size: int) -> None:
        self._pyrender = pyrender
        self._renderer = pyrender.Renderer(1, 1)
        self._renderer._read_main_framebuffer = self._read
        self.largest_size = largest_size

    def load(self, patches: Sequence[Patch]) -> Stage:
        """Prepare patches, at least one; nearer ones will hide farther ones."""
        vertices = [patch.vertices for patch in patches]
        nearest, farthest = max(v[:, 2].max() for v in vertices), min(v[:, 2].min() for v in vertices)
        depth = float(nearest - farthest)
        # Room for rounding at both ends; a flat patch gets some of its width.
        slack = 0.01 * (depth or max(float(np.ptp(v, axis=0).max()) for v in vertices) or 1.0)
        scene = self._pyrender.Scene(bg_color=np.zeros(4))
        scene.add(self._pyrender.Mesh([self._primitive(patch) for patch in patches]))
        return Stage(scene, float(nearest), depth + 2 * slack, slack)

    def draw(
        self, stage: Stage, size: tuple[int, int], mm_per_pixel: float, middle: tuple[float, float] = (0.0, 0.0)
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """Draw patches on nothing.

        Parameters
        ----------
        stage : Stage
            What to draw.
        size : tuple of 2 int
            Width and height in pixels, at most `largest_size`.
        mm_per_pixel : float
            Scale; pixels are square.
        middle : tuple of 2 float
            What lies in the middle of the picture: x and y in mm.

        Returns
        -------
        color : (height, width, 4) uint8
            RGB premultiplied by A, the share of the pixel that is covered.
        depth : (height, width) float32
            Distance in mm behind the nearest vertex, in `depth_place` of each pixel; infinite where nothing is drawn.
        """
        near = stage.near_plane
        camera = self._pyrender.OrthographicCamera(1.0, 0.5 * size[1] * mm_per_pixel, znear=near, zfar=2 * near)
        pose = np.eye(4)
        pose[:3, 3] = *middle, stage.nearest + stage.slack + near
        node = stage.scene.add(camera, pose=pose)
        self._renderer.viewport_width, self._renderer.viewport_height = size
        flags = self._pyrender.RenderFlags
        flat = flags.FLAT | flags.RGBA | flags.OFFSCREEN | flags.SKIP_CULL_FACES
        color, depth = self._renderer.render(stage.scene, flat)
        stage.scene.remove_node(node)
        background = depth == 1
        depth *= np.float32(near)
        depth -= np.float32(stage.slack)
        depth[background] = np.inf
        return color, depth

    def depth_place(self) -> NDArray[np.float64]:
        """Where in each pixel depths are taken: right and down from its upper left corner, (2,) from 0 to 1.

        That is one of the pixel's samples, the first.
        """
        from OpenGL import GL  # noqa: PLC0415  (bound to the platform of the context)

        self._renderer._configure_main_framebuffer()
        place = np.zeros(2, dtype=np.float32)
        GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, self._renderer._main_fb_ms)
        GL.glGetMultisamplefv(GL.GL_SAMPLE_POSITION, 0, place)
        return np.array([place[0], 1 - place[1]], dtype=np.float64)

    def _read(self, _scene: Any, _flags: Any) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """RGBA and the depth buffer, 0 to 1, of what the renderer has drawn.

        Stands in for pyrender's own, which takes every camera for a perspective one: making depths of that and undoing
        it takes an eighth of the time of a picture.
        """
        from OpenGL import GL  # noqa: PLC0415  (bound to the platform of the context)

        renderer = self._renderer
        width, height = renderer._main_fb_dims
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, renderer._main_fb_ms)
        GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, renderer._main_fb)
        whole = (0, 0, width, height)
        for buffer in (GL.GL_COLOR_BUFFER_BIT, GL.GL_DEPTH_BUFFER_BIT):
            GL.glBlitFramebuffer(*whole, *whole, buffer, GL.GL_NEAREST)
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, renderer._main_fb)
        depth, color = np.empty((height, width), dtype=np.float32), np.empty((height, width, 4), dtype=np.uint8)
        GL.glReadPixels(*whole, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT, depth)
        GL.glReadPixels(*whole, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, color)
        return color[::-1], depth[::-1]

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
