"""One run of one engine in this process: `python worker.py JOB.json`, started by `runs.py`.

The job names the engine, its options, the file of the surface's arrays and where the results go.
"""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from measure import PeakMemory, Stages
from pectinate import Model, OrientationField, SurfaceData, SurfaceMesh, place_streamlines
from pectinate.errors import Error
from pectinate.io import UnitDecision
from surfaces import Arrays

PEER = "evenlyspacedstreamlines"


@dataclass(frozen=True, eq=False)
class Run:
    """Streamlines, on the triangles of the input, and what they took.

    Attributes
    ----------
    points, offsets, segment_triangles
        As in `pectinate.Placement`.
    stages
        Stage -> {"cpu": s, "wall": s}.
    peak_memory, placement_memory
        Rise from the arrays to the streamlines, and from mesh and field to them, MB; of the peer the same.
    """

    points: NDArray[np.float64]
    offsets: NDArray[np.int64]
    segment_triangles: NDArray[np.int32]
    stages: dict[str, dict[str, float]]
    peak_memory: float
    placement_memory: float


def method_options(text: str) -> dict[str, Any]:
    """Read a placement method and other options, as in "longest, seed_clearance=1.11"."""
    method, *others = (part.strip() for part in text.split(","))
    options: dict[str, Any] = {"method": method}
    for name, value in (other.split("=") for other in others):
        options[name] = value if name == "occupancy" else json.loads(value)
    return options


class Refused(Exception):
    """An engine does not take the surface."""


def run_pectinate(arrays: Arrays, options: dict[str, Any]) -> Run:
    """Place streamlines by one of our methods, stage by stage."""
    unit = UnitDecision("mm", 1.0, "made in millimetres", "user")
    data = SurfaceData(arrays.vertices, arrays.triangles, unit, "benchmark", vectors=arrays.field)
    stages, memory = Stages(), PeakMemory()
    try:
        with stages.stage("mesh"):
            mesh = SurfaceMesh(data.vertices, data.triangles)
        with stages.stage("field"):
            field = OrientationField.from_triangle_vectors(mesh, arrays.field)
        place = partial(
            place_streamlines,
            Model(mesh, field, data),
            separation_distance=options["separation_distance"],
            **method_options(options["method"]),
            seed_count=options["seed_count"],
            random_seed=options["random_seed"],
            thread_count=options["threads"],
        )
        memory.start_part()
        with stages.stage("placement"):
            placement = place()
    except Error as error:
        raise Refused(str(error)) from error
    peak_memory, placement_memory = memory.rise(), memory.part_rise()
    if options["again"]:
        with stages.stage("again"):
            place()
    with stages.stage("tubes"):
        placement.tubes()
    input_triangles = mesh.input_triangle[placement.segment_triangles]
    return Run(placement.points, placement.offsets, input_triangles, stages.seconds, peak_memory, placement_memory)


def run_peer(arrays: Arrays, options: dict[str, Any]) -> Run:
    """Place streamlines by the peer; its `radius` is d_sep, the least distance between two streamlines."""
    place = importlib.import_module(PEER).evenly_spaced_streamlines
    triangles = arrays.triangles.astype(np.int32)
    stages, memory = Stages(), PeakMemory()
    try:
        with stages.stage("placement"):
            lines, segment_triangles, _ = place(
                arrays.vertices,
                triangles,
                arrays.field,
                options["separation_distance"],
                seed_points=options["seed_count"],
                random_seed=options["random_seed"],
                parallel=options["threads"] > 1,
                num_threads=options["threads"],
            )
    except (ValueError, RuntimeError) as error:
        raise Refused(str(error)) from error
    peak_memory = memory.rise()
    offsets = np.concatenate([[0], np.cumsum([len(line) for line in lines])]).astype(np.int64)
    return Run(
        np.concatenate(lines), offsets, np.concatenate(segment_triangles), stages.seconds, peak_memory, peak_memory
    )


ENGINES: dict[str, Callable[[Arrays, dict[str, Any]], Run]] = {"pectinate": run_pectinate, PEER: run_peer}


def main(job_file: str) -> None:
    """Do the job: the streamlines go to one file, the figures to another."""
    job = json.loads(Path(job_file).read_text())
    try:
        run = ENGINES[job["engine"]](Arrays.read(Path(job["arrays"])), job["options"])
    except Refused as refusal:
        figures: dict[str, Any] = {"failure": f"refused: {refusal}"}
    else:
        figures = {
            "stages": run.stages,
            "peak_memory": run.peak_memory,
            "placement_memory": run.placement_memory,
        }
        np.savez(job["streamlines"], points=run.points, offsets=run.offsets, segment_triangles=run.segment_triangles)
    Path(job["figures"]).write_text(json.dumps(figures))


if __name__ == "__main__":
    main(sys.argv[1])
