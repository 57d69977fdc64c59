"""Measure orientation fields: making them from tracts, editing, smoothing, comparing.

`python benchmarks/fields.py` prints all tables as Markdown; `--part` chooses. See `README.md` for what they mean.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

import pectinate
from field_inputs import (
    SURFACES,
    constraints,
    disk,
    first_part,
    length_of,
    measured,
    measured_tracts,
    parallel_borders,
    polylines,
    reference_frame,
    with_outliers,
)
from pectinate import _core
from surfaces import SurfaceMissing
from tables import align

SEPARATION = 1.6  # mm
STRENGTHS = (0.5, 1.0, 1.5, 2.0, 3.0)  # mm
Line = list[str]


def main(argv: Sequence[str] | None = None) -> int:
    """Print the chosen tables; 0 if all surfaces were there."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", action="append", choices=list(PARTS), help="only this one (repeatable)")
    parser.add_argument("--surface", action="append", choices=SURFACES, help="measured surfaces (repeatable; all)")
    parser.add_argument("--repeats", type=int, default=3, help="runs of a step, of which the fastest counts (3)")
    arguments = parser.parse_args(argv)
    try:
        for name in arguments.part or PARTS:
            table = PARTS[name](arguments.surface or SURFACES, max(1, arguments.repeats))
            print(f"### {TITLES[name]}\n\n{table}\n", flush=True)
    except SurfaceMissing as reason:
        print(reason, file=sys.stderr)
        return 1
    return 0


