"""How the placement scales: against its floor, in triangles, d_sep, threads and memory; on hard cases, and polished.

`python benchmarks/engine.py --part NAME` prints one table; see `README.md` for what is measured.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from runs import Row, Setup, run_case, streamlines_file
from scenarios import Scenario, SurfaceSource
from shapes import HARD_CASES, HELIX_SLOPES, RECTANGLE_DEGREES
from surfaces import REPOSITORY, Arrays, SurfaceMissing, read_surface
from tables import align

LA_EPI = SurfaceSource(file="human_atrium_1/la_epi.pts")
FINE_DEMO = SurfaceSource(edge_length=0.5)
DEFAULT = "longest"
HYSTERESIS = "longest, seed_clearance=1.155"
FLOOR_PROGRAM = REPOSITORY / "build" / "benchmarks" / "floor"

# The same atrium with ever finer triangles, ever more atria of 1 mm edges, and the measured one ever finer: from 42
# thousand to 2.7 million triangles.
FINER = [SurfaceSource(edge_length=1.0), SurfaceSource(edge_length=0.5)]
FINER += [SurfaceSource(edge_length=0.25, refinements=refinements) for refinements in (0, 1)]
MORE = [SurfaceSource(edge_length=1.0, copies=copies) for copies in (1, 4, 16, 64)]
FINER_MEASURED = [SurfaceSource(file=LA_EPI.file, refinements=refinements) for refinements in (0, 1, 2)]
POLISHED = [SurfaceSource(file=f"human_atrium_1/{name}.pts") for name in ("la_epi", "la_endo", "ra_epi")]
POLISHED += [SurfaceSource(shape="torus")]
POLISHING_SECONDS = (1, 3, 10, 30)
EDGES_PER_SEPARATION = (0.25, 0.5, 1, 1.6, 2.5, 4, 6, 10, 16, 30)
PLACEMENT = ("placement",)
PLACEMENT_AGAIN = ("again",)
BEFORE_PLACEMENT = ("mesh", "field")


@dataclass(frozen=True)
class Bench:
    """How the parts measure.

    Attributes
    ----------
    setup
        As for the scenarios.
    repeats
        Runs of each row.
    floor_program
        What `floor.cpp` became.
    seeds
        Candidates a streamline, for methods that have them, and for the peer.
    """

    setup: Setup
    repeats: int
    floor_program: Path
    seeds: int = 32

    def rows(
        self, surface: SurfaceSource, arrays: Arrays, separation: float, methods: Sequence[str], threads: int = 1
    ) -> list[Row]:
        """Run our methods on a surface, and the peer if the setup wants it."""
        scenario = Scenario("", "", surface, [separation], list(methods), [self.seeds], [threads], self.repeats)
        (case,) = scenario.cases()
        rows = run_case(scenario, case, arrays, self.setup)
        for row in rows:
            if row.failure:
                raise SystemExit(f"{surface}, {case}: {row.name}: {row.failure}")
        return rows

    def row(self, surface: SurfaceSource, arrays: Arrays, separation: float) -> Row:
        """Run the default method."""
        return self.rows(surface, arrays, separation, [DEFAULT])[0]


# Floor ---------------------------------------------------------------------------------------------------------------


def print_floor(bench: Bench) -> None:
    """Placement beside the time to trace once what it kept."""
    cases = [(SurfaceSource(edge_length=1.0), 1.6)]
    cases += [(surface, separation) for surface in (LA_EPI, FINE_DEMO) for separation in (0.8, 1.6, 3.2)]
    lines = []
    for surface, separation in cases:
        arrays = read_surface(surface)
        figures = _floor(bench, arrays, separation)
        if not figures["greatest_difference"] < 1e-6:
            raise SystemExit(f"{surface}: the floor traced other streamlines than those placed")
        floor = figures["preparing"] + figures["tracing"]
        lines.append(
            [
                str(surface),
                f"{separation:g}",
                f"{figures['segments']:,.0f}",
                f"{1e3 * figures['tracing']:.2f}",
                f"{1e9 * figures['tracing'] / figures['segments']:.0f}",
                f"{1e3 * figures['preparing']:.1f}",
                f"{1e3 * figures['placing']:.1f}",
                f"{figures['placing'] / figures['tracing']:.0f}",
                f"{figures['placing'] / floor:.1f}",
            ]
        )
    titles = ["surface", "d_sep mm", "segments", "tracing ms", "ns a segment", "preparing ms", "placement ms"]
    print(align([*titles, "placement / tracing", "/ (preparing + tracing)"], lines, left=1))


def _floor(bench: Bench, arrays: Arrays, separation: float) -> dict[str, float]:
    """Run the program on the arrays."""
    file = bench.setup.folder / "surface.bin"
    with file.open("wb") as stream:
        np.array([len(arrays.vertices), len(arrays.triangles)], dtype=np.int64).tofile(stream)
        arrays.vertices.astype(np.float64).tofile(stream)
        arrays.field.astype(np.float64).tofile(stream)
        arrays.triangles.astype(np.int32).tofile(stream)
    command = [str(bench.floor_program), str(file), str(separation), str(bench.repeats)]
    output = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, timeout=bench.setup.timeout).stdout
    figures: dict[str, float] = json.loads(output)
    return figures


# Scaling -------------------------------------------------------------------------------------------------------------


def print_scaling(bench: Bench) -> None:
    """More triangles at a fixed d_sep/edge: finer ones make streamlines longer against d_sep, more atria do not."""
    for edges in (1.6, 4):
        for title, surfaces in (("finer triangles", FINER), ("more atria", MORE), ("measured, finer", FINER_MEASURED)):
            _print_growth(f"{title.capitalize()}, d_sep = {edges:g} edges", surfaces, edges, bench)


def _print_growth(title: str, surfaces: Sequence[SurfaceSource], edges: float, bench: Bench) -> None:
    rows, counts, lines = [], [], []
    bench = replace(bench, setup=replace(bench.setup, again=True))
    for surface in surfaces:
        arrays = read_surface(surface)
        separation = edges * arrays.edge_length
        row = bench.row(surface, arrays, separation)
        rows.append(row)
        counts.append(len(arrays.triangles))
        sizes = _size_cells(row, separation)
        sizes.append(f"{1e6 * row.best('cpu', PLACEMENT_AGAIN) / counts[-1]:.2f}")
        lines.append([f"{counts[-1]:,}", f"{separation:.3g}", *_cost_cells(row, counts[-1]), *sizes])
    print(f"\n### {title}\n")
    print(align(["triangles", "d_sep mm", *COST_TITLES, "n", "L_avg / d_sep", "us a triangle, again"], lines, left=0))
    first, again, before = (
        _slope(counts, [row.best("cpu", stages) for row in rows])
        for stages in (PLACEMENT, PLACEMENT_AGAIN, BEFORE_PLACEMENT)
    )
    print(
        f"\nExponent of the number of triangles: placement {first:.2f}, again {again:.2f}, mesh and field {before:.2f}."
    )


COST_TITLES = ["placement ms", "us a triangle", "mesh + field ms", "memory kB a triangle", "of placement alone"]


def _cost_cells(row: Row, triangle_count: int) -> list[str]:
    placement = row.best("cpu", PLACEMENT)
    return [
        f"{1e3 * placement:.0f}",
        f"{1e6 * placement / triangle_count:.2f}",
        f"{1e3 * row.best('cpu', BEFORE_PLACEMENT):.0f}",
        f"{1e3 * row.peak_memory / triangle_count:.2f}",
        f"{1e3 * row.placement_memory / triangle_count:.2f}",
    ]


def _size_cells(row: Row, separation: float) -> list[str]:
    return [f"{row.quality['n']:.0f}", f"{row.quality['mean_length'] / separation:.1f}"]


def _slope(counts: Sequence[int], seconds: Sequence[float]) -> float:
    return float(np.polyfit(np.log(counts), np.log(seconds), 1)[0])


# Separation ----------------------------------------------------------------------------------------------------------


def print_separation(bench: Bench) -> None:
    """From d_sep far below an edge to far above, on the same meshes."""
    for surface in (LA_EPI, FINE_DEMO):
        arrays = read_surface(surface)
        count = len(arrays.triangles)
        lines = []
        for edges in EDGES_PER_SEPARATION:
            separation = round(edges * arrays.edge_length, 4)
            row = bench.row(surface, arrays, separation)
            lines.append([f"{edges:g}", f"{separation:.3g}", *_cost_cells(row, count), *_size_cells(row, separation)])
        print(f"\n### {surface}, {count:,} triangles, mean edge {arrays.edge_length:.3f} mm\n")
        print(align(["d_sep / edge", "d_sep mm", *COST_TITLES, "n", "L_avg / d_sep"], lines, left=0))


# Threads -------------------------------------------------------------------------------------------------------------


def print_threads(bench: Bench) -> None:
    """One thread and two: time, and whether the bytes are the same."""
    methods = [DEFAULT, "random", "neighborhood", "distance"]
    lines = []
    for surface in (LA_EPI, FINE_DEMO):
        arrays = read_surface(surface)
        rows, digests = {}, {}
        for threads in (1, 2):
            for row in bench.rows(surface, arrays, 1.6, methods, threads):
                rows[threads, row.method] = row
                digests[threads, row.method] = _digest(streamlines_file(row, bench.setup))
        for method in methods:
            one, two = rows[1, method], rows[2, method]
            times = [(row.best("wall", PLACEMENT), row.best("cpu", PLACEMENT)) for row in (one, two)]
            same = "same" if digests[1, method] == digests[2, method] else "DIFFERENT"
            cells = [f"{1e3 * seconds:.0f}" for pair in zip(*times, strict=True) for seconds in pair]
            lines.append([str(surface), method, *cells, f"{times[0][0] / times[1][0]:.2f}x", same])
    titles = ["surface", "method", "wall ms, 1 thread", "2 threads", "CPU ms, 1 thread", "2 threads", "gain", "bytes"]
    print(align(titles, lines, left=2))


def _digest(file: Path) -> str:
    with np.load(file) as data:
        return hashlib.sha256(b"".join(data[name].tobytes() for name in sorted(data.files))).hexdigest()


# Flat and hard fields ------------------------------------------------------------------------------------------------


def print_rectangle(bench: Bench) -> None:
    """Constant fields on a rectangle of 100 x 80 mm: the densest that there is has d_avg = d_sep."""
    lines = []
    for degrees in RECTANGLE_DEGREES:
        surface = SurfaceSource(shape=f"rectangle, {degrees} degrees")
        for row in bench.rows(surface, read_surface(surface), 1.6, [DEFAULT, HYSTERESIS]):
            quality, checked = row.quality, row.checked
            cells = [f"{quality['n']:.0f}", f"{quality['mean_length']:.2f}", f"{quality['mean_spacing_ratio']:.4f}"]
            checks = [f"{checked[name]:.4f}" if checked else "" for name in CHECKED]
            lines.append([str(degrees), row.method, *cells, *checks])
    print(align(["degrees", "method", "n", "L_avg mm", "d_avg/d_sep", *CHECKED.values()], lines, left=2))


CHECKED = {"min_separation_surface": "least separation", "coverage": "coverage", "largest_gap": "largest gap"}


HELIX_METHODS = [
    DEFAULT,
    "longest, seed_clearance=1.005",
    "longest, polishing_rounds=40",
    "longest, polishing_rounds=100",
]


def print_helices(bench: Bench) -> None:
    """A torus with helices of many slopes beside the peer with 1000 seeds, which must be there."""
    bench = replace(bench, setup=replace(bench.setup, with_peer=True), seeds=1000)
    lines, ratios, seconds = [], [], []
    for slope in HELIX_SLOPES:
        surface = SurfaceSource(shape=f"torus, slope {slope}")
        *ours, peer = bench.rows(surface, read_surface(surface), 1.6, HELIX_METHODS)
        ratios.append([row.quality["mean_length"] / peer.quality["mean_length"] for row in ours])
        seconds.append([row.best("cpu") for row in (peer, *ours)])
        cells = [f"{row.quality['n']:.0f}" for row in (peer, *ours)]
        lengths = [f"{peer.quality['mean_length']:.1f}", *(f"{ratio:.3f}" for ratio in ratios[-1])]
        lines.append([f"{slope:g}", *(cell for pair in zip(cells, lengths, strict=True) for cell in pair)])
    mean_ratios = [f"{ratio:.2f}" for ratio in np.exp(np.log(ratios).mean(axis=0))]
    lines.append(["geometric mean", "", "", *(cell for ratio in mean_ratios for cell in ("", ratio))])
    titles = ["slope", "n, peer", "L_avg mm", *(title for method in HELIX_METHODS for title in ("n", method))]
    print(align(titles, lines, left=1))
    means = ", ".join(f"{mean:.2g}" for mean in np.mean(seconds, axis=0))
    print(f"\nMean CPU seconds of the peer and of ours: {means}.")


def print_hard(bench: Bench) -> None:
    """Fields and meshes that could be slow, beside the measured surface at the same d_sep/edge."""
    sources = [LA_EPI, *(SurfaceSource(shape=name) for name in HARD_CASES)]
    lines = []
    usual: dict[float, float] = {}
    for surface in sources:
        arrays = read_surface(surface)
        count = len(arrays.triangles)
        for edges in (0.25, 1.6, 5):
            separation = edges * arrays.edge_length
            row = bench.row(surface, arrays, separation)
            per_triangle = row.best("cpu", PLACEMENT) / count
            ratio = per_triangle / usual.setdefault(edges, per_triangle)
            lines.append([str(surface), f"{edges:g}", f"{count:,}", *_cost_cells(row, count), f"{ratio:.1f}"])
            lines[-1] += _size_cells(row, separation)
    print(
        align(["surface", "d_sep / edge", "triangles", *COST_TITLES, "time / la_epi", "n", "L_avg / d_sep"], lines, 1)
    )


# Polishing -----------------------------------------------------------------------------------------------------------


def print_polishing(bench: Bench) -> None:
    """How much longer streamlines get in so many seconds."""
    columns = ["n", "L_avg mm", "gain", "weighted mm", "d_avg/d_sep", "short", *CHECKED.values()]
    lines = []
    for surface in POLISHED:
        arrays = read_surface(surface)
        for separation in (0.8, 1.6, 3.2):
            for method in (DEFAULT, HYSTERESIS):
                methods = [method, *(f"{method}, polishing_time={seconds}" for seconds in POLISHING_SECONDS)]
                rows = bench.rows(surface, arrays, separation, methods)
                for row, seconds in zip(rows, (0, *POLISHING_SECONDS), strict=True):
                    cells = _polishing_cells(row, rows[0])
                    lines.append([str(surface), f"{separation:g}", method, str(seconds), *cells])
    print(align(["surface", "d_sep mm", "method", "s", *columns], lines, left=1))


def _polishing_cells(row: Row, unpolished: Row) -> list[str]:
    quality, checked = row.quality, row.checked
    return [
        f"{quality['n']:.0f}",
        f"{quality['mean_length']:.2f}",
        f"{quality['mean_length'] / unpolished.quality['mean_length'] - 1:+.1%}",
        f"{quality['length_weighted_mean']:.2f}",
        f"{quality['mean_spacing_ratio']:.3f}",
        f"{quality['short_fraction']:.1%}",
        *(f"{checked[name]:.4f}" if checked else "" for name in CHECKED),
    ]


# The smallest ---------------------------------------------------------------------------------------------------------


def print_demo(bench: Bench) -> None:
    """Milliseconds on the demo atrium with 1 mm edges: whether it is interactive."""
    surface = SurfaceSource(edge_length=1.0)
    arrays = read_surface(surface)
    lines = []
    for row in bench.rows(surface, arrays, 1.6, [DEFAULT, HYSTERESIS]):
        cells = [f"{1e3 * row.best('cpu', (stage,)):.1f}" for stage in ("mesh", "field", "placement")]
        median = float(np.median(row.seconds("cpu", PLACEMENT)))
        lines.append([row.method, f"{len(arrays.triangles):,}", *cells, f"{1e3 * median:.1f}"])
    print(align(["method", "triangles", "mesh ms", "field ms", "placement ms", "its median ms"], lines, left=1))


PARTS: dict[str, Callable[[Bench], None]] = {
    "demo": print_demo,
    "floor": print_floor,
    "scaling": print_scaling,
    "separation": print_separation,
    "threads": print_threads,
    "rectangle": print_rectangle,
    "helices": print_helices,
    "hard": print_hard,
    "polishing": print_polishing,
}


def main() -> int:
    """Print the tables of the chosen parts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", action="append", choices=PARTS, help="print this one only (repeatable)")
    parser.add_argument("--repeats", type=int, default=3, help="runs of each row; the fastest counts (3)")
    parser.add_argument("--timeout", type=float, default=600, metavar="S", help="give up one run after so long (600)")
    parser.add_argument("--check", type=Path, metavar="CHECKER", help="as for run.py; part rectangle shows it")
    parser.add_argument("--floor-program", type=Path, default=FLOOR_PROGRAM, metavar="PATH", help="floor.cpp, built")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pectinate-bench-") as folder:
        setup = Setup(
            folder=Path(folder),
            with_peer=False,
            repeats=None,
            timeout=arguments.timeout,
            checker=arguments.check,
            log=lambda line: print(line, file=sys.stderr, flush=True),
        )
        bench = Bench(setup, arguments.repeats, arguments.floor_program)
        complete = True
        for part in arguments.part or PARTS:
            print(f"\n## {part}\n", flush=True)
            try:
                PARTS[part](bench)
            except SurfaceMissing as reason:
                setup.log(f"{part}: {reason}")
                complete = False
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())
