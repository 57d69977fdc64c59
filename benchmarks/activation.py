"""Example: activation times on an atrium, drawn under its streamlines.

`python benchmarks/activation.py surface.pts --start=X,Y,Z --out sheet.png` draws any surface with fibres. The wave
runs from one place along the shortest ways, faster along the fibres than across them (on a flat grid up to 11 % late,
1 % in the mean); no cells, no wall, so this is an illustration and not a simulation.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

import pectinate
from pectinate import Model, _core
from pectinate.figure import SurfaceValues

# mm per ms.
SPEED_ALONG, SPEED_ACROSS = 1.0, 0.4
ISOCHRONE_STEP = 10.0  # ms
# Ways lead straight from a vertex to those as many edges away: the more, the more directions there are.
EDGES_AHEAD = 3


def activation_times(model: Model, start: ArrayLike) -> NDArray[np.float64]:
    """Time, (V,) ms, at which a wave from the vertex nearest to `start` (mm) reaches each vertex of the mesh.

    NaN where it does not.
    """
    vertices = model.mesh.vertices
    fibres = _core.vertex_directions(model.mesh, model.require_field())
    near, far = vertex_pairs(model.mesh.triangles, len(vertices))
    way = vertices[far] - vertices[near]
    times = np.mean([travel_times(way, fibres[end]) for end in (near, far)], axis=0)
    graph = csr_array((times, (near, far)), shape=(len(vertices), len(vertices)))
    first = int(np.argmin(np.linalg.norm(vertices - np.asarray(start), axis=1)))
    found = dijkstra(graph, indices=first)
    return np.where(np.isfinite(found), found, np.nan)


def vertex_pairs(triangles: NDArray[np.integer], vertex_count: int) -> tuple[NDArray[np.integer], NDArray[np.integer]]:
    """Pairs of vertices that are at most `EDGES_AHEAD` edges apart, both ways."""
    ends = np.concatenate([triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    ends = np.concatenate([ends, ends[:, ::-1]])
    edges = csr_array((np.ones(len(ends), bool), ends.T), shape=(vertex_count, vertex_count))
    reached = edges
    for _ in range(EDGES_AHEAD - 1):
        reached = (reached @ edges + reached).astype(bool)
    near, far = reached.nonzero()
    return near[near != far], far[near != far]


def travel_times(ways: NDArray[np.float64], fibres: NDArray[np.float64]) -> NDArray[np.float64]:
    """Time, (n,) ms, along straight ways (n, 3) in mm where fibres are (n, 3); zero vectors conduct as if across."""
    along = (ways * fibres).sum(axis=1)
    across = np.maximum((ways**2).sum(axis=1) - along**2, 0.0)
    return np.sqrt((along / SPEED_ALONG) ** 2 + across / SPEED_ACROSS**2)


def activation_values(model: Model, start: ArrayLike) -> SurfaceValues:
    """Activation times with isochrones."""
    return SurfaceValues(activation_times(model, start), label="activation time (ms)", contours=ISOCHRONE_STEP)


def main(argv: Sequence[str] | None = None) -> None:
    """Draw the sheet of a file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, help="surface with fibres")
    parser.add_argument(
        "--start",
        type=lambda text: [float(x) for x in text.split(",")],
        help="X,Y,Z, mm; by default the uppermost vertex",
    )
    parser.add_argument("--separation", type=float, default=1.6, help="of the streamlines, mm")
    parser.add_argument("--out", type=Path, required=True, help="picture")
    arguments = parser.parse_args(argv)
    model = pectinate.load(arguments.mesh)
    vertices = model.mesh.vertices
    start = vertices[np.argmax(vertices[:, 2])] if arguments.start is None else arguments.start
    placement = pectinate.place_streamlines(model, separation_distance=arguments.separation)
    placement.figure(arguments.out, surface_values=activation_values(model, start), size=(640, 560))


if __name__ == "__main__":
    main()