def cpu_seconds(work: Callable[[], object], repeats: int = 1) -> float:
    """CPU time of all threads, the fastest of some runs."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def median_degrees(angles: np.ndarray) -> float:
    """Median of those that are defined."""
    return float(np.degrees(np.nanmedian(angles)))


def mean_length(mesh: _core.SurfaceMesh, field: _core.OrientationField) -> float:
    """L_avg of the default placement, mm."""
    return _core.place_streamlines(mesh, field, separation_distance=SEPARATION).statistics.mean_length


def steps(surfaces: Sequence[str], repeats: int) -> str:
    """CPU time of every step from a surface to a field."""
    titles = ["surface", "triangles", "mesh", "disk", "frame", "constraints", "solver", "solve", "topology"]
    return align([*titles, "flipped", "critical"], [_steps_of(name, repeats) for name in surfaces], left=1)


def _steps_of(name: str, repeats: int) -> Line:
    model, demands = measured(name), constraints(name)
    mesh, data = model.mesh, model.data

    def solve() -> tuple[_core.FieldInterpolator, float]:
        solver = _core.FieldInterpolator(mesh)
        return solver, cpu_seconds(lambda: solver.interpolate(demands))

    field = _core.FieldInterpolator(mesh).interpolate(demands).field
    faults = [len(disk(name).flipped_triangles), len(reference_frame(name).critical_points)]
    times = [
        cpu_seconds(lambda: _core.SurfaceMesh(data.vertices, data.triangles), repeats),
        cpu_seconds(lambda: _core.parameterize(mesh), repeats),
        cpu_seconds(lambda: reference_frame(name), repeats),
        cpu_seconds(lambda: _core.make_constraints(mesh, measured_tracts(name), parallel_borders(mesh)), repeats),
        cpu_seconds(lambda: _core.FieldInterpolator(mesh), repeats),
        min(solve()[1] for _ in range(repeats)),
        cpu_seconds(lambda: _core.field_topology(mesh, field), repeats),
    ]
    return [name, f"{mesh.triangle_count:,}", *(f"{seconds:.2f}" for seconds in times), *map(str, faults)]


def editing(_surfaces: Sequence[str], _repeats: int) -> str:
    """A tract more or less on la_epi against a fresh solve, in turn; then many edits against a fresh solver."""
    mesh, tracts, borders = (
        measured("la_epi").mesh,
        measured_tracts("la_epi"),
        parallel_borders(measured("la_epi").mesh),
    )
    projector = _core.TractProjector(mesh)
    live = _core.FieldInterpolator(mesh)
    field = live.interpolate(constraints("la_epi")).field
    lines = sorted(polylines(_core.place_streamlines(mesh, field)), key=length_of)
    lengths = (5.0, 20.0, 60.0)
    drawn = [first_part(next(line for line in lines if length_of(line) >= length), length) for length in lengths]

    def start() -> None:
        demands = _core.TractProjector(mesh).make_constraints(tracts, borders)
        _core.FieldInterpolator(mesh).interpolate(demands)

    def edit(tracts: list[_core.Tract]) -> None:
        live.interpolate(projector.make_constraints(tracts, borders))

    fresh, added, removed = [], [], []
    for _ in range(7):
        fresh.append(cpu_seconds(start))
        added.append([])
        removed.append([])
        for line in drawn:
            added[-1].append(cpu_seconds(partial(edit, [*tracts, _core.Tract(line)])))
            removed[-1].append(cpu_seconds(partial(edit, tracts)))
    whole, more, less = np.median(fresh), np.median(added, axis=0), np.median(removed, axis=0)
    rows = [
        [
            f"{length_of(line):.0f}",
            f"{whole:.2f}",
            f"{a * 1e3:.0f}",
            f"{r * 1e3:.0f}",
            f"{whole / a:.1f}x",
            f"{whole / r:.1f}x",
        ]
        for line, a, r in zip(drawn, more, less, strict=True)
    ]
    table = align(["tract mm", "fresh s", "add ms", "remove ms", "fresh / add", "fresh / remove"], rows, left=0)
    return f"{table}\n\n{_many_edits(live, projector, lines)}"


def _many_edits(live: _core.FieldInterpolator, projector: _core.TractProjector, lines: list[np.ndarray]) -> str:
    mesh = measured("la_epi").mesh
    random = np.random.default_rng(1)
    tracts = measured_tracts("la_epi")
    for _ in range(50):
        if len(tracts) > 1 and random.random() < 0.5:
            tracts = [tract for k, tract in enumerate(tracts) if k != random.integers(len(tracts))]
        else:
            tracts = [*tracts, _core.Tract(first_part(lines[random.integers(len(lines))], random.uniform(5, 60)))]
        demands = projector.make_constraints(tracts, parallel_borders(mesh))
        edited = live.interpolate(demands).field
    fresh = _core.FieldInterpolator(mesh).interpolate(demands).field
    same = edited.directions.tobytes() == fresh.directions.tobytes()
    greatest = np.degrees(np.nanmax(_core.angles_between(edited, fresh)))
    return f"After 50 random edits: {'the same bytes' if same else f'{greatest:.1e} degrees'} as from a fresh solver."


def solvers(_surfaces: Sequence[str], repeats: int) -> str:
    """The fresh solve on la_epi beside scipy's SuperLU on the same system."""
    mesh, demands = measured("la_epi").mesh, constraints("la_epi")
    field = _core.FieldInterpolator(mesh).interpolate(demands).field
    ours = cpu_seconds(lambda: _core.FieldInterpolator(mesh).interpolate(demands), repeats)
    lines = [["pectinate", f"{ours:.2f}", "1.0x", ""]]
    if importlib.util.find_spec("scipy") is None:
        return align(["solver", "CPU s", "over ours", "greatest angle"], lines, left=1)
    from field_peer import ORDERINGS, solve_by_superlu  # noqa: PLC0415

    for ordering in ORDERINGS:
        theirs, seconds = solve_by_superlu(mesh, demands, ordering)
        angle = np.degrees(np.nanmax(_core.angles_between(field, theirs)))
        lines.append([f"SuperLU, {ordering}", f"{seconds:.2f}", f"{seconds / ours:.1f}x", f"{angle:.0e}"])
    return align(["solver", "CPU s", "over ours", "greatest angle"], lines, left=1)


def methods(surfaces: Sequence[str], _repeats: int) -> str:
    """Connection and reference frame from the same constraints."""
    titles = ["surface", "method", "energy", "singularities", "to measured", "to each other"]
    return align(titles, [line for name in surfaces for line in _methods_on(name)], left=2)


def _methods_on(name: str) -> list[Line]:
    model, demands = measured(name), constraints(name)
    mesh = model.mesh
    solvers = {
        "connection": _core.FieldInterpolator(mesh),
        "reference frame": _core.FieldInterpolator(mesh, reference_frame(name)),
    }
    fields = {method: solver.interpolate(demands).field for method, solver in solvers.items()}
    apart = f"{median_degrees(_core.angles_between(*fields.values())):.2f}"
    return [
        [
            name,
            method,
            f"{_core.dirichlet_energy(mesh, field):.0f}",
            str(len(_core.field_topology(mesh, field).singularities)),
            f"{median_degrees(_core.angles_between(field, model.require_field())):.1f}",
            apart,
        ]
        for method, field in fields.items()
    ]


