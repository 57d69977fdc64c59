"""Surfaces that pectinate makes itself."""

from __future__ import annotations

from dataclasses import replace

from pectinate import _core
from pectinate.choices import member
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
    return Model.from_data(replace(_surface_data(atrium, "demo atrium"), vectors=atrium.directions))


def atrial_surface(chamber: str, *, layer: str = "epicardium", edge_length: float = 1.0) -> Model:
    """Make one surface of the built-in atria, without a field.

    All of them lie in one frame, in mm: +x points to the patient's left, +y backwards, +z up. Tags tell the regions, as
    the notes of the model say. Every boundary loop has a name, see `Model.loop_names`.

    Parameters
    ----------
    chamber
        `left_atrium`, `right_atrium`, or `bachmann_bundle`, a band above both.
    layer
        `epicardium`, or `endocardium` some 2 mm inside it; Bachmann's bundle has an epicardium only.
    edge_length
        Of its triangles, mm, from 0.1 to 2; at 1 mm the epicardium of all three has about 43,700 triangles.

    Raises
    ------
    InvalidOption
        An unknown chamber or layer, the endocardium of Bachmann's bundle, an edge length out of its range.
    """
    kind = member(_core.AtrialSurface, "chamber", chamber)
    depth = member(_core.AtrialLayer, "layer", layer)
    surface = _core.make_atrial_surface(kind, depth, edge_length=edge_length)
    return Model.from_data(_surface_data(surface, f"{chamber.replace('_', ' ')}, {layer}"))


def _surface_data(surface: _core.DemoAtrium | _core.GeneratedSurface, source: str) -> SurfaceData:
    return SurfaceData(
        vertices=surface.vertices,
        triangles=surface.triangles.astype("int64"),
        units=UnitDecision("mm", 1.0, "made in millimetres", "auto"),
        source=source,
        tags=surface.regions.astype("int64"),
        notes=tuple(f"tag {tag} is the {name}" for tag, name in enumerate(surface.region_names)),
        loop_points={loop.name.replace("_", " "): surface.vertices[loop.vertices[0]] for loop in surface.loops},
    )
