"""Draw the pictures of the documentation: `python benchmarks/pictures.py`, or `make pictures`.

The figures are those of the paper: the fibres of both atria (Fig. 8) and, on the demo atrium, how the reference
orientation comes about (Fig. 3), how a few tracts make a field step by step (Fig. 4), what noise does to streamlines,
and smoothing to noise (Fig. 10).
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import pectinate
from demo_fields import DemoFields, streamline_layer
from pectinate import _core
from pectinate.datasets.sheets import AtrialFibres, fibre_sheet
from pectinate.figure import SurfaceValues, View, draw_disk, draw_sheet

FOLDER = Path(__file__).resolve().parents[1] / ".github" / "images"
PAPER, INK = "white", (60, 56, 54)
ALONG, ACROSS = (0.06, 0.22, 0.45), (0.80, 0.33, 0.05)
# Where a fossa ovalis would be: on the septum, in front of the right veins.
FOSSA_OVALIS = (-34.0, -8.0, 0.0)
LENS = (0.02, 0.03, 0.32)
ANTERIOR = View("anterior", (0, 1, 0), (0, 0, 1))
POSTERIOR = View("posterior", (0, -1, 0), (0, 0, 1))
APPENDAGE = View("from the left and above", (-0.75, 0.6, -0.25), (0, 0, 1))
TRACT_GROUPS = ("Bachmann", "septopulmonary", "T,", "appendage")
SHADES = 64
# Four edges: noise that differs from triangle to triangle.
SMOOTHING_LENGTH = 4.0


def demo_atrium() -> Image.Image:
    """The picture at the top of the README."""
    placement = pectinate.place_streamlines(pectinate.datasets.demo_atrium(), separation_distance=1.6)
    return placement.figure(views=["anterior", "posterior", "left"], size=(560, 470))


def atria_fibres() -> Image.Image:
    """Fig. 8: both layers of the built-in atria in three views, with the numbers of the paper's rows."""
    layers = {
        layer: {
            name: AtrialFibres(made, pectinate.place_streamlines(made.model))
            for name, made in pectinate.datasets.atria(layer=layer).items()
        }
        for layer in ("epicardium", "endocardium")
    }
    return fibre_sheet(layers, size=(620, 540))


def posterior() -> Image.Image:
    """The picture that the README's ten lines make."""
    placement = pectinate.place_streamlines(pectinate.datasets.demo_atrium(), separation_distance=2.4)
    return placement.figure(views="posterior")


def reference_frame() -> Image.Image:
    """Fig. 3: the disk and a lens on its holes; streamlines along v_0 and across it from behind and from the front."""
    demo = DemoFields()
    mesh, names = demo.mesh, demo.loop_names()
    parameterization = _core.parameterize(mesh)
    frame = _core.make_reference_frame(mesh, parameterization, inner_point=FOSSA_OVALIS)
    outer = {loop: name if loop == parameterization.outer_loop else "" for loop, name in names.items()}
    disk = draw_disk(parameterization, frame, mesh, loop_names=outer, size=460, lens=LENS)
    lens = draw_disk(parameterization, frame, mesh, loop_names=names, origin_name="FO", size=460, window=LENS)
    layers = []
    for angle, color in ((0.0, ALONG), (0.5 * np.pi, ACROSS)):
        field = _core.field_from_angles(mesh, frame, np.full(mesh.triangle_count, angle))
        layers.append(streamline_layer(demo.place(field, 3.2), 0.45, color))
    surface = (mesh.vertices, mesh.triangles)
    look = {"layers": layers, "size": (560, 490)}
    from_behind = draw_sheet(surface, views=POSTERIOR, scale_bar=False, **look)
    from_front = draw_sheet(surface, views=ANTERIOR, **look)
    return rows([panel("A", disk), lens], [panel("B", from_behind), panel("C", from_front)])


def steps() -> Image.Image:
    """Fig. 4: tracts on the left, the streamlines that they make on the right, step by step."""
    demo = DemoFields()
    surface = (demo.mesh.vertices, demo.mesh.triangles)
    panels = []
    for letter, groups, view in (
        ("A", 0, ANTERIOR),
        ("B", 2, ANTERIOR),
        ("C", 3, POSTERIOR),
        ("D", 4, APPENDAGE),
    ):
        constraints = demo.constraints(TRACT_GROUPS[:groups])
        placement = demo.place(demo.interpolate(constraints).field, 1.6)
        look = {"views": view, "size": (430, 370), "labels": False, "scale_bar": False}
        left = draw_sheet(surface, layers=[demo.drawn_lines(constraints)], **look)
        panels.append(panel(letter, beside([left, placement.figure(**look)])))
    return rows(panels[:2], panels[2:])


