"""Surfaces that pectinate makes itself."""

from __future__ import annotations

from pectinate import _core
from pectinate.io.units import UnitDecision
from pectinate.model import Model, SurfaceData


def demo_atrium(*, edge_length: float = 1.0) -> Model:
    """Make an atrium-like surface with a smooth orientation field.

    A body with four pulmonary veins, an appendage and an open mitral valve; +x points to the patient's left, +y
    backwards, +z up. Tags: 0 body, then the veins and the appendage, as the notes of the model say. Its boundary loops
    have names, see `Model.loop_names`.

    Parameters
    ----------
    edge_length
        Of its triangles, mm, from 0.2 to 4; 1 mm gives about 43,000 triangles.

    Raises
    ------
    InvalidOption
        An edge length out of its range.
    """
    atrium = _core.make_demo_atrium(edge_length=edge_length)
    data = SurfaceData(
        vertices=atrium.vertices,
        triangles=atrium.triangles.astype("int64"),
        units=UnitDecision("mm", 1.0, "made in millimetres", "auto"),
        source="demo atrium",
        vectors=atrium.directions,
        tags=atrium.regions.astype("int64"),
        notes=tuple(f"tag {tag} is the {name}" for tag, name in enumerate(atrium.region_names)),
        loop_points={loop.name.replace("_", " "): atrium.vertices[loop.vertices[0]] for loop in atrium.loops},
    )
    return Model.from_data(data)
