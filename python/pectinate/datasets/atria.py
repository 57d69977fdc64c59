"""Fibres of the built-in atria, after the nineteen rows of the paper's Tables 1 and 2."""

from __future__ import annotations

from importlib import resources
from types import MappingProxyType

from pectinate import _core
from pectinate.choices import member
from pectinate.datasets.surfaces import atrial_surface
from pectinate.errors import InvalidOption
from pectinate.interpolated_field import InterpolatedField
from pectinate.interpolation import interpolate
from pectinate.io.tract_file import read_tracts
from pectinate.tracts import TractSet

#: What fibres do where, by the number of the row in the paper: 1 to 14 of the epicardium, 15 to 19 of the endocardium.
FIBRE_RULES = MappingProxyType(
    {
        1: "Bachmann's bundle lies on both atria as a surface of its own; its fibres run along it.",
        2: "Over the roof of the left atrium fibres run from front to back: the septopulmonary bundle.",
        3: "Round the mitral and the tricuspid valve fibres are circles.",
        4: "Outside, the sleeve of the superior vena cava has longitudinal fibres.",
        5: "On the front of the right atrium fibres turn gradually from Bachmann's bundle to the circles of the valve.",
        6: "On the right appendage fibres run towards its tip.",
        7: "Outside, the sleeves of the pulmonary veins are wrapped in circles.",
        8: "From between the veins of either side fibres run to the posterior wall.",
        9: "Below the right inferior pulmonary vein fibres turn towards the right atrium.",
        10: "On the posterior wall of the left atrium the orientation changes abruptly.",
        11: "The crista terminalis runs lengthwise from the superior to the inferior vena cava.",
        12: "On the posterior wall of the right atrium fibres run straight against the crista terminalis.",
        13: "Outside, on the free wall, fibres run beside the crista terminalis and on to the right appendage.",
        14: "Round the inferior vena cava fibres are circles.",
        15: "The left appendage has circles outside and lengthwise fibres inside.",
        16: "Inside, the superior vena cava is wrapped in circles.",
        17: "Inside the pulmonary veins fibres are lengthwise or oblique.",
        18: "Inside the left atrium fibres run from the veins down to the mitral valve.",
        19: "Inside, pectinate muscles run straight from the crista terminalis over the free wall.",
    }
)

#: How far the few points of a tract may lie from the surface, mm: they were drawn by eye.
_MAXIMUM_DISTANCE = 3.0


def atrial_tracts(chamber: str, *, layer: str = "epicardium") -> TractSet:
    """Fibre tracts and boundary conditions of one surface of the built-in atria.

    Parameters
    ----------
    chamber, layer
        As for `atrial_surface`.

    Returns
    -------
    TractSet
        The `label` of a tract is the number of the row in `FIBRE_RULES` that it stands for, if any.

    Raises
    ------
    InvalidOption
        An unknown chamber or layer, or the endocardium of Bachmann's bundle.
    """
    member(_core.AtrialSurface, "chamber", chamber)
    if chamber not in _chambers(layer):
        raise InvalidOption(f"{chamber} has no {layer}; it has an epicardium only")
    with resources.as_file(resources.files(__package__) / "tracts" / f"{chamber}_{layer}.json") as path:
        return read_tracts(path)


def atria(*, edge_length: float = 1.0, layer: str = "epicardium") -> dict[str, InterpolatedField]:
    """Make one layer of the built-in atria, with fibres interpolated from `atrial_tracts`.

    Parameters
    ----------
    edge_length
        Of the triangles, mm, from 0.1 to 2; at 1 mm the epicardium has about 43,700 triangles in all.
    layer
        `epicardium` or `endocardium`.

    Returns
    -------
    dict
        An `InterpolatedField` per chamber: `left_atrium`, `right_atrium` and, of the epicardium, `bachmann_bundle`. All
        lie in one frame; see `atrial_surface`.

    Raises
    ------
    InvalidOption
        An unknown layer, or an edge length out of its range.
    """
    return {
        chamber: interpolate(
            atrial_surface(chamber, layer=layer, edge_length=edge_length),
            atrial_tracts(chamber, layer=layer),
            maximum_distance=_MAXIMUM_DISTANCE,
        )
        for chamber in _chambers(layer)
    }


def _chambers(layer: str) -> tuple[str, ...]:
    member(_core.AtrialLayer, "layer", layer)
    return ("left_atrium", "right_atrium", *(("bachmann_bundle",) if layer == "epicardium" else ()))