def noise() -> Image.Image:
    """Fig. 10: an interpolated field with noise of 0, 5 and 10 degrees; below, each after smoothing."""
    demo = DemoFields()
    constraints = demo.constraints(TRACT_GROUPS)
    clean = demo.interpolate(constraints).field
    surface = (demo.mesh.vertices, demo.mesh.triangles)
    look = {"size": (376, 324), "scale_bar": False}
    tracts = draw_sheet(surface, layers=[demo.drawn_lines(constraints)], views=named("tracts"), **look)
    raw, smoothed = [panel("A", tracts)], [Image.new("RGB", tracts.size, PAPER)]
    for letters, degrees in (("BE", 0), ("CF", 5), ("DG", 10)):
        field = noisy(demo, clean, degrees)
        smooth_field = _core.smooth(demo.mesh, field, length=SMOOTHING_LENGTH).field
        for row, letter, what in zip((raw, smoothed), letters, (field, smooth_field), strict=True):
            placement = demo.place(what, 1.6)
            name = f"{degrees} degrees" + (", smoothed" if row is smoothed else "")
            name += f": mean length {placement.statistics.mean_length:.1f} mm"
            row.append(panel(letter, placement.figure(views=named(name), **look)))
    return rows(raw, smoothed)


def values() -> Image.Image:
    """Numbers on the surface: how sure an interpolated field is, and what smoothing leaves of noise of 10 degrees."""
    demo = DemoFields()
    constraints = demo.constraints(TRACT_GROUPS)
    interpolation = demo.interpolate(constraints)
    smoothed = _core.smooth(demo.mesh, noisy(demo, interpolation.field, 10), length=SMOOTHING_LENGTH).field
    left = np.degrees(_core.angles_between(smoothed, interpolation.field))
    confidence = SurfaceValues(interpolation.confidence, value_range=(0, 1), label="confidence")
    angles = SurfaceValues(left, "magma", (0, 20), "error left (degrees)")
    look = {"views": [ANTERIOR, POSTERIOR], "size": (430, 370)}
    lines = demo.drawn_lines(constraints)
    return rows(
        [panel("A", demo.model.figure(surface_values=confidence, layers=[lines], **look))],
        [panel("B", demo.model.figure(surface_values=angles, **look))],
    )


def noisy(demo: DemoFields, field: _core.OrientationField, degrees: float) -> _core.OrientationField:
    """The field with normal noise of a standard deviation in degrees."""
    return _core.add_angular_noise(demo.mesh, field, standard_deviation=np.radians(degrees))


def named(name: str) -> View:
    """The anterior view under another name."""
    return View(name, ANTERIOR.direction, ANTERIOR.up)


def panel(letter: str, picture: Image.Image) -> Image.Image:
    """Write a panel's letter into the upper left corner."""
    ImageDraw.Draw(picture).text((10, 4), letter, INK, ImageFont.load_default(30))
    return picture


def beside(pictures: Sequence[Image.Image]) -> Image.Image:
    """Lay pictures side by side, in the middle of a common height."""
    height = max(picture.height for picture in pictures)
    sheet = Image.new("RGB", (sum(picture.width for picture in pictures), height), PAPER)
    x = 0
    for picture in pictures:
        sheet.paste(picture, (x, (height - picture.height) // 2))
        x += picture.width
    return sheet


def rows(*pictures: Sequence[Image.Image]) -> Image.Image:
    """Lay rows of pictures below each other."""
    strips = [beside(row) for row in pictures]
    sheet = Image.new("RGB", (max(strip.width for strip in strips), sum(strip.height for strip in strips)), PAPER)
    y = 0
    for strip in strips:
        sheet.paste(strip, ((sheet.width - strip.width) // 2, y))
        y += strip.height
    return sheet


def with_few_shades(picture: Image.Image) -> Image.Image:
    """Round each channel to one of few shades, black and white among them: nobody sees it, and files are smaller."""
    step = 255 / (SHADES - 1)
    return picture.point([round(round(shade / step) * step) for shade in range(256)] * 3)


PICTURES: dict[str, Callable[[], Image.Image]] = {
    "demo_atrium": demo_atrium,
    "atria_fibres": atria_fibres,
    "posterior": posterior,
    "reference_frame": reference_frame,
    "interpolation_steps": steps,
    "noise_and_smoothing": noise,
    "values": values,
}


def main(argv: Sequence[str] | None = None) -> None:
    """Draw all pictures, or those that are named."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", nargs="*", choices=[*PICTURES, []], help="what to draw; all by default")
    parser.add_argument("--out", type=Path, default=FOLDER, help="folder for the pictures")
    arguments = parser.parse_args(argv)
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name in arguments.name or PICTURES:
        path = arguments.out / f"{name}.png"
        with_few_shades(PICTURES[name]()).save(path, optimize=True)
        print(f"{path}: {path.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