def smoothing(surfaces: Sequence[str], _repeats: int) -> str:
    """Measured fibres, smoothed by several strengths."""
    titles = ["surface", "length mm", "L_avg mm", "over raw", "moved median", "95 %", "outliers", "CPU s"]
    return align(titles, [line for name in surfaces for line in _smoothing_of(name)], left=1)


def _smoothing_of(name: str) -> list[Line]:
    mesh, field = measured(name).mesh, measured(name).require_field()
    raw = mean_length(mesh, field)
    lines = [[name, "raw", f"{raw:.2f}", *[""] * 5]]
    for length in STRENGTHS:
        start = time.process_time()
        result = _core.smooth(mesh, field, length=length)
        seconds = time.process_time() - start
        smoothed = mean_length(mesh, result.field)
        far = np.degrees(np.nanquantile(result.moved_angles, 0.95))
        moved = [f"{median_degrees(result.moved_angles):.2f}", f"{far:.1f}", f"{result.outliers.mean():.1%}"]
        lines.append([name, f"{length:g}", f"{smoothed:.2f}", f"{smoothed / raw:.2f}x", *moved, f"{seconds:.2f}"])
    return lines


def synthetic(_surfaces: Sequence[str], _repeats: int) -> str:
    """Noise and outliers on a field that is known."""
    model = pectinate.datasets.demo_atrium(edge_length=0.4)
    truth = model.require_field()
    noisy = with_outliers(model, noise=np.radians(10), share=0.05)
    before = median_degrees(_core.angles_between(truth, noisy))
    lines = []
    for length in (*STRENGTHS, 4.0):
        result = _core.smooth(model.mesh, noisy, length=length)
        after = median_degrees(_core.angles_between(truth, result.field))
        lines.append([f"{length:g}", f"{before:.2f}", f"{after:.2f}", f"{before / after:.1f}x"])
    return align(["length mm", "error before", "after", "before / after"], lines, left=0)


def noise(_surfaces: Sequence[str], _repeats: int) -> str:
    """Figure 10 of the paper: streamlines of a noisy field, raw and smoothed."""
    model = pectinate.datasets.demo_atrium()
    mesh = model.mesh
    lines = []
    for degrees in (0, 5, 10):
        noisy = _core.add_angular_noise(mesh, model.require_field(), standard_deviation=np.radians(degrees))
        smoothed = _core.smooth(mesh, noisy, length=1.5).field
        lines.append([str(degrees), f"{mean_length(mesh, noisy):.2f}", f"{mean_length(mesh, smoothed):.2f}"])
    return align(["noise, degrees", "L_avg raw", "L_avg smoothed"], lines, left=0)


def transfer(_surfaces: Sequence[str], repeats: int) -> str:
    """From outside to inside by nearest points."""
    lines = []
    for source, target in (("la_epi", "la_endo"), ("ra_epi", "ra_endo")):
        arguments = measured(source).mesh, measured(source).require_field(), measured(target).mesh

        carry = partial(_core.transfer_by_nearest_point, *arguments, maximum_distance=np.inf)
        angles = _core.angles_between(carry().field, measured(target).require_field())
        lines.append([f"{source} to {target}", f"{cpu_seconds(carry, repeats):.2f}", f"{median_degrees(angles):.1f}"])
    return align(["surfaces", "CPU s", "median angle"], lines, left=1)


PARTS: dict[str, Callable[[Sequence[str], int], str]] = {
    "steps": steps,
    "editing": editing,
    "solvers": solvers,
    "methods": methods,
    "smoothing": smoothing,
    "synthetic": synthetic,
    "noise": noise,
    "transfer": transfer,
}
TITLES = {
    "steps": "Steps, CPU seconds",
    "editing": "Live editing on la_epi, CPU time, medians of 7",
    "solvers": "Fresh solve on la_epi, from connection to field, angles in degrees",
    "methods": "Connection and reference frame, median angles in degrees",
    "smoothing": "Smoothing of measured fibres, angles in degrees",
    "synthetic": "Smoothing of 10 degrees of noise and 5 % outliers on the demo atrium, median error in degrees",
    "noise": "Noise on the demo atrium, d_sep 1.6 mm, smoothed by 1.5 mm",
    "transfer": "Comparison of outside and inside",
}

if __name__ == "__main__":
    sys.exit(main())
