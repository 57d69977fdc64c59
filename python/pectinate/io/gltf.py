"""Surface and tubes as a trimesh scene, and as GLB for programs that draw.

A GLB file of a placement keeps to glTF 2.0: one unit is a metre, +y points up and +z to the viewer who looks at the
patient from the front, for coordinates with +x to the patient's left, +y backwards and +z up. The node `pectinate`
holds that transform; below it, `surface` and `streamlines` have materials of the same names, normals, and coordinates
in millimetres.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.visual.material import PBRMaterial

from pectinate.figure.shading import Color, Style, vertex_normals
from pectinate.io.text import unwritable

if TYPE_CHECKING:
    from pectinate._core import SurfaceMesh, Tubes

_ROOT = "pectinate"
# From patient coordinates in mm (left, posterior, superior) to glTF.
_TO_GLTF = 1e-3 * np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1e3]])
_SURFACE_ROUGHNESS, _TUBE_ROUGHNESS = 0.9, 0.6


def make_scene(mesh: SurfaceMesh, tubes: Tubes, style: Style = Style()) -> trimesh.Scene:  # noqa: B008  (immutable)
    """A scene in millimetres with the nodes `surface` and, where there is any tube, `streamlines`."""
    scene = trimesh.Scene(base_frame=_ROOT)
    parts = {
        "surface": (mesh.vertices, mesh.triangles, style.surface_color, _SURFACE_ROUGHNESS),
        "streamlines": (tubes.vertices, tubes.triangles, style.tube_color, _TUBE_ROUGHNESS),
    }
    for name, (vertices, triangles, color, roughness) in parts.items():
        if len(triangles):
            material = _material(name, color, roughness, both_sides=name == "surface")
            scene.add_geometry(make_trimesh(vertices, triangles, material), node_name=name, geom_name=name)
    return scene


def make_trimesh(
    vertices: NDArray[np.float64], triangles: NDArray[np.integer[Any]], material: PBRMaterial | None = None
) -> trimesh.Trimesh:
    """A `trimesh.Trimesh` with the same rows, and normals per vertex."""
    normals = vertex_normals(np.asarray(vertices), np.asarray(triangles, dtype=np.int64))
    visual = None if material is None else trimesh.visual.TextureVisuals(material=material)
    return trimesh.Trimesh(
        np.array(vertices), np.array(triangles), vertex_normals=normals, visual=visual, process=False
    )


def write_glb(path: Path, scene: trimesh.Scene) -> None:
    """Write a scene of `make_scene` as GLB, in metres with +y up.

    Raises
    ------
    InvalidFile
        It cannot be written.
    """
    placed = trimesh.Scene(base_frame="world")
    placed.graph.update(frame_from="world", frame_to=_ROOT, matrix=_TO_GLTF)
    for name, geometry in scene.geometry.items():
        placed.add_geometry(geometry, node_name=name, geom_name=name, parent_node_name=_ROOT)
    data = trimesh.exchange.gltf.export_glb(placed, include_normals=True)
    try:
        path.write_bytes(data)
    except OSError as error:
        raise unwritable(path, error) from error


def _material(name: str, color: Color, roughness: float, *, both_sides: bool) -> PBRMaterial:
    return PBRMaterial(
        name=name,
        baseColorFactor=[*(_linear(channel) for channel in color), 1.0],
        metallicFactor=0.0,
        roughnessFactor=roughness,
        doubleSided=both_sides,
    )


def _linear(channel: float) -> float:
    """Light of a channel of display RGB (sRGB): glTF's factors are linear."""
    return channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4  # noqa: PLR2004
