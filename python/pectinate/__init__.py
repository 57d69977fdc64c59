"""Evenly spaced streamlines of fibre orientation fields on triangulated surfaces.

>>> import pectinate
>>> atrium = pectinate.load("la_epi.pts")
>>> placement = pectinate.place_streamlines(atrium, separation_distance=1.6)
>>> placement.save("streamlines.npz")

Everything is in millimetres after loading. An orientation is a line without a sign.
"""

from importlib.metadata import version

from pectinate import datasets, errors, viewer
from pectinate._core import OrientationField, SurfaceMesh, Tubes
from pectinate.atlas_field import CarriedTracts, atlas, carry_tracts
from pectinate.comparison import Comparison, add_noise, compare
from pectinate.correspondence import Correspondence, correspond
from pectinate.figure import Cell, Marker, Part, PatientAxes, figure_sheet
from pectinate.interpolated_field import InterpolatedField
from pectinate.interpolation import FieldEditor, interpolate
from pectinate.io import load, save_surface
from pectinate.io.tract_file import read_tracts
from pectinate.loops import find_loop
from pectinate.model import Model, SurfaceData
from pectinate.parameterization import DiskMap, parameterize
from pectinate.placement import Placement, place_streamlines
from pectinate.smoothing import SmoothedField, smooth
from pectinate.statistics import PlacementStatistics
from pectinate.tracts import BoundaryCondition, SurfaceIdentity, Tract, TractSet

__all__ = [
    "BoundaryCondition",
    "CarriedTracts",
    "Cell",
    "Comparison",
    "Correspondence",
    "DiskMap",
    "FieldEditor",
    "InterpolatedField",
    "Marker",
    "Model",
    "OrientationField",
    "Part",
    "PatientAxes",
    "Placement",
    "PlacementStatistics",
    "SmoothedField",
    "SurfaceData",
    "SurfaceIdentity",
    "SurfaceMesh",
    "Tract",
    "TractSet",
    "Tubes",
    "add_noise",
    "atlas",
    "carry_tracts",
    "compare",
    "correspond",
    "datasets",
    "errors",
    "figure_sheet",
    "find_loop",
    "interpolate",
    "load",
    "parameterize",
    "place_streamlines",
    "read_tracts",
    "save_surface",
    "smooth",
    "viewer",
]

__version__ = version("pectinate")
