"""Measure how well pictures of an orientation field can be read: ours, arrows, strokes, line integral convolution.

`python benchmarks/legibility.py` prints all tables as Markdown; `--part` chooses. See `README.md` for what they mean.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import pectinate
from pectinate.figure import Style, View, render_view
from pectinate.figure.frame import Frame, extent, fitting_scale, middle
from pectinate.placement import DRAWN_TUBE_HEIGHT
from picture_orientation import LEAST_COHERENCE, Scales, luminance, read_orientation
from projected_field import ProjectedField, project_field
from rival_pictures import Fibres, draw_glyphs, draw_line_integral_convolution
from surfaces import SurfaceMissing, find_file
from tables import align

SIZE = (1000, 840)
SEPARATION = 1.6  # mm
CLOSE = 15.0  # degrees
FACING = 0.5  # cosine: turned away from the viewer by less than 60 degrees
# Standard deviations in d_sep: a kernel is one d_sep across, a window two, two deviations to each side of the middle.
INNER, WINDOW = 0.25, 0.5
GRAIN = 0.1  # standard deviation of noise in the luminance of each pixel, which is 0 to 1
VIEWS = (View("posterior", (0, -1, 0), (0, 0, 1)), View("anterior", (0, 1, 0), (0, 0, 1)))
SURFACES = ("demo", "la_epi", "la_epi smoothed")
Line = list[str]


@dataclass(frozen=True, eq=False)
class Scene:
    """A model seen from one side."""

    model: pectinate.Model
    frame: Frame
    truth: ProjectedField

    @classmethod
    def of(cls, model: pectinate.Model, view: View, size: tuple[int, int] = SIZE) -> Scene:
        """Fit the surface into a picture."""
        vertices = model.mesh.vertices
        scale = fitting_scale(extent(vertices, view), size)
        frame = Frame(view, middle(vertices, view), size, scale)
        return cls(model, frame, project_field(vertices, model.mesh.triangles, model.require_field().directions, frame))

    @property
    def fibres(self) -> Fibres:
        """The model as plain arrays."""
        mesh = self.model.mesh
        return Fibres(mesh.vertices, mesh.triangles.astype(np.int64), self.model.require_field().directions)


@dataclass(frozen=True, eq=False)
class Reading:
    """How far what is read is from the truth, degrees, for each pixel of the visible surface, and what faces us."""

    errors: NDArray[np.float64]
    facing: NDArray[np.bool_]

    @classmethod
    def joined(cls, readings: Sequence[Reading]) -> Reading:
        """All pixels of some pictures."""
        return cls(np.concatenate([r.errors for r in readings]), np.concatenate([r.facing for r in readings]))

    @property
    def share(self) -> float:
        """Share of the visible surface within `CLOSE` of the truth."""
        return float((self.errors < CLOSE).mean())

    def cells(self) -> Line:
        """Median, share; the same of what faces the viewer."""
        return [
            _median(self.errors),
            _percent(self.errors),
            _median(self.errors[self.facing]),
            _percent(self.errors[self.facing]),
        ]


TITLES_OF_READING = ["median", "within 15", "facing: median", "within 15"]
Draw = Callable[[Scene], NDArray[np.uint8]]


def read_picture(picture: NDArray[np.uint8], truth: ProjectedField, scales: Scales, grain: float = 0.0) -> Reading:
    """Compare a picture with the truth; where it shows no orientation the error is 90 degrees."""
    brightness = luminance(picture)
    if grain:
        brightness = brightness + np.random.default_rng(0).normal(0, grain, brightness.shape)
    read = read_orientation(brightness, scales, truth.shown)
    turned = np.degrees(read.angles - truth.angles) % 180
    errors = np.minimum(turned, 180 - turned)
    # A triangle without direction has no truth to be read, and takes no part.
    counted = truth.shown & np.isfinite(truth.angles)
    errors = np.where(read.coherence < LEAST_COHERENCE, 90.0, errors)
    return Reading(errors[counted], truth.facing[counted] > FACING)


def read_all(
    draw: Draw, scenes: Iterable[Scene], inner: float = INNER, window: float = WINDOW, grain: float = 0.0
) -> Reading:
    """Draw and read all scenes, with scales in d_sep of `SEPARATION`."""
    readings = []
    for scene in scenes:
        unit = SEPARATION / scene.frame.mm_per_pixel
        readings.append(read_picture(draw(scene), scene.truth, Scales(inner * unit, window * unit), grain))
    return Reading.joined(readings)


@cache
def placement(model: pectinate.Model, separation: float) -> pectinate.Placement:
    """The default placement."""
    return pectinate.place_streamlines(model, separation_distance=separation)


def zebra(
    radius: float | None = None,
    taper: float | None = None,
    height: float = DRAWN_TUBE_HEIGHT,
    style: Style = Style(),  # noqa: B008  (immutable)
    separation: float = SEPARATION,
) -> Draw:
    """Our picture; radius and taper length in d_sep, by default those of `Placement.figure`."""

    def draw(scene: Scene) -> NDArray[np.uint8]:
        tubes = placement(scene.model, separation).tubes(
            radius=None if radius is None else radius * separation,
            taper_length=None if taper is None else taper * separation,
            height=height,
        )
        mesh, frame = scene.model.mesh, scene.frame
        return render_view(
            (mesh.vertices, mesh.triangles),
            (tubes.vertices, tubes.triangles),
            view=frame.view,
            size=frame.size,
            mm_per_pixel=frame.mm_per_pixel,
            style=style,
        )

    return draw


def glyphs(*, heads: bool, spacing: float, length: float) -> Draw:
    """Arrows or strokes, spacing and length in d_sep."""
    return lambda scene: draw_glyphs(
        scene.fibres, scene.frame, spacing=spacing * SEPARATION, length=length * SEPARATION, heads=heads
    )


def convolution(*, enhanced: bool) -> Draw:
    """Line integral convolution."""
    return lambda scene: draw_line_integral_convolution(scene.fibres, scene.frame, enhanced=enhanced)


PICTURES: dict[str, Draw] = {
    "streamlines (ours)": zebra(),
    "LIC, as it comes": convolution(enhanced=False),
    "LIC, enhanced": convolution(enhanced=True),
    "strokes": glyphs(heads=False, spacing=1.5, length=3.6),
    "arrows": glyphs(heads=True, spacing=1.5, length=3.6),
}


@cache
def scenes(surface: str) -> tuple[Scene, ...]:
    """A surface from all views."""
    if surface == "demo":
        model = pectinate.datasets.demo_atrium()
    else:
        model = pectinate.load(find_file("human_atrium_1/la_epi.pts"))
    if surface.endswith("smoothed"):
        model = pectinate.smooth(model, length=1.5).model
    return tuple(Scene.of(model, view) for view in VIEWS)


def rivals(folder: Path | None) -> str:
    """Every kind of picture on every surface."""
    lines = []
    for surface in SURFACES:
        for name, draw in PICTURES.items():
            drawn = {id(scene): draw(scene) for scene in scenes(surface)}
            again = lambda scene, drawn=drawn: drawn[id(scene)]  # noqa: E731
            if folder is not None:
                for scene in scenes(surface):
                    file = f"{surface}-{name}-{scene.frame.view.name}.png".replace(" ", "_")
                    Image.fromarray(drawn[id(scene)]).save(folder / file)
            plain = read_all(again, scenes(surface))
            grainy = [_percent(read_all(again, scenes(surface), grain=grain).errors) for grain in (GRAIN, 2 * GRAIN)]
            lines.append([surface, name, *plain.cells(), *grainy])
    return align(["surface", "picture", *TITLES_OF_READING, f"grain {GRAIN}", f"{2 * GRAIN}"], lines, left=2)


def closeness(_: Path | None) -> str:
    """Share within 15 degrees over how closely the picture is looked at."""
    looks = [(0.1, 0.5), (0.16, 0.5), (INNER, WINDOW), (0.25, 0.75), (0.25, 1.0), (0.35, 0.75)]
    lines = []
    for name, draw in PICTURES.items():
        drawn = {id(scene): draw(scene) for scene in scenes("demo")}
        shares = [read_all(lambda scene, d=drawn: d[id(scene)], scenes("demo"), *look).errors for look in looks]
        lines.append([name, *map(_percent, shares)])
    return align(["kernel, window:", *[f"{inner}, {window}" for inner, window in looks]], lines, left=1)


def glyph_sizes(_: Path | None) -> str:
    """Which arrows and strokes read best."""
    lines = []
    for heads in (False, True):
        for spacing in (0.75, 1.0, 1.5):
            for length in (1.2, 1.6, 2.4):
                draw = glyphs(heads=heads, spacing=spacing, length=length * spacing)
                cells = read_all(draw, scenes("demo")).cells()
                lines.append(["arrows" if heads else "strokes", f"{spacing:g}", f"{length * spacing:g}", *cells])
    return align(["glyph", "spacing", "length", *TITLES_OF_READING], lines, left=1)


def radii(_: Path | None) -> str:
    """Tube radius over d_sep."""
    values = (0.10, 0.15, 0.20, 0.225, 0.25, 0.275, 0.35)
    return _sweep("radius / d_sep", [(f"{value:g}", zebra(radius=value)) for value in values])


def tapers(_: Path | None) -> str:
    """Taper length over d_sep."""
    values = (0.0, 0.5, 1.25, 2.0, 4.0)
    return _sweep("taper / d_sep", [(f"{value:g}", zebra(taper=value)) for value in values])


def heights(_: Path | None) -> str:
    """Height of tubes over their width."""
    values = (0.05, 0.1, 0.2, 0.3, 0.5, 1.0)
    return _sweep("height / width", [(f"{value:g}", zebra(height=value)) for value in values])


def contrasts(_: Path | None) -> str:
    """Colours and light."""
    style = Style()
    styles = {
        "default": style,
        "tubes 0": replace(style, tube_color=(0.0, 0.0, 0.0)),
        "tubes 0.1": replace(style, tube_color=(0.1, 0.1, 0.1)),
        "tubes 0.35": replace(style, tube_color=(0.35, 0.35, 0.35)),
        "tubes 0.6": replace(style, tube_color=(0.6, 0.6, 0.6)),
        "white tubes on dark": replace(style, tube_color=(0.95, 0.95, 0.95), surface_color=(0.25, 0.22, 0.2)),
        "gloss 0": replace(style, tube_gloss=0.0),
        "gloss 0.2": replace(style, tube_gloss=0.2),
        "folds 0": replace(style, fold_darkness=0.0),
        "folds 0.6": replace(style, fold_darkness=0.6),
        "edges 0": replace(style, edge_darkness=0.0),
        "edges 0.7": replace(style, edge_darkness=0.7),
        "shadows 0": replace(style, shadow_color=(0.0, 0.0, 0.0)),
        "shadows 0.5": replace(style, shadow_color=(0.5, 0.5, 0.5)),
        "no shadows": replace(style, shadow_color=(1.0, 1.0, 1.0), tube_gloss=0.0),
    }
    return _sweep("colours and light", [(name, zebra(style=some)) for name, some in styles.items()])


def separations(_: Path | None) -> str:
    """d_sep in pixels: the same streamlines in pictures of several sizes, read at the scale of d_sep in each."""
    lines = []
    for width in (150, 220, 300, 400, 560, 800, 1200):
        size = (width, round(0.84 * width))
        some = [Scene.of(scene.model, scene.frame.view, size) for scene in scenes("demo")]
        pixels = SEPARATION / some[0].frame.mm_per_pixel
        lines.append([f"{width}", f"{pixels:.1f}", *_plain_and_grainy(zebra(), some)])
    return align(["width", "d_sep, pixels", *TITLES_OF_READING, f"grain {GRAIN}"], lines, left=0)


def _sweep(title: str, draws: Sequence[tuple[str, Draw]]) -> str:
    lines = [[name, *_plain_and_grainy(draw, scenes("demo"))] for name, draw in draws]
    return align([title, *TITLES_OF_READING, f"grain {GRAIN}"], lines, left=1)


def _plain_and_grainy(draw: Draw, some: Sequence[Scene]) -> Line:
    drawn = {id(scene): draw(scene) for scene in some}
    plain = read_all(lambda scene: drawn[id(scene)], some)
    grainy = read_all(lambda scene: drawn[id(scene)], some, grain=GRAIN)
    return [*plain.cells(), _percent(grainy.errors)]


def _median(errors: NDArray[np.float64]) -> str:
    return f"{np.median(errors):.2f}"


def _percent(errors: NDArray[np.float64]) -> str:
    return f"{(errors < CLOSE).mean():.1%}"


PARTS: dict[str, tuple[str, Callable[[Path | None], str]]] = {
    "rivals": ("Pictures of the same field", rivals),
    "closeness": ("How closely the picture is looked at: share within 15 degrees, demo atrium", closeness),
    "glyphs": ("Which arrows and strokes", glyph_sizes),
    "radius": ("Tube radius", radii),
    "taper": ("Taper", tapers),
    "height": ("Height of tubes", heights),
    "contrast": ("Contrast", contrasts),
    "separation": ("Size of the picture", separations),
}


def main(argv: Sequence[str] | None = None) -> int:
    """Print the chosen tables; 0 if all surfaces were there."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", action="append", choices=list(PARTS), help="only this one (repeatable)")
    parser.add_argument("--out", type=Path, help="folder for the pictures of the first table")
    arguments = parser.parse_args(argv)
    if arguments.out is not None:
        arguments.out.mkdir(parents=True, exist_ok=True)
    try:
        for name in arguments.part or PARTS:
            title, make = PARTS[name]
            print(f"### {title}\n\n{make(arguments.out)}\n", flush=True)
    except SurfaceMissing as reason:
        print(reason, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
