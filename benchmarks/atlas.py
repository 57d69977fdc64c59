"""Measure the first field that a bare atrium gets from the built-in one, against its measured fibres.

`python benchmarks/atlas.py` prints the tables as Markdown. See `README.md` for what they mean.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from functools import cache

import numpy as np

import pectinate
from field_inputs import SURFACES, measured
from pectinate import _core
from surfaces import SurfaceMissing
from tables import align

# A point on each opening, mm, and what the surfaces' tags mean.
LEFT_REGIONS = {
    11: "body",
    13: "appendage",
    21: "left superior vein",
    23: "left inferior vein",
    25: "right superior vein",
    27: "right inferior vein",
}
RIGHT_REGIONS = {1: "body", 2: "appendage", 5: "coronary sinus", 6: "superior vena cava", 7: "inferior vena cava"}
LOOPS: dict[str, dict[str, tuple[float, float, float]]] = {
    "la_epi": {
        "mitral valve": (59.1, 31.4, 13.3),
        "left superior pulmonary vein": (20.9, 61.5, 49.0),
        "left inferior pulmonary vein": (22.2, 45.5, 45.5),
        "right superior pulmonary vein": (63.1, 64.8, 56.5),
        "right inferior pulmonary vein": (55.0, 51.1, 56.0),
    },
    "la_endo": {
        "mitral valve": (34.8, 45.8, 13.6),
        "left superior pulmonary vein": (24.4, 64.2, 41.9),
        "left inferior pulmonary vein": (22.5, 46.2, 46.1),
        "right superior pulmonary vein": (59.3, 61.2, 57.0),
        "right inferior pulmonary vein": (54.3, 50.3, 56.1),
    },
    "ra_epi": {
        "tricuspid valve": (70.7, 40.8, 10.1),
        "coronary sinus": (63.7, 43.7, 10.0),
        "superior vena cava": (68.0, 67.9, 47.5),
        "inferior vena cava": (74.0, 14.2, 34.2),
    },
    "ra_endo": {
        "tricuspid valve": (72.8, 32.6, 11.2),
        "coronary sinus": (64.1, 43.2, 10.7),
        "superior vena cava": (66.2, 67.2, 43.8),
        "inferior vena cava": (71.9, 15.2, 46.3),
    },
}
SMOOTHING_LENGTH = 1.5  # mm
Line = list[str]


def main(argv: Sequence[str] | None = None) -> int:
    """Print both tables; 0 if all surfaces were there."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--surface", action="append", choices=SURFACES, help="measured surfaces (repeatable; all)")
    chosen = parser.parse_args(argv).surface or SURFACES
    try:
        angles = [line for name in chosen for line in angle_lines(name)]
        fits = [fit_line(name) for name in chosen]
    except SurfaceMissing as reason:
        print(reason, file=sys.stderr)
        return 1
    titles = ["surface", "region", "share", "atlas", "field", "borders", "atlas", "field", "borders"]
    print("### The built-in atrium's fibres on measured surfaces, median angles in degrees\n")
    print(align(titles, angles, left=2), "\n\n### How the built-in atrium came to lie on them\n")
    print(align(["surface", "mm median", "95 %", "most", "tracts", "left out", "CPU s"], fits, left=1))
    return 0


@cache
def fields(name: str) -> tuple[pectinate.InterpolatedField, float, list[_core.OrientationField]]:
    """The atlas, its CPU time; then all fields to compare: atlas, finished field carried over, borders alone."""
    model = named(name)
    start = time.process_time()
    made = pectinate.atlas(model, LOOPS[name], chamber=chamber(name), layer=layer(name))
    seconds = time.process_time() - start
    parallel = [pectinate.BoundaryCondition(loop, "parallel") for loop in model.loop_names.values()]
    borders = pectinate.interpolate(model, pectinate.TractSet(boundary=tuple(parallel))).field
    return made, seconds, [made.field, carried_field(name), borders]


def carried_field(name: str) -> _core.OrientationField:
    """The built-in atrium's finished field, moved with its surface, taken from the nearest points."""
    model, finished = named(name), pectinate.datasets.atria(layer=layer(name))[chamber(name)].model
    mesh, found = finished.mesh, pectinate.correspond(finished, model)
    corners = mesh.vertices[mesh.triangles]
    step = 1e-3 * finished.require_field().directions  # mm
    centres = corners.mean(axis=1)
    directions = found.carry(centres + step) - found.carry(centres - step)
    moved = _core.SurfaceMesh(found.carry(mesh.vertices), mesh.triangles)
    field = _core.OrientationField.from_triangle_vectors(moved, directions)
    return _core.transfer_by_nearest_point(moved, field, model.mesh, maximum_distance=np.inf).field


def angle_lines(name: str) -> list[Line]:
    """Median angles, to the measured fibres and to the smoothed ones, of all triangles and per region."""
    model, (_, _, compared) = named(name), fields(name)
    mesh, own = model.mesh, model.require_field()
    smoothed = _core.smooth(mesh, own, length=SMOOTHING_LENGTH).field
    angles = [np.degrees(_core.angles_between(field, truth)) for truth in (own, smoothed) for field in compared]
    regions = LEFT_REGIONS if name.startswith("la") else RIGHT_REGIONS
    parts = {"all": np.ones(mesh.triangle_count, bool)} | {text: model.tags == tag for tag, text in regions.items()}
    shares = {text: mesh.triangle_areas[part].sum() / mesh.area for text, part in parts.items()}
    return [
        [name, text, f"{shares[text]:.0%}", *(f"{np.nanmedian(angle[part]):.0f}" for angle in angles)]
        for text, part in parts.items()
    ]


def fit_line(name: str) -> Line:
    """Distances of the warped surface, tracts carried and left out, time."""
    made, seconds, _ = fields(name)
    built_in = pectinate.datasets.atrial_surface(chamber(name), layer=layer(name), edge_length=2)
    drawn = pectinate.datasets.atrial_tracts(chamber(name), layer=layer(name))
    apart = pectinate.correspond(built_in, named(name)).report()["distances"].values()
    counts = [str(len(made.tracts.tracts)), str(len(drawn.tracts) - len(made.tracts.tracts))]
    return [name, *(f"{mm:.1f}" for mm in apart), *counts, f"{seconds:.1f}"]


def named(name: str) -> pectinate.Model:
    """A measured surface whose openings have names."""
    return measured(name).with_loop_points({loop: np.array(point) for loop, point in LOOPS[name].items()})


def chamber(name: str) -> str:
    """Of a measured surface."""
    return "left_atrium" if name.startswith("la") else "right_atrium"


def layer(name: str) -> str:
    """Of a measured surface."""
    return "epicardium" if name.endswith("epi") else "endocardium"


if __name__ == "__main__":
    sys.exit(main())
