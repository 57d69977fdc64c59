"""Writing placements: `.npz`, poly-lines for ParaView, tubes.

The `.npz` file holds, without pickles:

- `vertices` (V, 3), `triangles` (T, 3), `field` (T, 3): the surface, joined again where it was cut, and its unit
  directions, zero where there is none
- `points` (N, 3), `offsets` (n + 1,), `segment_triangles` (N - n,), `point_triangles` (N,), `barycentric` (N, 3),
  `lengths` (n,), `stop_reasons` (n, 2), `seed_points` (n,): as in `Placement`
- `stop_reason_names`: the name of each value in `stop_reasons`
- `input_vertex` (V,), `input_triangle` (T,): indices in the input
- `options`, `statistics`: JSON
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pectinate._core import StopReason, SurfaceMesh
from pectinate.errors import InvalidFile, InvalidOption
from pectinate.io.gltf import make_scene, write_glb
from pectinate.io.lines import to_polylines
from pectinate.io.trimesh_io import write_trimesh
from pectinate.io.vtk_library import save_dataset
from pectinate.viewer.page import SUFFIXES as PAGE_SUFFIXES

if TYPE_CHECKING:
    from pectinate.placement import Placement


def save(placement: Placement, path: Path, **options: Any) -> None:
    """Write a placement in the format that the suffix names; see `Placement.save`."""
    writers: dict[str, Callable[..., None]] = {".npz": _save_npz, ".vtp": _save_vtp, ".glb": _save_glb}
    writers |= dict.fromkeys((".ply", ".obj"), _save_tubes)
    writers |= dict.fromkeys(PAGE_SUFFIXES, _save_page)
    suffix = path.suffix.lower()
    if suffix not in writers:
        raise InvalidOption(f"{path}: streamlines cannot be saved as {suffix!r}; use one of {', '.join(writers)}")
    if options and (suffix == ".npz" or (suffix == ".vtp") != ("values" in options)):
        raise InvalidOption(f"{path}: {', '.join(options)} is not for files of this kind")
    writers[suffix](placement, path, **options)


def _save_npz(placement: Placement, path: Path) -> None:
    mesh = placement.mesh
    try:
        np.savez(
            path,
            vertices=mesh.vertices,
            triangles=_joined_triangles(mesh),
            field=placement.field.directions,
            points=placement.points,
            offsets=placement.offsets,
            segment_triangles=placement.segment_triangles,
            point_triangles=placement.point_triangles,
            barycentric=placement.barycentric,
            lengths=placement.lengths,
            stop_reasons=placement.stop_reasons,
            stop_reason_names=np.array([reason.name for reason in StopReason]),
            seed_points=placement.seed_points,
            input_vertex=mesh.input_vertex,
            input_triangle=mesh.input_triangle,
            options=json.dumps(placement.options),
            statistics=json.dumps(placement.statistics.to_dict()),
        )
    except OSError as error:
        raise InvalidFile.at(path, f"cannot be written ({error.strerror})", "check the folder") from error


def _joined_triangles(mesh: SurfaceMesh) -> NDArray[np.int32]:
    """Triangles that share the first copy of every vertex that was split, as the input has them."""
    _, first, group = np.unique(mesh.input_vertex, return_index=True, return_inverse=True)
    return first[group].astype(np.int32)[mesh.triangles]


def _save_vtp(placement: Placement, path: Path, *, values: Mapping[str, ArrayLike] | None = None) -> None:
    save_dataset(to_polylines(placement, values), path)


def _save_tubes(placement: Placement, path: Path, **tube_options: Any) -> None:
    tubes = placement.tubes(**tube_options)
    write_trimesh(path, tubes.vertices, tubes.triangles)


def _save_glb(placement: Placement, path: Path, **tube_options: Any) -> None:
    write_glb(path, make_scene(placement.mesh, placement.tubes(**tube_options)))


def _save_page(placement: Placement, path: Path, **page_options: Any) -> None:
    placement.page(**page_options).save(path)
