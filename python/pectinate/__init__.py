"""Evenly spaced streamlines of fibre orientation fields on triangulated surfaces.

>>> import pectinate
>>> atrium = pectinate.load("la_epi.pts")
>>> placement = pectinate.place_streamlines(atrium, separation_distance=1.6)
>>> placement.save("streamlines.npz")

Everything is in millimetres after loading. An orientation is a line without a sign.
"""

from importlib.metadata import version

from pectinate import datasets, errors
from pectinate._core import OrientationField, SurfaceMesh, Tubes
from pectinate.io import load, save_surface
from pectinate.model import Model, SurfaceData
from pectinate.placement import Placement, place_streamlines
from pectinate.statistics import PlacementStatistics

__all__ = [
    "Model",
    "OrientationField",
    "Placement",
    "PlacementStatistics",
    "SurfaceData",
    "SurfaceMesh",
    "Tubes",
    "datasets",
    "errors",
    "load",
    "place_streamlines",
    "save_surface",
]

__version__ = version("pectinate")
