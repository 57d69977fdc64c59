"""PLY, OBJ, OFF, STL and GLB: geometry without an orientation field, through trimesh (OBJ is read in `obj`)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from pectinate.errors import InvalidFile, InvalidMesh
from pectinate.io.obj import read_obj
from pectinate.io.objects import surface_from_arrays
from pectinate.io.text import unwritable
from pectinate.io.units import decide_unit, to_millimetres
from pectinate.model import SurfaceData

SUFFIXES = (".ply", ".obj", ".off", ".stl", ".glb")

#: Options for the formats that are text; the others are written in single precision.
_WRITE_OPTIONS: dict[str, dict[str, Any]] = {".obj": {"digits": 17}, ".off": {"digits": 17}}


def read_trimesh(path: Path, *, units: str = "auto") -> SurfaceData:
    """Read a surface in the order of the file; polygons are split into triangles and counted in the notes.

    STL stores each triangle by itself: vertices at exactly the same place are merged. The parts of a GLB scene are
    joined after their transforms.

    Raises
    ------
    InvalidFile
        The file is missing or malformed, or has no triangle.
    """
    suffix = path.suffix.lower()
    if suffix == ".obj":
        vertices, triangles, split = read_obj(path)
        notes = [f"{split} polygons were split into triangles"] if split else []
    else:
        vertices, triangles, notes = _read(path, suffix)
    decision = decide_unit(vertices, units)
    return SurfaceData(to_millimetres(vertices, decision), triangles, decision, str(path), notes=tuple(notes))


def surface_from_trimesh(mesh: Any, *, units: str = "auto") -> SurfaceData:
    """Take a `trimesh.Trimesh`, or a `trimesh.Scene` whose meshes are joined.

    Raises
    ------
    InvalidMesh
        It holds no triangle.
    """
    if isinstance(mesh, trimesh.Trimesh):
        return surface_from_arrays(mesh.vertices, mesh.faces, units=units, source="trimesh object")
    parts = _parts(mesh) if isinstance(mesh, trimesh.Scene) else []
    if not parts:
        raise InvalidMesh(f"the trimesh {type(mesh).__name__} holds no triangle; give a mesh")
    vertices, triangles = _join(parts)
    return surface_from_arrays(vertices, triangles, units=units, source="trimesh scene")


def write_trimesh(path: Path, vertices: NDArray[np.float64], triangles: NDArray[np.integer[Any]]) -> None:
    """Write a surface, vertices (V, 3) and triangles (T, 3); PLY, STL and GLB hold single precision only.

    Raises
    ------
    InvalidFile
        It cannot be written.
    """
    suffix = path.suffix.lower()
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    try:
        mesh.export(path, file_type=suffix[1:], **_WRITE_OPTIONS.get(suffix, {}))
    except OSError as error:
        raise unwritable(path, error) from error


def _read(path: Path, suffix: str) -> tuple[NDArray[np.float64], NDArray[np.int64], list[str]]:
    if not path.is_file():
        raise InvalidFile.at(path, "there is no such file", "check the path")
    # Without fix_texture=False trimesh splits the vertices of a PLY file along its texture seams.
    options: dict[str, Any] = {"fix_texture": False} if suffix == ".ply" else {}
    try:
        scene = trimesh.load(path, file_type=suffix[1:], force="scene", process=False, **options)
        parts = _parts(scene)
    except Exception as error:
        rule = f"is no valid {suffix[1:].upper()} file ({error})"
        raise InvalidFile.at(path, rule, "write it again") from error
    if not parts:
        raise InvalidFile.at(path, "holds no triangle", "give a surface, not a set of points or curves")
    vertices, triangles = _join(parts)
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        row = int(np.argmax(((triangles < 0) | (triangles >= len(vertices))).any(axis=1)))
        rule = f"triangle {row} has the corners {triangles[row].tolist()} among {len(vertices)} vertices"
        raise InvalidFile.at(path, rule, "correct the indices")
    notes = _face_notes(path, suffix, scene, len(triangles))
    if suffix == ".stl":
        vertices, triangles, note = _merge_duplicates(vertices, triangles)
        notes.append(note)
    if len(parts) > 1:
        notes.append(f"{len(parts)} meshes of the scene were joined")
    return vertices, triangles, notes


def _parts(scene: Any) -> list[tuple[NDArray[np.float64], NDArray[np.int64]]]:
    """Vertices, at their place in the scene, and triangles of each mesh, in the order of the meshes."""
    parts, ranks = [], {name: rank for rank, name in enumerate(scene.geometry)}
    placed = [(name, node, transform) for node in scene.graph.nodes_geometry for transform, name in [scene.graph[node]]]
    for name, _, transform in sorted(placed, key=lambda place: (ranks[place[0]], place[1])):
        mesh = scene.geometry[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            vertices = np.array(mesh.vertices, dtype=np.float64)
            if not np.array_equal(transform, np.eye(4)):
                vertices = vertices @ transform[:3, :3].T + transform[:3, 3]
            parts.append((vertices, np.array(mesh.faces, dtype=np.int64)))
    return parts


def _join(
    parts: list[tuple[NDArray[np.float64], NDArray[np.int64]]],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    triangles = [corners + start for (_, corners), start in zip(parts, starts, strict=False)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(triangles)


def _face_notes(path: Path, suffix: str, scene: Any, found: int) -> list[str]:
    """Compare the triangles with the faces that the file announces: more are polygons split, fewer a cut file."""
    stated = _stated_faces(path, suffix, scene)
    if stated is None or found == stated:
        return []
    if found < stated:
        rule = f"announces {stated} faces, {found} triangles were found"
        raise InvalidFile.at(path, rule, "write it again, it may have been cut off")
    split = f"{stated} faces gave {found} triangles: polygons were split"
    return [f"{split}, and triangles are no longer numbered like the faces of the file"]


def _stated_faces(path: Path, suffix: str, scene: Any) -> int | None:
    if suffix == ".ply":
        (mesh,) = scene.geometry.values()
        return int(mesh.metadata["_ply_raw"]["face"]["length"])
    if suffix == ".off":
        lines = [line.split("#")[0] for line in path.read_text(errors="replace").splitlines()]
        tokens = " ".join(lines).upper().partition("OFF")[2].split()
        return int(tokens[1])
    return None


def _merge_duplicates(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], str]:
    """Merge vertices at exactly the same place; the first of each keeps its rank."""
    _, first, group = np.unique(vertices + 0.0, axis=0, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    note = f"{len(vertices)} corners at {len(first)} places were merged: STL has no shared vertices"
    return vertices[np.sort(first)], rank[group.reshape(-1)][triangles], note
