"""Measure how long a picture takes beside PyVista's of the same scene: `python benchmarks/rendering.py`."""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyvista
from numpy.typing import NDArray
from PIL import Image

import pectinate
from pectinate.figure import Style, View, render_view
from pectinate.figure.frame import Frame, extent, fitting_scale, middle
from rival_pictures import look_along
from surfaces import SurfaceMissing, find_file
from tables import align

SIZE = (1600, 1200)
STREAMLINES = 1500
VIEW = View("posterior", (0, -1, 0), (0, 0, 1))
Triangles = tuple[NDArray[np.float64], NDArray[np.int32]]
Times = tuple[float, float]  # CPU of all threads, wall; s
Draw = Callable[[], tuple[NDArray[np.uint8], Times]]


def main(argv: Sequence[str] | None = None) -> int:
    """Print the table; 0 if the surface was there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5, help="runs of each, in turn (5)")
    parser.add_argument("--out", type=Path, help="folder for the pictures")
    arguments = parser.parse_args(argv)
    try:
        placement = placement_of(pectinate.load(find_file("human_atrium_1/la_epi.pts")))
    except SurfaceMissing as reason:
        print(reason, file=sys.stderr)
        return 1
    tubes = placement.tubes()
    scene = (placement.mesh.vertices, placement.mesh.triangles), (tubes.vertices, tubes.triangles)
    counts = f"{len(placement)} tubes ({len(tubes.triangles):,} triangles)"
    print(f"{counts} on {placement.mesh.triangle_count:,} triangles, {SIZE[0]} x {SIZE[1]} pixels\n")
    print(table(scene, arguments.repeats, arguments.out))
    return 0


def placement_of(model: pectinate.Model) -> pectinate.Placement:
    """Default placement, at the separation that gives about `STREAMLINES` streamlines."""
    candidates = [pectinate.place_streamlines(model, separation_distance=d) for d in (0.65, 0.7, 0.75, 0.8)]
    return min(candidates, key=lambda placement: abs(len(placement) - STREAMLINES))


def table(scene: tuple[Triangles, Triangles], repeats: int, folder: Path | None) -> str:
    """Medians of runs in turn, and ratios."""
    draws: dict[str, Draw] = {
        "ours, supersampling 2 (default)": lambda: ours(scene, 2),
        "ours, supersampling 1": lambda: ours(scene, 1),
        "PyVista, as it comes": lambda: theirs(scene, None),
        "PyVista, 8 samples": lambda: theirs(scene, "msaa"),
        "PyVista, supersampled": lambda: theirs(scene, "ssaa"),
    }
    times: dict[str, list[Times]] = {name: [] for name in draws}
    for repeat in range(-1, repeats):  # the first round, which loads libraries, does not count
        for name, draw in draws.items():
            picture, taken = draw()
            if repeat >= 0:
                times[name].append(taken)
            elif folder is not None:
                folder.mkdir(parents=True, exist_ok=True)
                Image.fromarray(picture).save(folder / f"{name.replace(' ', '_').replace(',', '')}.png")
    medians = {name: [statistics.median(column) for column in zip(*some, strict=True)] for name, some in times.items()}
    default, plain = list(draws)[:2]
    lines = []
    for name, numbers in medians.items():
        ratios = [f"{numbers[k] / medians[own][k]:.2f}x" for own in (default, plain) for k in (0, 1)]
        lines.append([name, *[f"{number:.2f}" for number in numbers], *ratios])
    titles = [
        "picture",
        "CPU s",
        "wall s",
        "CPU / ours at 2",
        "wall / ours at 2",
        "CPU / ours at 1",
        "wall / ours at 1",
    ]
    return align(titles, lines, left=1)


def ours(scene: tuple[Triangles, Triangles], supersampling: int) -> tuple[NDArray[np.uint8], Times]:
    """Draw with `render_view`."""
    with Stopwatch() as watch:
        picture = render_view(*scene, view=VIEW, size=SIZE, supersampling=supersampling)
    return picture, watch.times


def theirs(scene: tuple[Triangles, Triangles], smoothing: str | None) -> tuple[NDArray[np.uint8], Times]:
    """Draw with PyVista: the same triangles, colours, view and size, smooth shading."""
    points = np.concatenate([vertices for vertices, _ in scene])
    scale = fitting_scale(extent(points, VIEW), SIZE)
    frame = Frame(VIEW, middle(points, VIEW), SIZE, scale)
    with Stopwatch() as watch:
        plotter = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
        plotter.set_background("white")
        for (vertices, triangles), color in zip(scene, (Style().surface_color, Style().tube_color), strict=True):
            mesh = pyvista.PolyData.from_regular_faces(vertices, triangles)
            plotter.add_mesh(mesh, color=color, smooth_shading=True)
        if smoothing is not None:
            plotter.enable_anti_aliasing(smoothing)
        look_along(plotter, frame)
        picture: Any = plotter.screenshot(return_img=True)
        plotter.close()
    return np.asarray(picture), watch.times


class Stopwatch:
    """Takes CPU and wall time of a block."""

    def __enter__(self) -> Stopwatch:
        """Start."""
        self._start = time.process_time(), time.perf_counter()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop."""
        self.times: Times = time.process_time() - self._start[0], time.perf_counter() - self._start[1]


if __name__ == "__main__":
    sys.exit(main())
